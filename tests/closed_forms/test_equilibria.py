"""Equilibria against the closed forms of the planar rotor and against integration of the sliding equation."""

import math

import numpy as np
import pytest
from machines import PAPER, flight_matrix, random_parameters, rest_position
from scipy.integrate import solve_ivp
from yielding_rotors import Yielding, packed, two_planes

import carom as cm
from carom import find_equilibria
from carom.base.outcome import Outcome
from carom.closed_forms import Equilibrium
from carom.models import HuntCrossley, KelvinVoigt, jeffcott
from carom.parameters import Parameters

BOUNDARY_DAMPING = math.sqrt(PAPER.rho**2 - (1.0 - PAPER.omega**2) ** 2)
RUB_FOLD = PAPER.rho * math.hypot(1.0, PAPER.mu) - PAPER.mu * (1.0 - PAPER.omega**2)


def found(parameters: Parameters) -> tuple[Equilibrium, tuple[Equilibrium, ...]]:
    first, *rubs = find_equilibria(jeffcott(parameters))
    return first, tuple(rubs)


# ------------------------------------------------------------------------------------------------ contact-free


def test_contact_free_equilibrium_solves_the_equation_of_motion():
    random = np.random.default_rng(20)
    for _ in range(50):
        parameters = random_parameters(random)
        equilibrium, _ = found(parameters)
        assert equilibrium.kind == "contact-free"
        assert equilibrium.normal_force == 0.0
        assert equilibrium.position == pytest.approx(rest_position(parameters), rel=1e-13)
        assert equilibrium.radius == pytest.approx(abs(rest_position(parameters)), rel=1e-13)
        assert equilibrium.angle == pytest.approx(np.angle(rest_position(parameters)), abs=1e-13)
        assert equilibrium.stable
        # A double exponent is conditioned like a square root.
        expected = np.linalg.eigvals(flight_matrix(parameters))
        np.testing.assert_allclose(np.poly(equilibrium.eigenvalues), np.poly(expected), atol=1e-12)


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-10])
def test_contact_free_status_changes_at_the_boundary_damping(distance):
    assert found(PAPER.replace(gamma=BOUNDARY_DAMPING * (1.0 + distance)))[0].status == "admissible"
    assert found(PAPER.replace(gamma=BOUNDARY_DAMPING * (1.0 - distance)))[0].status == "virtual"


# ------------------------------------------------------------------------------------------------------- rubs


def rub_angles(parameters: Parameters) -> list[float]:
    """Both ``x`` with ``ρ sin x + μρ cos x = −γ − μ(1 − ω²)``, as ``√(1 + μ²) ρ sin(x + arctan μ)``."""
    if parameters.rho == 0.0:
        return []
    share = -(parameters.gamma + parameters.mu * (1.0 - parameters.omega**2)) / (
        parameters.rho * math.hypot(1.0, parameters.mu)
    )
    if abs(share) > 1.0:
        return []
    turn = math.atan(parameters.mu)
    return [math.asin(share) - turn, math.pi - math.asin(share) - turn]


def normal_force(parameters: Parameters, angle: float, speed: float = 0.0) -> float:
    """``N = ρ cos x + (1 + θ̇)² − ω²`` at ``x = θ − φ``."""
    return parameters.rho * math.cos(angle) + (1.0 + speed) ** 2 - parameters.omega**2


def sliding(parameters: Parameters, angle: float, speed: float) -> float:
    """``θ̈`` of a rotor that slides forward along the wall."""
    friction = parameters.mu * normal_force(parameters, angle, speed)
    return -parameters.gamma * (1.0 + speed) - parameters.rho * math.sin(angle) - friction


