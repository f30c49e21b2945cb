"""
39. A flexible rotor is dropped
===============================

The magnetic bearing rig of TU Munich, with its 8 mm shaft, loses levitation: what force acts on the touchdown bearings, and how many vectors does
the reduced rotor need to predict it?
"""

import matplotlib.pyplot as plt
import numpy as np

import carom as cm

times = np.linspace(5.7e-3, 7.0e-3, 500)
curves = {}
for accuracy in (0.3, 0.1, 0.02, 0.005):
    case = cm.load("../tum-flexible-rotor.toml", [f"accuracy={accuracy}"])
    scales = case.parameters.scales
    motion = cm.simulate(case, cm.drop(), "8 ms")
    curves[accuracy] = motion.forces(times / scales.time)[0] * scales.force
    print(
        f"error of at most {accuracy:.1%}: {len(motion.rotor.system.rest)} coordinates, {curves[accuracy].max():.1f} N"
    )

# %%
# What to see: with 2 and 0.5 percent the curves coincide.  The error is stated for the first contact of a rotor that arrives parallel and of a wall
# without damping; so even where 30 percent are accepted, the error of the peak force in this drop is only 3 percent.
figure = plt.figure(figsize=(5.6, 3.2), layout="constrained")
axes = figure.subplots()
looks = zip(curves.items(), ("#c7c7c7", "#56b4e9", "#0072b2", "#1a1a1a"), (2.6, 1.8, 2.4, 1.0), strict=True)
for (accuracy, forces), colour, width in looks:
    axes.plot(1e3 * times, forces, color=colour, lw=width, label=f"{accuracy:.1%}")
axes.set_xlabel("time after the release (ms)")
axes.set_ylabel("force on the first bearing (N)")
axes.set_ylim(0.0, None)
axes.legend(frameon=False, title="error accepted")
axes.spines[["top", "right"]].set_visible(False)
