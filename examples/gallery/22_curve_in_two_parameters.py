"""
22. A bifurcation in two parameters
===================================

The fold in which the bouncing orbits vanish, followed as damping and speed change together.
"""

import numpy as np
from matplotlib.figure import Figure

import carom as cm

machine = cm.load("../keogh-cole.toml")
branch = cm.continue_orbit(cm.find_orbits(machine)["B1,d"], "damping", ("1000 N s/m", "2000 N s/m"))
(fold,) = (point for point in branch.special if point.kind == "fold")
plane = cm.bifurcations.Plane("damping", "speed", ("500 N s/m", "3000 N s/m"), ("1300 rpm", "2500 rpm"))
curve = cm.continue_curve(fold, plane)
print(curve.kind, len(curve.points), "points; ends:", curve.stops)

# %%
# To the right of the curve no orbit with one impact a period exists.
figure = Figure(figsize=(5.0, 3.8), layout="constrained")
panel = figure.subplots()
rpm = np.pi / 30.0
panel.plot(curve.points[:, 0], curve.points[:, 1] / rpm, label="fold of two orbits")
panel.plot(1400, 184.2 / rpm, "*", ms=12, label="this machine")
panel.legend()
panel.set(xlabel="damping (N s/m)", ylabel="speed (rpm)")
