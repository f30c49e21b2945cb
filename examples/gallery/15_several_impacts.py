"""
15. Orbits with several impacts
===============================

Such orbits are found by search: sections of simulated motions are initial guesses for Newton's method.  Each orbit found is checked; the list may be
incomplete, but the share of new motions that end on one of the orbits is measured.
"""

import carom as cm

machine = cm.load("../source-paper.toml", ["gamma=0.0833"])
orbits = cm.find_orbits(machine, impacts=2, guesses=200)
for orbit in orbits:
    print(orbit.name, orbit.word, f"T = {orbit.period:.6f}", "stable" if orbit.stable else "unstable")
print(orbits.argument)

# %%
# What to see: the stable orbit with two impacts.  On the left both impacts are nearly at the same place: the orbit was born in a period doubling of
# the orbit with one impact, and is still close to it.
(doubled,) = (orbit for orbit in orbits if orbit.impacts == 2 and orbit.stable)
figure = doubled.plot()
