"""Search for curves wherever the motions of neighbouring points of a plane differ, until each change is explained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from carom.base.outcome import CaromError
from carom.base.progress import Reporter
from carom.bifurcations.changes import PlanePoint, UnexplainedChange, accounts_for, causes_between, change_between
from carom.bifurcations.conditions import ENDING, RESONANCES, conditions_at
from carom.bifurcations.curve_results import Codimension2Point, Curve, crossings, passes, with_curve
from carom.bifurcations.curves import continue_curve
from carom.bifurcations.motions import Motions, motions_at
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import Bifurcation
from carom.continuation import Equations
from carom.parameters import Numbers, Parameters

INSET = 1e-3
"""Distance of the outermost points from the edges, in widths of the plane."""
BRACKET_MARGIN = 0.01
"""Distance from a curve at which motions on both sides are compared, as a fraction of the line that it crosses."""
FROM_RESONANCE = 1e-5
"""Distance of the sum of two multipliers from ±2 where a curve that begins at a resonance is begun; on some curves it never exceeds 1e-4."""
ARRIVED, ITERATIONS = 1e-10, 20
MOST_CHANGES = 30
"""Largest number of changes searched between two neighbouring points."""


@dataclass(eq=False)
class Survey:
    """Motions on a grid of cells of a plane and along its edges, and the curves between them."""

    parameters: Parameters
    plane: Plane
    curves: list[Curve]
    """Curves known before; curves that are found are added."""
    unexplained: list[UnexplainedChange] = field(default_factory=list)
    seen: dict[Motions, tuple[float, float]] = field(default_factory=dict)
    """A point for each set of motions found at or between the points of the grid."""

    def grid(self, cells: int) -> tuple[np.ndarray, np.ndarray]:
        """Values of both parameters at the edges of the plane and in the middle of each cell, shape (cells + 2,) each."""
        shares = np.concatenate([[INSET], (np.arange(cells) + 0.5) / cells, [1.0 - INSET]])
        low = np.array([self.plane.first_range[0], self.plane.second_range[0]])
        xs, ys = low[:, None] + np.outer(self.plane.widths, shares)
        return xs, ys

    def run(self, cells: int, tell: Reporter) -> list[list[PlanePoint]]:
        """Explain the changes between all points of the grid; return the points in the middle of its cells."""
        examined = []
        xs, ys = self.grid(cells)
        for i, x in enumerate(xs):
            examined.append([self.examine(np.array([x, y])) for y in ys])
            tell(0.6 * (i + 1) / len(xs))
        self.leave_resonances()
        self.explain_all(examined, tell.part(0.6, 1.0))
        self.leave_resonances()
        return [column[1:-1] for column in examined[1:-1]]

    def examine(self, place: np.ndarray) -> PlanePoint:
        """Determine the motions at a point, and record them in ``seen``."""
        motions = motions_at(self.plane.at(self.parameters, *place.tolist()))
        self.seen.setdefault(motions, (float(place[0]), float(place[1])))
        return PlanePoint(place, motions)

    def explain_all(self, points: Sequence[Sequence[PlanePoint]], tell: Reporter) -> None:
        """Explain the changes between all neighbouring points of a grid whose motions differ."""
        for i, column in enumerate(points):
            for j, here in enumerate(column):
                for other in [*(next_column[j] for next_column in points[i + 1 : i + 2]), *column[j + 1 : j + 2]]:
                    if other.motions != here.motions:
                        self.explain(here, other)
            tell((i + 1) / len(points))

    def leave_resonances(self) -> None:
        """Follow the Neimark–Sacker curves that begin at the resonances 1:1 and 1:2 of the known curves."""
        for point in [point for curve in self.curves for point in curve.codimension2 if point.kind in ENDING]:
            at = self.plane.at(self.parameters, *point.value)
            torus = Bifurcation.near("neimark-sacker", at, point.period, point.radial_speed)
            if point.admissible and not self._known(torus):
                near = self._beside_resonance(point)
                if near is not None:
                    self._follow(near)

    def _beside_resonance(self, point: Codimension2Point) -> Bifurcation | None:
        """A point of the Neimark–Sacker curve next to the resonance where it begins; ``None`` outside the plane.

        For the pair of multipliers ``e^{±iα}`` the sum ``2 cos α`` is prescribed; place, period and radial speed are the
        unknowns, found by Newton's method.
        """
        base, plane, place = Numbers.of(self.parameters), self.plane, np.array(point.value)
        wanted = np.copysign(2.0 - FROM_RESONANCE, RESONANCES[point.kind])

        def conditions(u: np.ndarray, y: float) -> np.ndarray:
            period, speed, x = u.tolist()
            if not (period > 0.0 and np.isfinite((x, y)).all()):
                return np.full(4, np.nan)
            at = conditions_at(plane.numbers_at(base, x, y), period, speed)
            return np.array([at.closing, at.balance, at.neimark_sacker, at.pair_sum - wanted])

        scales = np.array([1.0, 1.0, *np.maximum(np.abs(place), 0.1 * plane.widths)])
        equations = Equations(conditions, None, scales)
        unknowns = np.array([point.period, point.radial_speed, *place]) / scales
        for _ in range(ITERATIONS):
            value = equations.value(unknowns)
            if not np.isfinite(value).all():
                return None
            period, speed, x, y = (unknowns * scales).tolist()
            if np.abs(value).max() < ARRIVED:
                lows, highs = np.transpose([plane.first_range, plane.second_range])
                inside = ((lows <= (x, y)) & ((x, y) <= highs)).all()
                return Bifurcation("neimark-sacker", plane.numbers_at(base, x, y), period, speed) if inside else None
            try:
                unknowns -= np.linalg.solve(equations.jacobian(unknowns), value)
            except np.linalg.LinAlgError:
                return None
        return None

    def explain(self, first: PlanePoint, last: PlanePoint) -> None:
        """Find the cause of every change of motions on the straight line between two points.

        Where known curves cross the line, the motions on both sides of the crossing are compared.  Changes that these
        curves do not account for are located by bisection.
        """
        line, here = last.place - first.place, first
        for start, end, kinds in self._crossed(first, last):
            near = self.examine(first.place + max(start - BRACKET_MARGIN, 0.0) * line)
            far = self.examine(first.place + min(end + BRACKET_MARGIN, 1.0) * line)
            self._explain_changes(here, near)
            if not accounts_for(kinds, near.motions, far.motions):
                self._explain_changes(near, far)
            here = far
        self._explain_changes(here, last)

    def _crossed(self, first: PlanePoint, last: PlanePoint) -> list[tuple[float, float, set[str]]]:
        """Crossings of the line by known curves, grouped if close together: first and last share, and kinds."""
        found = sorted(
            (share, curve.kind) for curve in self.curves for share in crossings(curve, first.place, last.place)
        )
        groups: list[tuple[float, float, set[str]]] = []
        for share, kind in found:
            if groups and share - groups[-1][1] < 2.0 * BRACKET_MARGIN:
                groups[-1] = (groups[-1][0], share, groups[-1][2] | {kind})
            else:
                groups.append((share, share, {kind}))
        return groups

    def _explain_changes(self, low: PlanePoint, high: PlanePoint) -> None:
        """Explain or record the changes between two points one by one."""
        for _ in range(MOST_CHANGES):
            if low.motions == high.motions:
                return
            nearer, further = change_between(self.parameters, self.plane, low, high)
            self._explain_bracket(nearer, further)
            low = further
        self._record(low, high, f"more than {MOST_CHANGES} changes between two neighbouring points")

    def _explain_bracket(self, low: PlanePoint, high: PlanePoint) -> None:
        """Find or continue the curves through a narrow bracket; record the change if they do not explain it."""
        known, reasons = set(), []
        for cause in causes_between(self.parameters, self.plane, low, high):
            reason = "" if self._known(cause) else self._follow(cause)
            if reason:
                reasons.append(f"{cause.kind}: {reason}")
            else:
                known.add(cause.kind)
        if not accounts_for(known, low.motions, high.motions):
            self._record(low, high, "; ".join(reasons) or "no test function changes sign")

    def _known(self, cause: Bifurcation) -> bool:
        return any(passes(curve, cause) for curve in self.curves)

    def _follow(self, cause: Bifurcation) -> str:
        """Continue a curve; return the reason if it failed, or an empty text."""
        try:
            curve = continue_curve(cause, self.plane)
        except CaromError as problem:
            return str(problem)
        if not passes(curve, cause):
            return "the curve that was found passes elsewhere"
        self.curves = with_curve(self.curves, curve)
        return ""

    def _record(self, low: PlanePoint, high: PlanePoint, reason: str) -> None:
        x, y = (0.5 * (low.place + high.place)).tolist()
        self.unexplained.append(UnexplainedChange((x, y), low.motions, high.motions, reason))
