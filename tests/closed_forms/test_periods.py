"""The period condition ``F₁``, its bounds, and the completeness of its roots."""

import mpmath
import numpy as np
import pytest
from compilation import sized
from flint import acb, arb, ctx
from machines import PAPER, exact_return, flight_matrix, random_parameters
from scipy.linalg import expm

from carom.base.outcome import CaromError
from carom.closed_forms.periods import PeriodCondition
from carom.core.periods import curvature_bound
from carom.models import jeffcott
from carom.parameters import Parameters


def condition_of(parameters: Parameters, slip: int = 1) -> PeriodCondition:
    return PeriodCondition.of(jeffcott(parameters).system, slip)


def slip_factor(parameters: Parameters) -> complex:
    return (1.0 + parameters.d) * complex(1.0, parameters.mu)


@pytest.fixture(autouse=True)
def forty_digits():
    with mpmath.workdps(40):
        yield


def rounding(exact: mpmath.mpc, rate: mpmath.mpc, period: float) -> float:
    """What a relative error of a few ε in the terms, and in ``λT``, may do; 200 ε leaves room for their number."""
    return 200 * np.finfo(float).eps * float(1 + abs(exact) + period * abs(rate))


@pytest.mark.parametrize("turns", [1, 2, 5])
@pytest.mark.parametrize("offset", [0.0, 1e-8, 1e-4, -1e-2])
@pytest.mark.parametrize("mode", [0, 1])
def test_flight_response_near_its_resonances(turns, offset, mode):
    """With weak damping ``λT`` comes as near to ``2πik`` as ``γT/2``."""
    parameters = PAPER.replace(gamma=1e-3)
    condition = condition_of(parameters)
    period = 2.0 * np.pi * turns / abs(condition.modes[mode, 0].imag) + offset
    back, rate = exact_return(parameters, period)
    error = abs(condition.a22(np.array([period]))[0] - back[1, 1])
    assert error <= rounding(back[1, 1], rate[1, 1], period)


# ------------------------------------------------------------------------------------------------------ bounds


def exact_curvature(parameters: Parameters, periods: np.ndarray) -> np.ndarray:
    """``F₁''`` from matrices: ``a'' = A²E(1 + E)(1 − E)⁻³`` with ``E = e^{AT}``, and its negative with ``E = e^{−AT}``."""
    matrix = flight_matrix(parameters)
    flown = expm(matrix * np.copysign(periods, parameters.gamma)[:, None, None])
    inverse = np.linalg.inv(np.eye(2) - flown)
    second = matrix @ matrix @ flown @ (np.eye(2) + flown) @ inverse @ inverse @ inverse
    return (slip_factor(parameters) * second[:, 1, 1]).real


def test_curvature_never_exceeds_its_bound():
    random = np.random.default_rng(3)
    sharpest = 0.0
    for _ in range(100):
        parameters = random_parameters(random)
        condition = condition_of(parameters)
        middles = random.uniform(0.05, min(condition.longest_period(), 60.0), 5)
        half_widths = middles * 10 ** random.uniform(-4, -0.1, 5)
        each = zip(middles, half_widths, strict=True)
        bounds = [curvature_bound(condition.modes, condition.factor, middle, half) for middle, half in each]
        inside = np.abs(middles + half_widths * np.linspace(-1, 1, 21)[:, None])
        curvatures = np.abs(exact_curvature(parameters, inside.ravel())).reshape(inside.shape)
        # The inverse of 1 − e^{AT} is as large as 1/T.
        assert (curvatures <= bounds + 1e-12 / inside.min() ** 3).all()
        sharpest = max(sharpest, (curvatures.max(axis=0) / bounds).max())
    # The bound is of use: somewhere it is within a factor of ten.
    assert sharpest > 0.1


def test_without_damping_there_is_no_longest_period():
    for gamma in (0.0, -0.1):
        assert condition_of(PAPER.replace(gamma=gamma)).longest_period() == np.inf


# ------------------------------------------------------------------------------------------------ completeness


