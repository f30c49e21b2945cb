"""
23. Orbits that shrink into the wall
====================================

Where levitation meets the wall, bouncing orbits may shrink to nothing: the non-smooth Hopf bifurcation.  It decides what becomes of the
rotor when the damping falls.
"""

import carom as cm

machine = cm.load("../source-paper.toml")
(boundary,) = cm.bifurcations.boundary_equilibria(machine)
print(boundary.words)

# %%
# What to see: near the wall, enlarged, a small unstable loop beside levitation, the pentagon.  It bounds what levitation recovers from, and
# shrinks into it as the damping falls.
near = machine.replace(gamma=boundary.value + 0.002)
figure = cm.find_orbits(near)["B1,b"].plot()
