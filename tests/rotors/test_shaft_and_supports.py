"""What turns with the shaft or changes with its speed: internal damping, coefficients of supports over speed, tilts; against own matrices and closed forms."""

import dataclasses

import numpy as np
import pytest
import scipy.linalg
from flexible_machines import munich, replaced, symmetric
from machines import machine_text

import carom as cm
from carom.base.outcome import InputError
from carom.models import rotor_of
from carom.motions import spin_down
from carom.parameters import Drive, TouchdownBearing
from carom.rotors import (
    PID,
    FlexibleMachine,
    FlexibleRotor,
    Housing,
    MagneticBearing,
    Material,
    ModalDamping,
    ProportionalDamping,
    ShaftSection,
    Support,
    TouchdownPlane,
    Unbalance,
    find_whirls,
    load_machine,
    rigid_rotor,
    sensitivity,
    synchronous_response,
)
from carom.rotors.free_motions import stability_limits
from carom.studies.levitating import levitating, levitation_facts

WALL = TouchdownBearing("rigid", restitution=0.8)
TABLE = Support(
    1, kxx=("2e5 N/m", "3e5 N/m", 7e5), kyy=(1e5, 3e5, 5e5), kxy=1e4, kyx=[-1e4, -3e4, 2e4], cxx=90.0, cyy=(50.0, 60.0, 80.0),
    rotating_damping=(5.0, 6.0, 6.0), tilt_stiffness=(900.0, 800.0, 400.0), tilt_damping=3.0, speeds=("1000 rpm", 400.0, "9000 rpm"),
)  # fmt: skip
OTHER = Support(2, 4e5, 4e5, cxx=100.0, cyy=100.0)


def rigid(external, internal, speed=200.0):
    return rigid_rotor(
        mass=12.0,
        polar_inertia=0.04,
        diametral_inertia=0.15,
        stations=(-0.15, 0.15),
        speed=speed,
        clearance="0.25 mm",
        supports=[
            Support(node, 4e5, 4e5, cxx=external, cyy=external, rotating_damping=internal, tilt_stiffness=1e5)
            for node in (0, 1)
        ],
        touchdowns=[TouchdownPlane(node, WALL, "20 mm", 0.15) for node in (0, 1)],
    )


@pytest.mark.parametrize(("external", "internal"), [(300.0, 200.0), (30.0, 500.0), (900.0, 3.0)])
def test_rotating_damping_limits_the_speed_as_in_closed_form(external, internal):
    closed = np.sqrt(8e5 / 12.0) * (1.0 + external / internal)
    (found,) = stability_limits(rigid(external, internal).whole.equations, [0.5 * closed, 1.7 * closed])
    assert found.speed == pytest.approx(closed, rel=1e-8)
    assert found.exponent == pytest.approx(1j * np.sqrt(8e5 / 12.0), rel=1e-8)
    assert found.stable_below
    with pytest.raises(InputError, match=rf"levitates below {closed * 30.0 / np.pi:.6g} rpm"):
        _ = rigid(external, internal, 1.2 * closed).model
    assert rigid(external, internal, 0.9 * closed).model.system.decay > 0.0


def test_a_spin_down_has_the_matrices_of_each_speed():
    """Against those of the machine made anew at that speed; and two motions of it, in steps of different size."""
    fast, slow = (rigid(300.0, 200.0, speed).model for speed in (200.0, 50.0))
    fixed = []
    for rotor, speed, changes in ((fast, 200.0, fast.finite_elements.changes_at(0.25)), (slow, 50.0, (0.0, 0.0))):
        _, damping, gyroscopic, stiffness, _ = rotor.without_levitation().matrices
        fixed.append((speed * (damping - 1j * gyroscopic + changes[0]), speed**2 * (stiffness + changes[1])))
    for one, other in zip(*fixed, strict=True):
        assert one == pytest.approx(other, rel=1e-12, abs=1e-12 * np.abs(other).max())
    slowed = [spin_down(fast, cm.drop(), drive=Drive(brake="0.05 N m"), steps=steps) for steps in (20, 80)]
    assert all(each.stands and not each.loads.planes[0].contacts for each in slowed)
    assert slowed[1].largest[0][0] == pytest.approx(slowed[0].largest[0][0], rel=0.05)