def closed_form(parameters: Parameters, periods: np.ndarray) -> np.ndarray:
    """``F₁`` from ``a₂₂ = e^{mT}((mT sinh(hT)/(hT) + cosh hT) − e^{mT})/det(1 − e^{AT})`` with ``λ± = m ± h``."""
    middle = -complex(0.5 * parameters.gamma, 1.0) * periods
    half = np.sqrt(complex(parameters.gamma**2 - 4.0 * parameters.omega**2)) / 2.0 * periods
    flown, ends = np.exp(middle), (np.exp(middle + half), np.exp(middle - half))
    near = np.abs(half) < 1e-4
    ratio = np.where(near, flown * (1.0 + half**2 / 6.0), (ends[0] - ends[1]) / np.where(near, 1.0, 2.0 * half))
    determinant = 1.0 - ends[0] - ends[1] + flown**2
    numerator = middle * ratio + 0.5 * (ends[0] + ends[1]) - flown**2
    return 1.0 + (slip_factor(parameters) * numerator / determinant).real


def sign_changes(parameters: Parameters, end: float) -> int:
    """Roots seen on a grid with 400 points to a turn of the fastest mode."""
    fastest = np.abs(np.linalg.eigvals(flight_matrix(parameters))).max()
    count = int(400 * (end * fastest / (2 * np.pi) + 1))
    values = closed_form(parameters, np.linspace(0.0, end, count + 1)[1:])
    return int(np.count_nonzero((values[1:] > 0) != (values[:-1] > 0)))


CORNERS = [
    PAPER.replace(**changes)
    for changes in (
        {"d": 1.0}, {"d": 1.0, "gamma": 0.4}, {"d": 0.0, "mu": 2.0}, {"mu": 0.0}, {"mu": 2.0}, {"gamma": 1e-3},
        {"gamma": 1e-3, "mu": 2.0, "d": 1.0}, {"gamma": 8.0, "omega": 0.05}, {"gamma": 8.0, "omega": 3.0},
        {"omega": 0.05}, {"omega": 3.0}, {"omega": 1.0}, {"omega": 1.0, "gamma": 1e-3}, {"gamma": 0.05},
    )
]  # fmt: skip


def test_number_of_roots_agrees_with_a_fine_scan():
    random = np.random.default_rng(5)
    count = sized(60, 60, 200)
    machines = CORNERS + [random_parameters(random) for _ in range(count)]
    with_roots = 0
    for parameters in machines:
        roots = condition_of(parameters).roots()
        assert roots.proven
        assert len(roots.periods) == sign_changes(parameters, roots.longest_period), parameters
        assert (np.diff(roots.periods) > 0).all()
        with_roots += len(roots.periods) > 0
    # The comparison is not about nothing.
    assert with_roots > 0.3 * count


def ball_value_and_slope(parameters: Parameters, period: arb) -> tuple[arb, arb]:
    """Enclosures of ``F₁`` and ``F₁'`` over a ball of periods."""
    gamma, omega = arb(parameters.gamma), arb(parameters.omega)
    root = acb(gamma**2 - 4 * omega**2).sqrt()
    value, slope = acb(0), acb(0)
    for sign in (1, -1):
        exponent = (acb(-gamma, -2) + sign * root) / 2
        decay = (exponent * period).exp()
        share = decay / (1 - decay)
        value += sign * exponent * share
        slope += sign * exponent**2 * share * (1 + share)
    factor = (1 + arb(parameters.d)) * acb(1, arb(parameters.mu)) / root
    return 1 + (factor * value).real, (factor * slope).real


