"""Thresholds in closed form: against equilibria, high precision and general solvers, also in their degenerate limits."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from machines import PAPER, path, rest_position
from scipy.integrate import solve_ivp

from carom.base.outcome import InputError
from carom.closed_forms import contact_free_kick, contact_free_shock, find_equilibria, rolling, runaway_speed
from carom.closed_forms.thresholds import (
    happens_to_rubs,
    has_stable_rub,
    ranges_of,
    rolling_condition,
    rub_fold_condition,
    sustaining_speed,
    wall_condition,
)
from carom.models import jeffcott
from carom.parameters import Numbers, Parameters

MACHINE = PAPER.replace(gamma=0.15, rho=0.3)

degenerate = (
    st.fixed_dictionaries(
        {
            "gamma": st.one_of(st.sampled_from([0.0, -1e-6]), st.floats(1e-12, 1.5), st.floats(-1.5, -1e-12)),
            "omega": st.one_of(st.sampled_from([0.05, 1.0 - 1e-7, 1.0, 1.0 + 1e-7]), st.floats(0.05, 2.0)),
            "rho": st.one_of(st.sampled_from([0.0, 1e-6]), st.floats(1e-3, 2.0)),
            "phi": st.just(0.3),
            "mu": st.one_of(st.sampled_from([0.0, 1e-6, 5.0]), st.floats(0.0, 1.0)),
            "d": st.sampled_from([0.0, 0.9, 1.0]),
            "radius_ratio": st.floats(0.5, 60.0),
        }
    )
    .filter(lambda values: abs(values["gamma"]) + abs(values["omega"] - 1.0) > 1e-8)
    .map(lambda values: Parameters(**values))
)
"""No friction, no unbalance, resonance, a restitution of one, and damping of either sign among them."""


def clear(parameters):
    """Whether no condition is so close to zero that rounding of the equilibria decides."""
    kappa = 1.0 - parameters.omega**2
    size = 1e-9 * (1.0 + abs(kappa) + abs(parameters.gamma) + parameters.rho)
    stiffness = abs(complex(kappa, parameters.gamma))
    conditions = (
        parameters.rho - stiffness,
        kappa - parameters.mu * parameters.gamma,
        abs(parameters.gamma + parameters.mu * kappa) - parameters.rho * math.hypot(1.0, parameters.mu),
        parameters.gamma + 2.0 * parameters.mu,
    )
    return stiffness > 1e-7 and min(map(abs, conditions)) > size


# ------------------------------------------------------------------------------------------------ levitation


@settings(max_examples=200, deadline=None)
@given(parameters=degenerate)
def test_levitation_is_inside_the_wall_where_its_condition_is_negative(parameters):
    assume(clear(parameters))
    status = find_equilibria(jeffcott(parameters))[0].status

    assert status == ("admissible" if wall_condition(parameters) < 0.0 else "virtual")


# ------------------------------------------------------------------------------------------------ synchronous rub


@settings(max_examples=200, deadline=None)
@given(parameters=degenerate)
def test_stable_rub_exists_where_an_equilibrium_is_one(parameters):
    assume(clear(parameters))
    rubs = find_equilibria(jeffcott(parameters))[1:]

    assert has_stable_rub(parameters) == any(rub.stable and rub.status == "admissible" for rub in rubs)
    assert (rub_fold_condition(parameters) > 0.0) == bool(rubs)


@pytest.mark.parametrize("gain", ["gamma", "omega"])
@settings(max_examples=120, deadline=None)
@given(parameters=degenerate, value=st.floats(0.02, 2.0))
def test_range_of_the_rub_for_either_sign_of_the_damping(gain, parameters, value):
    assume(gain == "gamma" or abs(parameters.gamma) + abs(value - 1.0) > 1e-8)
    here = parameters.replace(**{gain: value})
    assume(clear(here))
    rubs = find_equilibria(jeffcott(here))[1:]
    found = ranges_of("rub", parameters, gain)

    assert any(low.value <= value <= high.value for low, high in found) == any(rub.normal_force > 0.0 for rub in rubs)


@pytest.mark.parametrize("mu", [0.15, 1.0, 4.0])
@pytest.mark.parametrize("edge", [1.0, -1.0])
@pytest.mark.parametrize("ahead", [0.5, -0.5])
def test_rubs_next_to_the_fold_on_both_sides_of_where_it_touches_the_circle(mu, edge, ahead):
    """Just inside the strip, outside of the disc: the rubs are pressed on the wall towards larger ``κ`` only."""
    rho, slope = 0.4, math.hypot(1.0, mu)
    kappa = rho * (0.99 * edge * mu + ahead) / slope
    gamma = rho * (0.99 * edge - ahead * mu) / slope
    machine = PAPER.replace(gamma=gamma, omega=math.sqrt(1.0 - kappa), rho=rho, mu=mu)
    rubs = find_equilibria(jeffcott(machine))[1:]

    assert [rub.normal_force > 0.0 for rub in rubs] == [ahead > 0.0] * 2
    assert has_stable_rub(machine) == any(rub.stable for rub in rubs) == (ahead > 0.0 and gamma + 2.0 * mu > 0.0)
    found = ranges_of("rub", machine, "omega")
    assert any(low.value <= machine.omega <= high.value for low, high in found) == (ahead > 0.0)


def at_fold(random, side):
    """Random parameters on a fold of rubs, ``γ + μ(1 − ω²) = ± ρ√(1 + μ²)``; damping may be negative."""
    rho, mu, omega = random.uniform(0.05, 0.8), random.uniform(0.02, 1.0), random.uniform(0.1, 1.6)
    gamma = side * rho * math.hypot(1.0, mu) - mu * (1.0 - omega**2)
    return Parameters(gamma=gamma, omega=omega, rho=rho, phi=0.3, mu=mu, d=0.9, radius_ratio=50.0)


@pytest.mark.parametrize("side", [1, -1])
def test_a_fold_happens_to_rubs_where_the_wall_pushes_them(side):
    """Against the rubs just inside the fold, for both signs of the damping."""
    random = np.random.default_rng(side + 3)
    answers = []
    for _ in range(200):
        parameters = at_fold(random, side)
        try:
            rubs = find_equilibria(parameters.replace(gamma=parameters.gamma - side * 1e-9))[1:]
        except InputError:  # undamped resonance
            continue
        forces = [rub.normal_force for rub in rubs]
        assert len(forces) == 2
        if min(map(abs, forces)) < 1e-3:
            continue
        assert forces[0] * forces[1] > 0.0
        answers.append(happens_to_rubs(Numbers.of(parameters)))
        assert answers[-1] == (forces[0] > 0.0), parameters
    assert 20 < sum(answers) < len(answers)


# ------------------------------------------------------------------------------------------------ backward whirl


@settings(max_examples=150, deadline=None)
@given(parameters=degenerate)
def test_rolling_holds_where_friction_suffices_at_every_angle(parameters):
    """Against the forces of rolling themselves, ``N = s² − ω² + ρ cos x`` and ``F = ρ sin x − γs``, at many angles."""
    speed, angles = parameters.radius_ratio, np.linspace(0.0, 2.0 * math.pi, 20001)
    normal = speed**2 - parameters.omega**2 + parameters.rho * np.cos(angles)
    spare = parameters.mu * normal - np.abs(parameters.rho * np.sin(angles) - parameters.gamma * speed)
    least = min(spare.min(), normal.min())
    # The nearest of these angles is at most 2e-4 off, which changes a sinusoid of amplitude p by 2e-8 p.
    missed = 1e-7 * parameters.rho * math.hypot(1.0, parameters.mu) + 1e-9
    assume(abs(least) > missed)

    assert rolling(parameters).holds == (least > 0.0)
    if normal.min() > 0.0:
        assert rolling_condition(parameters) == pytest.approx(spare.min(), abs=missed, rel=1e-12)


@pytest.mark.parametrize("gamma", [-1e3, -0.3, -1e-12, 0.0, 1e-12, 0.3, 1e3])
@pytest.mark.parametrize("mu", [1e-12, 1e-3, 0.15, 10.0])
@pytest.mark.parametrize("rho", [0.0, 3 / 7])
def test_sustaining_speed_in_high_precision(gamma, mu, rho):
    machine = PAPER.replace(gamma=gamma, mu=mu, rho=rho)
    with mpmath.workdps(60):
        exact = [mpmath.mpf(value) for value in (mu, gamma, 0.76, rho)]
        pull = exact[3] * mpmath.sqrt(1 + exact[0] ** 2)
        half = exact[1] / (2 * exact[0])
        certain, average = (
            half + mpmath.sqrt(half**2 + exact[2] ** 2 + push / exact[0]) for push in (pull, mpmath.mpf(0))
        )

    found = runaway_speed(machine)
    assert found.average == sustaining_speed(machine) == pytest.approx(float(average), rel=1e-14)
    assert found.certain == pytest.approx(max(float(certain), math.sqrt(0.76**2 + rho)), rel=1e-14)


# ------------------------------------------------------------------------------------------------ harmless disturbances


@pytest.mark.parametrize("omega", [1e-3, 0.76, 30.0])
@pytest.mark.parametrize("ratio", [0.0, 1e-9, 0.5, 1.0 - 1e-9, 1.0 - 1e-14, 1.0, 1.0 + 1e-14, 1.0 + 1e-9, 3.0, 16.0])
def test_harmless_kick_in_high_precision(omega, ratio):
    """``γ = 2ω`` times a ratio; the largest response to a kick is that where its rate vanishes."""
    gamma = 2.0 * omega * ratio
    machine = Parameters(gamma=gamma, omega=omega, rho=1e-6, phi=0.0, mu=0.1, d=0.9, radius_ratio=50.0)
    with mpmath.workdps(60):
        half, stiff = mpmath.mpf(gamma) / 2, mpmath.mpf(omega)
        root = mpmath.sqrt(mpmath.mpc(half**2 - stiff**2))
        if half != stiff:
            moment = mpmath.acosh(half / stiff) / root
            response = mpmath.exp(-half * moment) * mpmath.sinh(root * moment) / root
        else:
            response = mpmath.exp(-1) / stiff
        speed = (1 - abs(mpmath.mpf(1e-6) / mpmath.mpc(stiff**2 - 1, gamma))) / abs(response)
    # The speed is lowered by 1e-9; next to critical damping the response is that of critical damping.
    assert contact_free_kick(machine) == pytest.approx(float(speed), rel=2e-9)
    assert contact_free_kick(machine) <= float(speed)


@pytest.mark.parametrize("gamma", [0.0, 0.02, 0.15, 1.0, 1.6, 4.0])
def test_harmless_kicks_move_the_rotor_at_most_to_the_wall(gamma):
    """The largest deviation is that of the flight itself, whatever the direction; the bound is not wasteful."""
    machine = PAPER.replace(gamma=gamma, rho=0.2)
    rest = rest_position(machine)
    speed = contact_free_kick(jeffcott(machine))
    times = np.linspace(0.0, 12.0, 4001)
    farthest = 0.0
    for angle in np.linspace(0.0, 2.0 * math.pi, 61):
        flown = path(machine, rest, speed * np.exp(1j * angle), times)
        assert np.abs(flown).max() <= 1.0
        farthest = max(farthest, float(np.abs(flown - rest).max()))
    assert farthest == pytest.approx(1.0 - abs(rest), rel=1e-5)


@pytest.mark.parametrize("duration", [0.02, 0.7, 4.0])
def test_harmless_shocks_do_not_bring_the_rotor_to_the_wall(duration):
    """Followed in the fixed frame by a general solver through the pulse and after it, in many directions."""
    peak = contact_free_shock(jeffcott(MACHINE), duration)
    gamma, omega, rest = MACHINE.gamma, MACHINE.omega, abs(rest_position(MACHINE))

    def rate(time, state):
        push = peak * math.sin(math.pi * time / duration) if time < duration else 0.0
        return [state[1], -push - gamma * state[1] - omega**2 * state[0]]

    # The coefficients are real: the deviation stays on a line, and adds to the levitation at worst.
    during = solve_ivp(rate, (0.0, duration), [0.0, 0.0], rtol=1e-10, atol=1e-12, max_step=duration / 50)
    after = solve_ivp(rate, (duration, duration + 12.0), during.y[:, -1], rtol=1e-10, atol=1e-12, max_step=0.02)
    farthest = max(np.abs(during.y[0]).max(), np.abs(after.y[0]).max())
    assert farthest <= 1.0 - rest
    if duration < 0.1:
        assert farthest == pytest.approx(1.0 - rest, rel=1e-3)
