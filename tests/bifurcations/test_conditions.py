"""Test functions and points of curves against 60 digits, and the Jacobian of branches against differences."""

import math

import numpy as np
import pytest
from flint import acb, acb_mat, arb, arb_mat, ctx
from machines import PAPER

from carom import find_orbits
from carom.base.outcome import CaromError
from carom.bifurcations import Plane, continue_curve, continue_orbit, words
from carom.bifurcations.conditions import conditions_at, grazing_equations, pressed_on
from carom.continuation import continue_branch
from carom.models import jeffcott
from carom.parameters import Numbers, Scales

ctx.prec = 192
TESTS = ("fold", "speed-fold", "slip-stop", "contact-onset", "period-doubling", "neimark-sacker")


def reference(values: list[arb]) -> list[arb]:
    """Equations, test functions and the radius at a time, by matrix exponentials in high precision."""
    gamma, omega, rho, _, mu, d, radius_ratio, period, speed, time = values
    i, one = acb(0, 1), acb_mat(2, 2, [1, 0, 0, 1])
    matrix = acb_mat(2, 2, [0, 1, 1 - omega**2 - i * gamma, -gamma - 2 * i])
    flight = (matrix * period).exp()
    back = flight * (one - flight).inv()
    q = (1 + d) * acb(1, mu)
    lever, turn = q * back[0, 1], q * back[1, 1]
    rate = (matrix * back * (one + back))[1, 1]
    approach = acb(1, -turn.imag)
    force = -matrix[1, 0] * lever + matrix[1, 1] * approach
    leaving = speed * (approach - q)
    # The change of the next section with each coordinate of this one, at the time of the next impact.
    event_amplitudes = flight * acb_mat(2, 3, [i, 0, 0, i * leaving, 1 - q, i])
    rows = [[], [], []]
    for k in range(3):
        late = -event_amplitudes[0, k].real
        turned = (event_amplitudes[0, k] + approach * late).imag
        # In the frame that turned with the impact.
        change = event_amplitudes[1, k] + force * late - i * turned * speed * approach
        for row, entry in zip(rows, (turned, change.real, change.imag), strict=True):
            row.append(entry)
    section = arb_mat(rows)
    trace, square = section.trace(), (section * section).trace()
    minors, determinant = (trace**2 - square) / 2, section.det()
    rest = 1 + lever * speed
    course = (matrix * time).exp() * acb_mat(2, 1, [1 - rest, leaving])
    position, velocity = course[0, 0] + rest, course[1, 0]
    return [
        1 + turn.real,
        abs(rest) ** 2 - rho**2 / abs(matrix[1, 0]) ** 2,
        (q * rate).real,
        lever.real + abs(lever) ** 2 * speed,
        radius_ratio + 1 - (turn.imag + mu * (1 + d)) * speed,
        (-matrix[1, 0] * lever * speed + matrix[1, 1] * leaving).real + abs(leaving) ** 2,
        1 + trace + minors + determinant,
        determinant**2 - determinant * trace + minors - 1,
        trace - determinant,
        (position.conjugate() * velocity).real,
        abs(position) ** 2 - 1,
    ]


CRITICAL = 2.0 * PAPER.omega
CASES = {
    "paper": (PAPER, 2.8635671446, 0.7332305341),
    "fold": (PAPER.replace(gamma=0.1780277257), 1.6408219835, 0.6),
    "critical": (PAPER.replace(gamma=CRITICAL), 1.9, 0.3),
    "almost critical, below": (PAPER.replace(gamma=CRITICAL * (1.0 - 1e-13)), 1.9, 0.3),
    "almost critical, above": (PAPER.replace(gamma=CRITICAL * (1.0 + 1e-7)), 1.9, 0.3),
    "end of the series, above": (PAPER.replace(gamma=2.0 * math.hypot(PAPER.omega, 0.5)), 2.0000001, 0.3),
    "end of the series, below": (PAPER.replace(gamma=0.0, omega=0.5), 1.9999999, 0.3),
    "overdamped": (PAPER.replace(gamma=6.0), 4.0, 0.2),
    "no rebound": (PAPER.replace(d=0.0), 1.3, 0.4),
    "elastic": (PAPER.replace(d=1.0), 0.9, 0.5),
    "smooth": (PAPER.replace(mu=0.0), 2.2, 0.8),
    "no damping": (PAPER.replace(gamma=0.0), 2.2, 0.8),
    "growing": (PAPER.replace(gamma=-0.3), 2.2, 0.8),
    "shrunk to a point": (PAPER, 0.7611785497, 0.0),
    "long": (PAPER, 60.0, 0.8),
}


@pytest.mark.parametrize("name", CASES)
def test_conditions_near_degenerate_limits(name):
    parameters, period, speed = CASES[name]
    assert_exact(Numbers.of(parameters), period, speed)


