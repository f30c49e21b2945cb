"""
22. Regions of damping and stiffness
====================================

All curves of a plane, and which motions coexist in the regions between them.
"""

import carom as cm

machine = cm.load("../source-paper.toml")
plane = cm.bifurcations.Plane("gamma", "omega", (0.02, 0.3), (0.7, 0.85))
regions = cm.map_regions(machine, plane, grid=8)
for region in regions.regions[:3]:
    print(region.motions)

# %%
# What to see: below the green curve the machine levitates, above it it cannot.  Between the dashed and the black line it can also bounce for
# ever.  Each area has a number, and the list below tells the motions in it; the star is the machine.
figure = regions.plot()
