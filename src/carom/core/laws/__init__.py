"""Laws of a wall along its normal: the impulse of an impact, or with which force a compliant wall resists.

They know neither modes nor stations, only the radial speed of an impact or the depth in the wall, and the numbers of the wall as one
value, a :class:`~carom.core.wall.Wall`.  Each function is written once, for Python and for kernels, for one motion and for lanes.

Every module here but ``choice``, ``compliant`` and ``law`` is a law: its numbers are a frozen value, a :class:`~carom.core.laws.law.Law`, and its functions say the
rest.  ``impulse(speed, wall)`` is the impulse of an impact, per effective mass, ``impulse_by_speed`` and ``impulse_by_restitution`` are
its derivatives.  Slow impacts have the impulse ``(1 + d)ṙ``.
Compliant laws have no impulse; instead they have a ``force``, the Taylor coefficients of it, of its change and of what vanishes with it,
and the ``stored_energy`` of the wall.  A module that is added is found by its name.

=================  ===========================================================
``law``            what every law offers, and the laws there are
``choice``         the law of a wall, by its number
``rigid``          a rigid wall with Newton's restitution
``falling``        a restitution that falls with the speed of the impact
``compliant``      what compliant laws have in common
``kelvin_voigt``   a spring and a damper, without tension
``hunt_crossley``  a spring whose damping grows with the depth
=================  ===========================================================
"""
