"""Pseudo-arclength continuation of ``F(u, p) = 0`` with location of special points.

The branch is a curve in ``x = (u, p)``.  A step predicts along the tangent and corrects by Newton's method in the
hyperplane normal to it [1]_; the tangent comes from the bordered Jacobian, so folds in ``p`` are ordinary points.
The Jacobian is the caller's, or central differences where there is none.  The zeros of functions that are watched along the branch are located by bracketing in arclength.

References
----------
.. [1] Keller, "Numerical solution of bifurcation and nonlinear eigenvalue problems", in: Applications of Bifurcation
   Theory, Academic Press (1977).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from carom.base.outcome import CaromError, InputError
from carom.base.roots import HALVINGS, bracketed_root, narrowed, sign_change
from carom.continuation.branch import Branch, SpecialPoint, Watch
from carom.continuation.equations import DIFFERENCE, Equations, Point, applied

STRAY = 0.3
"""Largest distance of a corrected point from its prediction, in steps: a point further away is on another branch."""
ROUNDING = 1e-14
"""Value of a watched function that counts as zero, relative to its values at the ends of a step."""
LEVEL = 1e-12
"""Share of the parameter in the tangent that counts as none: at a fold the parameter is exact to its square."""
ON_LIMIT = 1e-9
"""Largest value of a limit, relative to its range, at which a point counts as on it."""
LANDED = 1e-15
"""Distance from a limit of the parameter, relative to the limits, of a point that is on it but for rounding."""
JUMP = 1e-4
"""Largest remaining value of a watched function at a zero, relative to its values on the step, or at the ends of the bracket if
it is not defined on all of it.

