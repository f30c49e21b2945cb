"""Periodic motions with a stretch of lasting contact, and where lasting contact begins.

A single-impact orbit has impacts of finite speed.  Where it grazes, its radius has a maximum: the acceleration at the
wall points inward, so the new impact of vanishing speed is a bounce, not the beginning of a rub.  With ``d > 0``
lasting contact begins elsewhere, on motions whose bounces accumulate: they chatter, slide and lift off.  At the onset
the chatter is complete at the same moment at which the normal force vanishes.  (With ``d = 0`` there is no chatter, and
the onset lies on the single-impact orbit itself: :func:`~carom.bifurcations.conditions.pressed_on`.)

The motion from one lift-off to the next is a map of one variable (:mod:`~carom.bifurcations.lift_offs`).  Its fixed
points are periodic motions with one lift-off a period.  Its slope is their only nonzero multiplier, because no other
disturbance survives the lasting contact.  A branch of them ends where the lasting contact shrinks to nothing (its
onset), or where the flights do: the normal force then just touches zero once a period, and beyond that the rotor stays
on the wall (permanent contact).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from carom.bifurcations.axes import Axis, Numbers, axis, within
from carom.bifurcations.lift_offs import LONGEST, LiftOff, Whirl, known, lift_off_state, next_lift_off, shift_of
from carom.continuation import Steps, Watch, continue_branch
from carom.continuation.roots import bracketed_root
from carom.models import Jeffcott
from carom.motions.trajectories import Trajectory, simulate
from carom.outcome import CaromError, InputError
from carom.parameters import Parameters
from carom.results import Result

__all__ = [
    "RubbingBranch",
    "RubbingOrbit",
    "RubbingPoint",
    "continue_rubbing",
    "rubbing_orbits",
]

SAMPLES = 48
HALVINGS = 10
"""Bisections between an angle that has a next lift-off and a neighbouring one that has none."""
STEPS = Steps(first=0.01, largest=0.05, smallest=1e-7, tolerance=1e-9, most_points=400)
DIFFERENCE = 1e-6
FORCE_SHARE = 0.05
"""Landing force, relative to the largest on the branch, below which its end is an onset or permanent contact."""
SAME_PERIOD = 0.02
"""Relative change of the period beyond which the motion counts as another one."""
FINEST = 1e-11
"""Relative step of the parameter at which the search for the end of a branch stops."""


@dataclass(frozen=True, eq=False, repr=False)
class RubbingOrbit(Result):
    """A periodic motion with one stretch of lasting contact a period.

    Attributes
    ----------
    parameters : Parameters
    whirl : {1, -1}
    angle : float
        ``x = θ − φ`` at the lift-off, rad.
    lift_off : LiftOff
        The next lift-off.
    multiplier : float
        Factor by which a small change of the angle grows from lift-off to lift-off; the other multipliers are zero.
    """

    parameters: Parameters
    whirl: Whirl
    angle: float
    lift_off: LiftOff
    multiplier: float

    @property
    def period(self) -> float:
        """Period in ``1/Ω``."""
        return self.lift_off.time

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return abs(self.multiplier) < 1.0

    def trajectory(self, periods: float = 1.0) -> Trajectory:
        """Follow the motion from a lift-off."""
        rotor = Jeffcott(self.parameters)
        start = lift_off_state(rotor, self.whirl, self.angle)
        if start is None:
            raise CaromError(f"the rotor does not lift off at an angle of {self.angle:g} rad from the unbalance")
        return simulate(rotor, start, periods * self.period)


@dataclass(frozen=True)
class RubbingPoint:
    """A special point of such a branch: ``"fold"``, ``"period-doubling"``, ``"contact-onset"`` or ``"permanent-contact"``.

    ``value`` is that of the parameter, ``place`` the index of the motion before it plus the fraction of the step.
    """

    kind: str
    value: float
    angle: float
    period: float
    place: float


@dataclass(frozen=True, eq=False, repr=False)
class RubbingBranch(Result):
    """Periodic motions with one stretch of lasting contact, along a parameter.

    Attributes
    ----------
    axis : Axis
    whirl : {1, -1}
    values, angle, period, contact_time, landing_force, multiplier : ndarray, shape (m,)
    impacts : ndarray of int, shape (m,)
    special : tuple of RubbingPoint
    stops : tuple of two str
        ``"contact-onset"`` (chatter stops being completed), ``"permanent-contact"`` (it stops lifting off),
        ``"parameter limit"``, ``"longest period"``, ``"other contacts"`` (the sequence of contacts changes: another impact
        or lift-off), or as in :class:`~carom.continuation.Branch`.
    """

    axis: Axis
    whirl: Whirl
    values: np.ndarray
    angle: np.ndarray
    period: np.ndarray
    contact_time: np.ndarray
    landing_force: np.ndarray
    multiplier: np.ndarray
    impacts: np.ndarray
    special: tuple[RubbingPoint, ...]
    stops: tuple[str, str]

    def __len__(self) -> int:
        return len(self.values)

    @property
    def stable(self) -> np.ndarray:
        """Which of them are stable, bool, shape (m,)."""
        return np.abs(self.multiplier) < 1.0


def rubbing_orbits(
    parameters: Parameters, longest: float = LONGEST, samples: int = SAMPLES
) -> tuple[RubbingOrbit, ...]:
    """Periodic motions with one stretch of lasting contact a period, found from evenly spaced angles of lift-off.

    Stable and unstable ones are found; two whose angles lie closer than ``2π/samples`` may be missed.

    Parameters
    ----------
    parameters : Parameters
    longest : float
        Longest period, in ``1/Ω``.
    samples : int
        Number of angles tried in each direction of whirl.

    Returns
    -------
    tuple of RubbingOrbit
    """
    rotor = Jeffcott(parameters)
    angles = np.linspace(-math.pi, math.pi, samples + 1).tolist()
    found = []
    whirls: tuple[Whirl, Whirl] = (1, -1)
    for whirl in whirls:

        def shift(angle: float, whirl: Whirl = whirl) -> float:
            return shift_of(next_lift_off(rotor, whirl, angle, longest), whirl, angle)

        for low, high in _brackets(shift, angles):
            try:
                angle = bracketed_root(shift, low, high, 1e-13)
            except CaromError:
                continue
            if abs(shift(angle)) < STEPS.tolerance:
                found.append(_orbit(parameters, whirl, angle, longest))
    return tuple(orbit for orbit in found if orbit is not None)


def continue_rubbing(orbit: RubbingOrbit, parameter: str, interval: tuple[float, float]) -> RubbingBranch:
    """Continue a periodic motion with lasting contact along a parameter, up to the onset of lasting contact.

    The map of lift-offs is simulated, and its derivatives are central differences.

    Parameters
    ----------
    orbit : RubbingOrbit
    parameter : str
        Dimensionless or physical name.
    interval : tuple of float

    Returns
    -------
    RubbingBranch

    Raises
    ------
    InputError
        Unknown parameter, or an interval without the motion.
    """
    along = axis(orbit.parameters, parameter)
    base = Numbers.of(orbit.parameters)
    present = within(along.get(base), interval)
    if not interval[0] <= present <= interval[1] or not interval[0] < interval[1]:
        raise InputError(parameter, interval, f"an interval that holds the motion's own value {present:.6g}")
    lift_offs = _Map(along, base, orbit.whirl)
    size = max(abs(present), 0.1 * (interval[1] - interval[0]))
    branch = continue_branch(
        lambda u, p: np.array([lift_offs.shift(float(u[0]), p)]),
        np.array([orbit.angle]),
        present,
        interval,
        watches=[Watch("period-doubling", lambda u, p: 1.0 + lift_offs.multiplier(float(u[0]), p))],
        steps=STEPS,
        scales=np.array([1.0, size]),
    )
    rows = list(zip(branch.unknowns[:, 0].tolist(), branch.parameters.tolist(), strict=True))
    course = [known(lift_offs.after(*row)) for row in rows]
    special = []
    for point in branch.special:
        if point.kind != "branch point":
            angle = float(point.unknowns[0])
            period = known(lift_offs.after(angle, point.parameter)).time
            special.append(RubbingPoint(point.kind, point.parameter, angle, period, point.place))
    stops: list[str] = list(branch.stops)
    for end in (0, -1):
        if stops[end] in ("end of domain", "step too small"):
            stops[end] = _why_it_ends(course, end)
        if stops[end] in ("contact-onset", "permanent-contact"):
            points = np.array(rows if end == -1 else rows[::-1])
            angle, value = _towards_end(lift_offs.alike(course[end].time), points, size)
            period = known(lift_offs.after(angle, value)).time
            special.append(RubbingPoint(stops[end], value, angle, period, 0.0 if end == 0 else len(rows) - 1.0))
    return RubbingBranch(
        axis=along,
        whirl=orbit.whirl,
        values=branch.parameters,
        angle=branch.unknowns[:, 0],
        period=np.array([entry.time for entry in course]),
        contact_time=np.array([entry.contact_time for entry in course]),
        landing_force=np.array([entry.landing_force for entry in course]),
        multiplier=np.array([lift_offs.multiplier(*row) for row in rows]),
        impacts=np.array([entry.impacts for entry in course]),
        special=tuple(sorted(special, key=lambda point: point.place)),
        stops=(stops[0], stops[1]),
    )


@dataclass(frozen=True)
class _Map:
    """The map of lift-offs as a function of the angle and of a parameter."""

    along: Axis
    base: Numbers
    whirl: Whirl

    def after(self, angle: float, value: float) -> LiftOff | None:
        """The next lift-off."""
        try:
            rotor = Jeffcott(self.along.set(self.base, value).parameters)
        except InputError:
            return None
        return next_lift_off(rotor, self.whirl, angle)

    def shift(self, angle: float, value: float) -> float:
        """Angle from a lift-off to the next, in rad."""
        return shift_of(self.after(angle, value), self.whirl, angle)

    def multiplier(self, angle: float, value: float) -> float:
        """Slope of the map."""
        ends = [self.shift(angle + side, value) for side in (DIFFERENCE, -DIFFERENCE)]
        return 1.0 + (ends[0] - ends[1]) / (2.0 * DIFFERENCE)

    def alike(self, period: float) -> Callable[[float, float], float]:
        """The same function restricted to motions with nearly this period; ``nan`` for others."""

        def shift(angle: float, value: float) -> float:
            found = self.after(angle, value)
            same = found is not None and abs(found.time - period) < SAME_PERIOD * period
            return shift_of(found, self.whirl, angle) if same else math.nan

        return shift


def _why_it_ends(course: list[LiftOff], end: Literal[0, -1]) -> str:
    """Reason why the equations, and so the branch, end at its first or last motion."""
    last = course[end]
    if len(course) > 1 and last.landing_force < FORCE_SHARE * max(entry.landing_force for entry in course):
        return "contact-onset" if last.contact_time < 0.5 * last.time else "permanent-contact"
    return "longest period" if last.time > 0.98 * LONGEST else "other contacts"


def _brackets(shift: Callable[[float], float], angles: list[float]) -> list[tuple[float, float]]:
    """Intervals that contain a fixed point of the map, including those next to angles without a next lift-off."""
    brackets = []

    def note(low: float, at_low: float, high: float, at_high: float) -> None:
        # A change of sign through ±π, or a jump, is no fixed point.
        if at_low * at_high < 0.0 and abs(at_low) + abs(at_high) < math.pi:
            brackets.append((min(low, high), max(low, high)))

    values = [shift(angle) for angle in angles]
    for (low, at_low), (high, at_high) in pairwise(zip(angles, values, strict=True)):
        note(low, at_low, high, at_high)
        if math.isnan(at_low) != math.isnan(at_high):
            inner, at_inner, outer = (high, at_high, low) if math.isnan(at_low) else (low, at_low, high)
            for _ in range(HALVINGS):
                middle = 0.5 * (inner + outer)
                value = shift(middle)
                if math.isnan(value):
                    outer = middle
                else:
                    note(inner, at_inner, middle, value)
                    inner, at_inner = middle, value
    return brackets


def _orbit(parameters: Parameters, whirl: Whirl, angle: float, longest: float) -> RubbingOrbit | None:
    rotor = Jeffcott(parameters)
    here = next_lift_off(rotor, whirl, angle, longest)
    if here is None:
        return None
    ends = [shift_of(next_lift_off(rotor, whirl, angle + side, longest), whirl, angle + side) for side in (1e-6, -1e-6)]
    return RubbingOrbit(parameters, whirl, angle, here, 1.0 + (ends[0] - ends[1]) / 2e-6)


def end_of_motions(
    residual: Callable[[float, float], float],
    start: tuple[float, float],
    lean: float,
    step: float,
    slope: float,
    finest: float,
) -> tuple[float, float]:
    """Last angle and value of a parameter at which the motion exists.

    The equations end there, so they have no derivative at that point.  The predictor is a straight line; the corrector
    uses the slope of the residual at a point before the end.  The step is doubled until it fails for the first time;
    after each failure it is halved.

    Parameters
    ----------
    residual : callable
        Function of angle and value; ``nan`` where there is no such motion.
    start : tuple of float
        Angle and value of a motion near the end.
    lean : float
        Change of the angle with the value.
    step : float
        First change of the value, towards the end.
    slope : float
        Derivative of the residual with respect to the angle.
    finest : float
        Step of the value at which the search stops.

    Returns
    -------
    tuple of float
    """
    angle, value = start
    passed = False
    while abs(step) > finest:
        trial, p = angle + lean * step, value + step
        left = math.nan
        for _ in range(6):
            left = residual(trial, p)
            if not abs(left) > STEPS.tolerance:
                break
            trial -= left / slope
        if abs(left) <= STEPS.tolerance:
            angle, value = trial, p
            step *= 1.0 if passed else 2.0
        else:
            passed = True
            step *= 0.5
    return angle, value


def _towards_end(residual: Callable[[float, float], float], points: np.ndarray, size: float) -> tuple[float, float]:
    """:func:`end_of_motions` from the points of a branch, shape (m, 2), the last of which is next to the end."""
    angle, value = points[-1].tolist()
    far = np.flatnonzero(np.abs(points[:, 1] - value) > 1e-6 * size)
    if not len(far):
        return angle, value
    x, p = points[far[-1]].tolist()
    slope = (residual(x + 1e-5, p) - residual(x - 1e-5, p)) / 2e-5
    lean = (angle - x) / (value - p)
    return end_of_motions(residual, (angle, value), lean, math.copysign(1e-5 * size, value - p), slope, FINEST * size)
