"""Misprints: the printed and the right form, both evaluated here by routes that share nothing with the package."""

import cmath
import math

import numpy as np
import pytest
from machines import PAPER, flight_matrix, fly, rest_position
from scipy.linalg import expm
from scipy.optimize import brentq

GAMMA = 0.1
Q = (1.0 + PAPER.d) * complex(1.0, PAPER.mu)


def returned(gamma: float, period: float) -> np.ndarray:
    """``(e^{−AT} − 1)⁻¹``."""
    return np.linalg.inv(expm(-flight_matrix(PAPER.replace(gamma=gamma)) * period) - np.eye(2))


def closing(gamma: float, period: float) -> float:
    return 1.0 + (Q * returned(gamma, period)[1, 1]).real


def orbit(gamma: float, low: float, high: float, fast: bool) -> tuple[float, float, complex, float]:
    """Period between two values, and ``ṙ``, ``U₀``, ``θ̇`` of the faster or slower orbit, from (4.3) to (4.5)."""
    period = brentq(lambda period: closing(gamma, period), low, high, xtol=1e-14)
    lever, turn = Q * returned(gamma, period)[0, 1], Q * returned(gamma, period)[1, 1]
    rest = rest_position(PAPER.replace(gamma=gamma))
    speeds = np.roots([abs(lever) ** 2, 2.0 * lever.real, 1.0 - abs(rest) ** 2]).real
    speed = float(speeds.max() if fast else min(speeds, key=abs))
    return period, speed, rest / (1.0 + lever * speed), -turn.imag * speed


@pytest.fixture(scope="module")
def rows(found):
    return {row.place: row for row in found.misprints if row.place != "Proposition 4.1"}


@pytest.fixture(scope="module")
def bounce():
    return orbit(GAMMA, 2.0, 3.2, fast=True)


@pytest.fixture(scope="module")
def birth():
    return math.sqrt(PAPER.rho**2 - (1.0 - PAPER.omega**2) ** 2)


def test_all_of_them(found):
    assert len(found.misprints) == 17
    for row in found.misprints:
        # Each shows that the printed form fails.
        assert row.difference is None or abs(row.difference) > 0.03


def test_impulse(rows, bounce):
    _, speed, *_ = bounce
    row = rows["(2.5)"]
    assert row.value == pytest.approx(50.0 * 1.95 * speed * 0.7e-3 * 184.2, rel=1e-10)
    assert row.printed_value == pytest.approx(1.95 * speed * 0.7e-3 * 184.2, rel=1e-10)


def test_slip_by_the_velocity_in_the_fixed_frame(rows, bounce):
    period, speed, position, turn = bounce
    after = complex(speed, turn) * position - Q * speed * position
    before = fly(PAPER.replace(gamma=GAMMA), position, after, period)
    # Z = U e^{it}: the velocity of the contact point is that of the centre plus s along the wall.
    fixed = before[1] + 1j * before[0]
    row = rows["(2.3), section 4"]
    assert row.value == pytest.approx(PAPER.radius_ratio + (fixed / position).imag, rel=1e-10)
    assert row.printed_value == pytest.approx(row.value - 1.0, rel=1e-12)
    # And the velocity of (4.2), from the same flight.
    row = rows["(4.2)"]
    assert row.value == pytest.approx(abs(before[1]), rel=1e-10)
    assert row.printed_value == pytest.approx(abs(speed + 1j * turn * position), rel=1e-10)


def test_matrix_by_the_exponential(rows, bounce):
    period = bounce[0]
    row = rows["matrix after (4.1)"]
    assert row.value == pytest.approx(closing(GAMMA, period), abs=1e-12)
    upper, lower = np.linalg.eigvals(flight_matrix(PAPER.replace(gamma=GAMMA)))
    if upper.imag < lower.imag:
        upper, lower = lower, upper
    v_upper, v_lower = (-value / (1.0 - PAPER.omega**2 - 1j * GAMMA) for value in (upper, lower))
    up, down = cmath.exp(upper * period), cmath.exp(lower * period)
    kappa = 1.0 / ((1.0 - down) * (1.0 - up) * (v_lower - v_upper))
    entry = kappa * (v_lower * down - v_upper * up - up * down)
    assert row.printed_value == pytest.approx(1.0 + (Q * entry).real, abs=1e-9)


