"""
20. A bifurcation diagram
=========================

All equilibria and orbits along one parameter, with the points where they appear, vanish and change their stability.
"""

import carom as cm

machine = cm.load("../keogh-cole.toml")
diagram = cm.find_bifurcations(machine, "damping", ("600 N s/m", "4000 N s/m"))
for point in diagram.points:
    print(f"{point.kind:22s} {point.name:16s} {point.value:8.1f} N s/m")

# %%
# What to see: in the lowest panel each bar is a motion that can persist.  To the right of the ends of bouncing (two orbits meet, the
# black triangles) and of the rub (the cross) only levitation and, after a violent start, backward whirl are left.  The dotted line is
# the present machine: it has all four motions.
figure = diagram.plot()
