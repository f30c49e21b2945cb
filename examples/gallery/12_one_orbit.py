"""
12. One orbit in two frames
===========================

The stable orbit closes after each impact in the co-rotating frame; seen from outside its impacts wander round the bearing.
"""

import carom as cm

orbit = cm.find_orbits(cm.load("../keogh-cole.toml"))["B1,d"]
print(f"one impact every {orbit.period:.4f}/Omega, towards the wall with {orbit.radial_speed:.4f} clearances Omega")

# %%
# What to see: the loop on the left closes after each impact.  On the right the same eight impacts lie all round the bearing, each a good third
# of a turn after the last.
figure = orbit.plot()
