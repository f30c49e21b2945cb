"""Flexible rotors on magnetic bearings: closed loops, reduction, drops, and the limit of a rigid rotor."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import scipy.signal
from compilation import sized
from flexible_machines import munich, munich_rotor, replaced, symmetric
from refusals import assert_refused

import carom as cm
from carom.base.outcome import InputError, Outcome
from carom.parameters import Gravity, TouchdownBearing
from carom.rotors import (
    PID,
    MagneticBearing,
    TouchdownPlane,
    Unbalance,
    campbell,
    find_whirls,
    load_machine,
    sensitivity,
)
from carom.rotors.equations import equations_of
from carom.rotors.reduction import contact_error, damping_of_basis

MACHINE = munich()


def exponents_of(reduced):
    """Exponents of a model in the fixed frame, 1/s."""
    return (reduced.linear.system.exponents + 1j) * reduced.machine.speed


def test_the_error_told_is_that_of_the_forces():
    """Against all modes: the estimate tells the error to a factor of two."""
    for modes in (4, 8, 12):
        reduced = MACHINE.with_modes(modes)
        every = MACHINE.with_modes(1000)
        row = np.zeros(len(MACHINE.rotor.matrices.mass))
        row[2 * MACHINE.rotor.place_of(2)] = 1.0
        true = contact_error(MACHINE.rotor, reduced.basis, every.basis, row, 1e7)
        assert 0.5 < reduced.error / true < 2.0
    assert every.error == 0.0


def forces_of_damped_motion(basis, row, stiffness, times, damping):
    """Force on a wall by the matrix exponential of the damped equations, by the speed with which the rotor comes straight."""
    reach, still = row @ basis.shapes, np.zeros((len(basis.frequencies),) * 2)
    held = np.diag(basis.frequencies**2) + stiffness * np.outer(reach, reach)
    step = scipy.linalg.expm(np.block([[still, still + np.eye(len(still))], [-held, -damping]]) * times[1])
    states = [np.eye(2 * len(still))[len(still)] / reach[0]]
    for _ in times[1:]:
        states.append(step @ states[-1])
    return stiffness * np.array(states)[:, : len(still)] @ reach


@pytest.mark.parametrize("stiffness", [1e7, 1e8])
def test_the_error_is_that_of_the_damped_rotor(stiffness):
    """The damping of a mode of rotor and wall by itself, in place of what couples them, changes the error by less than a half."""
    rotor, few, every = MACHINE.rotor, MACHINE.basis(9), MACHINE.basis(1000)
    row = np.zeros(len(rotor.matrices.mass))
    row[2 * rotor.place_of(2)] = 1.0
    times = np.linspace(0.0, 2.0 * np.pi * np.sqrt(rotor.mass / stiffness), 600)
    one, other = (
        forces_of_damped_motion(basis, row, stiffness, times, damping_of_basis(rotor, basis)) for basis in (few, every)
    )
    lasts = slice(0, np.flatnonzero(other[1:] <= 0.0)[0] + 2)
    exact = np.linalg.norm((one - other)[lasts]) / np.linalg.norm(other[lasts])
    assert 0.9 < contact_error(rotor, few, every, row, stiffness) / exact < 1.5


def test_a_steady_force_bends_the_reduced_rotor_as_all_modes_do():
    """At bearings, sensors and touchdown bearings no compliance is lost, however few modes are kept."""
    few, every = MACHINE.with_modes(2).equations, MACHINE.with_modes(1000).equations
    sags = [given.rows.touchdowns @ np.linalg.solve(given.stiffness, given.rows.touchdowns.T) for given in (few, every)]
    assert sags[0] == pytest.approx(sags[1], rel=1e-9)


def rigid(machine, s):
    """What vanishes at the exponents of the translation of a rigid rotor on two bearings alike."""
    bearing = machine.bearings[0]
    return machine.rotor.mass * s**2 + 2.0 * (bearing.ki * complex(bearing.loop.at(s)) + bearing.ks)


def test_a_stiff_rotor_moves_as_a_rigid_one_on_its_controllers():
    """``m s² + 2 (ki C(s) + ks) = 0`` for the translation; the distance falls with the stiffness of the shaft."""
    errors = []
    for stiffer in (100.0, 1000.0):
        machine = symmetric(stiffer)
        found = exponents_of(machine.with_modes(4))
        exact = found[np.abs(found - 200j).argmin()]
        for _ in range(30):  # Newton
            missing, slope = rigid(machine, exact), (rigid(machine, exact + 1e-3) - rigid(machine, exact - 1e-3)) / 2e-3
            exact -= missing / slope
        errors.append(np.abs(found - exact).min())
    assert errors[1] < 1e-3 * abs(exact)
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=1e-3)


def test_without_integral_the_rotor_sags_by_its_weight():
    machine = symmetric(4e3, gravity=Gravity(carried_by="stiffness"))
    position, _ = machine.model.system.kicked(0.0)
    sag = machine.model.system.planes @ position
    expected = machine.rotor.mass * 9.81 / (2.0 * (50.0 * 9000.0 - 1e5)) / machine.clearance
    # A shaft that is thousands of times as stiff as steel.
    assert sag == pytest.approx(np.full(2, -1j * expected), rel=1e-4)


@pytest.mark.jit_only
def test_a_drop_from_the_centre_is_free_fall_and_then_a_mass_on_springs():
    """``√(2c/g)``, and ``F = mg(1 + √(1 + 2kc/mg))``, half of it at each bearing, for a stiff shaft: the error falls with the stiffness."""
    errors = []
    for stiffer in (30.0, 300.0):
        machine = symmetric(stiffer)
        model = machine.with_modes(4).model
        motion = cm.simulate(
            model, cm.drop(cm.State(np.zeros(len(model.system.rest)), np.zeros(len(model.system.rest)))), "8 ms"
        )
        first, scales = motion.contacts, model.scales
        assert first.time[0] * scales.time == pytest.approx(math.sqrt(2.0 * 0.2e-3 / 9.81), rel=1e-10)
        weight, stiffness = machine.rotor.mass * 9.81, 2.0 * 2e7
        peak = weight * (1.0 + math.sqrt(1.0 + 2.0 * stiffness * 0.2e-3 / weight))
        forces = [motion.seen_at(plane).contacts.peak_force.max() * scales.force for plane in (0, 1)]
        assert forces[0] == pytest.approx(forces[1], rel=1e-9)
        errors.append(abs(sum(forces) / peak - 1.0))
    assert errors[1] < 0.01
    assert errors[1] < 0.3 * errors[0]


@pytest.mark.jit_only
def test_a_dropped_rotor_that_bends_comes_to_rest():
    """Its unbalance shakes it where it lies, in hundreds of steps a turn; it goes round nothing."""
    assert cm.simulate(MACHINE.with_modes(2).model, cm.drop()).outcome is Outcome.AT_REST


def test_mounts_and_races_are_those_of_the_touchdown_bearing():
    bearing = TouchdownBearing(
        "hunt-crossley",
        "1e8 N/m",
        dissipation=0.5,
        race_inertia=1e-5,
        mount_mass=0.3,
        mount_stiffness=2e6,
        mount_damping=50.0,
    )
    model = munich(touchdown=bearing).with_modes(4)
    linear = model.linear
    assert [each.race is not None for each in linear.equations.touchdowns] == [True, True]
    # The mounts stand by themselves, and planes are seen from them.
    place = model.vectors
    mass, _, _, stiffness, _ = linear.matrices
    assert mass[place, place] == 0.3
    own = stiffness[place, place].real * MACHINE.speed**2 / mass[place, place].real
    assert own == pytest.approx(2e6 / 0.3)
    assert linear.equations.planes[0, place] == pytest.approx(-math.sqrt(MACHINE.rotor.mass))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: munich(touchdowns=[]), r"^touchdowns = \[\]: a sequence of carom.rotors.TouchdownPlane, one or more$"),
        (
            lambda: munich(bearings=[MagneticBearing(3, 50.0, -1e5, PID(1.0), (3, 16))]),
            r"^sensor node = 16: a node of the shaft: 0 to 14",
        ),
        (lambda: munich(unbalances=[Unbalance(20, 1e-5)]), r"^unbalance node = 20: a node of the shaft: 0 to 14"),
        (
            lambda: TouchdownPlane(0, TouchdownBearing(), 0.01, 0.1),
            r"^restitution = nothing given: the law rigid needs it",
        ),
        (
            lambda: munich(touchdown=TouchdownBearing(restitution=0.8)),
            r"^law = rigid: 'kelvin-voigt' or 'hunt-crossley'",
        ),
        (
            lambda: TouchdownPlane(0, TouchdownBearing("kelvin-voigt", 1e8, 1.0, offset=1e-5), 0.01, 0.1),
            r"^offset = 1e-05: 0: bearings of a flexible rotor are centred where it levitates$",
        ),
        (lambda: Unbalance(0, "10 mm"), r"^size = 10 mm: must be an unbalance"),
        (lambda: MACHINE.with_modes(0), r"^modes = 0: a whole number of at least 1$"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(make, says):
    assert_refused(make, says)


def test_controllers_that_do_not_hold_the_rotor_are_refused():
    weak = munich(bearings=[MagneticBearing(node, 50.0, -1e5, PID(1500.0, 0.0, 5.0, 1e-4)) for node in (3, 11)])
    with pytest.raises(
        InputError,
        match=r"^levitation = unstable: a displacement to one side grows with .* 1/s, 1 more slowly: controllers .* bearing 1: -2\.5e\+04 N/m",
    ):
        _ = weak.model
    late = munich(
        bearings=[MagneticBearing(node, 50.0, -1e5, PID(5000.0, 0.0, 5.0, 1e-4), delay="20 ms") for node in (3, 11)]
    )
    with pytest.raises(InputError, match=r"^levitation = unstable"):
        _ = late.model
    winding = munich(bearings=[MagneticBearing(node, 50.0, -1e5, PID(1500.0, 100.0, 5.0, 1e-4)) for node in (3, 11)])
    assert np.isinf(winding.bearings[0].static_stiffness)
    with pytest.raises(InputError, match=r"ki P \+ ks of bearing 1: -2\.5e\+04 N/m"):
        _ = winding.model


def test_damping_of_a_mode_is_asked_for():
    with pytest.raises(InputError, match=r"^damping = None"):
        munich_rotor(damping=None)
    assert replaced(MACHINE, gravity=Gravity(0.0)).model.system.forced is None


FILE = "examples/tum-flexible-rotor.toml"


def test_parts_are_told_as_the_file_has_them():
    rows = dict(cm.load(FILE).rows())
    assert rows["rotor"] == "3.273 kg, 702 mm long"
    assert rows["speed"] == "3,000 rpm"
    assert rows["magnetic bearing 2"].startswith("at 623 mm, sensors at 581 and 665 mm: ki 50 N/A, ks -100,000 N/m; ")
    assert "integral 1,500 A/m/s" in rows["magnetic bearing 1"]
    assert rows["touchdown bearing 1"].startswith(
        "at 94 mm: clearance 0.2 mm, rotor radius 4.8 mm, friction 0.15; hunt-crossley"
    )
    assert rows["unbalance 1"] == "at 363 mm: 20 g mm, at 0°"
    assert rows["gravity"].startswith("9.81 m/s²")
    assert "friction" not in rows


def test_a_support_is_told_with_what_it_has(tmp_path):
    text = Path(FILE).read_text(encoding="utf-8")
    path = tmp_path / "supported.toml"
    path.write_text(
        text + '\n[[support]]\nnode = 7\nkxx = "2e4 N/m"\nkyy = "1e4 N/m"\ncxx = "5 N s/m"\n', encoding="utf-8"
    )
    rows = dict(cm.load(path).rows())
    assert rows["support 1"] == "at 363 mm: kxx 20,000 N/m, kyy 10,000 N/m, cxx 5 N s/m"


UBERLANDIA = "examples/uberlandia-flexible-rotor.toml"
MUNICH = "examples/tum-flexible-rotor.toml"
STABLE = ["damping_of_stiffness=0.3 us", "filter_time=0.02 ms", "delay=0.1 ms"]
"""With these a vector of the reduction grows by 9 1/s, and no mode does."""
UNSTABLE = ["damping_of_stiffness=0.1 us", "filter_time=0.05 ms", "delay=0.3 ms"]
"""With these a bending mode at 3,135 Hz grows by 5 1/s that the usual reduction leaves out."""


def exponents(machine):
    """Exponents of the finite elements with PID, Padé's delay and amplifier as transfer functions of SciPy, 1/s."""
    rotor, speed, scale = machine.rotor, machine.speed, 3e3
    n, loops = len(rotor.matrices.mass), []
    stiffness = rotor.matrices.stiffness.astype(complex)
    for each in machine.bearings:
        at, given = 2 * rotor.place_of(each.node), each.controller
        stiffness[at, at] += each.ks
        above, below = np.array([given.proportional]), np.array([1.0])
        if given.integral:
            above, below = np.polyadd(np.polymul(above, [1, 0]), given.integral * below), np.polymul(below, [1, 0])
        if given.derivative:
            lag = [given.filter_time, 1.0]
            above = np.polyadd(np.polymul(above, lag), np.polymul(below, [given.derivative, 0.0]))
            below = np.polymul(below, lag)
        late = each.delay
        above = np.polymul(above, [-(late**3) / 120, late**2 / 10, -late / 2, 1.0])
        below = np.polymul(below, [late**3 / 120, late**2 / 10, late / 2, 1.0])
        if each.amplifier_bandwidth:
            below = np.polymul(below, [1.0 / each.amplifier_bandwidth, 1.0])
        # In a unit of time in which coefficients are of one size.
        above, below = (each * scale ** np.arange(len(each) - 1, -1, -1) for each in (above, below))
        loops.append(
            (
                at,
                [2 * rotor.place_of(node) for node in each.sensor_nodes],
                each.ki,
                *scipy.signal.tf2ss(above, below),
            )
        )
    size = 2 * n + sum(len(loop[3]) for loop in loops)
    rates, matrix = np.eye(size), np.zeros((size, size), complex)
    rates[n : 2 * n, n : 2 * n] = rotor.matrices.mass
    matrix[:n, n : 2 * n] = np.eye(n)
    matrix[n : 2 * n, :n] = -stiffness
    matrix[n : 2 * n, n : 2 * n] = 1j * speed * rotor.matrices.gyroscopic - rotor.damping_matrix
    first = 2 * n
    for at, seen, ki, A, B, C, D in loops:
        own = slice(first, first + len(A))
        matrix[own, own] = scale * A
        for place in seen:
            matrix[own, place] += scale * B[:, 0] / len(seen)
            matrix[n + at, place] -= ki * D[0, 0] / len(seen)
        matrix[n + at, own] = -ki * C[0]
        first = own.stop
    return scipy.linalg.eigvals(np.linalg.solve(rates, matrix))