def test_rubs_are_where_the_closed_form_puts_them():
    random = np.random.default_rng(21)
    seen = {0: 0, 2: 0}
    statuses = set()
    for _ in range(300):
        parameters = random_parameters(random, gamma=float(10 ** random.uniform(-2, 0.3)))
        expected = {np.round(np.exp(1j * x), 9): x for x in rub_angles(parameters)}
        _, rubs = found(parameters)
        assert len(rubs) == len(expected)
        seen[len(rubs)] += 1
        for rub in rubs:
            turned = rub.position * np.exp(-1j * parameters.phi)
            nearest = min(expected.values(), key=lambda x: abs(np.exp(1j * x) - turned))
            # The angle is conditioned like 1/cos(x + arctan μ), and like the square root of rounding at the fold.
            assert abs(np.exp(1j * nearest) - turned) < 1e-9
            force = normal_force(parameters, np.angle(turned))
            assert rub.kind == "rub"
            assert rub.radius == pytest.approx(1.0, abs=1e-15)
            assert rub.normal_force == pytest.approx(force, abs=1e-9 * (1.0 + parameters.omega**2))
            assert rub.status == ("admissible" if force > 0 else "virtual")
            assert abs(sliding(parameters, np.angle(turned), 0.0)) < 1e-9 * (1.0 + parameters.gamma)
            statuses.add(rub.status)
    assert min(seen.values()) > 30
    assert statuses == {"admissible", "virtual"}


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-10])
def test_rubs_meet_in_a_fold(distance):
    _, rubs = found(PAPER.replace(gamma=RUB_FOLD * (1.0 - distance)))
    stable, saddle = rubs
    assert stable.stable
    assert not saddle.stable
    # They part like the square root of the distance, to the next order; a double next to the fold has six digits of it.
    assert abs(stable.position - saddle.position) == pytest.approx(
        2.0 * math.sqrt(2.0 * distance * RUB_FOLD / PAPER.rho / math.hypot(1.0, PAPER.mu)), rel=distance + 1e-5
    )
    assert found(PAPER.replace(gamma=RUB_FOLD * (1.0 + distance)))[1] == ()


def test_stability_along_the_wall_is_that_of_the_sliding_equation():
    """``δθ̈ + (γ + 2μ)δθ̇ + ρ(cos x − μ sin x)δθ = 0``, from the derivatives of ``θ̈`` and ``N`` at rest."""
    random = np.random.default_rng(22)
    stabilities = []
    for _ in range(200):
        parameters = random_parameters(random, gamma=float(10 ** random.uniform(-2, 0.3)))
        for rub in found(parameters)[1]:
            x = np.angle(rub.position * np.exp(-1j * parameters.phi))
            stiffness = parameters.rho * (math.cos(x) - parameters.mu * math.sin(x))
            polynomial = [1.0, parameters.gamma + 2.0 * parameters.mu, stiffness]
            scale = 1.0 + np.abs(polynomial).max()
            np.testing.assert_allclose(np.poly(rub.eigenvalues), polynomial, atol=1e-9 * scale)
            assert rub.stable == (stiffness > 0 and rub.normal_force > 0 and parameters.d < 1.0)
            stabilities.append(rub.stable)
    assert 20 < sum(stabilities) < len(stabilities) - 20


@pytest.mark.parametrize("gamma", [0.05, 0.1, 0.2, 0.36])
def test_sliding_motion_goes_to_the_stable_rub_and_leaves_the_saddle(gamma):
    parameters = PAPER.replace(gamma=gamma)
    stable, saddle = found(parameters)[1]

    def rate(_: float, state: np.ndarray) -> list[float]:
        return [state[1], sliding(parameters, state[0], state[1])]

    target = stable.angle - parameters.phi
    start = [saddle.angle - parameters.phi, 0.0]
    nudge = 1e-6 * np.sign(np.sin(target - start[0]))
    start[0] += nudge
    brief = solve_ivp(rate, (0.0, 1.0), start, rtol=1e-12, atol=1e-14).y[:, -1]
    # Close to the saddle the disturbance follows its exponents, second-order terms being smaller by 1e-6.
    slow, fast = sorted(saddle.eigenvalues.real)
    share = nudge / (slow - fast)
    predicted = share * (slow * math.exp(fast) - fast * math.exp(slow))
    assert brief[0] - (start[0] - nudge) == pytest.approx(predicted, rel=1e-4)
    late = solve_ivp(rate, (0.0, 400.0), start, rtol=1e-10, atol=1e-12).y[:, -1]
    assert abs(np.exp(1j * (late[0] - target)) - 1.0) < 1e-7
    assert abs(late[1]) < 1e-7


# ----------------------------------------------------------------------------------------------------- corners


LAWS = [
    KelvinVoigt(100.0, 5.0),
    KelvinVoigt(1e4, 3.0),
    HuntCrossley(50.0, 0.5, 1.0),
    HuntCrossley(1e3, 0.5, 1.5),
    HuntCrossley(20.0, 0.1, 10 / 9),
    HuntCrossley(3.0, 0.1, 2.0),
]


def jacobian(rates, state, step=1e-5):
    """Derivative of rates, by central differences of fourth order."""
    columns = []
    for unit in np.eye(len(state)) * step:
        near, far = (np.subtract(rates(state + k * unit), rates(state - k * unit)) for k in (1, 2))
        columns.append((8.0 * near - far) / (12.0 * step))
    return np.array(columns).T


