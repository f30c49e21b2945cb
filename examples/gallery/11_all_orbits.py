"""
11. All orbits with one impact a period
=======================================

:func:`carom.find_orbits` solves the equation of the periods for all its roots, so the list is complete, and it says why.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
orbits = cm.find_orbits(machine)
for orbit in orbits:
    print(orbit.name, f"T = {orbit.period:.6f}", "stable" if orbit.stable else "unstable")
print(orbits.argument)

# %%
# What to see: each orbit is a loop that touches the wall once, in the frame that turns with the shaft.  Only the large solid one, B1,d, is
# stable: on it the machine bounces for ever.  The dashed ones are unstable; those beside the rub are too small to be seen here, and :meth:`carom.orbits.Orbit.plot` enlarges them.
figure = orbits.plot(cm.find_equilibria(machine))
