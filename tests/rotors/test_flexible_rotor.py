"""Shafts with discs as finite elements, against exact solutions of the beam and closed forms."""

import math

import numpy as np
import pytest
from exact_shafts import frequencies
from refusals import assert_refused
from scipy.linalg import eigh

from carom.rotors import Disc, FlexibleRotor, Material, ModalDamping, ShaftSection

STEEL = Material("210 GPa", 7800.0, 0.3)
UNDAMPED = ModalDamping(0.0)


def plain(length=1.0, diameter=0.1, inner=0.0, elements=32, discs=()):
    return FlexibleRotor([ShaftSection(length, diameter, inner, STEEL)], discs, UNDAMPED, length / elements)


def stepped(elements=60):
    """Three sections, one of them hollow, and two discs."""
    sections = [
        ShaftSection(0.3, 0.04, 0.0, STEEL),
        ShaftSection(0.5, 0.06, 0.02, STEEL),
        ShaftSection(0.2, 0.03, 0.0, STEEL),
    ]
    return FlexibleRotor(sections, [Disc(1, 5.0, 0.02, 0.03), Disc(3, 2.0, 0.01, 0.018)], UNDAMPED, 1.0 / elements)


def whirls(rotor, held, speed):
    """Frequencies of whirl with coordinates held, rad/s; backward ones are negative."""
    kept = [place for place in range(len(rotor.matrices.mass)) if place not in held]
    mass, stiffness, gyroscopic = (
        matrix[np.ix_(kept, kept)]
        for matrix in (rotor.matrices.mass, rotor.matrices.stiffness, rotor.matrices.gyroscopic)
    )
    n = len(kept)
    accelerations = -np.linalg.solve(mass, np.concatenate([stiffness, -1j * speed * gyroscopic], axis=1))
    values = np.linalg.eigvals(np.concatenate([np.eye(n, 2 * n, n), accelerations])).imag
    return np.sort(values[values < 0.0])[::-1], np.sort(values[values > 0.0])


def test_mass_and_inertias_are_those_of_the_cylinders():
    length, outer, inner = 0.7, 0.09, 0.05
    rotor = plain(length, outer, inner, 7)
    mass = STEEL.density * math.pi / 4.0 * (outer**2 - inner**2) * length
    polar = mass * (outer**2 + inner**2) / 8.0
    assert rotor.mass == pytest.approx(mass, rel=1e-14)
    assert rotor.translation @ rotor.matrices.mass @ rotor.translation == pytest.approx(mass, rel=1e-13)
    assert rotor.centre == pytest.approx(length / 2.0, rel=1e-13)
    assert rotor.polar_inertia == pytest.approx(polar, rel=1e-12)
    assert rotor.diametral_inertia == pytest.approx(polar / 2.0 + mass * length**2 / 12.0, rel=1e-12)


def test_a_disc_of_dimensions_is_a_short_shaft():
    body = ShaftSection("20 mm", "200 mm", "40 mm", STEEL)
    disc = Disc.of_body(0, body)
    shaft = FlexibleRotor([body], [], UNDAMPED)
    assert disc.mass == pytest.approx(shaft.mass)
    assert disc.polar_inertia == pytest.approx(shaft.polar_inertia)
    assert disc.diametral_inertia == pytest.approx(shaft.diametral_inertia)


def test_rigid_motions_bend_nothing():
    rotor = stepped()
    size = np.abs(rotor.matrices.stiffness).max()
    assert np.abs(rotor.matrices.stiffness @ rotor.translation).max() < 1e-15 * size
    assert np.abs(rotor.matrices.stiffness @ rotor.tilt).max() < 1e-15 * size
    # A rotor that is displaced turns about no axis.
    assert np.abs(rotor.matrices.gyroscopic @ rotor.translation).max() < 1e-15 * np.abs(rotor.matrices.gyroscopic).max()


def test_a_slender_shaft_bends_as_by_euler_and_bernoulli():
    """Shear and rotary inertia change the frequencies by shares of the square of diameter over length, 1e-6."""
    rotor = plain(1.0, 1e-3)
    bending, line = STEEL.elastic_modulus * rotor.sections[0].second_moment, STEEL.density * rotor.sections[0].area
    for mode, root in enumerate((4.730040744862704, 7.853204624095838, 10.995607838001671)):
        # Elements: (root/32)^4/720, below 2e-5 for the third.
        expected = root**2 * math.sqrt(bending / line)
        assert rotor.free_modes.frequencies[2 + mode] == pytest.approx(expected, rel=3e-5)


def test_simply_supported_frequencies_of_a_thick_shaft_are_those_of_timoshenko():
    """``EIk⁴ − ρAω² − ρI(1 + E/κG)k²ω² + ρ²Iω⁴/κG = 0`` with ``k = jπ/L``; the error falls with the square of the element: its shear is constant."""
    section, errors = ShaftSection(1.0, 0.2, 0.1, STEEL), []
    young, density, inertia = STEEL.elastic_modulus, STEEL.density, section.second_moment
    shear = section.shear_coefficient * STEEL.shear
    k = 2.0 * math.pi
    square = density**2 * inertia / shear
    linear = -(density * section.area + density * inertia * (1.0 + young / shear) * k**2)
    exact = math.sqrt(np.roots([square, linear, young * inertia * k**4]).real.min())
    for elements in (16, 32):
        rotor = plain(1.0, 0.2, 0.1, elements)
        n = len(rotor.matrices.mass)
        errors.append(whirls(rotor, (0, n - 2), 0.0)[1][1] / exact - 1.0)
    assert 0.0 < errors[1] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)


