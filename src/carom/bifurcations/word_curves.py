"""Curves of special points of orbits of any word in the plane of two parameters.

The unknowns are nodes, durations and the first parameter; the equations are those of the orbit and the function that vanishes at
the special point.  The derivatives of the orbit's equations are exact, by the parameters only without lasting contact; the others are differences.
"""

from __future__ import annotations

import numpy as np

from carom.bifurcations.conditions import ENDING, RESONANCES
from carom.bifurcations.curve_results import Codimension2Point, Curve
from carom.bifurcations.planes import EDGE, Plane
from carom.bifurcations.points import HALVING, Bifurcation
from carom.bifurcations.word_equations import TESTS, FamilyPoint, Orbits, halving
from carom.continuation import Branch, Steps, Watch, continue_branch
from carom.orbits.shooting import by_parameter, pack_free
from carom.outcome import InputError

STEPS = Steps(first=0.01, largest=0.08, sharpest_turn=0.25, most_points=400, tolerance=1e-10, iterations=12)
DIFFERENCE = 1e-6
"""Step of the central differences, relative to the size of the unknown."""
ON_CURVE = 1e-6
"""Margin that counts as zero on a curve on which one vanishes."""


class _CurveEquations(Orbits):
    """The equations of special points of one kind of orbits of one word."""

    def __init__(self, special: Bifurcation, plane: Plane, sizes: np.ndarray) -> None:
        rotor = special.orbit.rotor
        super().__init__(special.orbit.word, lambda x, y: rotor.replace(**{plane.first: x, plane.second: y}))
        self.kind, self.plane, self.sizes = special.kind, plane, sizes
        self.weight = 1.0

    def at(self, x: np.ndarray) -> FamilyPoint | None:
        """The orbit at nodes, durations and both parameters."""
        return self.point(x[:-2], *x[-2:].tolist())

    def left_sides(self, x: np.ndarray) -> np.ndarray:
        """Equations of the orbit, then that of the special point."""
        at = self.at(x)
        if at is None:
            return np.full(len(x) - 1, np.nan)
        return np.append(at.links.reduced[0], self.weight * TESTS[self.kind](at))

    def slopes(self, x: np.ndarray) -> np.ndarray:
        """Derivatives of the equations."""
        at = self.at(x)
        if at is None:
            return np.full((len(x) - 1, len(x)), np.nan)
        whole = np.empty((len(x) - 1, len(x)))
        whole[:-1, :-2] = at.links.reduced[1]
        for k, size in enumerate(self.sizes):
            change = np.zeros(len(x))
            change[k] = DIFFERENCE * size
            column = (self.left_sides(x + change) - self.left_sides(x - change)) / (2.0 * change[k])
            whole[-1, k] = column[-1]
            if k >= len(x) - 2:
                name = self.plane.second if k == len(x) - 1 else self.plane.first
                exact = by_parameter(at.rotor, self.word, at.links.start, name)
                whole[:-1, k] = column[:-1] if exact is None else exact
        return whole

    def weigh(self, x: np.ndarray) -> None:
        """Weigh the last equation so that its derivatives are about one: multipliers of many impacts are large."""
        self.weight = 1.0
        largest = float(np.abs(self.slopes(x)[-1] * self.sizes).max())
        self.weight = 1.0 / largest if np.isfinite(largest) and largest > 0.0 else 1.0


