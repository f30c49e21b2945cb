"""The unbalance response over the speed of the shaft, before it is stated in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]

from carom.base.arguments import checked
from carom.base.results import Result
from carom.parameters import Case, Scales
from carom.rotors.synchronous import SynchronousResponse, synchronous_response
from carom.studies.critical_speeds import Critical
from carom.studies.standards import vibration_limit


class Steady(NamedTuple):
    """Steady motions that are possible at a speed: at rest in the co-rotating frame, or rolling.

    Attributes
    ----------
    contact_free : bool
        Whether the contact-free whirl stays inside the clearance.
    stable_rubs, unstable_rubs : int or None
        Numbers of synchronous rubs that the wall can push; ``None`` where they are not known.
    rolls : bool or None
        Whether rolling on the bearing in backward whirl holds at every angle; ``None`` where that has no closed form.
    """

    contact_free: bool
    stable_rubs: int | None
    unstable_rubs: int | None
    rolls: bool | None


class SpeedStretch(NamedTuple):
    """A range of speeds over which something stays the same.

    Attributes
    ----------
    low, high : float
        In rad/s.
    what : Steady, str or bool
        The steady motions that are possible, the letter of a zone, or whether a limit is exceeded.
    """

    low: float
    high: float
    what: Any


class Rubs(NamedTuple):
    """Synchronous rubs over the speed: first one that is stable, then one that is not; ``nan`` where there is none.

    Attributes
    ----------
    speeds : ndarray, shape (k,)
        rad/s.
    lags : ndarray, shape (2, k)
        Angle by which the displacement lags the unbalance, rad, 0 to 2π.
    radii : ndarray, shape (2, k)
        In clearances: one in a rigid wall, more in a compliant touchdown bearing.
    """

    speeds: np.ndarray
    lags: np.ndarray
    radii: np.ndarray


@dataclass(frozen=True, eq=False, repr=False)
class ResponseData(Result):
    """Response of a machine to its unbalance over the speed of the shaft.

    Speeds are in rad/s, amplitudes 0-to-peak, in clearances unless a name ends in ``_si``.

    Attributes
    ----------
    case : Case
    whirl : SynchronousResponse
        The contact-free whirl at the speeds of the curves; the critical and the present speed are among them, where they lie in the range.
    interval : tuple of float
        Range of the curves.
    operating : tuple of float
        Lowest and highest operating speed.
    criticals : tuple of Critical
    rubs : Rubs or None
        ``None`` where they are not known: under weight, in several touchdown bearings, or where bearings are anisotropic.
    stretches : tuple of SpeedStretch
        Ranges of speeds with the same steady motions, :class:`Steady`.
    exact : bool
        Whether all steady motions in contact have closed forms, so that the ends of the stretches are exact; otherwise rubs were looked for at the speeds
        of their curve, and rolling was not.
    """

    case: Case
    whirl: SynchronousResponse
    interval: tuple[float, float]
    operating: tuple[float, float]
    criticals: tuple[Critical, ...]
    rubs: Rubs | None
    stretches: tuple[SpeedStretch, ...]
    exact: bool

    @property
    def scales(self) -> Scales:
        """Mass, clearance and present speed."""
        scales: Scales = self.case.parameters.scales
        return scales

    @property
    def speeds(self) -> np.ndarray:
        """Speeds of the curves, shape (n,)."""
        return self.whirl.speeds

    @property
    def present(self) -> float:
        """Present speed of the machine."""
        return self.scales.speed

    @checked
    def at(self, speed: float) -> SynchronousResponse:
        """The contact-free whirl at one speed."""
        return synchronous_response(self.case, [speed])

    @cached_property
    def now(self) -> SynchronousResponse:
        """The contact-free whirl at the present speed."""
        return self.at(self.present)

    @property
    def amplitude(self) -> np.ndarray:
        """Largest amplitude of the contact-free whirl at any touchdown bearing, in its clearance, shape (n,); virtual where the rotor would touch."""
        return np.asarray((self.whirl.touchdowns.major / self.whirl.clearances).max(axis=1))

    @property
    def reach(self) -> np.ndarray:
        """Largest distance from the centre, sag and whirl, at any touchdown bearing, in its clearance, shape (n,)."""
        return np.asarray(self.whirl.reach.max(axis=1))

    @property
    def peak_to_peak_si(self) -> np.ndarray:
        """Largest contact-free vibration in any fixed direction, m peak to peak, shape (n,)."""
        return np.asarray(2.0 * self.whirl.touchdowns.major.max(axis=1))

    @property
    def worst(self) -> int:
        """Index of the touchdown bearing at which sag and whirl come closest to it at the present speed."""
        return int(self.now.reach[0].argmax())

    @cached_property
    def lags(self) -> np.ndarray:
        """Angle by which the contact-free displacement lags the unbalance at each touchdown bearing, rad, without jumps over the speed, from −π/2 to 3π/2 at the lowest one; shape (n, P)."""
        whole = np.unwrap(self.whirl.lags, axis=0)
        turns = np.floor((whole[0] + 0.5 * np.pi) / (2.0 * np.pi))
        return np.asarray(whole - 2.0 * np.pi * turns)

    @cached_property
    def steady_at_present(self) -> Steady:
        """Steady motions at the present speed, if it lies in the range; the next ones else."""
        found = [each.what for each in self.stretches if each.low <= self.present <= each.high]
        own: Steady = found[0] if found else self.stretches[0 if self.present < self.interval[0] else -1].what
        return own._replace(contact_free=bool(self.now.reach.max() < 1.0))

    @checked
    def zone_at(self, speed: float) -> str:
        """Letter of the zone at a speed; empty where the rotor touches."""
        reach = float(self.at(speed).reach.max())
        return self.case.zones.zone(reach) if reach <= 1.0 else ""

    def reaching(self, share: float) -> list[float]:
        """Speeds at which sag and whirl reach a share of the clearance, refined between speeds of the curve."""
        return crossings(self.speeds, self.reach - share, lambda speed: float(self.at(speed).reach.max()) - share)

    @cached_property
    def saturating(self) -> tuple[SpeedStretch, ...]:
        """Over which speeds sag and whirl ask more of the magnetic bearings than their limits; empty without limits."""
        asked = self.whirl.saturation
        if not asked.shape[1]:
            return ()
        edges = crossings(self.speeds, asked.max(axis=1) - 1.0, lambda at: float(self.at(at).saturation.max()) - 1.0)
        return stretches_between(self.interval, edges, lambda at: bool(self.at(at).saturation.max() > 1.0))

    @property
    def allowed_si(self) -> np.ndarray:
        """Shaft vibration that API 617 allows at the speeds, m peak to peak, shape (m,)."""
        return vibration_limit(self.speeds)

    @cached_property
    def exceeds_api_617(self) -> tuple[SpeedStretch, ...]:
        """Over which speeds the contact-free vibration exceeds the limit of API 617."""

        def over(speed: float) -> float:
            width, allowed = 2.0 * self.at(speed).touchdowns.major.max(), vibration_limit(np.array(speed))
            return float(np.arctan2(width, allowed)) - 0.25 * math.pi  # finite at the peak of an undamped rotor

        values = np.arctan2(self.peak_to_peak_si, self.allowed_si) - 0.25 * math.pi
        edges = crossings(self.speeds, values, over)
        return stretches_between(self.interval, edges, lambda speed: over(speed) > 0.0)


def crossings(speeds: np.ndarray, values: np.ndarray, function: Callable[[float], float]) -> list[float]:
    """Zeros of a function between neighbouring speeds at which its values differ in sign."""
    changes = np.flatnonzero(np.diff(np.sign(values)) != 0.0)
    return [
        float(brentq(function, speeds[each], speeds[each + 1]))
        for each in changes
        if values[each] * values[each + 1] < 0.0
    ]


def stretches_between(
    interval: tuple[float, float], edges: Iterable[float], what: Callable[[float], Any]
) -> tuple[SpeedStretch, ...]:
    """Stretches of an interval on which something is the same, if it can change only at given edges."""
    low, high = interval
    ends = [low, *sorted({edge for edge in edges if low < edge < high}), high]
    found: list[SpeedStretch] = []
    for first, last in pairwise(ends):
        here = what(math.sqrt(first * last))
        if found and found[-1].what == here:
            found[-1] = found[-1]._replace(high=last)
        else:
            found.append(SpeedStretch(first, last, here))
    return tuple(found)
