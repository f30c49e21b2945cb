"""Balls: a contact against the half-space integrated with many digits, all balls against their sum, printed numbers, rolling by velocities."""

import math
import re
from pathlib import Path

import mpmath
import numpy as np
import pytest
from scipy.optimize import root

import carom as cm
from carom.base.outcome import InputError
from carom.closed_forms import BallRing, load_integral, point_contact
from carom.parameters import TouchdownBearing
from carom.studies.drops import load_entries, load_tables

ROOT = Path(__file__).parents[2]
SIZES = {"balls": 12, "ball_diameter": 6.35e-3, "race_diameter": 45e-3}
PLAIN, LOOSE = BallRing(**SIZES), BallRing(**SIZES, internal_clearance=12e-6, conformities=(0.515, 0.53))
PAIR = BallRing(24, 6.35e-3, 45e-3, math.radians(25.0), preload=100.0, rows=2)


def displacement(contact, x, y):
    """Place (x, y) of a half-space with ``E* = 1`` under the pressure of a contact: the potential of the pressure, in polar coordinates.

    On a ray from the place the root of the pressure is that of a quadratic, between the two ends of the ellipse on its line: the
    integral over a whole chord is ``π/2`` of half its length times the largest pressure on it.
    """
    a, b, p = map(mpmath.mpf, (contact.longer, contact.shorter, contact.pressure))

    def chord(angle):
        along, across = mpmath.cos(angle), mpmath.sin(angle)
        square = (along / a) ** 2 + (across / b) ** 2
        slope = x * along / a**2 + y * across / b**2
        inside = 1 - (x / a) ** 2 - (y / b) ** 2 + slope**2 / square
        return mpmath.pi / 2 * inside / mpmath.sqrt(square)

    flat = b / a  # the integrand is narrow there: the angle at which its size changes
    return p / mpmath.pi * mpmath.quad(chord, [0, flat, mpmath.pi / 2, mpmath.pi - flat, mpmath.pi])


@pytest.mark.parametrize("curvatures", [(1.0, 1.0), (1.0, 1.3), (3.0, 0.5), (4.0, 0.07), (200.0, 0.5)])
def test_the_surface_is_flattened_by_a_pressure_that_sums_up_to_the_force(curvatures):
    contact = point_contact(2.5, curvatures, 1.0)
    assert contact.pressure * contact.longer * contact.shorter * 2 * mpmath.pi / 3 == pytest.approx(2.5, rel=1e-14)
    middle = displacement(contact, 0, 0)
    assert contact.approach == pytest.approx(float(middle), rel=1e-12)
    x, y = 0.6 * contact.longer, 0.7 * contact.shorter
    for place, lifted in (((x, 0), min(curvatures) * x**2), ((0, y), max(curvatures) * y**2)):
        # Both bodies together move by what their curvatures leave open between them.
        assert float(middle - displacement(contact, *place)) == pytest.approx(0.5 * lifted, rel=1e-11)


def test_a_printed_example():
    """3,600 N on 12 balls with a radius of 4.9 mm, race 25 mm, groove 5 mm: 2,193.6 MPa, 2.101 mm and 0.156 mm.

    Contact stresses in a steel ball bearing, amesweb.info, by tables of coefficients.  It has Poisson's ratio 0.29; only ``E/(1 − ν²)`` counts.
    """
    modulus = 210e9 * (1 - 0.3**2) / (1 - 0.29**2)
    ring = BallRing(12, 9.8e-3, 50e-3, conformities=(5.0 / 9.8, 5.0 / 9.8), moduli=(modulus, modulus))
    # The printed pressure is by 0.4 % not 3F/(2πab) of the printed axes, one of which has three digits.
    assert ring.pressure_of(1500.0) == pytest.approx(2193.6e6, rel=5e-3)
    contact = point_contact(1500.0, (1 / 4.9e-3 + 1 / 25e-3, 1 / 4.9e-3 - 1 / 5e-3), 0.5 * 210e9 / (1 - 0.29**2))
    assert (1e3 * contact.longer, 1e3 * contact.shorter) == pytest.approx((2.101, 0.156), rel=5e-3)