@pytest.mark.parametrize("example", [UBERLANDIA, MUNICH])
def test_verdicts_are_those_of_all_exponents(example):
    """Machines on both sides of the boundary: accepted where all exponents lie left, refused by the rightmost where not."""
    random, verdicts = np.random.default_rng(1), set()
    for _ in range(sized(6, 60)):
        damping, lag, late = 10.0 ** random.uniform([-1.3, -2.0, -2.0], [1.0, -1.0, -0.3])
        settings = [f"damping_of_stiffness={damping} us", f"filter_time={lag} ms", f"delay={late} ms"]
        exact = exponents(load_machine(example, settings))
        worst = exact[exact.real.argmax()]
        if abs(worst.real) < 1e-3:  # what SciPy rounds
            continue
        verdicts.add(bool(worst.real > 0.0))
        if worst.real < 0.0:
            assert cm.models.rotor_of(cm.load(example, settings)).system.decay > 0.0
            continue
        with pytest.raises(InputError) as refused:
            cm.load(example, settings)
        shown = re.search(r"whirl of (\S+) Hz grows with (\S+) 1/s", str(refused.value))
        assert float(shown[1]) == pytest.approx(abs(worst.imag) / 2.0 / math.pi, rel=1e-3)  # four digits are stated
        assert float(shown[2]) == pytest.approx(worst.real, rel=1e-3)
    assert verdicts == {True, False}


