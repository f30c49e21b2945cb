"""
32. How unpredictable the end is
================================

Basin entropy measures how mixed the motions are in small boxes of a basin.  Above ln 2 at the boundaries, these cannot be smooth curves.
"""

import carom as cm

machine = cm.load("../source-paper.toml", ["gamma=0.15"])
basin = cm.map_basins(machine, cm.Grid(cm.disturbances.StateSlice(), (80, 80)))
entropy = cm.basins.basin_entropy(basin)
print(f"S_b = {entropy.whole:.3f}, at the boundaries {entropy.boundary:.3f}; fractal: {entropy.fractal}")

# %%
# What to see: all positions in which the rotor may be released, at rest as seen in the room.  From the blue ones it bounces, from the hatched
# ones it rubs, from none does it levitate; the border between them is one smooth curve.
figure = basin.plot()
