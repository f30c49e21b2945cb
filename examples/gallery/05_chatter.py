"""
5. Chatter
==========

Impacts may follow each other ever faster, infinitely many in a finite time.  carom sums the series of the bounces, after which the rotor slides
along the bearing.  With a restitution of 0.5 this takes few bounces.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml", ["restitution=0.5"])
motion = cm.simulate(machine, cm.kick("100 mm/s"), until="120 ms")
print(len(motion.contacts), "impacts;", [contact.kind for contact in motion.lasting_contacts])

# %%
# What to see: the last bounces before sliding, enlarged.  Each is shorter than the one before by the same factor; by 13.5 ms
# infinitely many have occurred, and the thick line along the wall is the sliding.
first = motion.lasting_contacts[0]
figure = cm.plots.radius(motion)
(panel, *_) = figure.axes
start = 1e3 * machine.parameters.scales.time * first.start
panel.set_xlim(start - 6.5, start + 2.0)
panel.set_ylim(0.63, 0.707)
print(f"it slides from t = {first.start:.6f} to {first.end:.6f}")
