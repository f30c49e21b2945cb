"""Every kind of located point, on several machines and parameters, looked at again by a route of its own."""

from collections import Counter

import mpmath
import numpy as np
import pytest
from machines import PAPER, ExactMotion

from carom import State, find_bifurcations, find_equilibria, find_orbits, map_regions, simulate
from carom.base.outcome import Phase
from carom.bifurcations import Bifurcation, Diagram, Plane, boundary_equilibria
from carom.bifurcations.conditions import orbit_of
from carom.closed_forms import PeriodCondition
from carom.models import jeffcott
from carom.orbits import Orbit, Section, impact_map
from carom.parameters import Numbers, Parameters

pytestmark = pytest.mark.jit_only

SOFT = PAPER.replace(omega=0.35, rho=0.2)
SOFTER = PAPER.replace(gamma=0.1, omega=0.34, rho=0.2, mu=0.2, d=0.6)
SMALL = PAPER.replace(radius_ratio=0.8, mu=0.4, gamma=0.12)
CASES = {
    "damping": (PAPER, "gamma", (0.05, 0.4)),
    "stiffness": (PAPER, "omega", (0.5, 1.3)),
    "friction": (PAPER, "mu", (0.0, 1.0)),
    "unbalance": (PAPER, "rho", (0.2, 0.7)),
    "restitution": (PAPER, "d", (0.5, 1.0)),
    "soft": (SOFT, "gamma", (0.05, 0.13)),
    "no rebound": (PAPER.replace(rho=0.1, mu=0.3, d=0.0), "gamma", (0.01, 0.1)),
    "small": (SMALL, "gamma", (0.05, 0.3)),
    "slippery": (PAPER.replace(mu=0.01, radius_ratio=3.0), "gamma", (0.002, 0.1)),
}
CLOSE = 1e-9
"""How near to a point, relative to the range of the parameter, the answers of both sides are compared."""


@pytest.fixture(scope="module")
def diagrams() -> dict[str, Diagram]:
    return {name: find_bifurcations(*case) for name, case in CASES.items()}


def sides(base: Parameters, point: Bifurcation, width: float, close: float = CLOSE) -> tuple[Parameters, Parameters]:
    low, high = (base.replace(**{point.parameter: point.value + side * close * width}) for side in (-1.0, 1.0))
    return low, high


def longest(point: Bifurcation) -> float:
    return 1.2 * float(point.period or 1.0)


def orbit_next_to(parameters: Parameters, point: Bifurcation) -> Orbit:
    orbits = [orbit for orbit in find_orbits(jeffcott(parameters), longest(point)) if orbit.slip > 0]
    return min(orbits, key=lambda o: abs(o.period - point.period) + abs(o.radial_speed - point.radial_speed))


def simulated_multipliers(parameters: Parameters, point: Bifurcation) -> np.ndarray:
    """From differences of the simulated impact map, without its derivative."""
    orbit = orbit_next_to(parameters, point)
    centre = np.array([orbit.angle, orbit.radial_speed, orbit.angular_speed])
    columns = []
    for unit in np.eye(3):
        ends = []
        for size in (1e-5, -1e-5):
            image = impact_map(orbit.rotor, Section(*(centre + size * unit))).image
            ends.append(np.array([image.angle, image.radial_speed, image.angular_speed]))
        change = ends[0] - ends[1]
        change[0] = np.remainder(change[0] + np.pi, 2.0 * np.pi) - np.pi
        columns.append(change / 2e-5)
    return np.linalg.eigvals(np.array(columns).T)


def count_roots(parameters: Parameters, point: Bifurcation) -> int:
    return len(PeriodCondition.of(jeffcott(parameters).system).roots(longest(point)).periods)


def count_orbits(parameters: Parameters, point: Bifurcation) -> int:
    return sum(orbit.slip > 0 for orbit in find_orbits(jeffcott(parameters), longest(point)))


def count_extrema(parameters: Parameters, point: Bifurcation) -> int:
    orbit = orbit_next_to(parameters, point)
    radius = np.abs(orbit.path(np.linspace(0.0, orbit.period, 40001)[1:-1]))
    return int((np.diff(np.sign(np.diff(radius))) != 0).sum())


def rolls_on(parameters: Parameters) -> bool:
    """Whether a simulated rotor that rolls does so for two turns without slipping or leaving the wall."""
    speed = 1.0 + parameters.radius_ratio
    motion = simulate(jeffcott(parameters), State(1.0 + 0j, complex(0.0, -speed)), 4.0 * np.pi / speed)
    return bool((motion.segment_phases[1:] == Phase.ROLLING).all())