def test_a_spin_down_asks_for_coefficients_down_to_standstill():
    machine = rigid(300.0, 0.0)
    table = Support(0, kxx=(4e5, 5e5), kyy=(4e5, 5e5), cxx=300.0, cyy=300.0, tilt_stiffness=1e5, speeds=(20.0, 300.0))
    machine = dataclasses.replace(machine, supports=(table, machine.supports[1]))
    with pytest.raises(InputError, match="beyond, the coefficients of a support at node 0 are not known"):
        spin_down(machine.with_modes(2).model, cm.drop())


def test_a_planar_machine_has_internal_damping():
    from_file = cm.load("examples/keogh-cole.toml").machine
    external, mass, speed = from_file.damping, from_file.mass, from_file.speed
    internal = 0.9 * external * (from_file.stiffness / mass) ** 0.5 / (speed - (from_file.stiffness / mass) ** 0.5)
    machine = from_file.replace(internal_damping=internal)
    rotor = rotor_of(machine)
    own = np.roots([mass, external + internal, from_file.stiffness - 1j * speed * internal])
    assert np.sort_complex((rotor.system.exponents + 1j) * speed) == pytest.approx(np.sort_complex(own), rel=1e-9)
    closed = np.sqrt(from_file.stiffness / mass) * (1.0 + external / internal)
    (limit,) = levitating(cm.models.case_of(machine), rotor).limits
    assert limit.speed == pytest.approx(closed, rel=1e-8)
    whirls = [synchronous_response(each, [0.4 * speed, speed]).touchdowns for each in (from_file, machine)]
    assert whirls[1].forward == pytest.approx(whirls[0].forward, rel=1e-12)  # which it does not change
    (own,), (other,) = (rotor_of(each.replace(force_limit=100.0)).listed_limits for each in (machine, from_file))
    assert (own.velocity, own.displacement) == (other.velocity, other.displacement)  # the controller has no part of it
    with pytest.raises(InputError, match="speed of the shaft changes"):
        cm.models.jeffcott(
            machine.parameters,
            cm.models.planar.RIGID,
            drive=cm.parameters.Drive(polar_inertia=1.0),
            internal_damping=1.0,
        )


def own_planes(machine, speed):
    """Damping and stiffness (4N, 4N) of displacements and tilts in x, then in y."""
    rotor, turning, both = machine.rotor, np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(2)
    mass, stiffness, gyroscopic = (getattr(rotor.matrices, name) for name in ("mass", "stiffness", "gyroscopic"))
    squares, shapes = scipy.linalg.eigh(stiffness, mass)
    rates = np.sqrt(np.maximum(squares, 0.0)) * (squares > 1e-6 * squares[2])
    pushed = mass @ shapes
    internal = pushed * (2.0 * rotor.internal.ratio * rates) @ pushed.T
    external = pushed * (2.0 * rotor.damping.ratio * rates) @ pushed.T
    damping = np.kron(both, internal + external) + speed * np.kron(turning, gyroscopic)
    held = np.kron(both, stiffness) + speed * np.kron(turning, internal)
    for each in machine.supports:
        at = {
            name: np.interp(speed, each.speeds, getattr(each, name)) if each.speeds and np.ndim(getattr(each, name)) else getattr(each, name)
            for name in ("kxx", "kxy", "kyx", "kyy", "cxx", "cxy", "cyx", "cyy", "rotating_damping", "tilt_stiffness", "tilt_damping")
        }  # fmt: skip
        x = 2 * rotor.place_of(each.node)
        place, tilts = (
            np.ix_((x, x + len(mass)), (x, x + len(mass))),
            np.ix_(
                (x + 1, x + 1 + len(mass)),
            )
            * 2,
        )
        held[place] += [[at["kxx"], at["kxy"]], [at["kyx"], at["kyy"]]] + speed * at["rotating_damping"] * turning
        damping[place] += [[at["cxx"], at["cxy"]], [at["cyx"], at["cyy"]]] + at["rotating_damping"] * both
        held[np.ix_(tilts[0], tilts[1])] += at["tilt_stiffness"] * both
        damping[np.ix_(tilts[0], tilts[1])] += at["tilt_damping"] * both
    return np.kron(both, mass), damping, held


def on_tables(**changes):
    shaft = dataclasses.replace(
        symmetric().rotor, damping=ModalDamping(0.01), internal=ModalDamping(0.02), longest_element=0.2
    )
    return symmetric(rotor=shaft, bearings=[], supports=[TABLE, OTHER], gravity=None, unbalances=[Unbalance(1, "20 g mm")], **changes)  # fmt: skip


