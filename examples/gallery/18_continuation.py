"""
18. An orbit along the damping
==============================

:func:`carom.continue_orbit` follows an orbit through folds and through stretches where it is no motion of the machine, and finds the special
points on the way.
"""

from matplotlib.figure import Figure

import carom as cm

machine = cm.load("../keogh-cole.toml")
orbit = cm.find_orbits(machine)["B1,d"]
branch = cm.continue_orbit(orbit, "damping", ("500 N s/m", "2000 N s/m"))
for point in branch.special:
    print(f"{point.kind:16s} {point.value:9.3f} N s/m")

# %%
# The period over the damping.
figure = Figure(figsize=(6.0, 3.6), layout="constrained")
panel = figure.subplots()
panel.plot(branch.values, branch.period, label="B1,d and beyond its fold B1,c")
panel.plot(
    [point.value for point in branch.special], [point.period for point in branch.special], "o", label="special points"
)
panel.legend()
panel.set(xlabel="damping (N s/m)", ylabel="period (1/$\\Omega$)")
