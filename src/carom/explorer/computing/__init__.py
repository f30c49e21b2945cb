"""What the page shows, as plain values and arrays: no module here knows the page.

=================  ==============================================================
``controls``       the parameters that can be moved, and what people type
``kicks``          where kicks out of the resting motion end
``kicked_motion``  the motion after one kick, ready to be drawn over time
``motions``        table of steady motions and orbits
``diagrams``       bifurcation diagram along one parameter
``judgement``      smallest lost kick, hardest impulse, verdict
``exports``        the machine shown as a file, as options, as a program
=================  ==============================================================
"""