@pytest.mark.parametrize("ends", [("free", "free"), ("pinned", "pinned"), ("clamped", "free")])
@pytest.mark.parametrize("speed", [0.0, 800.0])
def test_whirls_of_a_stepped_shaft_are_those_of_its_transfer_matrix(ends, speed):
    rotor = stepped()
    n = len(rotor.matrices.mass)
    held = {
        ("free", "free"): (),
        ("pinned", "pinned"): (0, n - 2),
        ("clamped", "free"): (0, 1),
    }[ends]
    rigid = 2 if ends == ("free", "free") else 0
    for found in whirls(rotor, held, speed):
        guesses = found[np.abs(found) > 100.0][: 4 - rigid] if rigid else found[:3]
        # Elements of a sixtieth of the shaft, and of the share of shear in the frequencies, a hundredth, the square of that.
        assert frequencies(rotor, *ends, guesses, speed) == pytest.approx(guesses, rel=1e-5)


def test_an_overhung_disc_on_a_light_shaft():
    """Cantilever with displacement ``L³/3EI + L/κGA``, ``L²/2EI`` and tilt ``L/EI`` by force and moment at its end."""
    length, speed = 0.4, 600.0
    light = ShaftSection(length, 0.02, 0.0, Material(2e11, 1.0, 0.3))
    disc = Disc(1, 20.0, 0.2, 0.35)
    rotor = FlexibleRotor([light], [disc], UNDAMPED)
    bending = 2e11 * light.second_moment
    shear = light.shear_coefficient * light.material.shear * light.area
    gives = np.array(
        [
            [length**3 / (3.0 * bending) + length / shear, length**2 / (2.0 * bending)],
            [length**2 / (2.0 * bending), length / bending],
        ]
    )
    stiffness, mass = np.linalg.inv(gives), np.diag([disc.mass, disc.diametral_inertia])
    spin = np.concatenate(
        [np.eye(2, 4, 2), -np.linalg.solve(mass, np.hstack([stiffness, np.diag([0.0, -1j * speed * 0.35])]))]
    )
    expected = np.sort(np.linalg.eigvals(spin).imag)
    backward, forward = whirls(rotor, (0, 1), speed)
    # A shaft of 0.13 g beside 20 kg.
    assert np.concatenate([backward[1::-1], forward[:2]]) == pytest.approx(expected, rel=1e-5)
    assert forward[0] > -backward[0]


def test_free_modes_are_those_of_the_pencil():
    rotor = stepped()
    modes = rotor.free_modes
    mass, stiffness = rotor.matrices.mass, rotor.matrices.stiffness
    assert np.allclose(modes.shapes.T @ mass @ modes.shapes, np.eye(len(mass)), rtol=0, atol=1e-12)
    assert np.array_equal(modes.frequencies[:2], [0.0, 0.0])
    exact = np.sqrt(eigh(stiffness, mass, eigvals_only=True)[2:8])
    assert modes.frequencies[2:8] == pytest.approx(exact, rel=1e-8)
    # All bending modes together give way as the shaft does to a force and the inertia that it meets.
    row = np.eye(len(mass))[2 * rotor.place_of(1)]
    whole = modes.flexibility(row, 2)
    push = row - mass @ modes.shapes[:, :2] @ (row @ modes.shapes[:, :2])
    assert np.abs(stiffness @ whole - push).max() < 1e-8


def test_long_sections_are_divided_and_nodes_stay_where_they_are():
    rotor = stepped(20)
    assert rotor.divisions == (6, 10, 4)
    assert rotor.places[[0, 6, 16, 20]] == pytest.approx([0.0, 0.3, 0.8, 1.0])
    assert [2 * rotor.place_of(node) for node in range(4)] == [0, 12, 32, 40]


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ShaftSection("94", "8 kg"), r"^outer_diameter = 8 kg: must be a length"),
        (lambda: ShaftSection(0.1, 0.01, 0.01), r"^inner_diameter = 0.01: a length below the outer diameter, 0.01 m$"),
        (lambda: Disc(-1, 1.0, 1.0, 1.0), r"^disc node = -1: the number of a node"),
        (lambda: Disc(0, 1.0, 1.0, 2.1), r"^polar_inertia = 2.1: at most twice the diametral inertia, 1 kg m\^2$"),
        (lambda: ModalDamping(-0.1), r"^ratio = -0.1: must be a number"),
        (
            lambda: FlexibleRotor([], [], UNDAMPED),
            r"^sections = \[\]: a sequence of carom.rotors.ShaftSection, one or more$",
        ),
        (lambda: plain(elements=-3), r"^longest_element = -0.333"),
        (
            lambda: plain(elements=501),
            r"^longest_element = 0.00199.*: a length with which the shaft has at most 500 elements",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(make, says):
    assert_refused(make, says)
