"""
10. Full spectrum
=================

The motion in the fixed frame as a sum of forward and backward whirls.  Levitation has one line, at the speed of the shaft; bouncing has
others that a vibration monitor shows.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
settled = cm.simulate(machine, cm.kick("100 mm/s"), settle=True)
bouncing = cm.simulate(machine, settled.final, until=400.0)
spectrum = cm.motions.full_spectrum(bouncing)
strongest = spectrum.orders[abs(spectrum.amplitudes).argsort()[::-1][:1]]
print("strongest line at", strongest, "times the speed")

# %%
# What to see: the line at +1X is the unbalance.  Those at −1.7X, −4.4X and +3.7X are the impacts, at no multiple of the speed: a line of this
# kind in the record of a machine means that it bounces.
figure = spectrum.plot()
