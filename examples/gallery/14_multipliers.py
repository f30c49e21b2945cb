"""
14. Multipliers
===============

Multipliers are the complex growth factors of a small deviation from an orbit, from one impact to the next: the orbit is stable if all of them lie
inside the unit circle.
"""

import carom as cm

orbits = cm.find_orbits(cm.load("../source-paper.toml"))
for orbit in orbits:
    print(orbit.name, abs(orbit.multipliers.values).round(4))

# %%
# What to see: all filled diamonds, those of B1,d, lie inside the unit circle: this orbit is stable.  Each of the other orbits has a multiplier
# outside, where the scale is logarithmic.
figure = cm.plots.multipliers(orbits)
