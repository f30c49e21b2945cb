"""
22. Regions of damping and stiffness
====================================

All bifurcation curves in the plane of two parameters, and the motions that coexist in the regions between them.
"""

import carom as cm

machine = cm.load("../source-paper.toml")
plane = cm.bifurcations.Plane("gamma", "omega", (0.02, 0.3), (0.7, 0.85))
regions = cm.map_regions(machine, plane, grid=8)
for region in regions.regions[:3]:
    print(region.motions)

# %%
# What to see: below the green curve the machine levitates, above it cannot.  Between the dashed and the black line it can also keep
# bouncing.  Each region has a number, and the list below states its motions; the star is the machine.
figure = regions.plot()