def test_second_form(rows):
    row = rows["(4.6), second form"]
    assert row.value == pytest.approx(closing(GAMMA, 1.0), abs=1e-13)
    # With the three corrections the second form gives the right value; see tests/literature.
    assert abs(row.printed_value - row.value) > 0.4


def tail(period: float, share: float, sign: int) -> tuple[float, float]:
    """(4.7) and (4.8) less one, times ``e^{γT/2}``, from the eigenvalues: with ``cos(s₄T ± ζ)`` and ``ζ`` from ``share s₃``."""
    upper, lower = sorted(np.linalg.eigvals(flight_matrix(PAPER.replace(gamma=GAMMA))), key=lambda v: -v.imag)
    leading = size = 0.0
    for value, side in ((upper, -1), (lower, 1)):
        s3 = abs(complex(1.0, PAPER.mu) * value)
        s4 = -side * value.imag
        s5 = -side * GAMMA + 2.0 * s4 * PAPER.mu
        s2 = 2.0 + side * (upper.imag - lower.imag) + GAMMA * PAPER.mu
        zeta = sign * 2.0 * math.atan(s5 / (share * s3 + s2))
        leading += side * s3 * math.cos(s4 * period + zeta)
        size += s3
    scale = (1.0 + PAPER.d) / (upper.imag - lower.imag)
    return scale * leading, scale * size


def test_long_periods(rows):
    """(4.7) carries the ζ of (4.6); the bound (4.8) lacks ``1 − e^{−γT/2}``, with which it holds."""
    decay = math.exp(0.5 * GAMMA * 200.0)
    exact = (closing(GAMMA, 200.0) - 1.0) * decay
    row = rows["(4.7)"]
    assert row.value == pytest.approx(exact, rel=1e-9)
    # What is left out is the next power of e^{−γT/2}.
    leading, size = tail(200.0, 2.0, -1)
    assert leading == pytest.approx(exact, abs=1.01 * size / decay)
    assert row.printed_value == pytest.approx(tail(200.0, 1.0, 1)[0], rel=1e-9)
    assert abs(row.printed_value - exact) > 0.03
    periods = np.linspace(20.0, 40.0, 2001)
    beyond = np.array([abs(closing(GAMMA, t) - 1.0) * math.exp(0.5 * GAMMA * t) / tail(t, 1.0, 1)[1] for t in periods])
    row = rows["(4.8)"]
    assert row.value == pytest.approx(beyond.max(), abs=1e-4)
    assert round(row.value, 1) == 1.3
    assert (beyond * (1.0 - np.exp(-0.5 * GAMMA * periods)) < 1.0).all()


def test_letters_of_section_5(rows, birth):
    """On the exact branch, by differences of the place of its impact."""
    step = 1e-5
    here = rest_position(PAPER.replace(gamma=birth))
    ends = [orbit(birth + side * step, 2.0, 3.3, fast=False)[2] for side in (-1.0, 1.0)]
    slope = (ends[1] - ends[0]) / (2.0 * step)
    row = rows["section 5, solution for w₁,₀₋"]
    assert row.value == pytest.approx(abs(slope), abs=1e-6)
    # With b for b₁ the equilibrium itself stands where its shift belongs.
    rests = [rest_position(PAPER.replace(gamma=birth + side * step)) for side in (-1.0, 1.0)]
    shift = (rests[1] - rests[0]) / (2.0 * step)
    assert row.printed_value == pytest.approx(abs(slope - shift + here), abs=1e-6)
    row = rows["section 5, place of the impact"]
    assert row.value == pytest.approx(1.0, abs=1e-9)
    assert row.printed_value == pytest.approx(abs(shift / abs(shift) + abs(shift) * slope), abs=1e-6)


