"""
9. Where the energy comes from
==============================

The energy ledger of a motion lists the work of every force.  Contact itself never supplies energy, but the drive of the shaft does, through
friction.  The balance closes to rounding.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "26 deg"), until=18.0)
ledger = cm.motions.energy_ledger(motion)
print(f"error of the balance: {ledger.imbalance:.1e} of the largest energy")

# %%
# What to see: contact dissipates 40 J in three impacts (falling line), and the drive of the shaft supplies as much (rising line) through
# friction.  The energy of the rotor itself, near zero, is hardly visible.
figure = ledger.plot()
