"""The unbalance response over the speed of the shaft, before it is told in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np

from carom.arguments import checked
from carom.closed_forms import SpeedResponse, find_equilibria, rolling
from carom.models import Axis, Jeffcott, axis
from carom.outcome import InputError
from carom.parameters import Case, Scales
from carom.results import Result
from carom.studies.standards import FULL_SPEED, LARGEST, Side, required_margin, vibration_limit


class Steady(NamedTuple):
    """Steady motions that are possible at a speed: at rest in the co-rotating frame, or rolling.

    Attributes
    ----------
    contact_free : bool
        Whether the contact-free whirl stays inside the clearance.
    stable_rubs, unstable_rubs : int
        Numbers of synchronous rubs that the wall can push.
    rolls : bool
        Whether rolling on the bearing in backward whirl holds at every angle.
    """

    contact_free: bool
    stable_rubs: int
    unstable_rubs: int
    rolls: bool


class Stretch(NamedTuple):
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


@dataclass(frozen=True)
class Separation:
    """Separation of the operating speeds from the critical speed (API 617).

    Attributes
    ----------
    side : {"below", "inside", "above"}
        Where the critical speed lies: below the operating speeds, among them or above.
    actual, required : float
        Distance as a share of the nearest operating speed, and the least that is required.
    """

    side: Side
    actual: float
    required: float

    @property
    def met(self) -> bool:
        """Whether the distance is large enough."""
        return self.required == 0.0 or (self.side != "inside" and self.actual >= self.required)


@dataclass(frozen=True, eq=False, repr=False)
class ResponseData(Result):
    """Response of a machine to its unbalance over the speed of the shaft.

    Speeds are in rad/s, lengths in clearances unless a name ends in ``_si``.

    Attributes
    ----------
    case : Case
    contact_free : SpeedResponse
        The contact-free response in closed form, with critical speed and amplification factor.
    interval : tuple of float
        Range of the curves.
    operating : tuple of float
        Lowest and highest operating speed.
    speeds : ndarray, shape (n,)
        The critical and the present speed are among them, where they lie in the range.
    displacement : ndarray of complex, shape (n,)
        Contact-free displacement along the unbalance, ``U*e^{−iφ}``; virtual where its modulus exceeds one.
    rubs : ndarray, shape (2, n)
        Angles of the synchronous rubs relative to the unbalance, rad, first the stable one
        (:meth:`~carom.closed_forms.SpeedResponse.rub_angles`); ``nan`` where there is none.  Their radius is one.
    stretches : tuple of Stretch
        Ranges of speeds with the same steady motions, :class:`Steady`; their ends are exact.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("api617", "iso14839")

    case: Case
    contact_free: SpeedResponse
    interval: tuple[float, float]
    operating: tuple[float, float]
    speeds: np.ndarray
    displacement: np.ndarray
    rubs: np.ndarray
    stretches: tuple[Stretch, ...]

    @property
    def scales(self) -> Scales:
        """Mass, clearance and present speed."""
        found = self.case.parameters.scales
        if found is None:  # speed_response has refused such a case
            raise InputError("scales", None, "needed for a response over speed")
        return found

    @property
    def present(self) -> float:
        """Present speed of the machine."""
        return self.scales.speed

    @property
    def peak_to_peak_si(self) -> np.ndarray:
        """Contact-free vibration in any fixed direction, m peak to peak: twice the radius of the whirl, shape (n,)."""
        width: np.ndarray = 2.0 * self.scales.clearance * np.abs(self.displacement)
        return width

    @property
    def lag(self) -> np.ndarray:
        """Angle by which the contact-free displacement lags the unbalance, rad, shape (n,)."""
        angle: np.ndarray = -np.angle(self.displacement)
        return angle

    @property
    def rub_lags(self) -> np.ndarray:
        """The same for both rubs, 0 to 2π, shape (2, n); ``nan`` where there is none."""
        angle: np.ndarray = -self.rubs % math.tau
        return angle

    @cached_property
    def steady_at_present(self) -> Steady:
        """Steady motions at the present speed."""
        return steady_at(self.case, axis(self.case, "speed"), self.present)

    @cached_property
    def zones(self) -> tuple[Stretch, ...]:
        """Zone of the contact-free amplitude over speed; an empty letter where there is no contact-free motion."""
        limits = (*self.case.zones.limits, 1.0)
        edges = [speed for limit in limits for speed in self.contact_free.beyond(limit) or ()]
        return stretches_between(self.interval, edges, self.zone_at)

    @checked
    def zone_at(self, speed: float) -> str:
        """Letter of the zone of the contact-free amplitude at a speed; empty where that is virtual."""
        radius = float(self.contact_free.amplitude(np.array(speed)))
        return self.case.zones.zone(radius) if radius <= 1.0 else ""

    @cached_property
    def exceeds_api_617(self) -> tuple[Stretch, ...]:
        """Over which speeds the contact-free vibration exceeds the limit of API 617."""
        scales, free = self.scales, self.contact_free
        share = LARGEST / (2.0 * scales.clearance)
        edges = [FULL_SPEED, *(free.beyond(share) or ())]
        # Beyond that speed: (ρ/share)²w⁵ = (ω_n/Ω_0)⁴ − 2b(ω_n/Ω_0)²w² + w⁴ for w = Ω/Ω_0.
        ratio = (free.natural_frequency / FULL_SPEED) ** 2
        middle = 1.0 - 2.0 * free.damping_ratio**2
        roots = np.roots([-((self.case.parameters.rho / share) ** 2), 1.0, 0.0, -2.0 * middle * ratio, 0.0, ratio**2])
        # A double root may have a small imaginary part; an edge too many does no harm.
        edges += [FULL_SPEED * root.real for root in roots if abs(root.imag) < 1e-4 * abs(root)]

        def exceeds(speed: float) -> bool:
            at = np.array(speed)
            return bool(2.0 * scales.clearance * free.amplitude(at) > vibration_limit(at))

        return stretches_between(self.interval, edges, exceeds)

    @property
    def separation(self) -> Separation | None:
        """Separation of the operating speeds from the critical speed; ``None`` without a critical speed."""
        critical, (low, high) = self.contact_free.critical_speed, self.operating
        if critical is None:
            return None
        side: Side = "below" if critical < low else "above" if critical > high else "inside"
        actual = {"below": 1.0 - critical / low, "inside": 0.0, "above": critical / high - 1.0}[side]
        return Separation(side, actual, required_margin(self.contact_free.amplification_factor, side))


def stretches_between(
    interval: tuple[float, float], edges: Iterable[float], what: Callable[[float], Any]
) -> tuple[Stretch, ...]:
    """Stretches of an interval on which something is the same, if it can change only at given edges."""
    low, high = interval
    ends = [low, *sorted({edge for edge in edges if low < edge < high}), high]
    found: list[Stretch] = []
    for first, last in pairwise(ends):
        here = what(math.sqrt(first * last))
        if found and found[-1].what == here:
            found[-1] = found[-1]._replace(high=last)
        else:
            found.append(Stretch(first, last, here))
    return tuple(found)


def steady_at(case: Case, along: Axis, speed: float) -> Steady:
    """Steady motions at a speed."""
    rotor = along.move(Jeffcott(case.parameters), speed)
    levitation, *rubs = find_equilibria(rotor)
    pushed = [rub.stable for rub in rubs if rub.status == "admissible"]
    return Steady(levitation.status == "admissible", sum(pushed), len(pushed) - sum(pushed), rolling(rotor).holds)
