"""Machines of published work, entered in their own units, against numbers that the sources print."""

import math

import pytest
from flexible_machines import munich, munich_rotor
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from carom import State, find_equilibria, load, simulate
from carom.base.outcome import Outcome
from carom.models import jeffcott
from carom.parameters import Machine, read_quantity
from carom.parameters.terms import ENTRIES
from carom.rotors import Material, find_whirls

# The rotor-stator rig of DTU (github.com/SV3A/masterproject-contact-code): settings.toml, in kg, m, s and N.
TRANSVERSE_INERTIA, POLAR_INERTIA = 7.085371e-2, 0.106132e-2
TO_MAGNET, TO_DISC, TO_CONTACT = 171.7e-3, 259.7e-3, 428.7e-3
BEARING_STIFFNESS, BEARING_DAMPING = 3.09e4, (8.48 + 7.7) / 2
UNBALANCE_MASS, UNBALANCE_PLACE = 1e-3, complex(0.027, -0.072)
# magnet-force/rot_sim_exp315.mat, columns 3 and 4: first and last place of the disc, place and velocity at the impact.
# The columns have no names; that they are the place of the disc in metres is seen from where the velocity jumps.
# Cubics through 5 to 10 ms on both sides of the impact differ by 0.01 mm there, and by a tenth of the speeds.
FIRST, LAST = 1e-3 * complex(-0.160, 0.490), 1e-3 * complex(-0.001, -0.520)
RADIUS_AT_IMPACT, VELOCITY_BEFORE = 1.20e-3, complex(0.047, -0.047)  # towards the ring, and along it, against the angle
MEASURED_RESTITUTION = 0.63, 0.87


def test_the_machine_of_keogh_and_cole_has_the_printed_numbers_in_other_terms_too():
    """Section 2 of the source paper: m = 50 kg, k = 9.8e5 N/m, omega = 0.76, rho = 3/7."""
    printed = load("examples/keogh-cole.toml")
    rest = {
        "mass": "50 kg",
        "speed": "184.2 rad/s",
        "unbalance_phase": "0.21 rad",
        "friction": 0.15,
        "restitution": 0.95,
    }
    rewritten = Machine(
        **rest,
        natural_frequency="140 rad/s",
        damping_ratio="10 %",
        unbalance="15 kg mm",
        rotor_diameter="80 mm",
        diametral_clearance="1.4 mm",
    )

    assert rewritten == printed.machine
    assert round(printed.parameters.omega, 2) == 0.76
    assert printed.parameters.rho == 3 / 7


def test_the_test_rig_of_munich_has_nearly_the_natural_frequency_that_was_measured():
    """Abschaetzung_ML_k.m: m = 3.2740 kg, 52.013 Hz measured with P = 5000 A/m, k = (2 pi 52.013 Hz)^2 m/2 for a bearing."""
    machine = load("examples/tum-test-rig.toml").machine
    found = math.sqrt(machine.stiffness / machine.mass) / (2 * math.pi)

    # Two bearings of ki P + kx = 50 N/A 5000 A/m - 1e5 N/m = 1.5e5 N/m; ki D = 250 N s/m.
    assert (machine.stiffness, machine.damping) == (3e5, 500.0)
    assert found == pytest.approx(48.177, abs=5e-4)
    # The model has no integral gain and a rigid shaft, and ki and kx are given with one digit.
    assert found / 52.013 == pytest.approx(0.9263, abs=1e-4)
    measured = machine.replace(natural_frequency="52.013 Hz")
    assert measured.stiffness / 2 == pytest.approx((52.013 * 2 * 3.141592653589793) ** 2 * 3.2740 / 2, rel=1e-13)
    assert measured.damping == machine.damping


def test_the_flexible_shaft_of_munich_has_whirls_on_both_sides_of_what_was_measured():
    """52.013 Hz: between the bending of the shaft and its ends on the bearings, which are strongly damped; a stiff shaft has the 48.2 Hz of a rigid one."""
    at_rest = find_whirls(munich(speed=1.0), count=6)
    assert [round(each.frequency, 1) for each in at_rest[::2]] == [16.7, 59.8, 61.8]
    stiff = munich(speed=1.0, rotor=munich_rotor(material=Material(1e15, 7860.0)))
    # What the derivative gain damps slows it down: the size of the exponent is the frequency without.
    lowest = min(abs(each.exponent) for each in find_whirls(stiff)) / (2 * math.pi)
    assert lowest == pytest.approx(48.177, rel=0.02)


def test_the_test_rig_levitates_within_its_limit_of_current():
    case = load("examples/tum-test-rig.toml")
    levitation = find_equilibria(jeffcott(case.parameters)).members[0]
    machine = case.machine

    current = abs(5000.0 + 5j * machine.speed) * levitation.radius * machine.clearance  # gains of the file

    assert levitation.status == "admissible"
    assert current < 0.1 * machine.current_limit


@pytest.fixture
def danish():
    return load("examples/dtu-test-rig.toml")


