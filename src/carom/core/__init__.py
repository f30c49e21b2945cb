"""Numba kernels: floats and arrays in, floats and outcome codes out.

Nothing here knows units, files or results.  A kernel sees a rotor as the arrays of
:func:`~carom.core.layout.rotor_record` and works for any number of modes and contact stations.

=====================  ===========================================================
``records``            arrays and scalars that kernels take by one address
``layout``             the data that kernels work on
``flow``               exact flight: sums of exponentials and their derivatives
``table``              constants of a block of flight, for the search of crossings
``block``              one block of flight: possible roots, state at a time
``events``             certified first crossing of the wall
``wall``               numbers of a wall, and stations at it
``wall_work``          what compliant walls take of the energy
``laws``               laws of a wall along its normal
``friction``           impacts and lasting contact with Coulomb friction
``phases``             states of contact of a station
``joint``              impacts of several stations in one instant
``contact_series``     lasting contact as Taylor series
``compliance``         contact with a compliant wall, as Taylor series
``shaft``              the speed of the shaft as a state, in contact and from flight to flight
``limits``             limits of magnetic bearings: what is asked for beyond them
``anisotropy``         anisotropic bearings
``surfaces``           speeds of the two surfaces in contact, where they change
``rounding``           rounding errors of sums over the modes
``taylor``             length of a step, sums and zeros of Taylor series
``rub``                when lasting contact changes, and what follows
``rub_step``           one step of lasting contact
``event_log``          the log of a motion's events
``in_turn``            many motions one after another, each for the same time
``contact_events``     what happens where a station arrives at its wall
``advance``            the event loop of one motion
``settling``           criteria for the end to which a motion settles
``planar_proofs``      ends that are proven before they are reached
``ensemble``           many motions in one call, each to its end
``lanes``              many motions side by side in vector registers
``lane_search``        the search of crossings for lanes
``vector``             numbers that stand for many lanes
``counter``            a counter by which threads share a list of tasks
``closing``            the orbit that a simulated motion approaches
``periods``            all periods of single-impact orbits
``planar``             single-impact orbits in closed form
``segments``           maps of the segments of an orbit, with derivatives
``equations``          linear equations
``closure``            equations of multiple shooting, and Newton's method
``sensitivity``        how these equations change with a parameter
``margins``            how far an orbit is from a change of its word
``variation``          how small changes of a state propagate
``processors``         number of available processor cores
``compiling``          how kernels are compiled and kept on the disk
=====================  ===========================================================
"""
