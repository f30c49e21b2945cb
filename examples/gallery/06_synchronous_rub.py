"""
6. Sliding into the rub
=======================

A rotor that is put on the bearing at rest in the turning frame slides to the stable rub.  In lasting contact there are forces instead
of impulses.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
equilibria = cm.find_equilibria(machine)
motion = cm.simulate(machine, cm.State(1.0), settle=True)
print(motion.outcome.meaning)

# %%
# What to see: the normal force swings about that of the equilibrium, the number below, and settles there.  The dashed line is friction, the
# same times 0.15.
scales = machine.parameters.scales
print(f"{equilibria[1].normal_force * scales.force:.4g} N in equilibrium")
figure = cm.plots.touchdown(motion)
