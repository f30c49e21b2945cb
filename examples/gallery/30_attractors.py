"""
30. Where disturbances end
==========================

A seeded sample of kicks and of starts within the clearance, simulated until each outcome is certain.  The intervals have 95 %
confidence.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
found = cm.find_attractors(machine, count=100, seed=1)
for attractor in found:
    print(f"{attractor.name.words:22s} {attractor.share_of_disturbances:6.1%}")

# %%
# What to see: two bars: two thirds of the disturbances end in regular bouncing.  The motions without a bar exist and persist once reached,
# but no disturbance of this sample reached them.
figure = found.plot()