@pytest.mark.parametrize(
    ("difference", "longer", "shorter", "approach"),
    [(0.3204, 1.2623, 0.8114, 0.9761), (0.7948, 2.265, 0.5480, 0.7961), (0.95738, 4.395, 0.3830, 0.5551), (0.990902, 8.062, 0.2814, 0.3745)],
)  # fmt: skip
def test_printed_dimensionless_numbers_of_contacts(difference, longer, shorter, approach):
    """Harris, Rolling Bearing Analysis: axes and approach of contacts by the difference of their curvatures over their sum."""
    found = point_contact(1.0, (0.5 * (1.0 + difference), 0.5 * (1.0 - difference)), 1.0)
    unit = 1.5 ** (1.0 / 3.0)
    # The printed digits.
    assert (found.longer / unit, found.shorter / unit) == pytest.approx((longer, shorter), abs=1e-3)
    assert found.approach / (0.5 * unit**2) == pytest.approx(approach, abs=1e-4)


# Sjövall's integral of point contacts as Harris prints it (Rolling Bearing Analysis, load distribution), and Stribeck's 4.37.
PRINTED = {
    0.1: 0.1156, 0.2: 0.1590, 0.3: 0.1892, 0.4: 0.2117, 0.5: 0.2288, 0.6: 0.2416, 0.7: 0.2505, 0.8: 0.2559, 0.9: 0.2576,
    1.0: 0.2546, 1.25: 0.2289, 5 / 3: 0.1871, 2.5: 0.1339, 5.0: 0.0711,
}  # fmt: skip


@pytest.mark.parametrize("zone", [1e-9, *PRINTED, 1e7])
def test_the_load_integral(zone):
    with mpmath.workdps(25):
        end = mpmath.acos(1 - 2 * mpmath.mpf(zone)) if zone < 1 else mpmath.pi

        def part(psi):
            return max(1 - (1 - mpmath.cos(psi)) / (2 * mpmath.mpf(zone)), 0) ** 1.5 * mpmath.cos(psi) / mpmath.pi

        exact = float(mpmath.quad(part, [0, end]))
    # The root at the end of the zone costs the quadrature digits.
    assert load_integral(zone) == pytest.approx(exact, rel=1e-9)
    assert load_integral(zone) == pytest.approx(PRINTED.get(zone, exact), abs=6e-5)
    assert round(1.0 / load_integral(0.5), 2) == 4.37


def stiffness_of_a_ball(ring):
    """Both contacts by complete elliptic integrals of first and second kind, with 40 digits."""
    angle, size = mpmath.mpf(ring.contact_angle), mpmath.mpf(ring.ball_diameter)
    slope = size * mpmath.cos(angle) / (ring.race_diameter + size)
    modulus, total = 1 / ((1 - mpmath.mpf(0.3) ** 2) * 2 / mpmath.mpf(208e9)), mpmath.mpf(0)
    for side, conformity in zip((1, -1), ring.conformities, strict=True):
        along, across = 2 / size * (1 + side * slope / (1 - side * slope)), (2 - 1 / mpmath.mpf(conformity)) / size

        def unequal(m, along=along, across=across):
            k, e = mpmath.ellipk(m), mpmath.ellipe(m)
            return (e / (1 - m) - k) / (k - e) - along / across

        m = mpmath.findroot(unequal, (0.3, 1 - 1e-9), solver="bisect", maxsteps=90, tol=1e-40, verify=False)
        k, e = mpmath.ellipk(m), mpmath.ellipe(m)
        longer = (3 * (k - e) / (m * mpmath.pi * modulus * across)) ** (mpmath.mpf(1) / 3)
        total += 3 * k / (2 * mpmath.pi * modulus * longer)
    return total ** mpmath.mpf(-1.5)


@pytest.mark.parametrize("ring", [PLAIN, LOOSE, PAIR, BallRing(7, 6.35e-3, 20e-3, 0.26, preload=20.0)])
def test_the_force_of_all_balls(ring):
    """Sums over the balls, and their mean over all places, with 25 digits."""
    with mpmath.workdps(25):
        k, angle, each = stiffness_of_a_ball(ring), mpmath.mpf(ring.contact_angle), ring.balls // ring.rows
        assert ring.ball_stiffness == pytest.approx(float(k), rel=1e-12)
        axial = mpmath.mpf(0)
        if ring.preload:
            axial = (ring.preload / (each * k * mpmath.sin(angle))) ** (mpmath.mpf(2) / 3) / mpmath.sin(angle)
        for depth in (2e-7, 8e-6, 40e-6):
            play = mpmath.mpf(ring.internal_clearance) / 2

            def bears(place, moved=depth + play, play=play):
                pressed = (moved * mpmath.cos(place) - play) * mpmath.cos(angle) + axial * mpmath.sin(angle)
                return k * max(pressed, 0) ** 1.5 * mpmath.cos(angle) * mpmath.cos(place)

            for turned in (0.0, 0.2):
                exact = ring.rows * sum(bears(turned + 2 * mpmath.pi * j / each) for j in range(each))
                loads = ring.ball_loads(depth, turned)
                found = loads @ np.cos(turned + 2.0 * math.pi * np.arange(each) / each)
                assert found * ring.rows * math.cos(ring.contact_angle) == pytest.approx(float(exact), rel=1e-8)
            inside = (play * mpmath.cos(angle) - axial * mpmath.sin(angle)) / ((depth + play) * mpmath.cos(angle))
            end = mpmath.acos(max(inside, -1))
            mean = ring.balls * mpmath.quad(bears, [0, end]) / mpmath.pi
            assert ring.force(depth) == pytest.approx(float(mean), rel=1e-8)