def test_counts(found):
    most, admissible = (row for row in found.misprints if row.place == "Proposition 4.1")
    roots = [orbit(GAMMA, *ends, fast=fast)[1] for ends in ((0.3, 2.0), (2.0, 3.2)) for fast in (False, True)]
    assert (most.printed_value, most.value) == (2.0, len(set(roots)))
    # At 0.06 the path of B1,d goes through the wall between its impacts, that of B1,c does not.
    inside = 0
    for low, high in ((0.3, 2.0), (2.0, 3.3)):
        period, speed, position, turn = orbit(0.06, low, high, fast=True)
        after = (complex(speed, turn) - Q * speed) * position
        times = np.linspace(0.0, period, 300)[1:-1]
        radii = [abs(fly(PAPER.replace(gamma=0.06), position, after, time)[0]) for time in times]
        inside += speed > 0.0 and max(radii) < 1.0
    assert (admissible.printed_value, admissible.value) == (2.0, inside)


def test_multiplier_is_minus_one(rows):
    """A small disturbance along it changes side at each impact and keeps its size; by flights of matrix exponentials."""
    row = rows["section 4a"]
    gamma = 0.0833814175
    period, speed, position, turn = orbit(gamma, 2.0, 3.3, fast=True)
    parameters = PAPER.replace(gamma=gamma)

    def impact(state: np.ndarray) -> np.ndarray:
        angle, radial, angular = state
        there = cmath.rect(1.0, angle)
        after = (complex(radial, angular) - Q * radial) * there
        time = brentq(
            lambda t: abs(fly(parameters, there, after, t)[0]) - 1.0, 0.97 * period, 1.03 * period, xtol=1e-14
        )
        end, velocity = fly(parameters, there, after, time)
        rates = velocity / end
        return np.array([cmath.phase(end), rates.real, rates.imag])

    here = np.array([cmath.phase(position), speed, turn])
    step = 1e-5
    jacobian = np.array([(impact(here + s) - impact(here - s)) / (2.0 * step) for s in step * np.eye(3)]).T
    critical = max(np.linalg.eigvals(jacobian), key=abs)
    assert critical.real == pytest.approx(-1.0, abs=1e-6)
    assert critical.imag == 0.0
    assert row.value == pytest.approx(-1.0, abs=1e-9)
    assert row.printed_value is None


def test_side_of_levitation(rows, birth):
    row = rows["section 5, choice of ε"]
    inside = [abs(rest_position(PAPER.replace(gamma=birth + change))) < 1.0 for change in (-1e-6, 1e-6)]
    assert inside == [False, True]
    assert (row.printed_value, row.value) == (-1.0, 1.0)


def test_direction_of_the_jump(rows, birth):
    """The jump of a small orbit is along its normal, whose angle tends to that of the boundary equilibrium."""
    row = rows["section 5, reset at order ε"]
    _, _, position, _ = orbit(birth + 1e-7, 2.0, 3.3, fast=False)
    turned = cmath.phase(position / rest_position(PAPER.replace(gamma=birth)))
    assert row.value == pytest.approx(turned, abs=1e-9)
    assert abs(row.value) < 1e-6
    assert row.printed_value == math.pi / 2.0


def test_local_condition_and_slope(rows, birth):
    period = brentq(lambda period: closing(birth, period), 2.0, 3.3, xtol=1e-14)
    row = rows["(5.4)"]
    assert row.value == pytest.approx(closing(birth, period), abs=1e-12)
    assert row.printed_value == pytest.approx(2.0, abs=1e-12)
    # Slope of the exact branch, by central differences improved once.
    step = 1e-4

    def slope(step: float) -> float:
        ends = [orbit(birth + side * step, 2.0, 3.3, fast=False)[3] for side in (-1.0, 1.0)]
        return (ends[1] - ends[0]) / (2.0 * step)

    exact = (4.0 * slope(step) - slope(2.0 * step)) / 3.0
    row = rows["section 5, last display"]
    assert row.value == pytest.approx(exact, abs=1e-8)
    assert row.printed_value == pytest.approx(-exact, abs=1e-8)


def test_regions_of_grazing(found, rows):
    row = rows["section 4b"]
    assert "R1 and R4" in row.right
    assert row.value == pytest.approx(0.759065186, abs=5e-9)
    # Left of the curve, on either side of that stiffness, B1,d is no motion of the machine.
    for region in found.plane.regions:
        if region.part in ("R1.3", "R4.3"):
            omega = region.point[1]
            assert (omega > row.value) == (region.source == "R1")
            assert region.motions.orbits in (1, 3)
