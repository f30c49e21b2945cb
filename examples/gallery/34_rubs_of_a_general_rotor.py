"""
34. Rubs at two bearings at once
================================

The same rotor may rub at one bearing or at both.  With contact at up to two bearings all equilibria are found.
"""

import numpy as np

import carom as cm

ends = np.array([[1.0, 0.8], [1.0, -0.7]])
rotor = cm.models.from_matrices(
    mass=np.diag([1.0, 0.4]),
    damping=0.05 * ends.T @ ends,
    stiffness=0.3 * ends.T @ ends,
    gyroscopic=np.diag([0.0, 0.3]),
    forcing=[0.25, 0.05],
    touchdowns=[cm.models.Touchdown(end, cm.models.Rigid(0.9), friction=0.15, surface_speed=21.0) for end in ends],
    translation=[1.0, 0.0],
)
equilibria = cm.find_equilibria(rotor)
for equilibrium in equilibria:
    print(equilibrium.kind, equilibrium.status, "stable" if equilibrium.stable else "unstable")

# %%
# What to see: a circle for each bearing.  The filled square is the only stable rub; it touches at both bearings.  Grey squares would need a wall
# that pulls.  The thin line is the motion after a kick, which bounces and ends in the rub.
figure = equilibria.plot()
motion = cm.simulate(rotor, cm.kick(0.6, angle=1.6), settle=True)
times = np.linspace(0.0, 40.0, 4000)
for plane, panel in enumerate(figure.axes):
    path = motion.seen_at(plane).position(times)
    panel.plot(path.real, path.imag, lw=0.5, color="#3d4f66", zorder=1)
