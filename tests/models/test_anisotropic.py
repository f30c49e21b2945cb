"""Rotors whose bearings are anisotropic, against the plain equations of motion in the fixed frame."""

import numpy as np
import pytest
from limited_reference import follow, struck
from scipy.linalg import expm

import carom as cm
from carom.base.outcome import InputError, Phase
from carom.models import Force, KelvinVoigt, Rigid, Touchdown, from_matrices
from carom.motions import State, energy_ledger

MASS = np.diag([1.0, 0.3])
GYROSCOPIC = np.diag([0.0, 0.2])
STIFFNESS = np.array([[0.6, 0.1], [0.1, 0.4]])
DAMPING = 0.05 * np.eye(2) + 0.1 * STIFFNESS
ACROSS = np.stack(
    [
        0.03 * np.eye(2) + 0.01j * np.array([[0.0, 1.0], [1.0, 0.0]]),
        np.array([[0.15 + 0.05j, 0.02], [0.02, 0.1]]),
    ]
)
UNBALANCE = np.array([0.1 + 0.05j, 0.0])
ROW = np.array([1.0, 0.2])
FELT = 1.0 / (ROW @ np.linalg.solve(MASS, ROW))
WEIGHT = -0.02j
START = State(np.array([0.2 + 0.1j, -0.1]), np.array([1.0j, 0.4]))
SOFT = KelvinVoigt(stiffness=200.0, damping=0.5)


def rotor_of(law=SOFT, friction=0.15, surface_speed=8.0, conjugate=ACROSS, **changes):
    given = {"mass": MASS, "damping": DAMPING, "stiffness": STIFFNESS, "gyroscopic": GYROSCOPIC, "forcing": UNBALANCE}
    planes = [Touchdown(ROW, law, friction, surface_speed)]
    return from_matrices(**{**given, **changes}, touchdowns=planes, translation=[1.0, 0.0], conjugate=conjugate)


def has_mass(rotor):
    return rotor.under(Force(-1j, np.array([WEIGHT, 0.0])))


def fixed(state, time):
    """Coordinates and velocities in the fixed frame, as one vector."""
    turn = np.exp(1j * time)
    return np.concatenate([state.position * turn, (state.velocity + 1j * np.asarray(state.position)) * turn])


def rates(push):
    """Rates of that vector, under a contact force on the plane by its displacement and velocity."""

    def found(time, state):
        place, speed = state[:2], state[2:]
        force = UNBALANCE * np.exp(1j * time) + MASS @ [WEIGHT, 0.0] + ROW * push(ROW @ place, ROW @ speed)
        force = force - (DAMPING - 1j * GYROSCOPIC) @ speed - STIFFNESS @ place
        force = force - ACROSS[0] @ speed.conj() - ACROSS[1] @ place.conj()
        return np.concatenate([speed, np.linalg.solve(MASS, force)])

    return found


def test_flights_are_those_of_the_real_equations():
    rotor = rotor_of(forcing=np.zeros(2))
    spin, across = DAMPING - 1j * GYROSCOPIC, ACROSS

    def real(matrix, conjugate):  # A z + B z̄ of the real and the imaginary parts
        ahead, behind = matrix + conjugate, matrix - conjugate
        return np.block([[ahead.real, -behind.imag], [ahead.imag, behind.real]])

    masses = np.linalg.inv(np.kron(np.eye(2), MASS))
    forces = np.concatenate([real(STIFFNESS, across[1]), real(spin, across[0])], axis=1)
    generator = np.concatenate([np.eye(4, 8, 4), -masses @ forces])
    begins, time = 0.3, 7.0
    system = rotor.system
    amplitudes = system.amplitudes(START.position, START.velocity, begins)
    start = fixed(START, begins)
    vector = np.concatenate([start[:2].real, start[:2].imag, start[2:].real, start[2:].imag])
    end = expm(generator * time) @ vector

    position, _ = system.state(system.fly(amplitudes, np.array(time)))
    found = position * np.exp(1j * (begins + time))
    assert found.real == pytest.approx(end[:2], abs=1e-12)
    assert found.imag == pytest.approx(end[2:4], abs=1e-12)
    eigenvalues = np.linalg.eigvals(generator)
    # In an order that rounding of the real parts, equal in pairs, does not change.
    found, expected = (
        sorted(each, key=lambda one: (round(one.real, 9), one.imag)) for each in (system.exponents + 1j, eigenvalues)
    )
    assert found == pytest.approx(expected, abs=1e-12)


