"""The smallest kick out of levitation that does not come back."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.disturbances import FASTEST, VelocityKick
from carom.ensembles import settle_all
from carom.outcome import InputError, Outcome
from carom.rotors import Rotor

__all__ = ["SmallestKick", "harmless_kick", "harmless_shock", "smallest_lost", "smallest_unrecovered_kick"]

DIRECTIONS, SPEEDS = 96, 96
TOLERANCE = 1e-3
NARROWED = 4
"""Factor by which the directions looked at close in, from one round to the next."""
BESIDE = 8
"""Directions to each side of the best one so far, in each round."""
BELOW = 24
"""Speeds up to that of the best one so far, tried in each of them."""


@dataclass(frozen=True)
class SmallestKick:
    """The smallest kick found that does not come back to levitation.

    Attributes
    ----------
    speed : float
        Change of velocity in ``c_r Ω``.
    angle : float
        Direction in the co-rotating frame, rad.
    outcome : Outcome
        Where it ends.
    recovered : float
        A smaller kick in this direction, within the tolerance, that comes back.
    harmless : float
        Kicks up to this speed provably never reach the wall, in any direction; see :func:`harmless_kick`.
    tolerance : float
        Relative width of the bracket, and angle in rad between the directions looked at last.
    tried : int
        Kicks followed.
    """

    speed: float
    angle: float
    outcome: Outcome
    recovered: float
    harmless: float
    tolerance: float
    tried: int


def harmless_kick(rotor: Rotor) -> float:
    """Speed up to which a kick out of levitation provably never reaches the wall, in ``c_r Ω``.

    In the fixed frame the deviation from the levitation whirl obeys ``ü + γu̇ + ω²u = 0``, whose coefficients are real:
    a kick of speed ``v`` moves the rotor along its own direction, by at most ``v g``.  For ``γ < 2ω`` the largest
    response ``g = e^{−γτ/2}/ω`` is that of the first turning point ``τ = arctan(2w/γ)/w``, ``w = √(ω² − γ²/4)``;
    beyond critical damping the hyperbolic form holds.  Contact is impossible while ``v g < 1 − |U*|``.

    Zero where the rotor cannot levitate inside the wall or its levitation is unstable.
    """
    numbers = rotor.parameters
    gap = 1.0 - abs(rotor.equilibrium)
    gamma, omega = numbers.gamma, numbers.omega
    if gap <= 0.0 or gamma < 0.0:
        return 0.0
    return max(0.0, gap * (1.0 - 1e-9) / _largest_response(gamma, omega))


def harmless_shock(rotor: Rotor, duration: float) -> float:
    """Peak acceleration up to which a half-sine shock of the base provably never brings the rotor to the wall.

    The deviation is the shock folded with the response to a kick, which is at most ``g`` (:func:`harmless_kick`): no larger
    than ``g`` times the change of velocity through the pulse, ``2âT/π``.  A bound, and sharp for short pulses.

    Parameters
    ----------
    rotor : Rotor
    duration : float
        ``T``, in ``1/Ω``.

    Returns
    -------
    float
        In ``c_r Ω²``.
    """
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError("duration", duration, "a time above 0, in 1/Omega")
    return harmless_kick(rotor) * math.pi / (2.0 * duration)


def _largest_response(gamma: float, omega: float) -> float:
    """Largest deviation after a kick of speed 1."""
    half = gamma / 2.0
    square = (omega - half) * (omega + half)
    if abs(square) <= 1e-12 * omega**2:
        moment = 1.0 / half
    elif square > 0.0:
        moment = math.atan2(math.sqrt(square), half) / math.sqrt(square)
    else:
        rate = math.sqrt(-square)
        moment = math.log((half + rate) ** 2 / omega**2) / (2.0 * rate)
    return math.exp(-half * moment) / omega


def smallest_unrecovered_kick(
    rotor: Rotor,
    fastest: float = FASTEST,
    *,
    directions: int = DIRECTIONS,
    speeds: int = SPEEDS,
    tolerance: float = TOLERANCE,
    threads: int | None = None,
) -> SmallestKick | None:
    """Search the smallest kick that does not come back, beyond any grid.

    All directions are scanned at growing speeds between the proven harmless one and the fastest; the first speed that
    does not come back is bisected in every direction; then directions close in on the best one until they are
    ``tolerance`` rad apart, each scanned and bisected below the best speed so far.  Basins can be thinner than any
    scan: a smaller kick that is lost is possible, but all that were tried below come back.

    Parameters
    ----------
    rotor : Rotor
    fastest : float
        Largest kick looked at, in ``c_r Ω``.
    directions, speeds : int
        Of the scan.
    tolerance : float
    threads : int, optional

    Returns
    -------
    SmallestKick or None
        ``None`` if every kick tried comes back.

    Raises
    ------
    InputError
        The rotor cannot levitate inside the wall, or its levitation is unstable.
    """
    if abs(rotor.equilibrium) >= 1.0:
        raise InputError("kick", f"|U*| = {abs(rotor.equilibrium):.6g}", "needs levitation inside the wall")
    if rotor.parameters.gamma < 0.0:
        raise InputError("gamma", rotor.parameters.gamma, "at least 0: there is no levitation to come back to")
    if not (np.isfinite(fastest) and fastest > 0.0):
        raise InputError("fastest", fastest, "a speed above 0, in c_r Omega")
    harmless = harmless_kick(rotor)
    if harmless >= fastest:
        return None
    search = _Search(rotor, tolerance, threads)
    levels = harmless + (fastest - harmless) * np.arange(1, speeds + 1) / speeds
    search.look(2.0 * math.pi * np.arange(directions) / directions, np.append(harmless, levels))
    if search.best is None:
        return None
    apart = 2.0 * math.pi / directions
    while apart > tolerance:
        apart /= NARROWED
        _, speed, angle, _ = search.best
        beside = angle + apart * np.delete(np.arange(-BESIDE, BESIDE + 1), BESIDE)
        search.look(beside, np.linspace(harmless, speed, BELOW + 1))
    recovered, speed, angle, outcome = search.best
    return SmallestKick(
        speed, math.remainder(angle, 2.0 * math.pi), outcome, recovered, harmless, tolerance, search.tried
    )


class _Search:
    """Kicks followed so far, and the best bracket: largest recovered below, smallest lost, direction, outcome."""

    def __init__(self, rotor: Rotor, tolerance: float, threads: int | None) -> None:
        self.rotor, self.tolerance, self.threads = rotor, tolerance, threads
        self.tried = 0
        self.best: tuple[float, float, float, Outcome] | None = None

    def look(self, angles: np.ndarray, levels: np.ndarray) -> None:
        """Scan directions at growing speeds, of which the first is known to come back; bisect the first that is lost."""
        outcomes = self._outcomes(levels[None, 1:], angles[:, None])
        gone = lost(outcomes)
        hit = np.flatnonzero(gone.any(axis=1))
        if not len(hit):
            return
        first = gone[hit].argmax(axis=1)
        low, high = levels[first], levels[first + 1]
        ends, angles = outcomes[hit, first], angles[hit]
        while ((high - low) > self.tolerance * high).any():
            middle = 0.5 * (low + high)
            found = self._outcomes(middle, angles)
            gone = lost(found)
            low, high = np.where(gone, low, middle), np.where(gone, middle, high)
            ends = np.where(gone, found, ends)
        place = int(high.argmin())
        if self.best is None or high[place] < self.best[1]:
            self.best = float(low[place]), float(high[place]), float(angles[place]), Outcome(int(ends[place]))

    def _outcomes(self, speeds: np.ndarray, angles: np.ndarray) -> np.ndarray:
        speeds, angles = np.broadcast_arrays(speeds, angles)
        starts = VelocityKick().starts(self.rotor, speeds, angles)
        self.tried += speeds.size
        return settle_all(self.rotor, starts.positions, starts.velocities, threads=self.threads).outcomes


def lost(outcomes: np.ndarray) -> np.ndarray:
    """Not back in levitation; what double precision cannot decide is not held against the rotor."""
    return (outcomes != Outcome.LEVITATED) & (outcomes != Outcome.GRAZING)


def smallest_lost(velocities: np.ndarray, outcomes: np.ndarray) -> tuple[float, float] | None:
    """Speed and direction of the smallest kick that is lost, if any, of kicks to these velocities."""
    gone = velocities[lost(outcomes)]
    if not gone.size:
        return None
    smallest = gone[np.abs(gone).argmin()]
    return float(abs(smallest)), float(np.angle(smallest))
