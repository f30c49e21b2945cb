"""The unbalance response over the speed of the shaft, before it is stated in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
from scipy.optimize import brentq  # type: ignore[import-untyped]

from carom.base.arguments import checked
from carom.base.results import Result, in_a_line, record
from carom.models import rotor_of
from carom.parameters import Case, Scales
from carom.parameters.fields import RPM
from carom.rotors import SynchronousResponse, synchronous_response
from carom.studies.critical_speeds import ASSUMPTIONS, Critical, vibration_limit

RESPONSE = "speeds_si=interval operating_si=operating criticals zone_limits=case.zones.limits words"
CURVE = "speed_si=speeds amplitude peak_to_peak_si api_617_limit_si=allowed_si"


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

    def document(self) -> dict[str, float]:
        """Its ends, as plain data for JSON."""
        low, high = self.low, self.high
        return {"from_si": low, "to_si": high, "from_rpm": low / RPM, "to_rpm": high / RPM}


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
class UnbalanceResponse(Result):
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
    exact : bool
        Whether all steady motions in contact have closed forms, so that the ends of the stretches are exact; otherwise rubs were looked for at the speeds
        of their curve, and rolling was not.
    rubs : Rubs or None
        ``None`` where they are not known: under weight, in several touchdown bearings, or where bearings are anisotropic.
    stretches : tuple of SpeedStretch
        Ranges of speeds with the same steady motions, :class:`Steady`.
    words : tuple of str
        What the response says about the machine, in sentences.
    """

    case: Case
    whirl: SynchronousResponse
    interval: tuple[float, float]
    operating: tuple[float, float]
    criticals: tuple[Critical, ...]
    exact: bool
    rubs: Rubs | None = None
    stretches: tuple[SpeedStretch, ...] = ()
    words: tuple[str, ...] = ()

    figure: ClassVar[str] = "unbalance_response"

    def rows(self) -> list[tuple[str, str]]:
        """The machine, the range, and what is said of it."""
        ends = " to ".join(f"{speed / RPM:,.6g}" for speed in self.interval)
        return [("case", self.case.name), ("speeds", f"{ends} rpm"), *(("", in_a_line(line)) for line in self.words)]

    def to_dict(self) -> dict[str, object]:
        """Return the response as ``carom response --json`` prints it."""
        rubs, highest = self.rubs, max(self.criticals, key=lambda each: each.amplitude, default=None)
        return {
            "name": self.case.name,
            "carom": version("carom"),
            **rotor_of(self.case).document(),
            **record(self, RESPONSE),
            "present": _at(self, self.present) | {"steady": self.steady_at_present._asdict()},
            "critical": highest and _at(self, highest.speed),
            "amplification_factor": highest and highest.factor,
            "exceeds_api_617": [each.document() for each in self.exceeds_api_617 if each.what],
            "saturates": [each.document() for each in self.saturating if each.what],
            "steady": [each.document() | each.what._asdict() for each in self.stretches],
            "curve": record(self, CURVE),
            "touchdowns": _bearings(self.whirl, self.lags),
            "rubs": rubs and record(rubs, "speed_si=speeds lags radii"),
            "assumptions": list(ASSUMPTIONS),
        }

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
        return np.asarray(whole - 2.0 * np.pi * np.floor((whole[0] + 0.5 * np.pi) / (2.0 * np.pi)))

    def lags_of(self, found: SynchronousResponse) -> np.ndarray:
        """Those of a response at one speed, without a jump from the curve at the nearest speed; shape (P,)."""
        near = self.lags[np.abs(self.speeds - found.speeds[0]).argmin()]
        return near + np.angle(np.exp(1j * (found.lags[0] - near)))

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
        return self._zeros(lambda found: found.reach.max(axis=1) - share)

    @cached_property
    def saturating(self) -> tuple[SpeedStretch, ...]:
        """Over which speeds sag and whirl ask more of the magnetic bearings than their limits; empty without limits."""
        if not self.whirl.saturation.shape[1]:
            return ()
        return self._exceeding(lambda found: found.saturation.max(axis=1) - 1.0)

    @property
    def allowed_si(self) -> np.ndarray:
        """Shaft vibration that API 617 allows at the speeds, m peak to peak, shape (m,)."""
        return vibration_limit(self.speeds)

    @cached_property
    def exceeds_api_617(self) -> tuple[SpeedStretch, ...]:
        """Over which speeds the contact-free vibration exceeds the limit of API 617."""
        # As an angle it is finite at the peak of an undamped rotor.
        return self._exceeding(
            lambda found: (
                np.arctan2(2.0 * found.touchdowns.major.max(axis=1), vibration_limit(found.speeds)) - 0.25 * np.pi
            )
        )

    def _exceeding(self, value: Callable[[SynchronousResponse], np.ndarray]) -> tuple[SpeedStretch, ...]:
        """Over which speeds a value is above zero."""
        return stretches_between(self.interval, self._zeros(value), lambda at: bool(value(self.at(at))[0] > 0.0))

    def _zeros(self, value: Callable[[SynchronousResponse], np.ndarray]) -> list[float]:
        """Speeds at which a value is zero, refined between neighbouring ones of the curve at which its sign differs."""
        speeds, signs = self.speeds, np.sign(value(self.whirl))
        changes = np.flatnonzero(signs[:-1] * signs[1:] < 0.0)
        ends = [(speeds[each], speeds[each + 1]) for each in changes]
        return [float(brentq(lambda speed: float(value(self.at(speed))[0]), *each)) for each in ends]


def stretches_between(
    interval: tuple[float, float], edges: Iterable[float], what: Callable[[float], object]
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


def _at(response: UnbalanceResponse, speed: float) -> dict[str, object]:
    """Contact-free response at a speed: that of the touchdown bearing where the rotor comes closest, then those of all."""
    found = response.at(speed)
    worst = int(found.reach[0].argmax())
    size = float(found.touchdowns.major[0, worst])
    return {
        "speed_si": speed,
        "rpm": speed / RPM,
        "amplitude": size / float(found.clearances[worst]),
        "peak_to_peak_si": 2.0 * size,
        "lag": float(response.lags_of(found)[worst]),
        "admissible": bool(found.reach.max() < 1.0),
        "zone": response.zone_at(speed) or None,
        "api_617_limit_si": float(vibration_limit(np.array(speed))),
        "touchdowns": _bearings(found, response.lags_of(found)[None]),
        "saturation": float(found.saturation.max()) if found.saturation.size else None,
    }


def _bearings(found: SynchronousResponse, lags: np.ndarray) -> list[dict[str, object]]:
    """Amplitudes 0-to-peak at each touchdown bearing, from 1 on, over the speeds of a response."""
    places = zip(found.clearances.tolist(), found.sags.tolist(), strict=True)
    return [
        {
            "bearing": place + 1,
            "clearance_si": clearance,
            "sag_si": sag,
            "amplitude_si": found.touchdowns.major[:, place].tolist(),
            "forward_si": np.abs(found.touchdowns.forward[:, place]).tolist(),
            "backward_si": np.abs(found.touchdowns.backward[:, place]).tolist(),
            "lag": lags[:, place].tolist(),
        }
        for place, (clearance, sag) in enumerate(places)
    ]