@pytest.mark.parametrize("ring", [PLAIN, LOOSE, PAIR, BallRing(5, 6.35e-3, 45e-3)])
def test_the_most_loaded_ball_stands_in_the_direction_of_the_force(ring):
    k, each, cos = ring.ball_stiffness, ring.balls // ring.rows, math.cos(ring.contact_angle)
    for force in (300.0, 6000.0):
        largest = []
        for turned in np.linspace(0.0, math.pi / each, 7):
            places = turned + 2.0 * math.pi * np.arange(each) / each

            def loads(moved, places=places):
                pressed = (moved[0] * np.cos(places) + moved[1] * np.sin(places)) * cos + ring.closure
                return k * np.maximum(pressed, 0.0) ** 1.5

            def left(moved, places=places, loads=loads, force=force):
                on_each = ring.rows * cos * loads(1e-6 * moved)
                return [on_each @ np.cos(places) / force - 1.0, on_each @ np.sin(places) / force]

            found = root(left, [30.0, 0.1], tol=1e-12)
            assert np.abs(left(found.x)).max() < 1e-9
            largest.append(float(loads(1e-6 * found.x).max()))
        assert ring.largest_load(force) == pytest.approx(max(largest), rel=1e-8)


def test_the_power_law_is_as_near_to_the_balls_as_it_says():
    assert PLAIN.law.exponent == 1.5
    assert PLAIN.law.stiffness == pytest.approx(12 * PLAIN.ball_stiffness * load_integral(0.5), rel=1e-13)
    assert PLAIN.pressure(PLAIN.law.highest) == pytest.approx(4.2e9, rel=1e-3)
    assert BallRing(**SIZES, contact_angle=0.2, preload=1000.0).law.exponent == 1.0
    assert BallRing(**SIZES, internal_clearance=1e-3).law.error > 1.0  # over a gap no ball bears
    assert BallRing(**SIZES, internal_clearance=1e-2).largest_load(1e-9) == pytest.approx(1e-9, rel=1e-9)
    for ring, most in ((PLAIN, 0.002), (LOOSE, 0.08), (PAIR, 0.25)):
        law = ring.law
        assert 0.0 < law.error < most
        for force in np.geomspace(law.lowest, law.highest, 12)[1:-1]:
            depth = (force / law.stiffness) ** (1.0 / law.exponent)
            for turned in (0.0, 0.1, math.pi / 12):
                along = np.cos(turned + 2.0 * math.pi * np.arange(12) / 12)
                true = ring.rows * math.cos(ring.contact_angle) * float(ring.ball_loads(depth, turned) @ along)
                assert abs(true / force - 1.0) < law.error * 1.001


@pytest.mark.parametrize("ring", [PLAIN, PAIR, BallRing(9, 12.7e-3, 52.3e-3, 0.7)])
def test_inertia_is_that_of_a_ball_that_rolls(ring):
    """Velocity of the centre and spin from what both contacts do: six equations, and no spin about the line of the contacts."""
    angle, size, speed = ring.contact_angle, ring.ball_diameter, 300.0
    line, axis = np.array([math.cos(angle), 0.0, math.sin(angle)]), np.array([0.0, 0.0, 1.0])
    centre = np.array([0.5 * ring.pitch_diameter, 0.0, 0.0])
    inner, outer = centre - 0.5 * size * line, centre + 0.5 * size * line

    def velocities(motion):
        return [*(motion[:3] + np.cross(motion[3:], place - centre) for place in (inner, outer)), [motion[3:] @ line]]

    equations = np.array([np.concatenate(velocities(unit)) for unit in np.eye(6)]).T
    wanted = np.concatenate([speed * np.cross(axis, inner), np.zeros(4)])
    motion, *_ = np.linalg.lstsq(equations, wanted, rcond=None)
    assert equations @ motion == pytest.approx(wanted, abs=1e-10)
    mass = 7800.0 * math.pi / 6.0 * size**3
    energy = 0.5 * mass * motion[:3] @ motion[:3] + 0.05 * mass * size**2 * motion[3:] @ motion[3:]
    assert ring.inertia(7800.0) == pytest.approx(ring.balls * energy / (0.5 * speed**2), rel=1e-12)


