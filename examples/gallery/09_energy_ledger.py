"""
9. Where the energy comes from
==============================

The ledger of a motion lists what every force did to the rotor.  Contact itself never supplies energy, but through friction the drive of
the shaft does.  The balance closes to rounding.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["eccentricity=0.15 mm"])
motion = cm.simulate(machine, cm.kick("210 mm/s", "26 deg"), until=18.0)
ledger = cm.motions.energy_ledger(motion)
print(f"error of the balance: {ledger.imbalance:.1e} of the largest energy")

# %%
# What to see: the contact takes 40 J in three impacts, the falling line, and the drive of the shaft supplies as much, the rising line, since
# friction pulls the rotor along.  The energy of the rotor itself, near zero, hardly shows.
figure = ledger.plot()
