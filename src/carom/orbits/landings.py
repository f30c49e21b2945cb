"""Whether a chatter is complete before the normal force vanishes, and by how much.

Near the onset of lasting contact the last bounces of a chatter are small, and the normal force falls linearly: ``N = a s``
at a time ``s`` before it vanishes.  Let a bounce begin with the speed ``v``, and ``w = v a/N²``.  It takes the share ``τ`` of
``s`` with ``w = τ/2 − τ²/6`` and is followed by one with ``w' = d (τ/2 − τ²/3)/(1 − τ)²``.  One value ``w*`` repeats
itself: infinitely many bounces end exactly where the force vanishes, and that is the onset.  Below ``w*`` the chatter is complete earlier,
above it ends with a flight from which the rotor does not return at once (``w > 3/8``).

A small distance from ``w*`` grows by the factor ``λ = d²/(1 − τ)⁵`` a bounce while ``N`` falls by ``1 − τ``.  So the force
that is left at the landing is a power of the distance from the onset, with the exponent ``−ln(1 − τ)/ln λ``: 1 without
rebound, 3/5 for a rebound without loss.

Whether the contact slides or rolls is decided on the way.  The last bounces are alike: a bounce that begins with the speed ``v`` takes the
time ``2v/N``, in which the pull ``P`` along the wall changes the slip by ``2vP/N``, and the impact at its end can take away
``μ(1 + d)v``.  The difference is what friction can take beyond that (:func:`slip_at_landing`); where it vanishes small bounces cease to
stop the slip, before the limit of rolling is reached.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from carom.core.event_log import EventLog
from carom.core.margins import local_motion
from carom.models import Rotor

NO_RETURN = 0.375
"""Value of ``w`` above which the rotor does not return to the wall at once."""
BESIDE = 1e-4
"""Distance from ``w*`` at which it grows by the same factor in every bounce."""
LAST = 1e-14
"""Value of ``w`` at which a chatter is complete."""


class Onset(NamedTuple):
    """The chatter that ends where the normal force vanishes.

    Attributes
    ----------
    ratio : float
        ``w*``.
    power : float
        Power of the normal force at the landing that is proportional to the distance from the onset.
    slope : float
        How fast that power of the normal force, relative to that of a bounce, falls with ``w`` of this bounce at ``w*``.
    """

    ratio: float
    power: float
    slope: float


@lru_cache(maxsize=64)
def onset_of(restitution: float) -> Onset:
    """The chatter at the onset of lasting contact, for a coefficient of restitution between 0 and 1."""
    if restitution == 0.0:
        return Onset(0.0, 1.0, 0.0)
    roots = np.roots([-1.0, 5.0, 2.0 * restitution - 7.0, 3.0 * (1.0 - restitution)])
    share = float(min(root.real for root in roots if abs(root.imag) < 1e-9 and root.real > 0.0))
    power = math.log(restitution**2 / (1.0 - share) ** 5) / -math.log(1.0 - share)
    ratio = 0.5 * share - share**2 / 6.0
    return Onset(ratio, power, _left_at_landing(restitution, ratio - BESIDE) ** power / BESIDE)


def _left_at_landing(restitution: float, ratio: float) -> float:
    """Normal force at the landing, relative to that at the beginning of a bounce with ``w`` below ``w*``."""
    left = 1.0
    while ratio > LAST:
        taken = 1.5 * (1.0 - math.sqrt(1.0 - ratio / NO_RETURN))
        ratio = restitution * (taken / 2.0 - taken**2 / 3.0) / (1.0 - taken) ** 2
        left *= 1.0 - taken
    return left


def distance_from_onset(restitution: float, force: float, ratio: float) -> float:
    """Signed measure of the distance from the onset: proportional to it nearby, above zero where the chatter is complete.

    Parameters
    ----------
    restitution : float
        Below 1.
    force : float
        Normal force at the beginning of one of the last bounces.
    ratio : float
        ``w`` of this bounce; below zero if the force grows.
    """
    if restitution == 0.0:
        return force
    onset, w, gone = onset_of(restitution), ratio, 1.0
    if w < onset.ratio - BESIDE:
        return float((force * _left_at_landing(restitution, w)) ** onset.power)
    while w - onset.ratio > BESIDE:
        # The bounce before: the smaller root of w (1 − τ)² = d (τ/2 − τ²/3).
        square, linear = w + restitution / 3.0, w + 0.25 * restitution
        taken = w / (linear + math.sqrt(linear**2 - square * w))
        w, gone = 0.5 * taken - taken**2 / 6.0, gone * (1.0 - taken)
    return float((abs(force) / gone) ** onset.power * onset.slope * (onset.ratio - w))


def slip_at_landing(rotor: Rotor, plane: int, direction: int, bounces: EventLog) -> tuple[float, int | None]:
    """How far a chatter is from contact of another kind, as a function that vanishes there and is continuous.

    Parameters
    ----------
    rotor : Rotor
    plane : int
    direction : {1, -1, 0}
        Of the slip after it; 0 if rolling follows.
    bounces : EventLog

    Returns
    -------
    float
        The slip at the landing in this direction, above zero.  Where friction stops the slip: what it could still take away in all
        bounces from then on or, if that is less, in the later bounces relative to their speed; above zero if
        rolling follows, below if not.
    int or None
        The first bounce from which on friction stops the slip, if that is not what follows.
    """
    planes = np.full(len(bounces.times), plane)
    wall = rotor.system.contacts[plane].wall
    friction, restitution = wall.friction, wall.restitution
    _, speed, _, _, _, spare = local_motion(rotor.system.arrays, planes, bounces.before).T
    slides = np.flatnonzero(spare < 0.0)
    first = int(slides[-1]) + 1 if len(slides) else 0
    _, radial, slip, push, pull, _ = local_motion(rotor.system.arrays, planes[:1], bounces.after[-1:])[0].tolist()
    if first < len(bounces.times):
        sense = direction or 1
        if direction and restitution == 0.0 and sense * pull > friction * push:
            return sense * pull - friction * push, None
        later = float((spare[first + 1 :] / speed[first + 1 :]).min(initial=np.inf))
        spared = float(spare[first:].sum()) + _spare_beyond(friction, restitution, radial, abs(pull), push)
        if not direction:
            return min(spared, later), None
        # Where small bounces begin to stop the slip it vanishes with its slope, and there is nothing to be carried on beyond zero.
        return (-spared, first) if spared < later else (-later, None)
    sense = direction or (1 if slip > 0.0 else -1)
    left = sense * slip - _spare_beyond(friction, restitution, radial, sense * pull, push)
    return (left if direction else -left), None


def _spare_beyond(friction: float, restitution: float, radial: float, pull: float, push: float) -> float:
    """What friction could take away, beyond what the pull adds to the slip, in all bounces after one that begins with a radial speed."""
    if push <= 0.0:
        return 0.0
    return -radial / (1.0 - restitution) * (friction * (1.0 + restitution) - 2.0 * pull / push)