def test_vectors_that_are_no_modes_do_not_grow():
    reduced = cm.load(UBERLANDIA, STABLE).parameters.finite_elements
    equations = equations_of(reduced.machine, reduced.basis)
    assert np.linalg.eigvals(equations.generator(reduced.machine.speed)).real.max() > 5.0
    # The slowest of all modes, an integrator, is the slowest of the vectors too.
    slowest = reduced.machine.slowest.exponents[0].real
    assert -reduced.linear.system.decay * reduced.machine.speed == pytest.approx(slowest, rel=1e-3)


def test_a_gain_with_which_a_mode_grows_does_not_levitate_in_maps():
    model = cm.load(MUNICH, ["damping_of_stiffness=0.15 us", *UNSTABLE[1:]]).parameters
    faster = model.replace(derivative=8.0)
    assert model.system.levitates
    assert faster.system.exponents.real.max() < 0.0  # of its vectors none grows
    assert not faster.system.levitates


def test_what_grows_is_told_beyond_what_is_listed():
    machine = load_machine(MUNICH, UNSTABLE)
    grows = [each for each in find_whirls(machine, count=3) if each.damping_ratio < 0.0]
    assert [round(each.frequency) for each in grows] == [3133, 3135]  # one backward, one forward
    found = campbell(machine, [0.5 * machine.speed, machine.speed], count=3)
    assert not found.levitates.any()
    assert (found.exponents.real > 0.0).any()
    assert sensitivity(machine).zones is None
    assert campbell(load_machine(MUNICH), [100.0]).levitates.all()
