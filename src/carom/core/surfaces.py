"""Speeds of the two surfaces in contact at a station, where they change: that of the rotor with its shaft, that of a race that turns.

At constant speed the rotor's surface moves by ``s`` along the wall, and the wall stands still.  A shaft at the speed ``σ`` adds ``s(σ − 1)``
to the slip (:mod:`carom.core.shaft`), a race whose surface moves by ``q`` takes ``q`` from it.  Friction ``F`` along growing angle, per
effective mass, changes ``q`` by ``−gF`` with ``g = mR²/J``, and drag slows the race: ``q̇ = λq − gF``.
"""

from __future__ import annotations

from carom.core.compiling.decorators import inlined
from carom.core.shaft import excess_coefficient, surface_excess


@inlined
def may_change(rotor, station):
    """Whether the speed of a surface at a station may change."""
    return rotor.shaft.shape[0] > 0 or rotor.race[station] >= 0


@inlined
def relative_excess(rotor, station, amplitudes):
    """What the changes of both surfaces add to the slip at a station."""
    faster = 0.0
    if rotor.race[station] >= 0:
        faster -= amplitudes[rotor.race[station]].real
    if rotor.shaft.shape[0] > 0:
        faster += surface_excess(rotor, station, amplitudes)
    return faster


@inlined
def relative_coefficient(rotor, station, k, work):
    """Coefficient ``k`` of :func:`relative_excess`."""
    faster = 0.0
    if rotor.race[station] >= 0:
        faster -= work.series[k, rotor.race[station]].real
    if rotor.shaft.shape[0] > 0:
        faster += excess_coefficient(rotor, station, k, work)
    return faster


@inlined
def race_grip(rotor, station, k, work):
    """Coefficient ``k`` of ``λq``: the friction per ``1 + g`` with which a station follows a race that slows down."""
    race = rotor.race[station]
    return rotor.exponents[race].real * work.series[k, race].real if race >= 0 else 0.0


@inlined
def turn_race(rotor, station, friction, amplitudes):
    """Change the speed of a race by a friction impulse on the rotor along growing angle, in place."""
    if rotor.race[station] >= 0:
        amplitudes[rotor.race[station]] -= complex(rotor.race_gain[station] * friction, 0.0)
