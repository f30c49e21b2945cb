"""
21. A bifurcation in two parameters
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
# What to see: to the right of the curve, at higher damping, no orbit with one impact a period exists.  The star is the machine: at its speed another
# 240 N s/m are enough, and the faster it runs the more it needs.
figure = Figure(figsize=(5.0, 3.8), layout="constrained")
panel = figure.subplots()
rpm = np.pi / 30.0
damping, speed = curve.points[:, 0], curve.points[:, 1] / rpm
panel.fill_betweenx(speed, 500, damping, color="#0072b2", alpha=0.25, label="orbits with one impact a period")
panel.fill_betweenx(speed, damping, 3000, color="#009e73", alpha=0.25, label="none")
panel.plot(damping, speed, color="#1a1a1a", label="fold of two orbits")
panel.plot(1400, 184.2 / rpm, "*", ms=12, color="#d55e00", label="this machine")
panel.legend(loc="lower right")
panel.set(xlabel="damping (N s/m)", ylabel="speed (rpm)", xlim=(500, 3000), ylim=(1300, 2500))
