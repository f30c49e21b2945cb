"""
16. Orbits with several impacts
===============================

Such orbits are searched from stretches of simulated motions.  Each one found is closed by Newton's method and checked; nothing proves that
they are all.
"""

import carom as cm

machine = cm.load("../source-paper.toml", ["gamma=0.0833"])
orbits = cm.find_orbits(machine, impacts=2, starts=20)
for orbit in orbits:
    print(orbit.name, orbit.word, f"T = {orbit.period:.6f}", "stable" if orbit.stable else "unstable")
print(orbits.argument)
figure = orbits[0].plot()
