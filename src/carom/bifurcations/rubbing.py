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
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import ClassVar, Literal

import numpy as np

from carom.bifurcations.lift_offs import (
    LONGEST,
    TOLERANCE,
    LiftOff,
    Whirl,
    end_of_branch,
    known,
    lift_off_state,
    next_lift_off,
    shift_of,
    slope,
)
from carom.bifurcations.points import Bifurcation, MotionKind
from carom.continuation import Steps, Watch, continue_branch
from carom.continuation.roots import bracketed_root, sign_change
from carom.models import Jeffcott, Subject, jeffcott_of
from carom.models.axes import Axis, Ends, axis, interval_around
from carom.motions.trajectories import Trajectory, simulate
from carom.outcome import CaromError, InputError
from carom.parameters import Numbers, Parameters
from carom.results import Result

SAMPLES = 48
HALVINGS = 10
"""Bisections between an angle that has a next lift-off and a neighbouring one that has none."""
STEPS = Steps(first=0.01, largest=0.05, smallest=1e-7, tolerance=TOLERANCE, most_points=400)
LEVEL = 0.02
"""Least normal force at the landing, in ``m c_r Ω²``, of the motion from which the curve of an onset is followed."""
FORCE_SHARE = 0.05
"""Landing force, relative to the largest on the branch, below which its end is an onset or permanent contact."""
SAME_PERIOD = 0.02
"""Relative change of the period beyond which the motion counts as another one."""


@dataclass(frozen=True, eq=False, repr=False)
class RubbingOrbit(Result):
    """A periodic motion with one stretch of lasting contact a period.

    Attributes
    ----------
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


@dataclass(frozen=True, eq=False, repr=False)
class RubbingPoint(Bifurcation):
    """A special point of such a branch: ``"fold"``, ``"period-doubling"``, ``"contact-onset"`` or ``"permanent-contact"``."""

    angle: float = math.nan
    """``x = θ − φ`` at the lift-off, rad."""
    whirl: Whirl = 1
    beside: tuple[float, float, float] | None = None
    """For both onsets the landing force, angle and value of the parameter of a motion next to it."""

    @property
    def motion(self) -> MotionKind:
        """Kind of the motion."""
        return "rubbing"


@dataclass(frozen=True, eq=False, repr=False)
class RubbingBranch(Result):
    """Periodic motions with one stretch of lasting contact, along a parameter.

    Attributes
    ----------
    whirl : {1, -1}
    values, angle, period, contact_time, landing_force, multiplier : ndarray, shape (m,)
    impacts : ndarray of int, shape (m,)
    stops : tuple of two str
        ``"contact-onset"`` (chatter stops being completed), ``"permanent-contact"`` (it stops lifting off),
        ``"parameter limit"``, ``"longest period"``, ``"other contacts"`` (the sequence of contacts changes: another impact
        or lift-off), or as in :class:`~carom.continuation.Branch`.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "keller1977")

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


def rubbing_orbits(machine: Subject, longest: float = LONGEST, samples: int = SAMPLES) -> tuple[RubbingOrbit, ...]:
    """Periodic motions with one stretch of lasting contact a period, found from evenly spaced angles of lift-off.

    Stable and unstable ones are found; two whose angles lie closer than ``2π/samples`` may be missed.

    Parameters
    ----------
    longest : float
        Longest period, in ``1/Ω``.
    samples : int
        Number of angles tried in each direction of whirl.
    """
    rotor = jeffcott_of(machine)
    angles = np.linspace(-math.pi, math.pi, samples + 1).tolist()
    found = []
    whirls: tuple[Whirl, Whirl] = (1, -1)
    for whirl in whirls:

        @cache
        def shift(angle: float, whirl: Whirl = whirl) -> float:
            return shift_of(next_lift_off(rotor, whirl, angle, longest), whirl, angle)

        for neighbours in pairwise(angles):
            bracket = sign_change(shift, *neighbours, HALVINGS)
            # A change of sign through ±π, or a jump, is no fixed point.
            if bracket is None or abs(shift(bracket[0])) + abs(shift(bracket[1])) >= math.pi:
                continue
            try:
                angle = bracketed_root(shift, *bracket, 1e-13)
            except CaromError:
                continue
            here = next_lift_off(rotor, whirl, angle, longest)
            if here is not None and abs(shift_of(here, whirl, angle)) < TOLERANCE:
                found.append(RubbingOrbit(rotor.parameters, whirl, angle, here, 1.0 + slope(shift, angle)))
    return tuple(found)