BALLS = 'law = "hunt-crossley"\ndissipation = 0.3\nballs = 12\nball_diameter = "6.35 mm"\nrace_diameter = "45 mm"\n'


@pytest.mark.parametrize("name", ["touchdown-balls", "tum-flexible-rotor"])
def test_a_bearing_without_a_stiffness_has_that_of_its_balls(tmp_path, name):
    """Of one mass and of a flexible shaft: the same law as with these two numbers in the file."""
    text = (ROOT / "examples" / f"{name}.toml").read_text(encoding="utf-8")
    before, mark, after = text.partition("touchdown]")
    after = re.sub(
        r"^(stiffness|exponent|dissipation|balls|ball_diameter|race_diameter|conformity) = .*\n", "", after, flags=re.M
    )
    after = re.sub(r"^law = .*\n", BALLS, after, flags=re.M)
    own, path = before + mark + after, tmp_path / "machine.toml"

    def loaded(written, *settings):
        path.write_text(written, encoding="utf-8")
        case = cm.load(path, settings)
        return case, cm.models.rotor_of(case)

    case, rotor = loaded(own)
    loads = cm.motions.drop_loads(cm.simulate(case, cm.drop(), "9 ms"))
    for entry in load_entries(loads, case.limits):
        assert entry["touchdown"]["of_balls"]["exponent"] == 1.5
        assert entry["loads"]["ball_load_si"] == PLAIN.largest_load(entry["loads"]["force_si"])
    assert all("stiffness of balls" in dict(rows) for _, rows in load_tables(loads, "the release"))
    law = PLAIN.law
    _, stated = loaded(own.replace("balls = 12", f"stiffness = {law.stiffness}\nexponent = 1.5\nballs = 12"))
    assert [each.law for each in rotor.equations.touchdowns] == [each.law for each in stated.equations.touchdowns]
    _, loose = loaded(own, "touchdown_balls=14")
    assert loose.equations.touchdowns[0].law.stiffness > rotor.equations.touchdowns[0].law.stiffness
    assert "touchdown_ball_diameter" in rotor.varied
    assert "touchdown_ball_diameter" not in stated.varied
    bearing = TouchdownBearing("hunt-crossley", dissipation=0.3, **SIZES)
    assert (
        "stiffness of its balls 2.289×10¹⁰ N/m^1.5, within 0.13 % of the force of all balls from 86.7 to 8,670 N"
        in bearing.words
    )
    assert bearing.document()["of_balls"]["exponent"] == 1.5


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ({"exponent": 1.5}, "exponent = 1.5: must be left out: it belongs to a stiffness"),
        ({"preload": 100.0}, "contact_angle = nothing given: an axial preload needs it"),
        ({"preload": 100.0, "contact_angle": 0.0}, "contact_angle = 0.0: above 0 with an axial preload"),
        ({"preload": 1e6, "contact_angle": 0.2}, "preload = 1000000.0: less: it alone presses the balls with more than 4.2 GPa"),
        ({"preload": 1.0, "contact_angle": 0.2, "internal_clearance": 1e-5}, "internal_clearance = 1e-05: must be left out: give it or a preload"),
        ({"rows": 2, "balls": 11}, "balls = 11: as many in each row, 5 to the 25 that have room"),
        ({"balls": 30}, "balls = 30: as many in each row, 5 to the 25"),
        ({"dynamic_rating": 2e4}, "race_inertia = nothing given: a share of the life needs a race that turns"),
        ({"ball_density": 7800.0}, "race_inertia = nothing given: it adds the inertia of the balls"),
    ],
)  # fmt: skip
def test_what_balls_cannot_be(entries, words):
    with pytest.raises(InputError) as caught:
        TouchdownBearing("hunt-crossley", dissipation=0.3, **{**SIZES, **entries})
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
