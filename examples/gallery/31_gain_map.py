"""
31. Which gains bring back more kicks
=====================================

The share of kicks that come back, over stiffness (P gain) and damping (D gain).
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
sample = cm.disturbances.Sample(kicks, 200, seed=1)
over = {"stiffness": ("5e5 N/m", "2e6 N/m", 10), "damping": ("700 N s/m", "5000 N s/m", 10)}
gains = cm.map_gains(machine, sample, over)

# %%
# What to see: above the solid line at least 99 % of the kicks come back.  The star is the present machine: twice its damping is not enough, three times is.
# In the hatched area the machine cannot levitate.
figure = gains.plot()
