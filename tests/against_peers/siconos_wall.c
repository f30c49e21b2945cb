/* The clearance as Siconos sees it: coordinates x, y of the rotor centre and the way of the shaft's surface. */

#include <math.h>

void gap(unsigned int coordinates, const double *q, unsigned int size, double *y, unsigned int parameters, double *z)
{
    y[0] = 1.0 - hypot(q[0], q[1]);
    if (size > 1)
        y[1] = 0.0;
}

/* Rows: speed away from the wall and slip; stored by columns. */
void gap_rates(unsigned int coordinates, const double *q, unsigned int size, double *rates, unsigned int parameters,
               double *z)
{
    double radius = hypot(q[0], q[1]);
    double across = q[0] / radius, along = q[1] / radius;
    rates[0] = -across;
    rates[1] = -along;
    rates[2] = -along;
    rates[3] = across;
    rates[4] = 0.0;
    rates[5] = 1.0;
}

void unbalance(double time, unsigned int coordinates, double *force, unsigned int parameters, double *z)
{
    force[0] = z[0] * cos(time + z[1]);
    force[1] = z[0] * sin(time + z[1]);
    force[2] = 0.0;
}
