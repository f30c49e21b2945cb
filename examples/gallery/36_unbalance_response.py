"""
36. Vibration over speed
========================

The unbalance response over speed, with the critical speed, the limits of API 617 and ISO 14839-2, and the speeds at which the rotor
touches.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.1 mm"])
response = cm.studies.unbalance_response(machine, ("500 rpm", "4000 rpm"))
print(f"amplification factor {response.criticals[0].factor:.3f}")

# %%
# What to see: the vibration peaks at the critical speed, the dotted line; at the speed of the machine, the dashed line, it is in zone B of ISO
# 14839-2, far above the limit of API 617.  Below, the phase passes through 90 degrees at the peak.
figure = response.plot()
