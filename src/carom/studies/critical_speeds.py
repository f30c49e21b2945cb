"""Critical speeds: peaks of the response to unbalance, with their separation from the operating speeds; and the limits of vibration of standards.

*API 617* (axial and centrifugal compressors; the rules for lateral analysis are explained in API RP 684).  Amplification
factor: speed of the peak of the response over the width of the peak at 0.707 of its height.  Below 2.5 the response counts
as critically damped and no separation is required.  Otherwise a critical speed below the operating speeds keeps a distance
of ``17(1 − 1/(AF − 1.5))`` %, at most 16 %, of the lowest of them, one above them ``10 + 17(1 − 1/(AF − 1.5))`` %, at most
26 %, of the highest.  Shaft vibration at speed: ``25.4 µm √(12000 rpm/N)`` peak to peak (``√(12000/N)`` mil), at most 25.4 µm.
The standard applies this to the vibration that is measured beside the bearings at the maximum continuous speed; here it is
compared with the motion of the calculated unbalance response at each speed.  Paragraphs: the factor is SP6.8.2.1 of API RP 684, the separation
SP6.8.2.10, the vibration SP6.8.2.11, which is 4.8.2.11 of API 617; numbers as the report of the program ROSS cites them, since the standard was not at hand.

*ISO 14839-2* (rotors on active magnetic bearings): zones A to D of the largest displacement of the rotor from the centre of
the clearance, with limits of 0.3, 0.4 and 0.5 of the smallest radial clearance.  Here the clearance of the touchdown bearing is
taken as the smallest, and the displacement is that of the static sag and of the whirl from unbalance together.  The limits are those of
the machine file (:class:`~carom.parameters.Zones`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import brentq, minimize_scalar  # type: ignore[import-untyped]

from carom.base.results import record
from carom.models import Rotor, Subject, rotor_of
from carom.parameters.fields import RPM
from carom.parameters.formats import number
from carom.rotors import SynchronousResponse, WhirlMode, synchronous_response
from carom.studies.wording import micrometres, rpm

Side = Literal["below", "inside", "above"]

LARGEST = 25.4e-6
"""Largest shaft vibration that API 617 allows, m peak to peak."""
FULL_SPEED = 12_000.0 * math.pi / 30.0
"""Speed in rad/s beyond which less is allowed."""
CRITICALLY_DAMPED = 2.5
"""Amplification factor below which no separation is required."""

ASSUMPTIONS = (
    "Amplification factor: critical speed over the width of the peak at 0.707 (1/√2) of its height (API RP 684, SP6.8.2.1); separation by SP6.8.2.10.",
    "API 617 limit (4.8.2.11): 25.4 µm √(12000 rpm/N) peak to peak, at most 25.4 µm, compared with the calculated response at each speed.",
    "Editions of API 617, and its annex on magnetic bearings, may state other limits.",
    "Zones of ISO 14839-2: sag and whirl together, as a share of the smallest radial clearance, assumed to be that of the touchdown bearing.",
    "Mass, damping, stiffness, eccentricity, friction and restitution are held constant over speed.",
)
"""What is taken from the standards, and what is assumed."""
HALF_POWER = math.sqrt(0.5)
SEARCHED_RANGE = (0.25, 1.5)
"""Default range of a response: these multiples of the smaller and of the larger one of critical and operating speed."""
SPEEDS = 400
"""Number of speeds of a curve."""
NARROW = 0.2
"""Damping ratio below which the response is computed densely about a whirl."""
MEASURED_AT = {"sensors": "sensors of magnetic bearing", "touchdowns": "touchdown bearing"}
"""What the number of a bearing counts, by what is measured there."""
REFINED, UNDAMPED = 1e-9, 1e-7
"""Relative width to which a peak is refined, and that of a peak that counts as one without damping."""
CRITICAL = (
    "bearing speed_si=speed amplitude_si=amplitude amplification_factor=factor half_power_si=half_power side=separation.side "
    "separation=separation.actual required=separation.required met=separation.met"
)


@dataclass(frozen=True)
class Separation:
    """Separation of the operating speeds from the critical speed (API 617).

    Attributes
    ----------
    side : {"below", "inside", "above"}
        Where the critical speed lies: below the operating speeds, among them or above.
    actual, required : float
        Distance as a share of the nearest operating speed, and the least that is required.
    operating : float
        That speed, rad/s.
    """

    side: Side
    actual: float
    required: float
    operating: float

    @classmethod
    def of(cls, critical: float, operating: tuple[float, float], factor: float | None) -> Separation:
        """Separation of a critical speed with this amplification factor, rad/s."""
        low, high = operating
        side: Side = "below" if critical < low else "above" if critical > high else "inside"
        actual = {"below": 1.0 - critical / low, "inside": 0.0, "above": critical / high - 1.0}[side]
        return cls(side, actual, required_margin(factor, side), low if side == "below" else high)

    @property
    def met(self) -> bool:
        """Whether the distance is large enough."""
        return self.required == 0.0 or (self.side != "inside" and self.actual >= self.required)


@dataclass(frozen=True)
class Critical:
    """A peak of the response to unbalance.

    Attributes
    ----------
    measured_at, bearing : str, int
        Where, from 1: the magnetic bearing whose sensors measure it, or the touchdown bearing of a machine without sensors.
    speed : float
        rad/s.
    amplitude : float
        There, 0-to-peak, m.
    factor : float or None
        Amplification factor: speed over the width of the peak at 0.707 of its height (API 617); ``None`` of a peak that is flatter than that, or cut
        off by the range.
    half_power : tuple of float, or None
        Speeds at which it is 0.707 of that, rad/s; ``None`` without the factor.
    separation : Separation
        From the operating speeds.
    """

    measured_at: str
    bearing: int
    speed: float
    amplitude: float
    factor: float | None
    half_power: tuple[float, float] | None
    separation: Separation

    @property
    def words(self) -> str:
        """The peak with its separation in a sentence."""
        margin, factor = self.separation, self.factor
        if factor == math.inf:
            return f"{rpm(self.speed)}; without damping the amplification factor is infinite."
        text = f"{rpm(self.speed)}, {micrometres(self.amplitude)} 0-to-peak at {self.measured_at} {self.bearing}"
        if factor is not None:
            text += f"; amplification factor {number(factor, 3)}"
        if factor is None or factor < CRITICALLY_DAMPED:
            return f"{text}; critically damped: API 617 requires no separation margin."
        inside = margin.side == "inside"
        where = "at" if inside else f"separation margin {number(100.0 * margin.actual, 3)} % {margin.side}"
        required = f"required {number(100.0 * margin.required, 3)} %: {'met' if margin.met else 'not met'}."
        return f"{text}, {where} {rpm(margin.operating)}, {required}"

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return record(self, CRITICAL) | {"speed_rpm": self.speed / RPM}


def usual_range(rotor: Rotor, whirls: Iterable[WhirlMode], run: tuple[float, float]) -> tuple[float, float]:
    """Speeds of a response that are not stated, rad/s: around the operating ones and the slowest whirl that may resonate, where all supports are known."""
    slow = [abs(each.exponent.imag) for each in whirls if each.sense != "backward" and each.damping_ratio < HALF_POWER]
    known = [*run, *([min(slow)] if slow else [])]
    low, high = known_speeds(rotor)
    return max(SEARCHED_RANGE[0] * min(known), low), min(SEARCHED_RANGE[1] * max(known), high)


def known_speeds(rotor: Rotor) -> tuple[float, float]:
    """Lowest and highest speed for which all of a rotor is known, rad/s."""
    elements = rotor.finite_elements
    return (0.0, math.inf) if elements is None else elements.machine.speed_range


def response_curve(
    machine: Subject,
    whirls: Iterable[WhirlMode],
    interval: tuple[float, float],
    operating: tuple[float, float],
    marks: Iterable[float] = (),
) -> tuple[SynchronousResponse, tuple[Critical, ...]]:
    """Response to unbalance over an interval of speeds, rad/s, and its peaks, which are among the speeds of the curve as the marks are.

    Speeds lie evenly over the interval, and densely about the frequencies of whirls that unbalance excites, whose peaks may be narrow: anisotropic
    supports let it excite backward ones too.
    """
    speeds = [np.linspace(*interval, SPEEDS), np.fromiter(marks, float)]
    for whirl in whirls:
        excited = whirl.sense == "forward" or rotor_of(machine).system.is_anisotropic
        if excited and whirl.damping_ratio < NARROW:
            speeds.append(abs(whirl.exponent.imag) + abs(whirl.exponent.real) * np.linspace(-4.0, 4.0, 41))

    def inside(speeds: np.ndarray) -> SynchronousResponse:
        kept = np.unique(speeds[(speeds >= interval[0]) & (speeds <= interval[1])])
        return synchronous_response(machine, kept.tolist())

    found = inside(np.concatenate(speeds))
    criticals = _criticals(machine, found, operating)
    peaks = [each.speed for each in criticals]
    return inside(np.append(found.speeds, peaks)) if peaks else found, criticals


def _criticals(machine: Subject, found: SynchronousResponse, operating: tuple[float, float]) -> tuple[Critical, ...]:
    """Peaks of what the sensors measure, or of the whirl at the touchdown bearings of a machine without sensors, refined between the speeds of a curve."""
    measured = "sensors" if found.sensors.forward.shape[1] else "touchdowns"
    criticals = []
    for bearing, sizes in enumerate(getattr(found, measured).major.T):

        def size(speed: float, bearing: int = bearing) -> float:
            return float(getattr(synchronous_response(machine, [speed]), measured).major[0, bearing])

        inner = (sizes[1:-1] > sizes[:-2]) & (sizes[1:-1] >= sizes[2:])
        for place in (np.flatnonzero(inner) + 1).tolist():
            low, middle, high = found.speeds[place - 1 : place + 2].tolist()
            near = minimize_scalar(
                lambda at, size=size: -size(at), bounds=(low, high), options={"xatol": REFINED * middle}
            )
            peak = max(middle, float(near.x), key=size)
            half = _half_power(found.speeds, sizes, place, peak, size)
            width = half[1] - half[0] if half else math.nan
            factor = peak / width if width > UNDAMPED * peak else math.inf if half else None
            separation = Separation.of(peak, operating, factor)
            criticals.append(Critical(MEASURED_AT[measured], bearing + 1, peak, size(peak), factor, half, separation))
    return tuple(criticals)


def _half_power(
    speeds: np.ndarray, sizes: np.ndarray, place: int, peak: float, size: Callable[[float], float]
) -> tuple[float, float] | None:
    """Speeds at which a peak has fallen to 0.707 of its height; ``None`` if it does not on both sides before it rises again."""
    height, ends = size(peak), []
    for step in (-1, 1):
        here = place + step
        while 0 <= here < len(sizes) and HALF_POWER * height < sizes[here] <= height:
            here += step
        if not 0 <= here < len(sizes) or sizes[here] > height:
            return None
        inside = peak if here == place + step else float(speeds[here - step])
        ends.append(float(brentq(lambda speed: size(speed) - HALF_POWER * height, inside, float(speeds[here]))))
    return ends[0], ends[1]


def vibration_limit(speeds: np.ndarray) -> np.ndarray:
    """Largest shaft vibration of API 617 at speeds in rad/s, in m peak to peak."""
    return np.asarray(LARGEST * np.minimum(1.0, np.sqrt(FULL_SPEED / np.asarray(speeds, float))))


def required_margin(factor: float | None, side: Side) -> float:
    """Separation that API 617 requires of a critical speed on one side of the operating speeds, as a share of them.

    The amplification factor is ``None`` if the peak is critically damped.  For a critical speed inside the operating
    speeds the separation of one above them is returned, which it does not keep.
    """
    if factor is None or factor < CRITICALLY_DAMPED:
        return 0.0
    share = 0.17 * (1.0 - 1.0 / (factor - 1.5))
    return min(0.16, share) if side == "below" else min(0.26, 0.10 + share)
