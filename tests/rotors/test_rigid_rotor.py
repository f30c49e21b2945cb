"""The rigid rotor with four degrees of freedom: closed forms, NumPy, the planar rotor, and machine files."""

import numpy as np
import pytest
from machines import machine_text
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.parameters import TouchdownBearing
from carom.rotors import Support, TouchdownPlane, find_whirls, load_machine, rigid_rotor

MASS, POLAR, DIAMETRAL, SPEED = 12.0, 0.04, 0.15, 2000.0
WALL = TouchdownBearing("rigid", restitution=0.8)
FILE = machine_text("four-degrees")


def on_supports(places, stiffness, damping, wall=WALL, **others):
    """A rotor on springs at two stations, where the touchdown bearings are too."""
    return rigid_rotor(
        mass=MASS,
        polar_inertia=POLAR,
        diametral_inertia=DIAMETRAL,
        stations=places,
        speed=SPEED,
        clearance="0.25 mm",
        supports=[Support(node, k, k, cxx=c, cyy=c) for node, k, c in zip((0, 1), stiffness, damping, strict=True)],
        touchdowns=[TouchdownPlane(node, wall, "20 mm", 0.15) for node in (0, 1)],
        **others,
    )


def test_poles_are_those_of_the_matrix():
    places, stiffness, damping = (-0.12, 0.19), (4e5, 7e5), (300.0, 900.0)
    machine = on_supports(places, stiffness, damping)
    rows = np.array([[1.0, place] for place in places])
    inertia = np.diag([MASS, DIAMETRAL])
    spring, damper = (rows.T @ np.diag(each) @ rows for each in (stiffness, damping))
    spin = damper - 1j * SPEED * np.diag([0.0, POLAR])
    expected = np.linalg.eigvals(
        np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(inertia, spring), -np.linalg.solve(inertia, spin)]])
    )
    found, _ = machine.whole.equations.exponents(SPEED)
    assert np.sort_complex(found) == pytest.approx(np.sort_complex(expected), rel=1e-12)
    model = machine.model.system.exponents * SPEED + 1j * SPEED
    assert np.sort_complex(model) == pytest.approx(np.sort_complex(expected), rel=1e-9)


def test_tilts_between_equal_bearings_whirl_as_in_closed_form():
    k, at = 4e5, 0.15
    whirls = find_whirls(on_supports((-at, at), (k, k), (0.0, 0.0)))
    turned, root = SPEED * POLAR, np.sqrt((SPEED * POLAR) ** 2 + 8.0 * k * at**2 * DIAMETRAL)
    tilts = [(turned + sign * root) / (2.0 * DIAMETRAL) for sign in (-1.0, 1.0)]
    straight = np.sqrt(2.0 * k / MASS)
    found = [each.exponent.imag for each in whirls]
    assert sorted(found) == pytest.approx(sorted([*tilts, -straight, straight]), rel=1e-12)


def test_a_file_says_the_same_as_python(tmp_path):
    path = tmp_path / "rigid.toml"
    path.write_text(FILE, encoding="utf-8")
    machine = load_machine(path, ["polar_inertia=0.05 kg m^2"])
    assert machine.rotor.stations == (-0.16, -0.14, -0.12, -0.1, 0.03, 0.15, 0.19)
    assert [each.node for each in machine.bearings] == [2, 5]
    assert machine.bearings[0].sensor_nodes == (1, 3)
    assert machine.value("polar_inertia") == 0.05
    case = cm.load(path)
    assert case.parameters.replace(polar_inertia=0.05).value("polar_inertia") == 0.05
    for inertia in (0.04, 0.05):
        changed = case.parameters.replace(polar_inertia=inertia).system.exponents
        whole = load_machine(path, [f"polar_inertia={inertia}"]).model.system.exponents
        assert changed == pytest.approx(whole, rel=1e-12)
    drop = cm.simulate(case, cm.drop(), "20 ms")
    assert all(len(drop.seen_at(plane).contacts) for plane in (0, 1))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('position = "30 mm"', "node = 2", r"\[\[unbalance\]\] 1: node.*no nodes"),
        ('position = "30 mm"\n', "", r"\[\[unbalance\]\] 1: position"),
        ('polar_inertia = "0.04', 'polar_inertia = "0.4', "polar_inertia.*at most twice"),
        ("restitution = 0.8\n[[unb", "[[unb", r"\[\[touchdown\]\] 2: restitution"),
        ("[rotor]\n", "[rotor]\ndamping_ratio = 0.01\n", "not allowed beside damping_ratio"),
        ("[gravity]", '[[disc]]\nposition = 0\nmass = "1 kg"\n', r"not allowed beside \[\[disc\]\]"),
    ],
)
def test_what_a_rigid_rotor_cannot_be_is_refused(tmp_path, old, new, words):
    path = tmp_path / "rigid.toml"
    path.write_text(FILE.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=words):
        cm.load(path)


def test_a_rotor_that_tilts_about_a_point_moves_as_its_equation():
    """The equation in the head of the example, integrated by SciPy."""
    rotor = cm.load("examples/overhung-rotor.toml").parameters
    speed, polar, ratio, ring, unbalance = 5.0, 0.143, 0.01, 10.0, 0.9 * 0.353

    def rates(_, y):
        z, v = y[0] + 1j * y[1], y[2] + 1j * y[3]
        a = 1j * speed * (polar - 2.0) * v - 2.0 * ratio * v + unbalance * speed**2
        a += (speed**2 * (1.0 - polar) - 1.0 - 2j * ratio * speed) * z - ring * max(0.0, 1.0 - 1.0 / abs(z)) * z
        return [v.real, v.imag, a.real, a.imag]

    place, velocity = 0.9 + 0.1j, 0.3 - 0.9j
    start = [place.real, place.imag, velocity.real, velocity.imag]
    ode = solve_ivp(rates, (0.0, 10.0), start, rtol=1e-11, atol=1e-12, max_step=0.01).y
    assert np.hypot(*ode[:2]).max() > 2.5
    reach = rotor.equations.planes[0, 0]
    motion = cm.simulate(rotor, cm.State(place / reach, velocity / speed / reach), 10.0 * speed)
    assert motion.final.position * reach == pytest.approx(ode[0, -1] + 1j * ode[1, -1], abs=1e-7)
    assert motion.final.velocity * speed * reach == pytest.approx(ode[2, -1] + 1j * ode[3, -1], abs=1e-7)
