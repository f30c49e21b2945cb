"""
7. Backward whirl
=================

Friction accelerates the whirl of a rotor that slides backward along the wall, until it rolls round the bearing at many times the shaft
speed.  This is the motion that destroys machines.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
limit = cm.closed_forms.runaway_speed(machine)
velocity = machine.parameters.scales.velocity
print(f"beyond {limit.certain * velocity:.3g} m/s backward the whirl surely runs away")

# %%
# ``U`` is the position and ``U̇`` the velocity in the co-rotating frame; a whirl at ``-w`` in the fixed frame turns at ``-(w + 1)`` there.
whirl = 1.2 * limit.certain
motion = cm.simulate(machine, cm.State(1.0, -1j * (whirl + 1.0)), until=3.2)
print([contact.kind for contact in motion.lasting_contacts])

# %%
# What to see: the force on the bearing grows four-hundredfold within 16 ms (a turn of the shaft takes 34 ms); note the logarithmic axis.  Where
# the friction force drops, slip has ended and the rotor rolls.  No wall is rigid under 4 MN: the study says so and states *no model* for this force.
figure = cm.plots.touchdown(motion)
