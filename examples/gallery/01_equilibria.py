"""
1. Levitation and rub
=====================

A rotor can be at rest in the co-rotating frame in two ways: it levitates without contact, or it is pressed against the touchdown
bearing and slides round it once a turn, the synchronous rub.  :func:`carom.find_equilibria` finds all equilibria of both kinds.
"""

import numpy as np

import carom as cm

machine = cm.load("../keogh-cole.toml")
equilibria = cm.find_equilibria(machine)
for equilibrium in equilibria:
    print(equilibrium.kind, equilibrium.status, "stable" if equilibrium.stable else "unstable", equilibrium.radius)

# %%
# What to see: the pentagon is levitation, the squares on the wall are rubs.  The filled rub is stable, the hollow one is not.  The small
# points are the equilibria at speeds from 600 to 4000 rpm: as the speed rises, levitation moves out to the wall at the right, is lost near the
# natural frequency, and returns from the left.  This machine levitates just inside the wall.
figure = equilibria.plot()
(panel,) = figure.axes
length = 1e3 * machine.parameters.scales.length
for speed in np.linspace(600, 4000, 120):
    for other in cm.find_equilibria(cm.load("../keogh-cole.toml", [f"speed={speed} rpm"])):
        if other.status == "admissible":
            place = length * other.position
            panel.plot(
                place.real, place.imag, ".", ms=2, color="#009e73" if other.kind == "contact-free" else "#cc79a7"
            )
