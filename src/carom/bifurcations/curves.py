"""Curves of each bifurcation in the plane of two parameters, with the codimension-2 points on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.bifurcations.conditions import (
    BOUNDLESS,
    ENDING,
    FASTEST,
    RESONANCES,
    TESTS,
    conditions_at,
    grazing_equations,
    orbits_on_curve,
    profile_at,
)
from carom.bifurcations.curve_results import Codimension2Point, Curve
from carom.bifurcations.planes import EDGE, Plane
from carom.bifurcations.points import Bifurcation
from carom.bifurcations.simulated_curves import KINDS as SIMULATED_KINDS
from carom.bifurcations.simulated_curves import SimulatedCurve
from carom.closed_forms.thresholds import happens_to_rubs
from carom.continuation import Branch, Steps, Watch, continue_branch, refined_points
from carom.orbits.flow import FlowBudget
from carom.parameters import Numbers

Function = Callable[[np.ndarray, float], np.ndarray]
STEPS = Steps(first=0.02, largest=0.1, sharpest_turn=0.3, most_points=1000)
BEND = 5e-5
"""Largest distance of a curve from the straight lines between its points, in widths of the plane."""
SHORTEST = 1e-4
"""Period, in ``1/Ω``, below which test functions may be only rounding; with ``d = 1`` the period of a pair can vanish.

