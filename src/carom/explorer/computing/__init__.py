"""What the page shows, as plain values and arrays: no module here knows the page.

=================  ==============================================================
``controls``       the parameters that can be moved, and what people type
``levitation``     how it levitates: slowest whirls, whirl by unbalance, response over speed
``rest``           the motion that is disturbed
``planes``         the kinds of disturbances: kicks, shocks, losses of a blade
``kicks``          where they end, over which range, and two representative ones
``walls``          loads of contact of a rotor: impulses, or forces and depths
``kicked_motion``  the motion after one of them, ready to be drawn over time
``motions``        table of steady motions and orbits
``diagrams``       bifurcation diagram along one parameter
``judgement``      smallest loss, hardest impact, verdict and advice
``proofs``         which kicks are proven to come back
``exports``        the machine shown as a file, as options, as a program
=================  ==============================================================
"""