def continue_rubbing(orbit: RubbingOrbit, parameter: str, interval: Ends) -> RubbingBranch:
    """Continue a periodic motion with lasting contact along a parameter, up to the onset of lasting contact.

    The map of lift-offs is simulated, and its derivatives are central differences.

    Parameters
    ----------
    parameter : str
        Dimensionless or physical name.
    interval : tuple of float or str
        Range of the parameter; text has a unit.

    Raises
    ------
    InputError
        Unknown parameter, or an interval without the motion.
    """
    along = axis(orbit.parameters, parameter)
    present, limits = interval_around(along, orbit.parameters.value(parameter), interval)
    lift_offs = _Map(along, Jeffcott(orbit.parameters), orbit.whirl)
    size = max(abs(present), 0.1 * (limits[1] - limits[0]))
    branch = continue_branch(
        lambda u, p: np.array([lift_offs.shift(float(u[0]), p)]),
        np.array([orbit.angle]),
        present,
        limits,
        watches=[Watch("period-doubling", lambda u, p: 1.0 + lift_offs.multiplier(float(u[0]), p))],
        steps=STEPS,
        scales=np.array([1.0, size]),
    )
    rows = list(zip(branch.unknowns[:, 0].tolist(), branch.parameters.tolist(), strict=True))
    course = [known(lift_offs.after(*row)) for row in rows]
    forces = np.array([entry.landing_force for entry in course])
    special = [
        lift_offs.point(point.kind, float(point.unknowns[0]), point.parameter, point.place)
        for point in branch.special
        if point.kind != "branch point"
    ]
    stops: list[str] = list(branch.stops)
    for end in (0, -1):
        if stops[end] in ("end of domain", "step too small"):
            stops[end] = _why_it_ends(course, end)
        if stops[end] in ("contact-onset", "permanent-contact"):
            points = np.array(rows if end == -1 else rows[::-1])
            angle, value = end_of_branch(lift_offs.alike(course[end].time), points, size)
            near = int(np.flatnonzero(forces > min(LEVEL, 0.5 * float(forces.max())))[end])
            beside = float(forces[near]), *rows[near]
            place = 0.0 if end == 0 else len(rows) - 1.0
            special.append(replace(lift_offs.point(stops[end], angle, value, place), beside=beside))
    return RubbingBranch(
        axis=along,
        whirl=orbit.whirl,
        values=branch.parameters,
        angle=branch.unknowns[:, 0],
        period=np.array([entry.time for entry in course]),
        contact_time=np.array([entry.contact_time for entry in course]),
        landing_force=forces,
        multiplier=np.array([lift_offs.multiplier(*row) for row in rows]),
        impacts=np.array([entry.impacts for entry in course]),
        special=tuple(sorted(special, key=lambda point: point.place)),
        stops=(stops[0], stops[1]),
    )


@dataclass(frozen=True)
class _Map:
    """The map of lift-offs as a function of the angle and of a parameter."""

    along: Axis
    base: Jeffcott
    whirl: Whirl

    def after(self, angle: float, value: float) -> LiftOff | None:
        """The next lift-off."""
        try:
            rotor = self.along.move(self.base, value)
        except InputError:
            return None
        return next_lift_off(rotor, self.whirl, angle)

    def shift(self, angle: float, value: float) -> float:
        """Angle from a lift-off to the next, in rad."""
        return shift_of(self.after(angle, value), self.whirl, angle)

    def multiplier(self, angle: float, value: float) -> float:
        """Slope of the map."""
        return 1.0 + slope(lambda x: self.shift(x, value), angle)

    def point(self, kind: str, angle: float, value: float, place: float) -> RubbingPoint:
        """A special point at this angle and value."""
        return RubbingPoint(
            kind,
            Numbers.of(self.base.parameters).moved(self.along.name, value),
            known(self.after(angle, value)).time,
            parameter=self.along.name,
            value=value,
            place=place,
            angle=angle,
            whirl=self.whirl,
        )

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
