"""Rubs in compliant walls, against their equations of motion written down a second time."""

import numpy as np
import pytest
from yielding_rotors import Yielding, packed, two_planes

import carom as cm
from carom.base.outcome import Outcome
from carom.models import HuntCrossley, KelvinVoigt

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