def check(base: Parameters, point: Bifurcation, width: float) -> None:
    at, (low, high) = base.replace(**{point.parameter: point.value}), sides(base, point, width)
    if point.kind == "fold":
        assert abs(count_roots(low, point) - count_roots(high, point)) == 2
    elif point.kind == "speed-fold":
        assert abs(count_orbits(low, point) - count_orbits(high, point)) == 2
    elif point.kind == "grazing":
        assert orbit_next_to(low, point).admissible != orbit_next_to(high, point).admissible
    elif point.kind == "period-doubling":
        assert np.abs(simulated_multipliers(at, point) + 1.0).min() < 1e-5
    elif point.kind == "neimark-sacker":
        values = simulated_multipliers(at, point)
        assert np.abs(np.abs(values[np.abs(values.imag) > 1e-3]) - 1.0).max() < 1e-5
    elif point.kind == "slip-stop":
        answers = ["stop the slip" in orbit_next_to(side, point).reason for side in (low, high)]
        assert answers[0] != answers[1]
    elif point.kind == "contact-onset":
        answers = ["stay on the wall" in orbit_next_to(side, point).reason for side in (low, high)]
        assert answers[0] != answers[1]
    elif point.kind == "radius-extremum":
        counts = [count_extrema(side, point) for side in sides(base, point, width, 1e-4)]
        assert abs(counts[0] - counts[1]) == 2
    elif point.kind == "non-smooth-hopf":
        assert abs(jeffcott(at).equilibrium) == pytest.approx(1.0, abs=1e-10)
        assert float(PeriodCondition.of(jeffcott(at).system).value(np.array([point.period]))[0]) == pytest.approx(
            0.0, abs=1e-9
        )
    elif point.kind == "boundary-equilibrium":
        assert abs(jeffcott(at).equilibrium) == pytest.approx(1.0, abs=1e-11)
        assert find_equilibria(jeffcott(low))[0].status != find_equilibria(jeffcott(high))[0].status
        if point.parameter in ("gamma", "omega"):
            known = boundary_equilibria(jeffcott(base), point.parameter)
            near = min(known, key=lambda entry: abs(entry.value - point.value))
            assert (near.value, near.kind) == (pytest.approx(point.value, abs=1e-11), point.detail)
    elif point.kind == "rub-fold":
        assert sorted(len(find_equilibria(jeffcott(side))) for side in (low, high)) == [1, 3]
    else:
        assert point.kind == "rolling-limit"
        assert rolls_on(sides(base, point, width, 1e-4)[0]) != rolls_on(sides(base, point, width, 1e-4)[1])


@pytest.mark.parametrize("name", CASES)
def test_every_point(diagrams, name):
    base, _, interval = CASES[name]
    points = [point for point in diagrams[name].points if point.admissible]
    assert points
    for point in points:
        check(base, point, interval[1] - interval[0])


def test_every_kind_was_looked_at(diagrams):
    counts = Counter(point.kind for found in diagrams.values() for point in found.points if point.admissible)
    expected = {
        "fold",
        "speed-fold",
        "grazing",
        "period-doubling",
        "neimark-sacker",
        "slip-stop",
        "contact-onset",
        "radius-extremum",
        "non-smooth-hopf",
        "boundary-equilibrium",
        "rub-fold",
        "rolling-limit",
    }
    assert set(counts) == expected


def vanishes(kind: str, parameters: Parameters, point) -> bool:
    """Whether a bifurcation of this kind happens at a codimension-2 point, by a formula that is not its test function's."""
    rotor = jeffcott(parameters)
    if kind in ("boundary-equilibrium", "non-smooth-hopf"):
        return abs(abs(rotor.equilibrium) - 1.0) < 1e-9
    if kind == "rub-fold":
        eigenvalues = [abs(rub.eigenvalues).min() for rub in find_equilibria(rotor)[1:]]
        moved = find_equilibria(jeffcott(parameters.replace(rho=parameters.rho * (1.0 + 1e-12))))
        return min(eigenvalues or [abs(rub.eigenvalues).min() for rub in moved[1:]]) < 1e-4
    condition, period = PeriodCondition.of(rotor.system), np.array([point.period])
    if kind == "fold":
        return abs(float(condition.slope(period)[0])) < 1e-7
    lever = complex(condition.factor * condition.a12(period)[0])
    if kind == "speed-fold":
        return abs(abs(lever) * point.radial_speed + lever.real / abs(lever)) < 1e-7
    # A search may find no orbit here: where two meet, rounding decides whether there are any.
    orbit = orbit_of(Numbers.of(parameters), 1, point.period, point.radial_speed)
    section = (orbit.angle, orbit.radial_speed, orbit.angular_speed)
    with mpmath.workdps(40):
        values = np.linalg.eigvals(ExactMotion(parameters).jacobian(section, 1, point.period))
    if kind == "period-doubling":
        return float(np.abs(values + 1.0).min()) < 1e-4
    if kind == "neimark-sacker":
        # The product of the pair does not notice when it meets on the real axis.
        pair = values[np.argsort(np.abs(np.abs(values) - 1.0))[:2]]
        return abs(np.prod(pair) - 1.0) < 1e-6
    if kind.startswith("resonance"):
        turns = int(kind[-1])
        away = np.sort(np.abs(values - np.exp(2j * np.pi / turns)))
        # Two multipliers that meet are a square root apart from what rounding makes of the place.
        return bool(away[1] < 1e-3 if turns <= 2 else away[0] < 1e-6)
    assert kind == "grazing"
    radius = np.abs(orbit.path(np.linspace(0.0, orbit.period, 200_001)))[100:-100]
    return abs(float(radius[1:-1][(radius[1:-1] > radius[:-2]) & (radius[1:-1] > radius[2:])].max()) - 1.0) < 1e-6


@pytest.mark.parametrize(
    ("base", "plane"),
    [
        pytest.param(PAPER, Plane("gamma", "omega", (0.02, 0.4), (0.6, 1.05)), marks=pytest.mark.deep),
        (SOFT, Plane("gamma", "omega", (0.02, 0.15), (0.15, 0.6))),
        pytest.param(PAPER, Plane("mu", "gamma", (0.02, 0.4), (0.03, 0.3)), marks=pytest.mark.deep),
        pytest.param(SOFTER, Plane("omega", "gamma", (0.13, 0.9), (0.02, 0.3)), marks=pytest.mark.deep),
    ],
)
def test_at_codimension_2_points_both_happen(base, plane):
    found = map_regions(base, plane, grid=2)
    assert found.codimension2
    if base is SOFT:
        ratios = {point.kind for point in found.codimension2 if point.kind.startswith("resonance")}
        assert {"resonance-1:2", "resonance-1:4"} <= ratios
    for point in found.codimension2:
        for kind in point.kind.split(" + "):
            assert vanishes(kind, plane.at(base, *point.value), point), (kind, point)