def test_the_test_rig_of_denmark_is_the_published_rotor_seen_where_it_touches(danish):
    """A rotor that turns about a joint moves at the ring like a mass I/l^2; forces elsewhere act by their distances."""
    machine = danish.machine

    # The file gives six digits.
    assert machine.mass == pytest.approx(TRANSVERSE_INERTIA / TO_CONTACT**2, rel=2e-6)
    assert machine.stiffness == pytest.approx(BEARING_STIFFNESS * (TO_MAGNET / TO_CONTACT) ** 2, rel=2e-6)
    assert machine.damping == pytest.approx(BEARING_DAMPING * (TO_MAGNET / TO_CONTACT) ** 2, rel=3e-6)
    assert machine.mass * machine.eccentricity == pytest.approx(
        UNBALANCE_MASS * abs(UNBALANCE_PLACE) * TO_DISC / TO_CONTACT, rel=2e-6
    )
    assert machine.clearance == pytest.approx(14.5e-3 - 12.5e-3, rel=1e-12)
    assert machine.speed == pytest.approx(17 * math.tau, rel=1e-15)


def test_the_test_rig_of_denmark_whirls_as_far_as_was_measured_but_for_the_gyroscopic_moment(danish):
    machine = danish.machine
    levitation = find_equilibria(jeffcott(danish.parameters)).members[0]
    at_disc = levitation.radius * machine.clearance * TO_DISC / TO_CONTACT

    # In synchronous whirl the gyroscopic moment takes I_zz off I_xx: 1.5 % of it, and 10 % off a response this near
    # resonance.  The rest is the coupling of the two directions in the bearing, left out, which makes circles ellipses.
    held = complex(BEARING_STIFFNESS, BEARING_DAMPING * machine.speed) * TO_MAGNET**2
    plain, gyroscopic = (
        abs(held - inertia * machine.speed**2) for inertia in (TRANSVERSE_INERTIA, TRANSVERSE_INERTIA - POLAR_INERTIA)
    )

    assert at_disc == pytest.approx(0.560e-3, abs=5e-7)
    assert at_disc / abs(FIRST) == pytest.approx(1.0862, abs=1e-4)
    assert at_disc * plain / gyroscopic == pytest.approx(abs(FIRST), rel=0.03)


def test_the_test_rig_of_denmark_was_hit_where_its_clearance_says(danish):
    at_contact = RADIUS_AT_IMPACT * TO_CONTACT / TO_DISC

    assert at_contact == pytest.approx(danish.machine.clearance, rel=0.01)


def test_the_restitution_of_the_test_rig_of_denmark_is_what_its_contact_law_does(danish):
    """Nikravesh.m: F = K d^1.5 (1 + 3 (1 - e^2)/4 d'/v) with e = 1/2, for an approach at v; it leaves at 0.725 v, not v/2.

    With u = d'/v and a = 3 (1 - e^2)/4, u du/(1 + a u) = -K d^1.5 dd/(m v^2), so that u/a - ln(1 + a u)/a^2 is the same
    before and after.
    """
    slope = 0.75 * (1 - 0.5**2)

    def invariant(u):
        return u / slope - math.log1p(slope * u) / slope**2

    left = brentq(lambda u: invariant(-u) - invariant(1.0), 1e-6, 1.0, xtol=1e-14)

    def fall(time, state):
        return state[1], -(state[0] ** 1.5) * (1 + slope * state[1]) if state[0] > 0 else 0.0

    def out(time, state):
        return state[0] + 1e-12  # the start, at zero, is no way out

    out.terminal, out.direction = True, -1
    flown = solve_ivp(fall, (0.0, 20.0), (0.0, 1.0), events=out, method="DOP853", rtol=1e-11, atol=1e-13)

    assert -flown.y_events[0][0][1] == pytest.approx(left, rel=1e-7)
    assert danish.machine.restitution == pytest.approx(left, abs=5e-4)
    low, high = MEASURED_RESTITUTION
    assert low < danish.machine.restitution < high


def test_the_test_rig_of_denmark_comes_back_from_the_measured_impact(danish):
    """The record ends within 1 % of the radius at which it began; its phase to the unbalance is not known: all are tried."""
    assert abs(LAST) == pytest.approx(abs(FIRST), rel=0.01)
    scales = danish.parameters.scales
    # The rig turns against the angle, so the mirror image is followed; along the ring the rotor moves with the shaft.
    velocity = VELOCITY_BEFORE.conjugate() * (TO_CONTACT / TO_DISC) / (scales.clearance * scales.speed)
    for phase in range(0, 360, 15):
        machine = danish.machine.replace(unbalance_phase=f"{phase} deg")
        motion = simulate(machine, State(1 + 0j, velocity - 1j), settle=True)
        assert motion.outcome is Outcome.LEVITATED
        assert len(motion.contacts)


def test_weight_and_unbalance_printed_in_two_systems_of_units_agree():
    """An asymmetric rotor "(19N; 4.3 lb)" with a rotating unbalance of "(43 µm.N; 6100 µin.oz)", at up to 50,000 rpm.

    "Dynamic characteristics of a high-speed rotor with radial and axial foil-bearing supports", J. Lubrication Technology
    103 (1981) 361, abstract.  The unbalance is printed as weight times length.
    """
    gravity = 9.80665
    weight = read_quantity(ENTRIES["mass"], "4.3 lb") * gravity
    unbalance = read_quantity(ENTRIES["unbalance"], "6100 µoz in") * gravity

    assert round(weight) == 19
    assert round(unbalance * 1e6) == 43
    assert read_quantity(ENTRIES["unbalance"], "6100 µoz-in") * gravity == unbalance
    assert read_quantity(ENTRIES["speed"], "50,000 rpm") == pytest.approx(50000 * math.tau / 60, rel=1e-15)
