"""
1. Levitation and rub
=====================

A rotor can stay in one place of the co-rotating frame in two ways: it levitates without contact, or it is pressed on the touchdown
bearing and slides along it once a turn, the synchronous rub.  :func:`carom.find_equilibria` finds all of both.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
equilibria = cm.find_equilibria(machine)
for equilibrium in equilibria:
    print(equilibrium.kind, equilibrium.status, "stable" if equilibrium.stable else "unstable", equilibrium.radius)

# %%
# The pentagon is levitation.  Of the two rubs the filled square attracts; the hollow one does not.
figure = equilibria.plot()
