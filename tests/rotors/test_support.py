"""Anisotropic supports, against the equations of two real planes written down anew."""

import dataclasses

import numpy as np
import pytest
from flexible_machines import munich, replaced

import carom as cm
from carom.base.outcome import InputError
from carom.rotors import Support, Unbalance, find_whirls, sensitivity, synchronous_response

SEAL = Support(7, kxx="2e5 N/m", kyy=5e4, kxy=3e4, kyx=-1e4, cxx=20.0, cyy=50.0, cxy=5.0)
MACHINE = munich(0.06, unbalances=[Unbalance(7, "20 g mm"), Unbalance(3, "5 g mm", "90 deg")], supports=[SEAL])


def planes(machine, exponent=None):
    """Stiffness, damping and mass (4N, 4N) of displacements and tilts in x, then in y; magnetic bearings act at an exponent, if one is given."""
    rotor = machine.rotor
    n = len(rotor.matrices.mass)
    both = np.eye(2)
    turning = np.array([[0.0, 1.0], [-1.0, 0.0]])  # −iG ż of z = x + iy
    mass, stiffness = np.kron(both, rotor.matrices.mass), np.kron(both, rotor.matrices.stiffness).astype(complex)
    damping = np.kron(both, rotor.damping_matrix) + machine.speed * np.kron(turning, rotor.matrices.gyroscopic)
    for each in machine.supports:
        place = 2 * rotor.place_of(each.node)
        at = np.ix_((place, n + place), (place, n + place))
        stiffness[at] += np.array([[each.kxx, each.kxy], [each.kyx, each.kyy]])
        damping[at] += np.array([[each.cxx, each.cxy], [each.cyx, each.cyy]])
    for each in machine.bearings if exponent is not None else ():
        for shift in (0, n):
            place = shift + 2 * rotor.place_of(each.node)
            stiffness[place, place] += each.ks
            for node in each.sensor_nodes:
                seen = shift + 2 * rotor.place_of(node)
                stiffness[place, seen] += each.ki * complex(each.loop.at(exponent)) / len(each.sensor_nodes)
    return mass, damping, stiffness


def size_of(machine):
    return len(machine.rotor.matrices.mass)


def test_whirls_solve_the_equations_of_both_planes():
    n = size_of(MACHINE)
    for whirl in find_whirls(MACHINE):
        mass, damping, stiffness = planes(MACHINE, whirl.exponent)
        matrix = stiffness + whirl.exponent * damping + whirl.exponent**2 * mass
        scale = np.sqrt(np.diag(planes(MACHINE)[2]).real)
        _, sizes, vectors = np.linalg.svd(matrix / np.outer(scale, scale))
        # Singular, to the rounding of a matrix whose largest is one.
        assert sizes[-1] < 1e-12
        along, across = np.split(vectors[-1].conj() / scale, 2)
        # x = Re(X e^{λt}): z = ½ (X + iY) e^{λt} + ½ conj(X − iY) e^{λ̄t}.
        ahead, behind = 0.5 * (along + 1j * across)[:n:2], 0.5 * (along - 1j * across)[:n:2].conj()
        turn = whirl.shape[np.abs(whirl.shape).argmax()] / ahead[np.abs(whirl.shape).argmax()]
        assert turn * ahead == pytest.approx(whirl.shape, abs=1e-6)
        assert turn.conjugate() * behind == pytest.approx(whirl.opposite, abs=1e-6)
        prevails = np.linalg.norm(whirl.shape) > np.linalg.norm(whirl.opposite)
        assert prevails or whirl.sense == "straight"
        sizes = np.abs(whirl.shape) + np.abs(whirl.opposite)
        assert sizes.max() == pytest.approx(1.0)
        assert np.abs(whirl.widest).max() == pytest.approx(1.0)


@pytest.mark.parametrize("speed", [100.0, 330.0, 900.0])
def test_response_to_unbalance_goes_round_the_ellipses_of_both_planes(speed):
    machine = replaced(MACHINE, speed=speed)
    rotor, n = machine.rotor, size_of(machine)
    mass, damping, stiffness = planes(machine, 1j * speed)
    force = np.zeros(2 * n, complex)
    for each in machine.unbalances:
        turn = each.size * speed**2 * np.exp(1j * each.angle)
        force[2 * rotor.place_of(each.node)] += turn  # x = Re(turn e^{iΩt}), y = Im(...)
        force[n + 2 * rotor.place_of(each.node)] += -1j * turn
    answer = np.linalg.solve(stiffness + 1j * speed * damping - speed**2 * mass, force)
    places = np.array([2 * rotor.place_of(each.node) for each in machine.touchdowns])
    angles = np.linspace(0.0, 2.0 * np.pi, 7200, endpoint=False)
    turns = np.exp(1j * angles)[:, None]
    path = (answer[places] * turns).real + 1j * (answer[n + places] * turns).real

    found = synchronous_response(machine, [speed])
    ellipses = found.touchdowns
    assert path == pytest.approx(ellipses.forward[0] * turns + ellipses.backward[0] / turns, rel=1e-8, abs=1e-14)
    assert ellipses.major[0] == pytest.approx(np.abs(path).max(axis=0), rel=1e-6)
    assert np.abs(ellipses.minor[0]) == pytest.approx(np.abs(path).min(axis=0), rel=1e-5)
    farthest = path[np.abs(path).argmax(axis=0), range(len(places))]
    assert np.abs(np.exp(2j * ellipses.direction[0]) - (farthest / np.abs(farthest)) ** 2).max() < 2e-3
    without = found.reach[0] - found.sags / found.clearances
    assert without == pytest.approx(np.abs(path).max(axis=0) / np.array(machine.clearances), abs=1e-6)


