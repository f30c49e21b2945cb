"""
13. Why there are no more orbits
================================

The periods are the roots of a function ``F₁`` of one variable.  Beyond a certain period a bound keeps it away from zero.
"""

import matplotlib.pyplot as plt
import numpy as np

import carom as cm

machine = cm.load("../source-paper.toml")
orbits = cm.find_orbits(machine)
periods = np.linspace(0.05, 30.0, 2000)

# %%
# What to see: the curve crosses zero at two periods only, the dots.  Beyond them it oscillates above zero; in the shaded range a bound excludes roots.
figure = plt.figure()
axes = figure.subplots()
axes.plot(periods, cm.orbits.period_condition(machine, periods))
axes.plot(orbits.periods, np.zeros(len(orbits.periods)), "ko")
axes.axhline(0.0, color="k", lw=0.5)
axes.axvspan(orbits.longest_period, periods[-1], color="0.9")
axes.set(xlabel="period T (1/Ω)", ylabel="period condition F₁", xlim=(0.0, periods[-1]), ylim=(-0.5, 3.0))
