"""
15. Orbits with several impacts
===============================

Such orbits are searched: stretches of simulated motions are guesses for Newton's method.  Each orbit found is checked; nothing proves that
they are all, but the share of fresh motions that end on one of them is measured.
"""

import carom as cm

machine = cm.load("../source-paper.toml", ["gamma=0.0833"])
orbits = cm.find_orbits(machine, impacts=2, guesses=200)
for orbit in orbits:
    print(orbit.name, orbit.word, f"T = {orbit.period:.6f}", "stable" if orbit.stable else "unstable")
print(orbits.argument)

# %%
# What to see: the stable one of the orbits with two impacts.  On the left both impacts are nearly at the same place: it was born from the orbit
# with one, where that doubles its period, and is close to it still.
(doubled,) = (orbit for orbit in orbits if orbit.impacts == 2 and orbit.stable)
figure = doubled.plot()
