"""
16. The orbit on which a motion has settled
===========================================

A motion approaches its orbit without reaching it.  :func:`carom.orbits.orbit_of_motion` reads the sequence of contacts and closes
the orbit exactly.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
motion = cm.simulate(machine, cm.kick("100 mm/s"), settle=True)
orbit = cm.orbits.orbit_of_motion(motion)
print(f"period {orbit.period:.12f}, known exactly: {cm.find_orbits(machine)['B1,d'].period:.12f}")
print(orbit.margins)

# %%
# What to see: three periods of the orbit.  All bounces are identical, because the orbit is closed exactly, not taken from a decaying motion.
figure = cm.plots.radius(orbit.trajectory(3))
