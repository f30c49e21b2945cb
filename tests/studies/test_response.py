"""Response over speed: limits, margins, words, and whether simulated motions do what is said of each speed."""

import cmath
import math
from itertools import pairwise

import numpy as np
import pytest
from compilation import sized
from machines import LIGHT, machine_file

import carom as cm
from carom.base.outcome import Outcome
from carom.base.results import table_of
from carom.models import Rotor, jeffcott
from carom.motions.ensembles import settle
from carom.parameters import Machine
from carom.studies import unbalance_response
from carom.studies.critical_speeds import vibration_limit
from carom.studies.response import BEARING

RPM = math.pi / 30.0


@pytest.fixture(scope="module")
def real():
    return unbalance_response(cm.load("examples/keogh-cole.toml"), ("500 rpm", "4000 rpm"))


def test_the_real_machine(real):
    (critical,), machine = real.criticals, real.case.machine
    ratio = 0.5 * machine.damping / math.sqrt(machine.stiffness * machine.mass)
    peak = machine.eccentricity / (2.0 * ratio * math.sqrt(1.0 - ratio**2))
    # (ρ/|U|)² = y² − 2by + 1 with y = (ω_n/Ω)² and b = 1 − 2ζ² is twice its least value at the half-power speeds.
    reach = 2.0 * ratio * math.sqrt(1.0 - ratio**2)
    half = [math.sqrt(machine.stiffness / machine.mass / (1.0 - 2.0 * ratio**2 + side * reach)) for side in (1.0, -1.0)]
    assert critical.speed / RPM == pytest.approx(1350.474, abs=1e-3)
    assert critical.factor == pytest.approx(4.796906, abs=1e-6)
    assert critical.half_power == pytest.approx(half, rel=1e-9)  # twice the tolerance of a root
    assert critical.amplitude == pytest.approx(peak, rel=1e-12)
    assert [steady.what for steady in real.stretches] == [
        (True, 0, 0, True),
        (False, 1, 0, True),
        (True, 1, 1, True),
    ]
    # Ends of the stretches are where the diagram along the speed has its special points.
    points = cm.find_bifurcations(cm.load("examples/keogh-cole.toml"), "speed", (100.0, 200.0)).points
    touching = [point.value for point in points if point.kind == "boundary-equilibrium"]
    assert [stretch.high for stretch in real.stretches[:-1]] == pytest.approx(touching, rel=1e-9)


def test_the_present_and_the_critical_speed_are_on_the_curve(real):
    for speed in (real.present, real.criticals[0].speed):
        assert speed in real.speeds
    place = int(np.flatnonzero(real.speeds == real.present)[0])
    equilibrium = cm.find_equilibria(real.case)[0]
    assert real.amplitude[place] == pytest.approx(equilibrium.radius, rel=1e-12)
    assert real.peak_to_peak_si[place] == pytest.approx(2.0 * 0.7e-3 * equilibrium.radius, rel=1e-12)


def random_machine(random: np.random.Generator, least_unbalance: float = 0.003) -> Machine:
    """Machines whose critical and operating speeds are of the size of those of compressors and turbines."""
    mass, natural, clearance = 10 ** random.uniform(0, 3), 10 ** random.uniform(2, 3.5), 10 ** random.uniform(-4, -3)
    return Machine(
        mass=mass,
        damping=2.0 * 10 ** random.uniform(-1.7, -0.4) * mass * natural,
        stiffness=mass * natural**2,
        eccentricity=clearance * 10 ** random.uniform(math.log10(least_unbalance), -0.2),
        clearance=clearance,
        rotor_radius=clearance * random.uniform(30, 150),
        speed=natural * random.uniform(0.5, 2.5),
        unbalance_phase=random.uniform(-3, 3),
        friction=random.uniform(0.05, 0.3),
        restitution=random.uniform(0.4, 0.95),
    )


def test_where_the_limit_of_api_617_is_exceeded():
    """At fresh speeds, the vibration of the contact-free equilibrium is compared with the limit again."""
    random = np.random.default_rng(11)
    crossings = 0
    for _ in range(sized(compiled=60, interpreted=20, deep=1000)):
        machine = random_machine(random)
        low, high = machine.speed * 0.2, machine.speed * 8.0
        response = unbalance_response(machine, (low, high))
        ends = [low, *(stretch.high for stretch in response.exceeds_api_617)]
        crossings += len(ends) - 2
        assert ends[-1] == high
        for stretch, (first, last) in zip(response.exceeds_api_617, pairwise(ends), strict=True):
            speed = first + (last - first) * random.uniform(1e-6, 1.0 - 1e-6, 20)
            width = np.array([2.0 * machine.clearance * abs(_equilibrium(machine, one)) for one in speed])
            assert ((width > vibration_limit(speed)) == stretch.what).all()
    assert crossings > 40


def _equilibrium(machine: Machine, speed: float) -> complex:
    return jeffcott(machine.parameters.replace(speed=speed)).equilibrium


