"""
19. Grazing
===========

An orbit that touches the wall with zero radial speed between its impacts grazes.  There the sequence of contacts changes.
"""

import carom as cm

machine = cm.load("../source-paper.toml")
branch = cm.continue_orbit(cm.find_orbits(machine)["B1,d"], "gamma", (0.05, 0.1))
(grazing,) = (point for point in branch.special if point.kind == "grazing")
print(f"grazes at gamma = {grazing.value:.10f}; beyond it is {branch.orbits[0].reason or 'admissible'}")

# %%
# What to see: between two impacts, at the triangles, the curve just touches the wall.  With less damping it would cross the wall: the orbit is then
# virtual.
figure = cm.plots.radius(grazing.orbit.trajectory(2))
