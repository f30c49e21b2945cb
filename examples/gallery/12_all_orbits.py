"""
12. All orbits with one impact a period
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
# Each closes in the frame that turns with the shaft.
figure = orbits.plot(cm.find_equilibria(machine))