def test_conditions_with_backward_slip():
    assert_exact(Numbers.of(PAPER)._replace(mu=-0.4), 2.1, 0.6)


def assert_exact(numbers: Numbers, period: float, speed: float) -> None:
    at, time = conditions_at(numbers, period, speed), 0.4 * period
    expected = [float(value) for value in reference([arb(x) for x in (*numbers[:7], period, speed, time)])]
    found = [at.closing, at.balance, at.period_fold, at.speed_fold, at.slip_stop, pressed_on(numbers, period, speed)]
    found += [at.period_doubling, at.neimark_sacker, at.pair_sum, *grazing_equations(numbers, period, speed, time)]
    # Errors are those of rounding; they grow with the period through the phase of the free motion.
    assert found == pytest.approx(expected, rel=2e-13 * max(1.0, period), abs=2e-13 * max(1.0, period))


def followed(monkeypatch, module, follow) -> tuple:
    """The equations, their Jacobian and the branch of a continuation."""
    caught = []

    def catch(equations, *args, **kwargs):
        branch = continue_branch(equations, *args, **kwargs)
        caught.append((equations.residual, equations.slopes, branch))
        return branch

    monkeypatch.setattr(module, "continue_branch", catch)
    follow()
    monkeypatch.undo()
    return caught[0]


def assert_consistent(residual, jacobian, branch) -> None:
    """Compare the Jacobian with differences of the fourth order at a few points of the branch."""
    for i in np.linspace(1, len(branch) - 2, 4).astype(int):
        x = np.append(branch.unknowns[i], branch.parameters[i])
        columns = []
        sizes = np.where(x == 0.0, 1.0, np.abs(x))
        for k, size in enumerate(sizes):
            h = 2e-4 * size * np.eye(len(x))[k]
            near, far = (residual(*split(x + s * h)) - residual(*split(x - s * h)) for s in (1.0, 2.0))
            columns.append((8.0 * near - far) / (24e-4 * size))
        differences, exact = np.array(columns).T, jacobian(*split(x))
        # Differences of the fourth order with relative steps of 2e-4.
        assert np.abs((exact - differences) * sizes).max() < 1e-7 * max(1.0, np.abs(exact * sizes).max())


def split(x: np.ndarray) -> tuple[np.ndarray, float]:
    return x[:-1], float(x[-1])


SCALED = PAPER.replace(scales=Scales(50.0, 0.7e-3, 184.2))


@pytest.mark.parametrize(
    "name", ["gamma", "omega", "rho", "mu", "d", "speed", "mass", "clearance", "damping", "stiffness"]
)
def test_branches_along_any_parameter(monkeypatch, name):
    orbit = find_orbits(jeffcott(SCALED))["B1,d"]
    value = SCALED.value(name)

    def follow():
        continue_orbit(orbit, name, (0.98 * value, 1.02 * value))

    assert_consistent(*followed(monkeypatch, words, follow))


PLANES = {
    "gamma, omega": Plane("gamma", "omega", (0.02, 0.6), (0.6, 1.0)),
    "speed, damping": Plane("speed", "damping", ("1400 rpm", "2200 rpm"), (100.0, 8000.0)),
    "speed, gamma": Plane("speed", "gamma", (150.0, 230.0), (0.02, 0.6)),
    "gamma, speed": Plane("gamma", "speed", (0.02, 0.6), (150.0, 230.0)),
    "stiffness, eccentricity": Plane("stiffness", "eccentricity", (5e5, 2e6), ("0.1 mm", "0.6 mm")),
}


@pytest.mark.parametrize("plane", PLANES)
def test_curves_in_planes_of_any_two_parameters(plane):
    """In a plane of a physical and a dimensionless parameter the second one undoes a part of what the first one moves."""
    branch = continue_orbit(find_orbits(jeffcott(SCALED))["B1,d"], "gamma", (0.02, 0.3))
    followed_kinds = set()
    for point in branch.special:
        if point.kind not in TESTS:
            continue
        try:
            curve = continue_curve(point, PLANES[plane])
        except CaromError:
            continue
        rows = list(zip(curve.points, curve.periods, curve.radial_speeds, strict=True))
        for place, period, speed in rows[:: max(1, len(rows) // 4)]:
            numbers = PLANES[plane].numbers_at(point.numbers, *place)
            values = [float(value) for value in reference([arb(x) for x in (*numbers[:7], period, speed, 0.0)])]
            assert [*values[:2], values[2 + TESTS.index(curve.kind)]] == pytest.approx([0.0] * 3, abs=1e-9)
        followed_kinds.add(curve.kind)
    assert followed_kinds >= {"fold", "period-doubling"} - NOT_IN.get(plane, set())


NOT_IN = {"stiffness, eccentricity": {"fold"}}
"""``F₁`` does not depend on the unbalance."""
