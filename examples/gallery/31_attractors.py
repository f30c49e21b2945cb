"""
31. Where disturbances end
==========================

A seeded sample of kicks and of starts within the clearance, followed until each motion is known.  The intervals are those at 95 %
confidence.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
found = cm.find_attractors(machine, count=100, seed=1)
for attractor in found:
    print(f"{attractor.name:18s} {attractor.share_of_disturbances:6.1%}")
figure = found.plot()
