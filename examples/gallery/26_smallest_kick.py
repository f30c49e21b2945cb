"""
26. The smallest kick that does not come back
=============================================

A search over sizes and directions brackets the smallest kick that does not come back.  Up to a smaller size contact is impossible, which is
proven.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
kicks = cm.disturbances.VelocityKick.of(machine, "250 mm/s")
smallest = cm.basins.smallest_unrecovered(machine, kicks)
unit = 1e3 * machine.parameters.scales.velocity
print(f"no contact up to {smallest.contact_free * unit:.3g} mm/s; lost from {smallest.size * unit:.4g} mm/s on")

# %%
# What to see: the small circle at the edge of the green core is the smallest kick found that does not come back.  Inside the dashed ring no kick leads to contact.
basin = cm.map_basins(machine, cm.Grid(kicks, (40, 60)))
figure = basin.plot(smallest)
