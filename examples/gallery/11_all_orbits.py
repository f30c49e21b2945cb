"""
11. All orbits with one impact a period
=======================================

:func:`carom.find_orbits` finds all roots of the equation of the periods, so the list is complete; the result states the argument.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
orbits = cm.find_orbits(machine)
for orbit in orbits:
    print(orbit.name, f"T = {orbit.period:.6f}", "stable" if orbit.stable else "unstable")
print(orbits.argument)

# %%
# What to see: each orbit is a loop that touches the wall once, in the frame that turns with the shaft.  Only the large solid one, B1,d, is
# stable: bouncing on it persists.  The dashed ones are unstable; those next to the rub are too small to be seen here, and :meth:`carom.orbits.Orbit.plot` enlarges them.
figure = orbits.plot(cm.find_equilibria(machine))
