"""Laws of a wall along its normal: with which impulse an arrival ends.

They know neither modes nor planes, only the radial speed of an arrival and the numbers of the wall as one value, a
:class:`~carom.core.wall.Wall`.  Each function is written once, for Python and for kernels, for one motion and for lanes.

Every module here but ``choice`` is a law: ``impulse(speed, wall)`` says with which impulse, per effective mass, an arrival ends, and
``impulse_by_speed`` and ``impulse_by_restitution`` are its derivatives.  Slow arrivals have the impulse ``(1 + d)ṙ``.  A module that is
added is found by its name, and chosen by the ``law`` of a class in :mod:`carom.models.touchdown`.

===========  ===========================================================
``choice``   the law of a wall, by its number
``rigid``    a rigid wall with Newton's restitution
``falling``  a restitution that falls with the speed of the arrival
===========  ===========================================================
"""
