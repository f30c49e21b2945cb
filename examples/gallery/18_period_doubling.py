"""
18. Period doubling
===================

Where a multiplier passes −1, an orbit of twice the period is born.  One call switches to its branch.
"""

import carom as cm

machine = cm.load("../source-paper.toml")
branch = cm.continue_orbit(cm.find_orbits(machine)["B1,d"], "gamma", (0.07, 0.1))
(doubling,) = (point for point in branch.special if point.kind == "period-doubling")
print(f"doubles at gamma = {doubling.value:.10f}")
doubled = cm.bifurcations.switch(doubling, (0.08, 0.0834))
print(f"orbits of period {doubled.period.min():.4f} to {doubled.period.max():.4f}; ends: {doubled.stops}")

# %%
# What to see: the middle orbit of the new branch.  On the left it has two loops and two impacts; the orbit from which it branched off has
# one.
figure = doubled.orbits[len(doubled) // 2].plot()