@pytest.mark.jit_only
def test_motions_do_what_is_said_of_each_speed():
    """Motions from fresh starts at fresh speeds, followed to their ends.

    Where no contact-free motion is possible none ends there; where it is possible the levitating rotor stays so; next to a
    stable rub the motion settles in it; and a rotor that rolls goes on rolling.
    """
    random = np.random.default_rng(12)
    seen = {"virtual": 0, "free": 0, "rub": 0, "rolls": 0}
    for _ in range(sized(compiled=12, interpreted=2, deep=150)):
        machine = random_machine(random, least_unbalance=0.05)
        response = unbalance_response(machine)
        for stretch in response.stretches:
            low, high = stretch.low, stretch.high
            speed = low + (high - low) * random.uniform(0.02, 0.98)
            rotor = jeffcott(machine.parameters.replace(speed=speed))
            if stretch.what.contact_free:
                (end,) = _ends(rotor, [rotor.equilibrium], [0j])
                assert end == Outcome.LEVITATED
                seen["free"] += 1
            else:
                places = [cmath.rect(math.sqrt(random.uniform()), random.uniform(0, 6.3)) for _ in range(20)]
                ends = _ends(rotor, places, [complex(*random.normal(0.0, 0.5, 2)) for _ in places])
                assert Outcome.LEVITATED not in ends
                seen["virtual"] += 1
            if stretch.what.stable_rubs:
                angle = cm.closed_forms.rub_angles(machine, [speed])[0, 0] + rotor.unbalance_phase
                (end,) = _ends(rotor, [cmath.rect(1.0, angle + 1e-3)], [0j])
                assert end == Outcome.FORWARD_RUB
                seen["rub"] += 1
            if stretch.what.rolls:
                place = cmath.rect(1.0, random.uniform(0, 6.3))
                (end,) = _ends(rotor, [place], [-1j * (1.0 + rotor.parameters.radius_ratio) * place])
                assert end == Outcome.ROLLING
                seen["rolls"] += 1
    assert min(seen.values()) >= 3, seen


def _ends(rotor: Rotor, places: list[complex], velocities: list[complex]) -> list[int]:
    return settle(rotor, cm.State(np.array(places), np.array(velocities))).outcomes.tolist()


def test_the_lag_at_the_present_speed_is_that_of_the_curve():
    """Of two bearings one is past the half turn: 202° and 182°, not -158° and -178°."""
    found = unbalance_response(cm.load("examples/uberlandia-flexible-rotor.toml"))
    lags = np.degrees(found.lags_of(found.now))
    beside = [np.interp(found.present, found.speeds, np.degrees(lag)) for lag in found.lags.T]
    # Between two speeds of the curve the lag turns by less than a degree.
    np.testing.assert_allclose(lags, beside, atol=1.0)
    assert lags.min() > 180.0
    shown = [row[-1] for row in table_of(BEARING, range(2), found)[1]]
    assert shown == ["202°", "182°"]
    assert found.to_dict()["present"]["lag"] == pytest.approx(math.radians(lags[found.worst]))


def test_separation_margin():
    below = unbalance_response(LIGHT, operating=("8000 rpm", "10000 rpm"))
    critical = below.criticals[0].speed
    assert below.criticals[0].separation.side == "below"
    assert below.criticals[0].separation.actual == pytest.approx(1.0 - critical / (8000.0 * RPM))
    assert below.criticals[0].separation.required == pytest.approx(
        0.17 * (1.0 - 1.0 / (below.criticals[0].factor - 1.5))
    )
    assert below.criticals[0].separation.met
    above = unbalance_response(LIGHT, operating=("2000 rpm", "5500 rpm"))
    assert above.criticals[0].separation.side == "above"
    assert above.criticals[0].separation.actual == pytest.approx(critical / (5500.0 * RPM) - 1.0)
    assert not above.criticals[0].separation.met
    inside = unbalance_response(LIGHT, operating=("2000 rpm", "9000 rpm"))
    assert (
        inside.criticals[0].separation.side,
        inside.criticals[0].separation.actual,
        inside.criticals[0].separation.met,
    ) == ("inside", 0.0, False)
    assert "not met" in " ".join(inside.words)
    flat = unbalance_response(LIGHT.replace(damping="12000 N s/m"))
    assert flat.criticals[0].factor is None
    assert flat.criticals[0].separation.met
    assert "requires no separation margin" in " ".join(flat.words)
    assert unbalance_response(LIGHT.replace(damping="20000 N s/m")).criticals == ()


def test_where_a_rotor_that_sags_touches_and_its_bearings_saturate():
    """The ends of the ranges, at speeds of their own, against the modes of the levitating rotor there."""
    case = cm.load(machine_file("saturating"))
    response, model = unbalance_response(case), cm.models.rotor_of(case)
    assert response.rubs is None
    assert {stretch.what.contact_free for stretch in response.stretches} == {True, False}
    assert [stretch.what for stretch in response.saturating].count(True) == 1
    for stretch in response.stretches:
        at = math.sqrt(stretch.low * stretch.high)
        reach = cm.closed_forms.levitation(model.replace(speed=at)).reach
        assert (reach < 1.0) is stretch.what.contact_free
        assert response.at(at).reach[0, 0] == pytest.approx(reach, rel=1e-9)
    for stretch in response.saturating:
        at = math.sqrt(stretch.low * stretch.high)
        held = cm.closed_forms.levitation(model.replace(speed=at))
        assert held.stable is not stretch.what