def test_the_model_levitates_round_the_same_ellipse():
    machine = replaced(MACHINE, gravity=None)
    whole = machine.whole
    found, system = synchronous_response(machine, [machine.speed]).touchdowns, whole.model.system
    assert system.arrays["offsets"] * machine.clearance == pytest.approx(found.forward[0], rel=1e-7)
    behind = system.arrays["rows"][:, system.arrays["anisotropy"][0]] * machine.clearance
    assert behind == pytest.approx(found.backward[0], rel=1e-7)
    # Their exponents are the whirls, and the conjugates of these.
    slowest = sorted(find_whirls(machine), key=lambda each: each.frequency)[:6]
    own = (system.exponents + 1j) * machine.speed
    for whirl in slowest:
        for exponent in (whirl.exponent, whirl.exponent.conjugate()):
            assert np.abs(own - exponent).min() < 1e-6 * abs(exponent)


def test_static_sag_is_that_of_both_planes():
    machine = replaced(MACHINE, bearings=[], supports=[SEAL, Support(3, 1e5, 2e5), Support(11, 2e5, 1e5, kxy=1e4)])
    rotor, n = machine.rotor, size_of(machine)
    _, _, stiffness = planes(machine)
    weight = np.zeros(2 * n)
    weight[n:] = -machine.gravity.acceleration * rotor.matrices.mass @ np.tile([1.0, 0.0], n // 2)
    sag = np.linalg.solve(stiffness.real, weight)
    place = 2 * rotor.place_of(machine.touchdowns[0].node)
    system = machine.whole.model.system
    found = system.arrays["rows"][0] @ system.outer * machine.clearance
    assert found == pytest.approx(sag[place] + 1j * sag[n + place], rel=1e-6)


def test_sensitivity_is_the_worse_of_both_axes():
    frequencies = [200.0, 380.0, 416.3]
    found = sensitivity(MACHINE, frequencies)
    n, rotor = size_of(MACHINE), MACHINE.rotor
    for place, frequency in enumerate(frequencies):
        s = 1j * frequency
        mass, damping, stiffness = planes(replaced(MACHINE, bearings=[]))
        matrix = stiffness + s * damping + s * s * mass
        pulls, seen, gains = [], [], []
        for shift in (0, n):
            for each in MACHINE.bearings:
                pull, row = np.zeros((2, 2 * n))
                at = shift + 2 * rotor.place_of(each.node)
                pull[at], matrix[at, at] = 1.0, matrix[at, at] + each.ks
                for node in each.sensor_nodes:
                    row[shift + 2 * rotor.place_of(node)] += 1.0 / len(each.sensor_nodes)
                pulls, seen = [*pulls, pull], [*seen, row]
                gains.append(each.ki * complex(each.loop.at(s)))
        opened = np.array(seen) @ np.linalg.solve(matrix, np.array(pulls).T) * gains
        own = np.diag(np.linalg.inv(np.eye(4) + opened)).reshape(2, 2)
        axis = [int(np.abs(own[0, number] - found.values[place, number]) > 1e-8) for number in range(2)]
        assert found.values[place] == pytest.approx(own[axis, range(2)], rel=1e-8)


def test_a_support_that_drives_whirl_is_refused():
    with pytest.raises(InputError, match="grows"):
        _ = replaced(MACHINE, supports=[Support(7, 1e5, 1e5, 1e6, -1e6)]).with_modes(6).linear


@pytest.mark.parametrize(
    ("changes", "words"),
    [({"node": 30}, "node of the shaft"), ({"kxx": "3 kg"}, "stiffness"), ({"cxy": float("nan")}, "finite|damping")],
)
def test_bad_supports_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        replaced(MACHINE, supports=[dataclasses.replace(SEAL, **changes)])


@pytest.mark.parametrize(
    "verb",
    [
        lambda rotor: cm.find_equilibria(rotor),
        lambda rotor: cm.closed_forms.small_cycles(rotor),
    ],
)
def test_what_rests_on_alike_directions_is_refused(verb):
    with pytest.raises(InputError, match="anisotropic bearings"):
        verb(MACHINE.with_modes(3).linear)