def continue_word_curve(special: Bifurcation, plane: Plane, steps: Steps | None = None) -> Curve:
    """:func:`~carom.bifurcations.continue_curve` for a special point of an orbit of any word.

    Raises
    ------
    InputError
        A kind that cannot be followed, or a start outside the plane.
    CaromError
        No such special point near the start.
    """
    if special.kind not in TESTS:
        raise InputError("kind", special.kind, f"one of: {', '.join(TESTS)}")
    if special.kind == "slide-stop" and special.orbit.word.lands.any():
        # Its function has a slope that depends on the number of the bounce in which friction stops the slip.
        raise InputError("kind", f"slide-stop of {special.orbit.word}", "a slide-stop of an orbit without chatter")
    rotor = special.orbit.rotor
    start, typical = plane.start_at(rotor)
    unknowns = pack_free(special.orbit.word, special.orbit.links.start)
    sizes = np.concatenate([np.ones(len(unknowns)), typical])
    equations = _CurveEquations(special, plane, sizes)
    equations.weigh(np.concatenate([unknowns, start]))
    branch = continue_branch(
        lambda u, p: equations.left_sides(np.append(u, p)),
        np.append(unknowns, start[0]),
        float(start[1]),
        plane.second_range,
        jacobian=lambda u, p: equations.slopes(np.append(u, p)),
        watches=_watches(equations, plane, unknowns),
        steps=steps or STEPS,
        scales=sizes,
        # A fold in the second parameter is only a turning point of the curve.
        folds="turning point",
        crossings="",
    )
    return _curve(special, plane, equations, branch)


def _watches(equations: _CurveEquations, plane: Plane, start: np.ndarray) -> list[Watch]:
    def watch(name: str) -> Watch:
        def value(u: np.ndarray, p: float) -> float:
            at = equations.at(np.append(u, p))
            found = np.nan if at is None else at.pair_sum - RESONANCES[name] if name in RESONANCES else TESTS[name](at)
            return found if np.isfinite(found) else np.nan

        return Watch(name, value, at_zero="end" if name in ENDING else "pass")

    others = [name for name in TESTS if name != equations.kind]
    if equations.kind == "neimark-sacker":
        # At the resonances 1:1 and 1:2 two multipliers are 1, or −1.
        others = [name for name in others if name not in ("fold", "period-doubling")] + list(RESONANCES)
    halves = halving(equations.word, start)
    # Beyond that point the curve would come back over itself, with the halves of the period exchanged.
    ends = [] if halves is None else [Watch(HALVING, lambda u, _: halves(u[:-1]), at_zero="end")]
    return [plane.edge, *ends, *map(watch, others)]


def _curve(special: Bifurcation, plane: Plane, equations: _CurveEquations, branch: Branch) -> Curve:
    def measured(x: np.ndarray) -> tuple[float, float, bool]:
        """Period, radial speed, and whether the orbit is a motion of the machine."""
        at = equations.at(x)
        return (np.nan, np.nan, False) if at is None else (*_period_and_speed(at), at.margins.least > -ON_CURVE)

    rows = np.column_stack([branch.unknowns, branch.parameters])
    periods, speeds, admissible = map(np.array, zip(*map(measured, rows), strict=True))
    meetings = []
    for point in branch.special:
        if point.kind in (EDGE, "turning point"):
            continue
        x = np.append(point.unknowns, point.parameter)
        other = "period-doubling" if point.kind == HALVING else point.kind
        kinds = (other,) if other in RESONANCES else (special.kind, other)
        meetings.append(Codimension2Point(kinds, (float(x[-2]), float(x[-1])), *measured(x)))
    stops = [EDGE if stop == "parameter limit" else stop for stop in branch.stops]
    return Curve(
        kind=special.kind,
        plane=plane,
        points=rows[:, -2:],
        periods=periods,
        radial_speeds=speeds,
        admissible=admissible,
        orbits=(special.orbit.name,),
        codimension2=tuple(meetings),
        stops=(stops[0], stops[1]),
    )


def _period_and_speed(at: FamilyPoint) -> tuple[float, float]:
    """Period, and radial speed at the first impact; ``nan`` if it begins with a lift-off."""
    system, start = at.rotor.system, at.links.start
    position, velocity = system.at_planes(system.nodes.amplitudes(start.nodes[:1]), at.word.planes[:1])
    speed = float((position.conj() * velocity).real[0]) if at.word.arrives[0] else np.nan
    return float(start.durations.sum()), speed
