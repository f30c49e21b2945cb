"""
32. A sweep in memory
=====================

The same computation for every machine of a grid.  Larger sweeps are stored, resumed and run on clusters with the same call.
"""

import carom as cm
from carom.sweeps import GridAxis, plan_sweep

case = cm.load("../keogh-cole.toml")
axes = [
    GridAxis.between("speed", "1500 rpm", "3000 rpm", 12),
    GridAxis.between("damping", "700 N s/m", "5000 N s/m", 10, "log"),
]
kicks = cm.disturbances.VelocityKick.of(case, "100 mm/s")
data = cm.run_sweep(plan_sweep(case, axes, cm.disturbances.Sample(kicks, 60, seed=1))).dataset
print(dict(data.sizes))

# %%
# What to see: each cell is a machine, its colour the share of kicks that come back.  At 5000 N s/m all come back, at any speed; with less
# damping a faster rotor does better than one near its critical speed, where it cannot even levitate.
figure = cm.plots.sweep_map(data, "recovered")
