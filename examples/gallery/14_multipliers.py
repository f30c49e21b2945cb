"""
14. Multipliers
===============

A small deviation from an orbit is multiplied by these complex numbers from one impact to the next: the orbit is stable if all of them lie
inside the unit circle.
"""

import carom as cm

orbits = cm.find_orbits(cm.load("../source-paper.toml"))
for orbit in orbits:
    print(orbit.name, abs(orbit.multipliers.values).round(4))

# %%
# What to see: all filled diamonds, those of B1,d, lie inside the unit circle, so that it is stable.  Each of the other orbits has a mark
# outside, where the scale is logarithmic.
figure = cm.plots.multipliers(orbits)