@pytest.mark.parametrize("speed", [110.0, 300.0, 400.0, 700.0])
def test_exponents_and_response_at_any_speed_are_those_of_own_matrices(speed):
    machine = on_tables()
    mass, damping, held = own_planes(machine, speed)
    none, one = np.zeros_like(mass), np.eye(len(mass))
    shapes = scipy.linalg.eigh(own_planes(machine, 110.0)[2] + own_planes(machine, 110.0)[2].T, mass)[
        1
    ]  # in which digits are kept
    own = np.linalg.eigvals(np.block([[none, one], [-shapes.T @ held @ shapes, -shapes.T @ damping @ shapes]]))
    for equations in (machine.whole.equations, replaced(machine, speed=speed).whole.equations):
        found = equations.exponents(speed)[0]
        assert np.abs(found[:, None] - own).min(axis=0) == pytest.approx(0.0, abs=1e-8 * np.abs(own).max())
        slow = own[np.abs(own) < 3e3]
        assert (np.abs(found[:, None] - slow).min(axis=0) < 1e-8 * np.abs(slow)).all()
    push, place = np.zeros(len(mass), complex), 2 * machine.rotor.place_of(1)
    push[[place, place + len(mass) // 2]] = 20e-6 * speed**2 * np.array([1.0, -1j])
    answer = np.linalg.solve(held + 1j * speed * damping - speed**2 * mass, push)
    whirl = synchronous_response(machine, [speed]).touchdowns
    x, y = answer[place], answer[place + len(mass) // 2]
    assert whirl.forward[0, 0] == pytest.approx(0.5 * (x + 1j * y), rel=1e-8)
    assert whirl.backward[0, 0] == pytest.approx(0.5 * np.conj(x - 1j * y), rel=1e-8)


def test_a_file_holds_them(tmp_path):
    path = tmp_path / "machine.toml"
    machine = replaced(munich(0.06), supports=[replaced(TABLE, node=7)], speed="2000 rpm")
    machine = replaced(machine, rotor=dataclasses.replace(machine.rotor, internal=ProportionalDamping(0.0, "20 us")))
    path.write_text(machine.with_modes(6).to_toml())
    again = load_machine(path)
    assert (again.supports, again.rotor.internal) == (machine.supports, machine.rotor.internal)
    assert [each.exponent for each in find_whirls(again, 300.0)] == [
        each.exponent for each in find_whirls(machine, 300.0)
    ]
    assert dict(again.rows())["support 1"].endswith("; from a table of 3 speeds")
    assert again.speed_range == pytest.approx((1000.0 * np.pi / 30.0, 9000.0 * np.pi / 30.0))
    for name, given, message in (
        ("speed", "900 rpm", "speed = 900 rpm: 1,000 to 9,000 rpm"),
        ("speed", "9001 rpm", "a support at node 7 are not known"),
        ("kxx_1", "5e5 N/m", "unknown name"),
    ):
        with pytest.raises(InputError, match=message):
            load_machine(path, [f"{name}={given}"])
    for changes, message in (
        ({"speeds": (1.0, 1.0)}, "increasing"),
        ({"kxx": (1.0, 2.0)}, "3 values"),
        ({"speeds": ()}, "two or more"),
    ):
        with pytest.raises(InputError, match=message):
            replaced(TABLE, **changes)
    with pytest.raises(InputError, match="only what bends"):
        dataclasses.replace(machine.rotor, internal=ProportionalDamping(1.0))


def test_a_study_states_the_limit_of_speed(tmp_path):
    path = tmp_path / "machine.toml"
    text = machine_text("flexible").replace("[rotor]", "[rotor]\ninternal_damping_ratio = 0.3", 1)
    path.write_text(text + "[[support]]\nnode = 1\nkxx = [0, 0]\nkyy = 0\nspeeds = ['500 rpm', '40000 rpm']\n")
    case = cm.load(path, ["speed=14000 rpm"])
    found = levitating(case, rotor_of(case))
    (fact,) = [each for each in levitation_facts(found) if each.label == "Limit of speed"]
    assert fact.text == "Levitation is stable below 16,499.7 rpm: faster, a forward whirl of 220.4 Hz grows."
    assert found.document()["stability_limits"] == [
        {
            "speed_rpm": pytest.approx(16499.7, rel=1e-6),
            "frequency_hz": pytest.approx(220.37, rel=1e-5),
            "stable_below": True,
        }
    ]
    assert found.campbell.speeds[0] == pytest.approx(700.0 * np.pi / 30.0)


def test_magnets_react_on_a_housing_and_sensors_measure_against_it():
    places, ki, ks, gains = (-0.12, 0.19), 60.0, -1e5, (9000.0, 12.0)
    machine = rigid_rotor(
        mass=12.0, polar_inertia=0.04, diametral_inertia=0.15, stations=(*places, 0.25), speed=900.0, clearance="0.25 mm",
        bearings=[MagneticBearing(node, ki, ks, PID(gains[0], 0.0, gains[1], 0.0), ks_tilt=-3e3 * node) for node in (0, 1)],
        supports=[Support(2, 2e4, 2e4, cxx=30.0, cyy=30.0)],
        touchdowns=[TouchdownPlane(node, WALL, "20 mm", 0.15) for node in (0, 1)],
        unbalances=[Unbalance(1, "20 g mm")],
        housings=[Housing(20.0, 3e6, 400.0, bearings=[1], touchdowns=(1, 2)), Housing("8 kg", "1e6 N/m", bearings=[2], supports=[1])],
    )  # fmt: skip
    rows = np.array([[1.0, places[0], -1.0, 0.0], [1.0, places[1], 0.0, -1.0], [1.0, 0.25, 0.0, -1.0]])
    mass = np.diag([12.0, 0.15, 20.0, 8.0])
    spring, damper = (
        rows.T @ np.diag([at_magnets, at_magnets, at_support]) @ rows + np.diag([0.0, 0.0, *of_housings])
        for at_magnets, at_support, of_housings in (
            (ki * gains[0] + ks, 2e4, (3e6, 1e6)),
            (ki * gains[1], 30.0, (400.0, 0.0)),
        )
    )
    spring[1, 1] -= 3e3
    spin = damper - 900.0j * np.diag([0.0, 0.04, 0.0, 0.0])
    own = np.linalg.eigvals(
        np.block([[np.zeros((4, 4)), np.eye(4)], [-np.linalg.solve(mass, spring), -np.linalg.solve(mass, spin)]])
    )
    found = machine.whole.equations.exponents(900.0)[0]
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(own), rel=1e-10)
    assert np.sort_complex(machine.model.system.exponents + 1j) * 900.0 == pytest.approx(np.sort_complex(own), rel=1e-9)
    answer = np.linalg.solve(
        spring + 900.0j * spin - 900.0**2 * mass, 20e-6 * 900.0**2 * np.array([1.0, places[1], 0, 0])
    )
    whirl = synchronous_response(machine, [900.0])
    seated = np.array([[1.0, place, -1.0, 0.0] for place in places])
    assert whirl.touchdowns.forward[0] == pytest.approx(seated @ answer, rel=1e-9)
    assert whirl.sensors.forward[0] == pytest.approx(rows[:2] @ answer, rel=1e-9)
    s = 700.0j
    free = spring + s * damper - (ki * gains[0] + s * ki * gains[1]) * rows[:2].T @ rows[:2]
    loops = [
        rows[:2] @ np.linalg.solve(free + sign * s * (spin - damper) + s * s * mass, rows[:2].T) for sign in (1.0, -1.0)
    ]
    closed = [np.diag(np.linalg.inv(np.eye(2) + ki * (gains[0] + s * gains[1]) * each)) for each in loops]
    assert sensitivity(machine, [700.0]).values[0] == pytest.approx(0.5 * (closed[0] + closed[1]), rel=1e-9)


def test_a_housing_of_a_touchdown_bearing_alone_is_its_mount(tmp_path):
    wall = TouchdownBearing("hunt-crossley", stiffness="1e7 N/m", dissipation="0.5 s/m")
    mounted = wall.replace(mount_mass="1.5 kg", mount_stiffness="4e6 N/m", mount_damping="300 N s/m")
    plain = munich(0.1, touchdown=wall)
    standing = replaced(plain, housings=[Housing("1.5 kg", "4e6 N/m", "300 N s/m", touchdowns=[1])])
    other = replaced(plain, touchdowns=[replaced(plain.touchdowns[0], bearing=mounted), plain.touchdowns[1]])
    seen = []
    for each in (standing, other):
        motion = cm.simulate(each.with_modes(4).model, cm.drop(), "12 ms")
        seen.append(
            [
                column
                for plane in (0, 1)
                for name, column in motion.seen_at(plane).contacts.to_dataset().items()
                if name in ("time", "deepest", "heat")
            ]
        )
    for one, same in zip(*seen, strict=True):
        assert len(one) >= 2
        assert one.values == pytest.approx(same.values, rel=1e-7)
    seated = replaced(standing, housings=[Housing(3.0, 4e6, bearings=[1], touchdowns=[1])]).with_modes(4).model
    found = cm.simulate(seated, cm.drop(), "9 ms").channels("0.1 ms", [3], seated)
    assert np.ptp(found.housing_1_y.values) > 1e-6
    between = found.node_3_y - found.housing_1_y  # the magnet stands at this node
    assert found.magnetic_bearing_1_y.values == pytest.approx(between.values, abs=1e-15)
    path = tmp_path / "machine.toml"
    path.write_text(standing.with_modes(4).to_toml())
    assert load_machine(path).housings == standing.housings
    with pytest.raises(InputError, match="numbers from 1 to 2"):
        replaced(plain, housings=[Housing(1.0, 1.0, touchdowns=[3])])
    with pytest.raises(InputError, match="one housing at most"):
        replaced(plain, housings=[Housing(1.0, 1.0), Housing(1.0, 1.0, touchdowns=[2])])


@pytest.mark.parametrize("force", [-1.0, -0.6, 0.0, 2.0])
def test_axial_force_on_a_pinned_shaft_is_as_in_closed_form(force):
    """``w = sin βs, φ ∝ cos βs`` solves Timoshenko's beam between pins; it buckles at Engesser's ``P_E/(1 + P_E/κGA)``."""
    material = Material("70 GPa", 2700.0, shear_modulus="15 GPa")
    section = ShaftSection("0.5 m", "40 mm", 0.0, material)
    bending, beta = material.elastic_modulus * section.second_moment, np.pi / section.length
    shear, line = section.shear_coefficient * 15e9 * section.area, material.density * section.area
    buckling = bending * beta**2 / (1.0 + bending * beta**2 / shear)
    axial = force * buckling
    shaft = [dataclasses.replace(section, axial_force=axial)]
    stiff = [[shear * beta**2 + axial * beta**2, -shear * beta], [-shear * beta, bending * beta**2 + shear]]
    closed = scipy.linalg.eigvalsh(stiff, np.diag([line, material.density * section.second_moment]))
    found = []
    for elements in (80, 160):
        rotor = FlexibleRotor(shaft, [], ModalDamping(0.0), section.length / elements)
        free = np.setdiff1d(np.arange(2 * elements + 2), [0, 2 * elements])
        mass, stiffness = (each[np.ix_(free, free)] for each in rotor.matrices[:2])
        extra = 0.0 if rotor.axial_stiffness is None else rotor.axial_stiffness[np.ix_(free, free)]
        # Of inverses the largest, the lowest frequency and load, are accurate to rounding.
        pair = (mass, stiffness + extra) if force > -1.0 else (-extra, stiffness)
        found.append(1.0 / scipy.linalg.eigh(*pair, eigvals_only=True)[-1])
    # The shear angle of an element is one: its error falls with the square of the length, and goes by extrapolation.
    assert (4.0 * found[1] - found[0]) / 3.0 == pytest.approx(closed[0] if force > -1.0 else 1.0, rel=1e-8)
    pins = [Support(node, 1e11, 1e11, cxx=1.0, cyy=1.0) for node in (0, 1)]
    wall = [TouchdownPlane(0, TouchdownBearing("kelvin-voigt", stiffness=1e7, damping=10.0), "20 mm", 0.1)]
    damped = dataclasses.replace(rotor, damping=ModalDamping(1e-3), longest_element=0.025)
    machine = FlexibleMachine(damped, 100.0, "0.2 mm", [], wall, supports=pins)
    if force > -1.0:
        assert find_whirls(machine)[0].frequency == pytest.approx(np.sqrt(closed[0]) / (2.0 * np.pi), rel=2e-3)
    else:
        bent = dataclasses.replace(damped, sections=[dataclasses.replace(section, axial_force=1.01 * axial)])
        with pytest.raises(InputError, match="a displacement to one side grows"):
            _ = replaced(machine, rotor=bent).whole.linear
