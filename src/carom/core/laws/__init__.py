"""Contact laws: what a wall does to a plane of the rotor that arrives at it, and while it stays there.

Each law has a module of functions that know neither modes nor planes.  They work on the velocity ``ṙ + iθ̇`` of the plane in the
frame of its contact, and on the numbers of the law as one value, a :class:`~carom.core.laws.rigid.Wall`.

===========  ===========================================================
``rigid``    a rigid wall with Newton's restitution and Coulomb friction
===========  ===========================================================
"""
