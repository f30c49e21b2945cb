"""
13. Why there are no more orbits
================================

The periods are the roots of a function ``F₁`` of one variable.  Beyond a certain period a bound keeps it away from zero.
"""

import numpy as np

import carom as cm

machine = cm.load("../source-paper.toml")
orbits = cm.find_orbits(machine)
periods = np.linspace(0.05, 30.0, 2000)

# %%
# What to see: the curve crosses zero at two periods only, the dots.  It oscillates on above zero; in the shaded range a bound excludes roots.
figure = cm.plots.period_condition(orbits, periods, cm.orbits.period_condition(machine, periods))
