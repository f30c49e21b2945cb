"""Linear results of levitating rotors: whirls, response to unbalance and sensitivity, against finite elements written down anew and closed forms."""

import numpy as np
import pytest
from flexible_machines import munich, symmetric

from carom.base.outcome import InputError
from carom.rotors import Unbalance, campbell, find_whirls, sensitivity, synchronous_response

MACHINE = munich(0.06, unbalances=[Unbalance(7, "20 g mm"), Unbalance(3, "5 g mm", "90 deg")])


def dynamic(machine, exponent, closed=True, speed=None):
    """Dynamic stiffness of the finite elements, with the bearings as complex stiffnesses, and the rows of bearings and sensors."""
    rotor, speed = machine.rotor, machine.speed if speed is None else speed
    matrix = rotor.matrices.stiffness + exponent**2 * rotor.matrices.mass
    matrix = matrix + exponent * (rotor.damping_matrix - 1j * speed * rotor.matrices.gyroscopic)
    pulls, seen = np.zeros((2, len(machine.bearings), len(matrix)))
    for number, each in enumerate(machine.bearings):
        pulls[number, 2 * rotor.place_of(each.node)] = 1.0
        for node in each.sensor_nodes:
            seen[number, 2 * rotor.place_of(node)] += 1.0 / len(each.sensor_nodes)
        matrix = matrix + each.ks * np.outer(pulls[number], pulls[number])
        if closed:
            matrix = matrix + each.ki * complex(each.loop.at(exponent)) * np.outer(pulls[number], seen[number])
    return matrix, pulls, seen


def test_whirls_solve_the_equations_of_the_finite_elements():
    rotor = MACHINE.rotor
    for whirl in find_whirls(MACHINE):
        matrix, _, _ = dynamic(MACHINE, whirl.exponent)
        _, sizes, vectors = np.linalg.svd(
            matrix / np.sqrt(np.outer(np.diag(rotor.matrices.stiffness), np.diag(rotor.matrices.stiffness)))
        )
        # Singular, to the rounding of a matrix whose largest is one.
        assert sizes[-1] < 1e-13
        shape = (vectors[-1].conj() / np.sqrt(np.diag(rotor.matrices.stiffness)))[::2]
        shape /= shape[np.abs(whirl.shape).argmax()] / whirl.shape[np.abs(whirl.shape).argmax()]
        assert shape == pytest.approx(whirl.shape, abs=1e-6)


def test_unbalance_response_is_that_of_the_finite_elements():
    speeds = [40.0, 105.0, 314.0, 900.0]
    found, rotor = synchronous_response(MACHINE, speeds), MACHINE.rotor
    for number, speed in enumerate(speeds):
        matrix, _, seen = dynamic(MACHINE, 1j * speed, speed=speed)
        push = np.zeros(len(matrix), complex)
        for each in MACHINE.unbalances:
            push[2 * rotor.place_of(each.node)] += speed**2 * each.size * np.exp(1j * each.angle)
        answer = np.linalg.solve(matrix, push)
        places = [2 * rotor.place_of(each.node) for each in MACHINE.touchdowns]
        assert found.touchdowns.forward[number] == pytest.approx(answer[places], rel=1e-8)
        assert found.sensors.forward[number] == pytest.approx(seen @ answer, rel=1e-8)
        gains = [complex(each.loop.at(1j * speed)) for each in MACHINE.bearings]
        assert found.currents.forward[number] == pytest.approx(gains * (seen @ answer), rel=1e-8)
    assert found.reach.max() > 0.0
    assert set(found.zones) <= set("ABCD")


def test_the_model_that_levitates_whirls_with_that_amplitude():
    """Reduced, in its own units: at rest in the frame that turns."""
    reduced = MACHINE.reduce()
    found = synchronous_response(MACHINE, [MACHINE.speed]).touchdowns.forward[0] / MACHINE.clearance
    assert reduced.linear.equations.planes @ reduced.linear.system.rest == pytest.approx(found, rel=1e-3)
    whole = MACHINE.whole.linear
    assert whole.equations.planes @ whole.system.rest == pytest.approx(found, rel=1e-9)


def test_sensitivity_is_what_the_controller_sees_of_an_added_signal():
    frequencies = [20.0, 110.0, 400.0, 3000.0]
    found = sensitivity(MACHINE, frequencies)
    for row, frequency in zip(found.values, frequencies, strict=True):
        both = []
        for s in (1j * frequency, -1j * frequency):
            matrix, pulls, seen = dynamic(MACHINE, s)
            answers = [
                1.0 - row @ np.linalg.solve(matrix, pull * each.ki * complex(each.loop.at(s)))
                for row, pull, each in zip(seen, pulls, MACHINE.bearings, strict=True)
            ]
            both.append(np.array(answers))
        assert row == pytest.approx(0.5 * (both[0] + both[1].conj()), rel=1e-8)


def test_sensitivity_of_a_rigid_rotor_on_bearings_alike():
    """Both bearings act on the translation and on the tilt: half of each loop's sensitivity is that of either, for one speed at which none turns it."""
    machine = symmetric(4e3, speed=1e-3)
    rotor, (bearing, _) = machine.rotor, machine.bearings
    frequencies = np.array([60.0, 300.0, 700.0])
    gain, s = bearing.ki * bearing.loop.at(1j * frequencies), 1j * frequencies
    arm = 0.2**2
    moves = [
        1.0 / (rotor.mass / 2.0 * s**2 + bearing.ks),
        1.0 / (rotor.diametral_inertia / (2.0 * arm) * s**2 + bearing.ks),
    ]
    expected = sum(0.5 / (1.0 + gain * each) for each in moves)
    found = sensitivity(machine, frequencies.tolist())
    assert found.values[:, 0] == pytest.approx(expected, rel=1e-3)
    assert found.values[:, 1] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: find_whirls(1), r"^flexible = 1: "),
        (lambda: find_whirls(MACHINE, -1.0), r"^speed = -1.0: a finite number above 0"),
        (lambda: campbell(MACHINE, []), r"^speeds = \[\]: "),
        (lambda: campbell(MACHINE, [0.0]), r"^speeds = \[0.0\]: one or more numbers above 0, in rad/s$"),
        (lambda: sensitivity(munich(bearings=())), r"^bearings = nothing given: one or more carom.rotors.Magnetic"),
        (lambda: sensitivity(MACHINE, [-5.0]), r"^speeds = \[-5.0\]: one or more numbers above 0"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(make, says):
    with pytest.raises(InputError, match=says):
        make()
