"""A curve of bifurcations in the plane of two parameters: what is said of it, whether it passes through a point, what the equations of all have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from carom.base.outcome import STEADY_WORDS
from carom.base.results import Result
from carom.bifurcations.conditions import RESONANCES, TESTS
from carom.bifurcations.planes import EDGE, Plane
from carom.bifurcations.points import STEADY, Bifurcation
from carom.continuation import Branch, Equations, Steps, Watch, continue_branch, refined_points
from carom.models import Rotor
from carom.orbits.names import CountedName, OrbitName, combined
from carom.parameters import Numbers
from carom.parameters.formats import format_along


@dataclass(frozen=True)
class Codimension2Point:
    """A point where two bifurcations happen at once.

    Attributes
    ----------
    kinds : tuple of str
        For example ``("fold", "boundary-equilibrium")``; ``("resonance-1:3",)`` where a multiplier on a Neimark–Sacker
        curve is a third root of one, and so on; two multipliers are 1 at ``"resonance-1:1"``, −1 at ``"resonance-1:2"``.
    value : tuple of float
        Its place in the plane.
    period, radial_speed : float
        Those of the orbit; ``nan`` for equilibria.
    admissible : bool
        Whether it happens to a motion of the machine, or to one that just stops being one.
    """

    kinds: tuple[str, ...]
    value: tuple[float, float]
    period: float
    radial_speed: float
    admissible: bool

    @property
    def kind(self) -> str:
        """Its kinds as one text, such as ``"fold + boundary-equilibrium"``."""
        return " + ".join(self.kinds)

    @property
    def resonance(self) -> str:
        """Ratio of a resonance, such as ``"1:3"``; otherwise empty."""
        return self.kinds[0].removeprefix("resonance-") if self.kinds[0] in RESONANCES else ""


@dataclass(frozen=True, eq=False, repr=False)
class Curve(Result):
    """A curve of one bifurcation.

    Attributes
    ----------
    kind : str
    plane : Plane
    points : ndarray, shape (m, 2)
    periods : ndarray, shape (m,)
        Period of the orbit; ``nan`` for equilibria.
    radial_speeds : ndarray, shape (m,)
        ``ṙ`` of the orbit; ``nan`` for equilibria.
    admissible : ndarray of bool, shape (m,)
        Where it is a bifurcation of motions of the machine.
    orbits : tuple of OrbitName or CountedName
        Names of the orbits that bifurcate, where these are motions of the machine; for a fold the orbits that meet.
        Empty for equilibria and rolling.
    codimension2 : tuple of Codimension2Point
    stops : tuple of two str
        Reason for its end at both ends: ``"edge of the plane"``, ``"closed loop"``, the codimension-2 point where the
        bifurcation ceases (``"resonance-1:1"`` or ``"resonance-1:2"`` of a Neimark–Sacker curve),
        ``"period-halving"`` (both halves of the period become equal), ``"grazing meets the impact"`` (the time of grazing
        reaches an end of the period), ``"period vanishes"``, ``"radial speed without bound"``, or why the continuation gave
        up (:class:`~carom.continuation.Branch`).
    """

    kind: str
    plane: Plane
    points: np.ndarray
    periods: np.ndarray
    radial_speeds: np.ndarray
    admissible: np.ndarray
    orbits: tuple[OrbitName | CountedName, ...]
    codimension2: tuple[Codimension2Point, ...]
    stops: tuple[str, str]

    def line_of(self, name: str, value: object) -> str:
        """Points are stated in the units of both parameters."""
        if name == "points" and len(self.points):
            ranges = zip((self.plane.first, self.plane.second), self.points.T, strict=True)
            return f"{len(self.points)}, {', '.join(format_along(axis, ends) for axis, ends in ranges)}"
        return super().line_of(name, value)

    @cached_property
    def steps(self) -> np.ndarray:
        """Distances of neighbouring points in widths of the plane, shape (m − 1,)."""
        return np.linalg.norm(np.diff(self.points, axis=0) / self.plane.widths, axis=1)

    @property
    def subject(self) -> str:
        """The motion that bifurcates, such as ``"B1,c/d"``, ``"levitation"`` or ``"synchronous rub"``."""
        single = [name for name in self.orbits if isinstance(name, OrbitName)]
        if self.orbits and not single:
            return ", ".join(self.orbits)
        return combined(single) if single else STEADY_WORDS.get(STEADY.get(self.kind, ""), "")


CURVE_RADIUS = 5e-4
"""Distance from a curve, in widths of the plane, within which a point lies on it: ten times that from its chords."""
SAME_PERIOD, SAME_SPEED = 0.02, 0.02
"""Relative difference of periods, and difference of radial speeds in ``c_r Ω``, of orbits that count as the same."""
SAMPLES = 9
"""Number of points of a curve that must lie on another one for it to count as part of that one."""


def passes(curve: Curve, point: Bifurcation) -> bool:
    """Whether a bifurcation lies on a curve: the curve must pass close by with the same orbit."""
    place = curve.plane.place_of(point.at)
    return curve.kind == point.kind and _lies_on(curve, place, point.period, point.radial_speed)


def _lies_on(curve: Curve, place: Sequence[float], period: float, speed: float) -> bool:
    points, here = curve.points / curve.plane.widths, np.asarray(place) / curve.plane.widths
    ahead = np.diff(points, axis=0)
    share = np.clip(((here - points[:-1]) * ahead).sum(axis=1) / np.maximum((ahead**2).sum(axis=1), 1e-300), 0.0, 1.0)
    distance = np.linalg.norm(points[:-1] + share[:, None] * ahead - here, axis=1)
    for i in np.flatnonzero(distance <= CURVE_RADIUS):
        weights = np.array([1.0 - share[i], share[i]])
        # Equilibria have neither period nor radial speed.
        other = abs(weights @ curve.periods[i : i + 2] - period) >= SAME_PERIOD * period
        if not (other or abs(weights @ curve.radial_speeds[i : i + 2] - speed) >= SAME_SPEED):
            return True
    return False


def with_curve(curves: Sequence[Curve], new: Curve) -> list[Curve]:
    """Add a new curve to the known ones, and drop curves that are part of another."""
    if any(_is_part(new, curve) for curve in curves):
        return list(curves)
    return [*(curve for curve in curves if not _is_part(curve, new)), new]


def _is_part(curve: Curve, other: Curve) -> bool:
    """Whether a curve lies on another one."""
    if curve.kind != other.kind:
        return False
    looked_at = np.unique(np.linspace(0, len(curve.points) - 1, SAMPLES).round().astype(int))
    rows = zip(curve.points[looked_at], curve.periods[looked_at], curve.radial_speeds[looked_at], strict=True)
    return all(_lies_on(other, *row) for row in rows)


def crossings(curve: Curve, first: np.ndarray, last: np.ndarray) -> Iterator[float]:
    """Where a curve of motions of the machine crosses the straight line between two points, as shares of the line."""
    start, line = np.asarray(first), np.subtract(last, first) / curve.plane.widths
    offsets = (curve.points - start) / curve.plane.widths
    across = offsets[:, 0] * line[1] - offsets[:, 1] * line[0]
    along = offsets @ line / (line @ line)
    real = curve.admissible[:-1] | curve.admissible[1:]
    for i in np.flatnonzero(real & ((across[:-1] < 0.0) != (across[1:] < 0.0))):
        share = across[i] / (across[i] - across[i + 1])
        place = float(along[i] + share * (along[i + 1] - along[i]))
        if 0.0 <= place <= 1.0:
            yield place


Place = tuple[np.ndarray, float]
"""Unknowns, of which the last is the first parameter, and the second parameter."""
ROUNDING = 1e-6
"""Slack with which a bifurcation happens at a codimension-2 point."""


class CurveEquations(ABC):
    """The equations of a bifurcation, its unknowns at the start beside the first parameter, and what is watched along its curve."""

    usual_steps: ClassVar[Steps]
    bend: ClassVar[float]
    """Largest distance of the curve from the straight lines between its points, in widths of the plane."""
    slack: float = 0.0
    reach: Callable[[np.ndarray], float] | None = None
    kind: str
    plane: Plane
    base: Rotor | Numbers
    guess: Sequence[float] | np.ndarray
    watches: list[Watch]

    @abstractmethod
    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""

    @abstractmethod
    def orbit(self, u: np.ndarray, p: float) -> tuple[float, float]:
        """Period and radial speed; ``nan`` for equilibria."""

    @abstractmethod
    def happens(self, u: np.ndarray, p: float, slack: float) -> bool:
        """Whether it happens to a motion of the machine."""

    @abstractmethod
    def names(self, places: Sequence[Place]) -> tuple[OrbitName | CountedName, ...]:
        """Names of the orbits that bifurcate at places of the curve."""

    @abstractmethod
    def gives_up(self, reason: str, u: np.ndarray) -> str:
        """Why the continuation gave up, in terms of the motion."""

    def followed(self, steps: Steps | None) -> Curve:
        """The curve through the start, in both directions."""
        (first, second), sizes = self.plane.start_at(self.base)
        steps, known = steps or self.usual_steps, len(self.guess)
        equations = Equations(self.residual, None, np.array([*np.ones(known), *sizes]), steps)
        branch = continue_branch(
            equations,
            np.array([*self.guess, first]),
            float(second),
            self.plane.second_range,
            watches=[self.plane.edge, *self.watches],
            reach=self.reach,
            # A fold in the second parameter is only a turning point of the curve.
            folds="turning point",
        )
        shown = np.array([*np.full(known, np.inf), *self.plane.widths])
        rows = refined_points(equations, branch, widths=shown, bend=self.bend)
        return self._curve(branch, [(row[:-1], float(row[-1])) for row in rows], rows[:, -2:])

    def _curve(self, branch: Branch, places: Sequence[Place], points: np.ndarray) -> Curve:
        """The curve with what is known of its orbits."""
        periods, speeds = np.array([self.orbit(*place) for place in places]).T
        admissible = np.array([self.happens(*place, self.slack) for place in places])
        named = [place for place, is_real in zip(places, admissible, strict=True) if is_real or not admissible.any()]
        codimension2 = tuple(
            Codimension2Point(
                (point.kind,) if point.kind in RESONANCES else (self.kind, point.kind),
                (float(point.unknowns[-1]), point.parameter),
                *self.orbit(point.unknowns, point.parameter),
                self.happens(point.unknowns, point.parameter, ROUNDING),
            )
            for point in branch.special
            if point.kind in TESTS
        )
        stops = self._stop(branch, 0), self._stop(branch, -1)
        return Curve(self.kind, self.plane, points, periods, speeds, admissible, self.names(named), codimension2, stops)

    def _stop(self, branch: Branch, end: int) -> str:
        """Reason why the curve ends at its first or last point."""
        reason = branch.stops[end]
        if reason in ("end of domain", "step too small"):
            return self.gives_up(reason, branch.unknowns[end])
        return EDGE if reason == "parameter limit" else reason
