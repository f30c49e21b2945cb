"""Curves of each bifurcation in the plane of two parameters, with the codimension-2 points on them.

Of orbits without closed form they are folds, period doublings and Neimark–Sacker bifurcations: the equations are those of the path closed on the
flow of the simulator and the function that vanishes at the bifurcation, and all derivatives are differences.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.bifurcations.conditions import (
    BOUNDLESS,
    ENDING,
    FASTEST,
    TESTS,
    conditions_at,
    grazing_equations,
    orbits_on_curve,
    profile_at,
)
from carom.bifurcations.curve_results import Curve, CurveEquations, Place
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import STEADY, Bifurcation, happens_steadily
from carom.bifurcations.simulated import MOST_NUMBERS, begun_at_least_radius
from carom.bifurcations.simulated_family import Place as Values
from carom.bifurcations.simulated_family import SimulatedFamily
from carom.continuation import Steps, Watch
from carom.orbits.flow import Flow, FlowBudget
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.simulated import SimulatedOrbit
from carom.parameters import Numbers

SHORTEST = 1e-4
"""Period, in ``1/Ω``, below which test functions may be only rounding; with ``d = 1`` the period of a pair can vanish.

That of a Neimark–Sacker bifurcation then falls with the cube of the period: it is 2e-13 here and 2e-16 at a tenth of it.
"""
VANISHING = 1e-2
"""Period, or fraction of a period, that counts as vanished where the equations end."""
KINDS = {
    "fold": ("boundary-equilibrium", "period-doubling", "grazing", "speed-fold", "slip-stop", "resonance-1:1"),
    "speed-fold": ("fold", "grazing", "period-doubling", "resonance-1:1"),
    "period-doubling": ("grazing", "fold", "speed-fold", "slip-stop", "boundary-equilibrium", "resonance-1:2"),
    # It ends at the last two.
    "neimark-sacker": ("grazing", "boundary-equilibrium", "slip-stop", "resonance-1:3", "resonance-1:4", *ENDING),
    "grazing": ("fold", "speed-fold", "period-doubling", "boundary-equilibrium", "slip-stop"),
    "slip-stop": ("fold", "period-doubling", "grazing"),
    "contact-onset": ("fold", "period-doubling", "grazing", "slip-stop"),
    # Not grazing: the orbit is a point on the wall here, and the height of its radius is rounding.
    "non-smooth-hopf": ("fold", "period-doubling", "neimark-sacker", "slip-stop"),
    "boundary-equilibrium": ("rub-fold",),
    "rub-fold": ("boundary-equilibrium",),
    "rolling-limit": ("boundary-equilibrium", "rub-fold"),
    "levitation-lost": ("boundary-equilibrium",),
}
"""Bifurcations that can be followed in two parameters, and the test functions that are watched along each curve."""


def can_be_followed(point: Bifurcation) -> bool:
    """Whether :func:`continue_curve` knows equations for a bifurcation."""
    if point.shot is None:
        return point.kind in KINDS and isinstance(point.numbers, Numbers)
    return point.kind in SIMULATED_KINDS


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
    equations = ClosedFormCurve if bifurcation.shot is None else SimulatedCurve
    return equations(bifurcation, plane, budget).followed(steps)


class ClosedFormCurve(CurveEquations):
    """The equations of a bifurcation that has a closed form; of an orbit period and radial speed are unknown, of grazing also its time."""

    base: Numbers
    bend, usual_steps = 5e-5, Steps(first=0.02, largest=0.1, sharpest_turn=0.3, most_points=1000)

    def __init__(self, point: Bifurcation, plane: Plane, _: FlowBudget | None = None) -> None:
        self.kind, self.base, self.plane = point.kind, point.numbers, plane
        if not can_be_followed(point):
            raise InputError(
                "kind", self.kind, f"one of: {', '.join(KINDS)}; of machines without closed forms of orbits alone"
            )
        if self.base.mu < 0.0:
            raise InputError("bifurcation", f"{self.kind} of {point.name}", "one of an orbit with forward slip")
        plane.axes(self.base.parameters)
        plane.start_at(self.base)
        self.guess, self.watches = [], [self._watch(name) for name in KINDS[self.kind]]
        if self.kind in STEADY:
            return
        self.guess = [point.period, point.radial_speed]
        if not np.isfinite(self.guess).all():
            needed = "the period and radial speed of the orbit are needed"
            raise InputError("bifurcation", f"{self.kind} without them", needed)
        if self.kind == "grazing":
            self.guess.append(profile_at(self.base, *self.guess).top)
        if self.kind in ("grazing", "slip-stop", "contact-onset", "non-smooth-hopf"):
            self.slack = 1e-9
        # Where the radial speed grows without bound, the curve becomes straight.
        self.reach = lambda u: max(1.0, abs(float(u[1])))
        self.watches.insert(0, Watch(BOUNDLESS, lambda u, _: FASTEST - abs(u[1]), at_zero="end"))

    def _at(self, u: np.ndarray, p: float) -> tuple[Numbers, float, float]:
        """Numbers, period and radial speed; the last two mean nothing where there is no orbit."""
        speeds = (1.0, 0.0) if self.kind in STEADY else (float(u[0]), float(u[1]))
        return self.plane.numbers_at(self.base, float(u[-1]), p), *speeds

    def _watch(self, name: str) -> Watch:
        ends = self.kind == "neimark-sacker" and name in ENDING
        return Watch(name, lambda u, p: TESTS[name](*self._at(u, p)), at_zero="end" if ends else "pass")

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""
        test = TESTS[self.kind]
        if self.kind in STEADY:
            return np.array([test(*self._at(u, p))])
        period, _, *time, _ = u.tolist()
        if not (period > SHORTEST and all(0.0 < each < period for each in time)):
            return np.full(len(u), np.nan)
        at = self._at(u, p)
        return np.array([*conditions_at(*at)[:2], *(grazing_equations(*at, *time) if time else (test(*at),))])

    def orbit(self, u: np.ndarray, p: float) -> tuple[float, float]:
        """Period and radial speed; ``nan`` for equilibria."""
        return (np.nan, np.nan) if self.kind in STEADY else self._at(u, p)[1:]

    def happens(self, u: np.ndarray, p: float, slack: float) -> bool:
        """Whether it happens to a motion of the machine."""
        at, period, speed = self._at(u, p)
        if self.kind in STEADY:
            return happens_steadily(self.kind, at)
        slips = at.mu == 0.0 or conditions_at(at, period, speed).slip_stop > -slack
        return speed > -slack and slips and not profile_at(at, period, max(speed, 1e-4)).height >= slack

    def names(self, places: Sequence[Place]) -> tuple[OrbitName, ...]:
        """Names of the orbits that bifurcate at places of the curve; none of equilibria."""
        return () if self.kind in STEADY else orbits_on_curve(self.kind, [self._at(*place) for place in places])

    def gives_up(self, reason: str, u: np.ndarray) -> str:
        """Why the continuation gave up, in terms of the motion."""
        if self.kind not in STEADY and u[0] < VANISHING:
            return "period vanishes"
        if self.kind == "grazing" and min(u[2], u[0] - u[2]) < VANISHING * u[0]:
            return "grazing meets the impact"
        return reason


SIMULATED_KINDS = ("fold", "period-doubling", "neimark-sacker")


class SimulatedCurve(CurveEquations):
    """The equations of one of these bifurcations."""

    bend = np.inf
    usual_steps = Steps(
        first=0.02, largest=0.2, smallest=1e-3, sharpest_turn=0.4, most_points=80, tolerance=1e-7, resolution=1e-8
    )

    def __init__(self, point: Bifurcation, plane: Plane, budget: FlowBudget | None) -> None:
        if point.kind not in SIMULATED_KINDS:
            raise InputError("kind", point.kind, f"one of: {', '.join(SIMULATED_KINDS)}")
        orbit: SimulatedOrbit = point.shot
        numbers = len(Flow.vector(orbit.start))
        if numbers > MOST_NUMBERS:
            allowed = f"one of a rotor with at most {MOST_NUMBERS}"
            raise InputError("bifurcation", f"{numbers} numbers of a state", allowed)
        self.kind, self.plane, self.name = point.kind, plane, orbit.name
        begun = begun_at_least_radius(orbit) if orbit.repeats is None else orbit
        self.family = SimulatedFamily(begun, plane, plane.second_range, budget or FlowBudget())
        plane.axes(orbit.rotor)
        self.base, vector = orbit.rotor, Flow.vector(begun.start)
        self.guess = np.append(vector, begun.period) if self.family.free else vector
        tests = {"fold": self.family.fold, "period-doubling": self.family.doubling, "neimark-sacker": self.family.torus}
        self.test = tests.pop(self.kind)
        others = () if self.kind == "neimark-sacker" else tuple(name for name in tests if name != "neimark-sacker")
        self.watches = [Watch(name, self._over_plane(tests[name])) for name in others]

    @staticmethod
    def _over_plane(test: Callable[[np.ndarray, Values], float]) -> Callable[[np.ndarray, float], float]:
        """A test of a family as a function of the unknowns of a curve and the second parameter."""
        return lambda u, p: test(u[:-1], (float(u[-1]), p))

    def residual(self, u: np.ndarray, p: float) -> np.ndarray:
        """Left sides of the equations; ``nan`` where they are not defined."""
        unknowns, place = u[:-1], (float(u[-1]), p)
        closing = self.family.residual(unknowns, place)
        return np.append(closing, self.test(unknowns, place) if np.isfinite(closing).all() else np.nan)

    def _moved(self, u: np.ndarray, p: float) -> SimulatedOrbit:
        """The orbit at a place of the curve."""
        place = float(u[-1]), p
        flow = self.family.flow(place)
        if flow is None:
            raise RuntimeError("a curve is followed where there is a rotor")
        return self.family.orbit.moved(flow, *self.family.split(u[:-1]), np.empty(0), self.name)

    def orbit(self, u: np.ndarray, p: float) -> tuple[float, float]:
        """Period and radial speed."""
        orbit = self._moved(u, p)
        return orbit.period, orbit.radial_speed

    def happens(self, u: np.ndarray, p: float, slack: float) -> bool:
        """All are motions of the machine."""
        return True

    def names(self, places: Sequence[Place]) -> tuple[CountedName, ...]:
        """Name of the orbit that was followed."""
        return (self.name,)

    def gives_up(self, reason: str, u: np.ndarray) -> str:
        """Why the continuation gave up: its budget may be spent."""
        return "more would take too long" if self.family.budget.spent else reason
