"""
23. Orbits that shrink into the wall
====================================

Where levitation reaches the wall, bouncing orbits may shrink to zero amplitude: the non-smooth Hopf bifurcation.  It determines the motion of the
rotor when the damping falls.
"""

import carom as cm

machine = cm.load("../source-paper.toml")
(boundary,) = cm.bifurcations.boundary_equilibria(machine)
print(boundary.words)

# %%
# What to see: near the wall, enlarged, a small unstable loop next to levitation, the pentagon.  It limits the disturbances that come back, and
# shrinks to levitation as the damping falls.
near = machine.replace(gamma=boundary.value + 0.002)
figure = cm.find_orbits(near)["B1,b"].plot()
