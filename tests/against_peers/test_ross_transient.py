"""Transients of levitated rotors by ROSS, against exact ones: where its integrators are right, and where they are not (docs/decisions/flexible-rotors.md).

``ross_transient.py`` has written ``ross_transient.json`` with ROSS 2.3.0.  Exact here are flights of the imported rotor by its modes, and the same with
another sign of the magnets' stiffness.
"""

import itertools
import json
from pathlib import Path

import numpy as np
import pytest

import carom as cm
from carom.parameters import TouchdownBearing
from carom.rotors import PID, FlexibleMachine, MagneticBearing, TouchdownPlane, Unbalance, read_rotor

FOLDER = Path(__file__).parent
TABLE = json.loads((FOLDER / "ross_transient.json").read_text())
WALL = TouchdownBearing("kelvin-voigt", stiffness=1e8, damping=100.0)
EXAMPLES = {"springs": ("rotor_example_with_damping", 12, (4, 31)), "magnets": ("rotor_amb_example", 27, (12, 43))}
"""Rotor, its first disc, and its bearings."""


def machine_of(name, reverse=False):
    """The machine of a table, whose magnets may have the stiffness of the other sign, which then is part of the controller."""
    example, disc, nodes = EXAMPLES[name]
    if name == "springs":
        # Magnets without stiffness of their own; the damper is exact where its filter is far faster than all else.
        bearings = [
            MagneticBearing(node, 1.0, 0.0, PID(TABLE["spring"][0], 0.0, TABLE["spring"][1], 1e-8)) for node in nodes
        ]
    else:
        magnet = TABLE["magnet"]
        more = -2.0 * magnet["ks"] / magnet["ki"] if reverse else 0.0
        controller = PID(magnet["kp_pid"] + more, 0.0, magnet["kd_pid"], 1.0 / magnet["n_f"])
        bearings = [MagneticBearing(node, magnet["ki"], magnet["ks"], controller) for node in nodes]
    touchdowns = [TouchdownPlane(node, WALL, 0.02, 0.1) for node in (disc, *nodes)]
    rotor = read_rotor(FOLDER / "ross_imports" / f"{example}.npz")
    return FlexibleMachine(rotor, TABLE["speed"], 1e-3, bearings, touchdowns, [Unbalance(disc, TABLE["unbalance"])])


def exact(name, modes, reverse=False):
    """Displacements (n, 3) from rest in the centre, in m and in the fixed frame, by so many modes of the free rotor."""
    model = machine_of(name, reverse).with_modes(modes).linear
    system, nowhere = model.system, np.zeros(len(model.system.rest))
    times = np.linspace(0.0, TABLE["end"] * TABLE["speed"], 51)
    # A rotor at rest in the centre of the fixed frame is at rest in that of the shaft too.
    flown = system.fly(system.amplitudes(nowhere, nowhere), times)
    planes = [system.at_plane(flown, plane)[0] * np.exp(1j * times) for plane in range(3)]
    assert np.abs(planes).max() < 1.0
    return np.stack(planes, axis=1) * model.scales.length


@pytest.mark.jit_only
def test_a_motion_that_is_simulated_is_this_flight():
    model = machine_of("magnets").with_modes(4).linear
    nowhere = np.zeros(len(model.system.rest))
    motion = cm.simulate(model, cm.State(nowhere, nowhere), f"{TABLE['end']} s")
    times = np.linspace(0.0, motion.time, 51)
    found = [motion.seen_at(plane).position(times, "fixed") for plane in range(3)]
    assert np.stack(found, axis=1) * model.scales.length == pytest.approx(exact("magnets", 4), rel=1e-9, abs=1e-15)


def by_ross(name, method):
    """Displacements of each step, and the steps."""
    runs = [run for run in TABLE["runs"] if (run["rotor"], run["method"]) == (name, method)]
    moved = np.array([run["x"] for run in runs])
    return moved[..., 0] + 1j * moved[..., 1], [run["step"] for run in runs]


def errors(name, method, solution):
    found, steps = by_ross(name, method)
    assert steps == sorted(steps, reverse=True)
    return [float(np.linalg.norm(each - solution) / np.linalg.norm(solution)) for each in found]


@pytest.fixture(scope="module")
def springs():
    return exact("springs", 14)


@pytest.fixture(scope="module")
def magnets():
    """With the stiffness of the magnets, and with its sign reversed."""
    return exact("magnets", 14), exact("magnets", 14, reverse=True)


def test_modes_that_are_left_out_do_not_matter(springs):
    """Far more modes change the motion by less than the differences below."""
    finer = exact("springs", 22)
    assert np.linalg.norm(finer - springs) < 2e-7 * np.linalg.norm(springs)


def test_the_default_integrator_is_right_on_springs(springs):
    """Half the step, a quarter of the error."""
    found = errors("springs", "default", springs)
    assert found[0] < 1e-4
    assert [coarse / fine for coarse, fine in itertools.pairwise(found)] == pytest.approx([4.0, 4.0], rel=0.02)


def test_newmark_is_of_first_order_where_a_force_acts_from_the_beginning(springs):
    """It begins with no acceleration, so the average acceleration of its first step is half of the true one; the method would be of second order."""
    found = errors("springs", "newmark", springs)
    assert found[0] == pytest.approx(6.3e-3, rel=0.02)
    assert [coarse / fine for coarse, fine in itertools.pairwise(found)] == pytest.approx([2.0, 2.0], rel=0.02)


def test_newmark_on_magnets_tends_to_a_rotor_whose_magnets_push_back(magnets):
    """Its controller has ``F = −ki u + ks x`` with ``ks < 0`` where its bearings have the stiffness ``ki C + ks``: the motion is a third off."""
    right, reverse = (errors("magnets", "newmark", each) for each in magnets)
    assert min(right) > 0.3
    assert [coarse / fine for coarse, fine in itertools.pairwise(reverse)] == pytest.approx([2.0, 2.0], rel=0.03)
    assert reverse[-1] < 5e-3


def test_the_default_integrator_has_no_controller(magnets):
    """Stiffness and damping at the speed of the shaft stand for it: right in the end, 1.7 % off in the transient whatever the step."""
    right, _ = (errors("magnets", "default", each) for each in magnets)
    assert right == pytest.approx(3 * [1.745e-2], rel=2e-3)
