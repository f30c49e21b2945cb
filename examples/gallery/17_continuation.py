"""
17. An orbit along the damping
==============================

:func:`carom.continue_orbit` follows an orbit through folds and through intervals where it is virtual, and finds the special
points on the branch.
"""

from matplotlib.figure import Figure

import carom as cm

machine = cm.load("../keogh-cole.toml")
orbit = cm.find_orbits(machine)["B1,d"]
branch = cm.continue_orbit(orbit, "damping", ("500 N s/m", "2000 N s/m"))
for point in branch.special:
    print(f"{point.kind:16s} {point.value:9.3f} N s/m")

# %%
# What to see: the branch turns back at the fold, the rightmost point: beyond this damping the orbit does not exist.  It is stable on the
# upper part, between the fold and the next special point, the period doubling.
figure = Figure(figsize=(6.0, 3.6), layout="constrained")
panel = figure.subplots()
stable = branch.admissible & branch.stable
panel.plot(branch.values, branch.period, "--", color="#d55e00", label="unstable or not possible")
panel.plot(branch.values[stable], branch.period[stable], color="#0072b2", label="regular bouncing, stable")
for point, marker in zip(branch.special, "vDso", strict=True):
    panel.plot(point.value, point.period, marker, color="#1a1a1a", label=point.kind)
panel.legend(loc="center left")
panel.set(xlabel="damping (N s/m)", ylabel="period (1/$\\Omega$)")