That of a Neimark–Sacker bifurcation then falls with the cube of the period: it is 2e-13 here and 2e-16 at a tenth of it.
"""
VANISHING = 1e-2
"""Period, or fraction of a period, that counts as vanished where the equations end."""


@dataclass(frozen=True)
class _Kind:
    """Number of unknowns of a bifurcation, and the test functions to watch along its curve.

    ``unknowns`` does not count the first parameter: 0 for equilibria, 2 for orbits (period and radial speed), and 3 for
    grazing (also its time).
    """

    unknowns: int
    watched: tuple[str, ...]
    ends: tuple[str, ...] = ()


KINDS: dict[str, _Kind] = {
    "fold": _Kind(
        2, ("boundary-equilibrium", "period-doubling", "grazing", "speed-fold", "slip-stop", "resonance-1:1")
    ),
    "speed-fold": _Kind(2, ("fold", "grazing", "period-doubling", "resonance-1:1")),
    "period-doubling": _Kind(
        2, ("grazing", "fold", "speed-fold", "slip-stop", "boundary-equilibrium", "resonance-1:2")
    ),
    "neimark-sacker": _Kind(
        2,
        ("grazing", "boundary-equilibrium", "slip-stop", "resonance-1:3", "resonance-1:4"),
        ENDING,
    ),
    "grazing": _Kind(3, ("fold", "speed-fold", "period-doubling", "boundary-equilibrium", "slip-stop")),
    "slip-stop": _Kind(2, ("fold", "period-doubling", "grazing")),
    "contact-onset": _Kind(2, ("fold", "period-doubling", "grazing", "slip-stop")),
    # Not grazing: the orbit is a point on the wall here, and the height of its radius is rounding.
    "non-smooth-hopf": _Kind(2, ("fold", "period-doubling", "neimark-sacker", "slip-stop")),
    "boundary-equilibrium": _Kind(0, ("rub-fold",)),
    "rub-fold": _Kind(0, ("boundary-equilibrium",)),
    "rolling-limit": _Kind(0, ("boundary-equilibrium", "rub-fold")),
}
"""Bifurcations that can be followed in two parameters."""


def can_be_followed(point: Bifurcation) -> bool:
    """Whether :func:`continue_curve` knows equations for a bifurcation."""
    return point.kind in (KINDS if point.shot is None else SIMULATED_KINDS)


@checked
def continue_curve(
    bifurcation: Bifurcation, plane: Plane, steps: Steps | None = None, budget: FlowBudget | None = None
) -> Curve:
    """Follow a bifurcation in the plane of two parameters.

    The unknowns are the first parameter and, for an orbit, its period and radial speed.  The equations are those of the
    orbit (source paper (4.3), (4.4)) and the test function of the bifurcation.  Grazing has the time at which the
    radius is largest as a further unknown, and the equations ``Re(Ū U̇) = 0`` and ``|U| = 1``, which stay regular on its
    virtual side.  Folds, period doublings and Neimark–Sacker bifurcations of other periodic motions are followed too, closed on the flow of the
    simulator, with the numbers of their state as unknowns.

    Parameters
    ----------
    bifurcation : Bifurcation
        A special point of a branch or of a diagram, or :meth:`~carom.bifurcations.Bifurcation.near`; its kind is one of
        :data:`KINDS`.
    budget : FlowBudget, optional
        What simulated motions are paid from.

    Raises
    ------
    InputError
        A kind that cannot be followed, a start outside the plane, or an orbit without period and radial speed.
    CaromError
        No such bifurcation near the start.

    See Also
    --------
    carom.map_regions : all curves of a plane
    carom.continue_orbit : special points to begin with

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> branch = cm.continue_orbit(cm.find_orbits(machine)["B1,d"], "gamma", (0.1, 0.2))
    >>> plane = cm.bifurcations.Plane("gamma", "omega", (0.1, 0.25), (0.75, 0.77))
    >>> cm.continue_curve(branch.special[0], plane).stops
    ('edge of the plane', 'edge of the plane')
    """
    equations: Any = (ClosedFormCurve if bifurcation.shot is None else SimulatedCurve)(bifurcation, plane, budget)
    start, sizes = plane.start_at(equations.base)
    steps = steps or equations.steps
    known = len(equations.guess)
    scales = np.array([*np.ones(known), *sizes])
    branch = continue_branch(
        equations.residual,
        np.array([*equations.guess, start[0]]),
        float(start[1]),
        plane.second_range,
        watches=[plane.edge, *equations.watches],
        steps=steps,
        scales=scales,
        reach=equations.reach,
        # A fold in the second parameter is only a turning point of the curve.
        folds="turning point",
        crossings="",
    )
    shown = np.array([*np.full(known, np.inf), *plane.widths])
    rows = refined_points(equations.residual, branch, scales=scales, widths=shown, bend=equations.bend, steps=steps)
    return equations.curve(branch, rows)


class ClosedFormCurve:
    """The equations of a bifurcation that has a closed form, its unknowns at the start, and what is watched along its curve."""

    bend, steps = BEND, STEPS

    def __init__(self, point: Bifurcation, plane: Plane, _: FlowBudget | None = None) -> None:
        self.kind, self.base, self.plane = point.kind, point.numbers, plane
        if self.base.mu < 0.0:
            raise InputError("bifurcation", f"{self.kind} of {point.name}", "one of an orbit with forward slip")
        plane.axes(self.base.parameters)
        plane.start_at(self.base)
        if self.kind not in KINDS:
            raise InputError("kind", self.kind, f"one of: {', '.join(KINDS)}")
        definition, guess = KINDS[self.kind], [point.period, point.radial_speed]
        if not definition.unknowns:
            guess = []
        elif not np.isfinite(guess).all():
            raise InputError(
                "bifurcation", f"{self.kind} without them", "the period and radial speed of the orbit are needed"
            )
        if self.kind == "grazing":
            guess.append(profile_at(self.base, *guess).top)
        self.guess = guess
        # Where the radial speed grows without bound, the curve becomes straight.
        self.reach = (lambda u: max(1.0, abs(float(u[1])))) if guess else None
        bounds = [Watch(BOUNDLESS, lambda u, _: FASTEST - abs(u[1]), at_zero="end")] if guess else []
        self.watches = [*bounds, *(self._watch(name) for name in (*definition.watched, *definition.ends))]
        self.residual = _equations(self.kind, self.numbers_at)

    def numbers_at(self, x: float, y: float) -> Numbers:
        """Numbers at a point of the plane."""
        return self.plane.numbers_at(self.base, x, y)

    def _numbers(self, u: np.ndarray, p: float) -> Numbers:
        return self.numbers_at(float(u[-1]), p)

    def _watch(self, name: str) -> Watch:
        test, ends = TESTS[name], name in KINDS[self.kind].ends
        return Watch(
            name, lambda u, p: test(self._numbers(u, p), *_orbit(self.kind, u)), at_zero="end" if ends else "pass"
        )

    def curve(self, branch: Branch, rows: np.ndarray) -> Curve:
        """The curve with the names and speeds of its orbits."""
        return _curve(self.kind, self.plane, branch, rows, self._numbers)


def _orbit(kind: str, unknowns: np.ndarray) -> tuple[float, float]:
    """Period and radial speed among the unknowns; placeholders where there is no orbit."""
    return (float(unknowns[0]), float(unknowns[1])) if KINDS[kind].unknowns else (1.0, 0.0)


def _equations(kind: str, numbers_at: Callable[..., Numbers]) -> Function:
    """Equations of a curve."""
    test = TESTS[kind]

    def equilibrium(u: np.ndarray, p: float) -> np.ndarray:
        return np.array([test(numbers_at(float(u[0]), p), 1.0, 0.0)])

    def orbit(u: np.ndarray, p: float) -> np.ndarray:
        period, speed, *time, x = u.tolist()
        if not (period > SHORTEST and all(0.0 < each < period for each in time)):
            return np.full(len(u), np.nan)
        at = numbers_at(x, p), period, speed
        return np.array([*conditions_at(*at)[:2], *(grazing_equations(*at, *time) if time else (test(*at),))])

    return orbit if KINDS[kind].unknowns else equilibrium


def _curve(
    kind: str, plane: Plane, branch: Branch, rows: np.ndarray, numbers: Callable[[np.ndarray, float], Numbers]
) -> Curve:
    """Build the curve from rows of unknowns and second parameter."""
    of_orbits = KINDS[kind].unknowns > 0

    def happens(u: np.ndarray, p: float, slack: float) -> bool:
        at, (period, speed) = numbers(u, p), _orbit(kind, u)
        if not of_orbits:
            return kind != "rub-fold" or happens_to_rubs(at)
        slips = at.mu == 0.0 or conditions_at(at, period, speed).slip_stop > -slack
        return speed > -slack and slips and not profile_at(at, period, max(speed, 1e-4)).height >= slack

    absent = np.full(len(rows), np.nan)
    slack = 1e-9 if kind in ("grazing", "slip-stop", "contact-onset", "non-smooth-hopf") else 0.0
    admissible = np.array([happens(row[:-1], float(row[-1]), slack) for row in rows])
    named = [
        (numbers(row[:-1], float(row[-1])), *_orbit(kind, row)) for row in rows[admissible if admissible.any() else ...]
    ]
    return Curve(
        kind=kind,
        plane=plane,
        points=rows[:, -2:],
        periods=rows[:, 0] if of_orbits else absent,
        radial_speeds=rows[:, 1] if of_orbits else absent,
        admissible=admissible,
        orbits=orbits_on_curve(kind, named) if of_orbits else (),
        codimension2=tuple(
            Codimension2Point(
                (point.kind,) if point.kind in RESONANCES else (kind, point.kind),
                (float(point.unknowns[-1]), point.parameter),
                *(_orbit(kind, point.unknowns) if of_orbits else (np.nan, np.nan)),
                happens(point.unknowns, point.parameter, 1e-6),
            )
            for point in branch.special
            if point.kind in (*KINDS[kind].watched, *KINDS[kind].ends)
        ),
        stops=(_stop(kind, branch, 0), _stop(kind, branch, -1)),
    )


def _stop(kind: str, branch: Branch, end: Literal[0, -1]) -> str:
    """Reason why a curve ends at its first or last point."""
    reason = branch.stops[end]
    if reason == "parameter limit":
        return EDGE
    if reason not in ("end of domain", "step too small"):
        return reason
    unknowns = branch.unknowns[end]
    if KINDS[kind].unknowns and unknowns[0] < VANISHING:
        return "period vanishes"
    if kind == "grazing" and min(unknowns[2], unknowns[0] - unknowns[2]) < VANISHING * unknowns[0]:
        return "grazing meets the impact"
    return reason