At a jump more remains.
"""


def continue_branch(
    equations: Equations,
    unknowns: np.ndarray,
    parameter: float,
    interval: tuple[float, float],
    *,
    watches: Sequence[Watch] = (),
    reach: Callable[[np.ndarray], float] | None = None,
    folds: str = "fold",
) -> Branch:
    """Follow the branch of solutions through a point, in both directions.

    Parameters
    ----------
    equations : Equations
    unknowns : ndarray, shape (n,)
    parameter : float
        A solution or a point near one: it is corrected first, at fixed parameter where that is possible.
    interval : tuple of float
        Range of the parameter.  From a start on its edge the branch is followed inward only.
    watches : sequence of Watch
        Functions whose zeros are located.
    reach : callable, optional
        Of ``u``: the factor by which the largest step grows there; 1 by default.
    folds : str
        Kind under which turning points of the parameter are listed; empty if these are not wanted.

    Raises
    ------
    InputError
        The interval is empty or does not hold the parameter.
    CaromError
        No solution near the start.
    """
    if not interval[0] <= parameter <= interval[1] or interval[0] >= interval[1]:
        raise InputError("interval", interval, f"two values in ascending order with {parameter:g} between them")
    tracer = Tracer(equations, interval, watches, folds, reach)
    first, tangent = tracer.begin(np.append(np.asarray(unknowns, float), parameter) / equations.scales)
    ahead = tracer.walk(first, tangent)
    behind = _Path([first], [], "closed loop")
    if ahead.stop != "closed loop":
        behind = tracer.walk(first, -tangent)
    return tracer.joined(behind, ahead)


@dataclass(eq=False)
class _Path:
    """One direction of a branch in scaled unknowns; a special point is stored as kind, point and place on the path."""

    points: list[np.ndarray]
    special: list[tuple[str, np.ndarray, float]]
    stop: str


@dataclass(eq=False)
class Tracer:
    """Steps along a branch in scaled unknowns ``x``."""

    equations: Equations
    interval: tuple[float, float]
    watches: Sequence[Watch]
    folds: str
    reach: Callable[[np.ndarray], float] | None = None

    @cached_property
    def limits(self) -> dict[int, str]:
        """Kinds of the limits, by their place among the watched values."""
        return {0: "parameter limit"} | {
            i: watch.kind for i, watch in enumerate(self.watches, 1) if watch.at_zero == "limit"
        }

    @cached_property
    def avoided(self) -> list[int]:
        """Places, among the watched values, of those that are to be positive at every point."""
        return [i for i, watch in enumerate(self.watches, 1) if watch.at_zero == "avoid"]

    def begin(self, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First point and the direction in which the parameter grows there."""
        jacobian = self.equations.jacobian(guess)
        if np.isfinite(jacobian).all():
            level = np.zeros(len(guess))
            level[-1] = 1.0
            # At a fold the parameter cannot be held fixed.
            for normal in (level, np.linalg.svd(jacobian)[2][-1]):
                first = self.equations.correct(guess, normal, applied(np.linalg.inv, jacobian, normal))
                if first is not None and self._margin(self.equations.plain(first)[1]) >= -1e-9:
                    tangent = np.linalg.svd(self.equations.jacobian(first))[2][-1]
                    return first, tangent if tangent[-1] >= 0.0 else -tangent
        u, p = self.equations.plain(guess)
        raise CaromError(f"no solution near the start {u} at parameter {p:g}; give a closer one")

    def walk(self, start: np.ndarray, heading: np.ndarray) -> _Path:
        """Follow the branch from a point in a direction."""
        path = _Path([start], [], "most points")
        here = Point(start, self.equations.jacobian(start), heading)
        here.watched = self._watched(here)
        length = self.equations.steps.first
        while len(path.points) < self.equations.steps.most_points:
            to_limit = self._to_limit(here)
            length = min(length, to_limit)
            there, share, ending, known = self._step(here, length, length == to_limit), None, None, len(path.special)
            if there is not None:
                there.watched = self._watched(there)
                there = None if any(there.watched[i] <= 0.0 for i in self.avoided) else there
            if there is not None:
                left = self._left(here, there)
                if left:
                    path.stop = left
                    return path
                share = self._return(path, here, there, heading)
                ending = self._locate(path, here, there, length, share)
                if there.watched[0] == 0.0 and not ending and not share:
                    path.points.append(there.x)
                    ending = "parameter limit"
            # A step beyond the limit on which the limit itself was not located is too long as well.
            if there is None or (there.watched[0] < 0.0 and not ending and not share):
                del path.special[known:]
                length *= 0.5
                if length < self.equations.steps.smallest:
                    path.stop = self._stuck(here)
                    return path
                continue
            if ending or share:
                path.points += [] if ending else [start]
                path.stop = ending or "closed loop"
                return path
            path.points.append(there.x)
            if here.tangent @ there.tangent > math.cos(0.5 * self.equations.steps.sharpest_turn):
                length *= 1.5
            length = min(length, self._largest(there.x))
            here = there
        return path

    def _to_limit(self, here: Point) -> float:
        """Length of the step that ends on the limit of the parameter, beyond which the equations may be undefined.

        Infinite where the tangent does not lead there, or there is no solver for points at fixed parameter.
        """
        ahead, at = self.equations.plain(here.tangent)[1], self.equations.plain(here.x)[1]
        if self.equations.solver is None or ahead == 0.0:
            return math.inf
        return (self.interval[ahead > 0.0] - at) / ahead if here.watched[0] != 0.0 else math.inf

    def _left(self, here: Point, there: Point) -> str:
        """The limit that a step leaves from a point on it; empty if there is none."""
        return next(
            (kind for i, kind in self.limits.items() if there.watched[i] < 0.0 and here.watched[i] <= ON_LIMIT), ""
        )

    def _largest(self, x: np.ndarray) -> float:
        """Length of the largest step at a point."""
        return self.equations.steps.largest * (1.0 if self.reach is None else self.reach(self.equations.plain(x)[0]))

    def _step(self, here: Point, length: float, fixed: bool) -> Point | None:
        """Next point, on request at the parameter to which the tangent leads; ``None`` if the step is too long."""
        guess = here.x + length * here.tangent
        x = self.equations.near(guess, here, fixed)
        if x is None or math.dist(x, guess) > STRAY * length:
            return None
        jacobian = self.equations.jacobian(x)
        tangent = self.equations.tangent(jacobian, here.tangent)
        if tangent is None or here.tangent @ tangent < math.cos(self.equations.steps.sharpest_turn):
            return None
        return Point(x, jacobian, tangent)

    def _stuck(self, here: Point) -> str:
        """Why no step succeeds: the equations may be undefined within the reach of the central differences."""
        if here.watched[0] == 0.0:
            return "parameter limit"
        reach = 10.0 * DIFFERENCE * np.eye(len(here.x))
        around = [self.equations.value(here.x + side) for side in (*reach, *-reach)]
        return "step too small" if np.isfinite(around).all() else "end of domain"

    def _watched(self, at: Point) -> np.ndarray:
        """Values of the relative distance to the limit, of the watches, and of the function of folds."""
        u, p = self.equations.plain(at.x)
        watches = [watch.function(u, p) for watch in self.watches]
        return np.array([self._margin(p), *watches, at.tangent[-1]])

    def _watched_value(self, which: int, x: np.ndarray, here: Point) -> float:
        """One of the values of :meth:`_watched`, at a point on the step from ``here``."""
        u, p = self.equations.plain(x)
        if which == 0:
            return self._margin(p)
        if which <= len(self.watches):
            return self.watches[which - 1].function(u, p)
        jacobian = self.equations.jacobian(x)
        tangent = self.equations.tangent(jacobian, here.tangent)
        return float((here.tangent if tangent is None else tangent)[-1])

    def _margin(self, p: float) -> float:
        low, high = self.interval
        left = min(p - low, high - p)
        return 0.0 if abs(left) <= LANDED * max(abs(low), abs(high)) else left / (high - low)

    def _locate(self, path: _Path, here: Point, there: Point, length: float, share: float | None) -> str | None:
        """Add the special points of a step, up to a share of it, to the path, up to the first that ends the branch."""
        changed = (here.watched * there.watched < 0.0) | (np.isnan(here.watched) != np.isnan(there.watched))
        changed[self.avoided] = False
        if not changed.any():
            return None
        kinds = ["", *(watch.kind for watch in self.watches), self.folds]
        ends = [True, *(watch.at_zero in ("end", "limit") for watch in self.watches), False]
        reached: list[tuple[float, int, np.ndarray]] = []
        known = {0.0: here.x, length: there.x}
        for i in np.flatnonzero(changed):
            if i in self.limits and there.watched[i] > 0.0:
                continue  # It began beyond the limit by a rounding error, and comes in.
            place = self._root_on_step(here, there, known, int(i))
            if place is not None and (share is None or place[0] <= share * length):
                reached.append((place[0], int(i), place[1]))
        for distance, which, x in sorted(reached, key=lambda item: item[0]):
            if kinds[which]:
                path.special.append((kinds[which], x, len(path.points) - 1 + distance / length))
            if ends[which]:
                path.points.append(x)
                return kinds[which] or "parameter limit"
        return None

    def _root_on_step(
        self, here: Point, there: Point, known: dict[float, np.ndarray], which: int
    ) -> tuple[float, np.ndarray] | None:
        """Arclength and point of a zero of a watched function; the points ``known`` by arclength become more.

        ``None`` if the function jumps from one sign to the other, or has one sign wherever it is defined.
        """
        length = max(known)
        values = {0.0: float(here.watched[which]), length: float(there.watched[which])}
        of_fold = which == len(self.watches) + 1
        near = self.equations.near_fold if of_fold else self.equations.near

        def value(distance: float) -> float:
            if distance not in known:
                # On the chord between the nearest points found: the closer these are, the closer is the guess.
                before = max(each for each in known if each < distance)
                after = min(each for each in known if each > distance)
                share = (distance - before) / (after - before)
                x = near(known[before] + share * (known[after] - known[before]), here)
                if x is None:
                    return np.nan
                known[distance] = x
            if distance not in values:
                values[distance] = self._watched_value(which, known[distance], here)
            return values[distance]

        smaller, size = sorted(map(abs, values.values()))
        largest = size
        if smaller < JUMP * size:
            # One end is all but a zero, or the other a pole.
            size = min(size, abs(value(0.5 * length)))
        nothing = LEVEL if of_fold else ROUNDING * size

        def rounded(distance: float) -> float:
            found = value(distance)
            return 0.0 if abs(found) <= nothing else found

        low, high = narrowed(rounded, sorted(known))
        bracket = sign_change(rounded, low, high, HALVINGS - int(math.log2(length / (high - low))))
        if bracket is None:
            return None
        try:
            distance = bracketed_root(rounded, *bracket, self.equations.steps.resolution)
        except CaromError:
            return None
        if math.isnan(smaller + size):
            size = largest = max(abs(values[end]) for end in bracket)
        # A pole may be a zero by rounding, but next to it the function is largest.
        beside = values[min(values.keys() - {distance}, key=lambda each: abs(each - distance))]
        return None if abs(rounded(distance)) > JUMP * size or abs(beside) > largest else (distance, known[distance])

    def _return(self, path: _Path, here: Point, there: Point, heading: np.ndarray) -> float | None:
        """Share of the step at which the branch passes its start again, in the initial direction."""
        if len(path.points) < 3 or there.tangent @ heading < math.cos(2.0 * self.equations.steps.sharpest_turn):
            return None
        step, back = there.x - here.x, path.points[0] - here.x
        share = float(back @ step / (step @ step))
        near = np.linalg.norm(back - share * step) < 0.1 * np.linalg.norm(step)
        return share if near and 0.0 < share <= 1.0 else None

    def joined(self, behind: _Path, ahead: _Path) -> Branch:
        """Both directions as one branch."""
        points = np.array(behind.points[:0:-1] + ahead.points) * self.equations.scales
        for end, stop in ((0, behind.stop), (-1, ahead.stop)):
            if stop == "parameter limit":
                points[end, -1] = min(self.interval, key=lambda limit: abs(limit - points[end, -1]))
        shift = len(behind.points) - 1
        special = [(kind, x, shift - place) for kind, x, place in behind.special]
        special += [(kind, x, shift + place) for kind, x, place in ahead.special]
        return Branch(
            unknowns=points[:, :-1],
            parameters=points[:, -1],
            special=tuple(
                SpecialPoint(kind, *self.equations.plain(x), place)
                for kind, x, place in sorted(special, key=lambda item: item[2])
            ),
            stops=(behind.stop, ahead.stop),
        )
