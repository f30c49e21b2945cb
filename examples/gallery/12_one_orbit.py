"""
12. One orbit in two frames
===========================

The stable orbit closes after each impact in the co-rotating frame; in the fixed frame its impacts move round the bearing.
"""

import carom as cm

orbit = cm.find_orbits(cm.load("../keogh-cole.toml"))["B1,d"]
print(f"one impact every {orbit.period:.4f}/Omega, towards the wall with {orbit.radial_speed:.4f} clearances Omega")

# %%
# What to see: the loop on the left closes after each impact.  On the right the same eight impacts lie all round the bearing, each a little over a
# third of a turn after the last.
figure = orbit.plot()
