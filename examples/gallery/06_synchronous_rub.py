"""
6. Sliding into the rub
=======================

A rotor that starts on the bearing, at rest in the co-rotating frame, slides to the stable rub.  In lasting contact there are forces instead
of impulses.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
equilibria = cm.find_equilibria(machine)
motion = cm.simulate(machine, cm.State(1.0), settle=True)
print(motion.outcome.meaning)

# %%
# What to see: the normal force oscillates about its equilibrium value, printed below, and settles there.  The dashed line is the friction force, 0.15
# times the normal force.
scales = machine.parameters.scales
print(f"{equilibria[1].normal_force * scales.force:.4g} N in equilibrium")
figure = cm.plots.touchdown(motion)