def rigorous_root_count(parameters: Parameters, start: float, end: float) -> int:
    """Number of roots on an interval, proven in ball arithmetic."""
    count = 0
    stack = [(start, end)]
    while stack:
        left, right = stack.pop()
        middle = 0.5 * (left + right)
        value, slope = ball_value_and_slope(parameters, arb(middle, 0.5 * (right - left)))
        if value != 0:
            continue
        if slope != 0:
            ends = [ball_value_and_slope(parameters, arb(at))[0] for at in (left, right)]
            assert all(end_value != 0 for end_value in ends)
            count += bool(ends[0] > 0) != bool(ends[1] > 0)
            continue
        assert right - left > 1e-9
        stack += [(left, middle), (middle, right)]
    return count


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"gamma": 0.03},
        {"gamma": 0.17},
        {"gamma": 0.179},
        {"mu": 1.0, "gamma": 0.3},
        {"omega": 2.0, "d": 0.5, "mu": 0.6},
        # A slow mode: poles of F₁ pass by at the small distance ω²T/γ.
        {"omega": 0.03, "gamma": 0.3},
        {"omega": 0.001, "gamma": 0.152},
        {"omega": 0.001, "gamma": 3.0, "mu": 0.6},
    ],
    ids=str,
)
def test_number_of_roots_agrees_with_a_proof_in_ball_arithmetic(changes):
    parameters = PAPER.replace(**changes)
    precision, ctx.prec = ctx.prec, 100
    try:
        roots = condition_of(parameters).roots(None if parameters.omega > 0.1 else 60.0)
        # Close to T = 0 the printed form cancels; the first root is far above.
        start = 0.05
        assert rigorous_root_count(parameters, start, roots.longest_period) == np.count_nonzero(roots.periods > start)
        assert (roots.periods > start).all()
    finally:
        ctx.prec = precision


# ------------------------------------------------------------------------------------------------ double roots


def fold(parameters: Parameters, gamma: float, period: float) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Damping and period at which ``F₁ = F₁' = 0``, to forty digits."""

    stiffness = mpmath.mpf(parameters.omega) ** 2 - 1
    factor = mpmath.mpc(1, mpmath.mpf(parameters.mu)) * (1 + mpmath.mpf(parameters.d))

    def residual(damping, time):
        matrix = mpmath.matrix([[0, 1], [-mpmath.mpc(stiffness, damping), -mpmath.mpc(damping, 2)]])
        flown = mpmath.expm(matrix * time)
        inverse = (mpmath.eye(2) - flown) ** -1
        return [1 + (factor * (flown * inverse)[1, 1]).real, (factor * (matrix * flown * inverse**2)[1, 1]).real]

    damping, time = mpmath.findroot(residual, (gamma, period))
    return damping, time


@pytest.mark.parametrize(
    ("changes", "gamma", "period"),
    [({}, 0.178, 1.64), ({"mu": 0.5}, 0.5, 1.6), ({"omega": 1.5, "mu": 0.4}, 0.4, 1.3)],
    ids=["paper", "rough", "stiff"],
)
def test_roots_come_and_go_in_pairs_at_a_fold(changes, gamma, period):
    parameters = PAPER.replace(**changes)
    damping, time = fold(parameters, gamma, period)
    for power in range(2, 17):
        for sign in (1, -1):
            roots = condition_of(parameters.replace(gamma=float(damping) * (1 + sign * 10.0**-power))).roots().periods
            close = roots[np.abs(roots - float(time)) < 0.3]
            assert len(close) in (0, 2), (sign, power)
            if power <= 11:
                # Above the rounding of F₁ the side is seen.
                assert len(close) == (0 if sign > 0 else 2), (sign, power)
            if len(close) and power >= 14:
                # The roots part like the square root of what rounding does to F₁; their mean is better.
                np.testing.assert_allclose(close, float(time), atol=1e-7)


# ------------------------------------------------------------------------------------------- limits and refusals


def test_without_damping_roots_between_poles_are_found():
    """At ``γ = 0`` the condition has poles, across which its sign changes without a root."""
    roots = condition_of(PAPER.replace(gamma=0.0)).roots(30.0)
    assert not roots.proven
    periods = np.linspace(1e-4, 30.0, 300_001)
    values = closed_form(PAPER.replace(gamma=0.0), periods)
    crossing = np.flatnonzero((values[1:] > 0) != (values[:-1] > 0))
    # A pole's change of sign goes through large values.
    expected = [k for k in crossing if abs(values[k]) < 1.0]
    np.testing.assert_allclose(roots.periods, periods[expected], atol=1e-4)


@pytest.mark.parametrize("d", [0.5, 1.0])
def test_a_search_that_resonance_makes_endless_is_refused_in_bounded_work(d):
    """Without damping and friction ``F₁`` is ``(1 − d)/2`` throughout, though its parts have poles."""
    with pytest.raises(CaromError, match="too near resonance; give a shorter longest_period"):
        condition_of(PAPER.replace(gamma=0.0, mu=0.0, d=d)).roots(593.0)