def alike(found, expected, tolerance):
    """Whether two sets of exponents are the same, by their characteristic polynomial's roots next to each other."""
    return all(np.abs(np.asarray(expected) - each).min() <= tolerance * (1.0 + abs(each)) for each in found)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_rubs_are_at_rest_and_their_exponents_are_those_of_the_equations_of_motion(law):
    pushing = 0
    for omega in (0.9, 1.05, 0.76):
        rotor = Yielding(law, omega=omega)
        found = cm.find_equilibria(rotor.model)
        assert found.complete
        for rub in found[1:]:
            if rub.status != "admissible":
                continue
            pushing += 1
            state = packed(rub.position, 0j)
            scale = law.stiffness * max(rub.normal_force, 1.0)
            assert np.abs(rotor.rates(state, "+")).max() < 1e-13 * scale
            assert rub.normal_force == pytest.approx(rotor.force(rub.radius - 1.0, 0.0), rel=1e-12 * scale)
            expected = np.linalg.eigvals(jacobian(lambda each, rotor=rotor: rotor.rates(each, "+"), state))
            assert alike(rub.eigenvalues, expected, 1e-7)
            assert rub.stable == bool((expected.real < 0.0).all())
    assert pushing >= 2


@pytest.mark.parametrize("law", [LAWS[0], LAWS[2]], ids=str)
def test_motions_settle_to_the_rub_that_attracts(law):
    rotor = Yielding(law, omega=0.9, gamma=0.3)
    rubs = [rub for rub in cm.find_equilibria(rotor.model)[1:] if rub.stable]
    assert len(rubs) == 1
    motion = cm.simulate(rotor.model, cm.State(0.9 * rubs[0].position, 0.02j), settle=True)
    assert motion.outcome is Outcome.FORWARD_RUB
    assert abs(motion.final.position - rubs[0].position) < 1e-7
    assert abs(motion.final.velocity) < 1e-7


def test_a_repelling_rub_is_left():
    """Friction drives a whirl in a soft wall: the rub is at rest, and no motion settles on it."""
    rotor = Yielding(HuntCrossley(20.0, 0.0, 1.0), omega=0.9, mu=0.3, gamma=0.02)
    (rub,) = (rub for rub in cm.find_equilibria(rotor.model)[1:] if rub.status == "admissible")
    assert not rub.stable
    assert rub.eigenvalues.real.max() > 0.1
    motion = cm.simulate(rotor.model, cm.State(rub.position / abs(rub.position), 0j), settle=True, max_events=2000)
    assert abs(motion.final.position - rub.position) > 1e-3
    assert motion.outcome is not Outcome.FORWARD_RUB or abs(motion.final.velocity) > 1e-3


def test_rubs_at_two_planes_balance_the_forces_on_the_coordinates():
    laws = KelvinVoigt(300.0, 4.0), HuntCrossley(500.0, 0.2, 1.0)
    model = two_planes(*laws)
    rubs = [rub for rub in cm.find_equilibria(model)[1:] if len(rub.planes) == 2 and rub.status == "admissible"]
    assert rubs
    rows, mass, damping = np.array([[1.0, 0.3], [0.4, 1.0]]), np.diag([1.0, 1.4]), 0.3 * np.eye(2)
    stiffness = np.array([[0.8, -0.1], [-0.1, 0.9]]) - mass + 1j * damping
    for rub in rubs:
        outward = rub.places / np.abs(rub.places)
        pushes = np.array([law.stiffness for law in laws]) * (np.abs(rub.places) - 1.0)
        assert pushes == pytest.approx(rub.normal_forces, rel=1e-10)
        pull = rows.T @ ((1.0 + 1j * np.array([0.1, 0.2])) * pushes * outward)
        assert np.abs(stiffness @ rub.position + pull - [1.1, 1.4 + 0.2j]).max() < 1e-10

        def rates(state):
            u, v = state[:2] + 1j * state[2:4], state[4:6] + 1j * state[6:]
            places, moving = rows @ u, rows @ v
            outward = places / np.abs(places)
            depth, rate = np.abs(places) - 1.0, (outward.conj() * moving).real
            normal = np.array([300.0 * depth[0] + 4.0 * rate[0], 500.0 * depth[1] * (1.0 + 0.2 * rate[1])])
            force = [1.1, 1.4 + 0.2j] - stiffness @ u - (damping + 2j * mass) @ v
            a = np.linalg.solve(mass, force - rows.T @ ((1.0 + 1j * np.array([0.1, 0.2])) * normal * outward))
            return np.concatenate([v.real, v.imag, a.real, a.imag])

        state = np.concatenate([rub.position.real, rub.position.imag, np.zeros(4)])
        assert alike(rub.eigenvalues, np.linalg.eigvals(jacobian(rates, state)), 1e-7)