def test_states_come_back_from_amplitudes_at_any_time():
    system = has_mass(rotor_of()).system
    for time in (0.0, 1.3, 8.1):
        amplitudes = system.amplitudes(START.position, START.velocity, time)
        position, velocity = system.state(amplitudes)
        assert position == pytest.approx(START.position, abs=1e-14)
        assert velocity == pytest.approx(START.velocity, abs=1e-14)


def test_unbalance_leads_round_an_ellipse():
    rotor = rotor_of()
    ahead = STIFFNESS - MASS + 1j * (DAMPING - 1j * GYROSCOPIC)  # of e^{it}
    behind = STIFFNESS - MASS - 1j * (DAMPING - 1j * GYROSCOPIC)  # of e^{-it}
    forward, backward = rotor.system.rest, rotor.system.backward_whirl
    # Z = p e^{it} + q e^{-it}: the conjugate of one part acts on the other.
    across = ACROSS[1] - 1j * ACROSS[0], ACROSS[1] + 1j * ACROSS[0]
    assert ahead @ forward + across[1] @ backward.conj() == pytest.approx(UNBALANCE, abs=1e-14)
    assert behind @ backward + across[0] @ forward.conj() == pytest.approx(0.0, abs=1e-14)
    turns = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 2001))
    reach = np.abs(ROW @ (np.outer(forward, turns) + np.outer(backward, turns.conj()))).max()
    assert rotor.system.rest_radius == pytest.approx(reach, rel=1e-5)


def test_weight_lets_it_sag_as_the_real_equations_say():
    system = has_mass(rotor_of()).system
    sag = system.shapes @ system.outer
    force = STIFFNESS @ sag + ACROSS[1] @ sag.conj()
    assert force == pytest.approx(MASS @ np.array([WEIGHT, 0.0]), abs=1e-14)


@pytest.mark.parametrize("friction", [0.15, 0.0])
def test_motions_in_a_wall_that_gives_way_are_those_of_a_general_integrator(friction):
    motion = cm.simulate(has_mass(rotor_of(friction=friction)), START, 12.0)

    def push(place, speed):
        normal = place / abs(place)
        depth, rate = abs(place) - 1.0, (normal.conjugate() * speed).real
        # The surface of the rotor is so fast that it always slips forward.
        size = max(200.0 * depth + 0.5 * rate, 0.0) if depth > 0.0 else 0.0
        return -size * (1.0 + 1j * friction) * normal

    final, _ = follow(rates(push), fixed(START, 0.0), 12.0)

    entered = (motion.segment_phases[1:, 0] != Phase.FLIGHT) & (motion.segment_phases[:-1, 0] == Phase.FLIGHT)
    assert entered.sum() == 2
    # The integrator steps over the kink where the force ends.
    assert fixed(motion.final, 12.0) == pytest.approx(final, abs=1e-9)
    assert energy_ledger(motion).imbalance < 1e-12


def test_rigid_impacts_are_those_of_a_general_integrator():
    motion = cm.simulate(has_mass(rotor_of(Rigid(0.8))), START, 9.0)

    def after(_time, state):
        place, speed = ROW @ state[:2], ROW @ state[2:]
        change = struck(place, speed, 0.8, 0.15, 7.0) - speed
        return np.concatenate([state[:2], state[2:] + np.linalg.solve(MASS, ROW) * FELT * change])

    final, impacts = follow(
        rates(lambda place, speed: 0.0),
        fixed(START, 0.0),
        9.0,
        ends=lambda time, state: abs(ROW @ state[:2]) ** 2 - 1.0,
        after=after,
    )

    assert motion.contacts.time == pytest.approx(impacts, abs=1e-9)
    assert fixed(motion.final, 9.0) == pytest.approx(final, abs=1e-9)
    assert energy_ledger(motion).imbalance < 1e-12


@pytest.mark.parametrize("rotor", [rotor_of(), has_mass(rotor_of())])
def test_what_needs_alike_bearings_is_refused(rotor):
    with pytest.raises(InputError, match="anisotropic bearings"):
        cm.find_equilibria(rotor)
