"""Loads of drops over all stages: against closed forms of a mass on a spring, momentum of the race, the ledger and rolling."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import Outcome
from carom.disturbances import whirl
from carom.motions import drop_loads, energy_ledger, follow_loads, simulation
from carom.motions.kinematics import race_speed
from carom.motions.loads import MEASURED

pytestmark = pytest.mark.jit_only

BALLS = "examples/touchdown-balls.toml"
RIGID = "examples/dropped-rotor.toml"
MASS, PULL, CLEARANCE, SPEED = 5.0, 9.81, 0.25e-3, 300.0 * math.pi


def spring_case(tmp_path):
    """A balanced rotor over a spring without damper and friction."""
    path = tmp_path / "spring.toml"
    path.write_text(
        f"""
[machine]
mass = {MASS}
damping = 900
stiffness = 5e5
eccentricity = 0
clearance = {CLEARANCE}
rotor_radius = 0.02
speed = {SPEED!r}
friction = 0
[gravity]
acceleration = {PULL}
[touchdown]
law = "kelvin-voigt"
stiffness = 1e7
damping = 0
"""
    )
    return cm.load(path)


def test_a_fall_on_a_spring_in_closed_form(tmp_path):
    """From rest in the centre: ``F = mg(1 + √(1 + 2kc/(mg)))``, and half a swing about the static depth, the weight in it."""
    case = spring_case(tmp_path)
    (plane,) = drop_loads(cm.simulate(case, cm.drop(cm.State(0)), "10 ms")).planes
    fall, weight, own = math.sqrt(2.0 * CLEARANCE / PULL), MASS * PULL, math.sqrt(1e7 / MASS)
    force = weight * (1.0 + math.sqrt(1.0 + 2.0 * 1e7 * CLEARANCE / weight))
    lasts = 2.0 / own * (math.pi - math.atan(PULL * fall * own / PULL))
    si = plane.si()
    assert si["force"] == pytest.approx(force, rel=1e-9)
    assert si["depth"] == pytest.approx(force / 1e7, rel=1e-9)
    assert si["contact_time"] == pytest.approx(lasts, rel=1e-9)
    assert si["impulse"] == pytest.approx(2.0 * MASS * PULL * fall + weight * lasts, rel=1e-9)
    assert plane.force_at / SPEED == pytest.approx(fall + 0.5 * lasts, rel=1e-9)
    assert plane.impulse_at == plane.force_at
    assert plane.restitution == pytest.approx(1.0, rel=1e-9)
    assert (plane.contacts, plane.bounces, plane.is_compliant) == (1, 1, True)
    assert si["heat"] == 0.0
    assert (plane.in_contact_since, plane.race_at_end, plane.pressure) == (None, None, None)


RATED = 'dynamic_rating = "9 kN"\nstatic_rating = "4 kN"\nrace_inertia = "2e-6 kg m^2"\n'


@pytest.mark.parametrize("name", ["touchdown-balls", "tum-flexible-rotor"])
def test_the_life_that_a_landing_uses(tmp_path, name):
    """The cube of the force over the turns of the race, integrated in SI units over each segment of the recorded motion."""
    path, clearances = tmp_path / "machine.toml", iter(("0.2 mm", "0.26 mm"))
    lines = Path(f"examples/{name}.toml").read_text(encoding="utf-8").splitlines()
    text = [line for line in lines if not line.startswith("race_inertia")]
    if "tum" in name:
        text = [f'clearance = "{next(clearances)}"' if line.startswith("clearance") else line for line in text]
    path.write_text("".join(f"{line}\n{RATED if line.startswith('law =') else ''}" for line in text), encoding="utf-8")
    case = cm.load(path)
    motion = cm.simulate(case, cm.drop(), "25 ms")
    nodes, weights = np.polynomial.legendre.leggauss(14)
    starts, lasted = np.array(motion.segment_starts), motion.durations
    times = (starts[:, None] + 0.5 * lasted[:, None] * (1.0 + nodes)).ravel()
    for seen, plane in zip(motion.at_each, drop_loads(motion).planes, strict=True):
        scales, race = seen.scales, seen.rotor.races[seen.plane]
        force = seen.history(times).normal_force * scales.force
        turning = race_speed(seen.rotor.system, seen.plane, motion.amplitudes_at(times)[0]) / race.radius * scales.speed
        rolled = ((force**3 * np.abs(turning)).reshape(-1, 14) @ weights) @ (0.5 * lasted) * scales.time
        assert rolled > 0.0
        # Nodes at the ends of segments, where the force sets in, lose digits.
        assert plane.catalogue.life_share == pytest.approx(rolled / (2e6 * math.pi * 9e3**3), rel=1e-8)
        assert plane.landings == 1.0 / plane.catalogue.life_share
        broken = dataclasses.replace(plane, catalogue=plane.catalogue._replace(static_share=1.01))
        assert broken.landings == 0.0
        pressed = plane.catalogue._replace(static_share=None, pressure=4.3e9)
        assert dataclasses.replace(plane, catalogue=pressed).landings == 0.0
        assert dataclasses.replace(plane, outcome=Outcome.BEYOND_MODEL).landings is None
        assert plane.catalogue.static_share == pytest.approx(plane.si()["force"] / 4e3, rel=1e-14)
        checks = {
            check.name: check for check in cm.studies.check_loads(plane, cm.parameters.LoadLimits(life_share=1e-14))
        }
        assert checks["life_share"].exceeded
        assert checks["static_share"].limit == 1.0


def test_friction_gives_the_race_its_momentum():
    """Without drag ``J_r ω_r = R ∫F dt``, with the radius ``R + c_r`` at which the race is touched."""
    case = cm.load(BALLS, ["touchdown_race_drag=0"])
    motion = cm.simulate(case, cm.drop(race_speed="500 rpm"), "60 ms")
    (plane,) = drop_loads(motion).planes
    push = -motion.contacts.friction_impulse.sum() * case.parameters.scales.impulse
    gained = (plane.race_at_end * SPEED - 500.0 * math.pi / 30.0) * 2e-5
    assert gained == pytest.approx(push * (20e-3 + CLEARANCE), rel=1e-9)
    assert plane.fastest_race == plane.race_at_end
    assert plane.contacts == len(motion.contacts)


@pytest.mark.parametrize("machine", [BALLS, RIGID])
def test_stages_count_together(machine):
    """Levitation is back in the middle of the first contact, or after some impacts."""
    motion = cm.simulate(cm.load(machine), cm.drop(regained_after="6 ms" if machine == BALLS else "11.1 ms"))
    falls, back = motion.parts
    found = drop_loads(motion)
    (plane,) = found.planes
    assert found.time == back.begins + back.time
    lost = [energy_ledger(part) for part in (falls, back)]
    heat = -sum(each.friction[-1] + (0.0 if plane.is_compliant else each.impacts[-1]) for each in lost)
    assert plane.heat + (0.0 if plane.is_compliant else plane.restitution_loss) == pytest.approx(heat, rel=1e-9)
    if plane.is_compliant:
        assert falls.contacts.lasts[-1]
        assert not back.contacts.entered[0]
        assert plane.contacts == len(falls.contacts) + len(back.contacts) - 1
        hardest = max(
            (part.contacts.peak_force.max(), part.begins + part.contacts.peak_time[0]) for part in motion.parts
        )
        assert (plane.force, plane.force_at) == hardest
    else:
        assert plane.contacts == plane.bounces == len(falls.contacts) + len(back.contacts)
        assert min(len(falls.contacts), len(back.contacts)) > 0
        assert plane.force_at is None
        assert plane.restitution == pytest.approx(0.5, rel=1e-9)
        hardest = falls.contacts.normal_impulse.argmax()
        assert plane.impulse_at == falls.contacts.time[hardest]


def test_rolling_whirl_goes_round_with_the_ratio_of_the_radii():
    """A rigid wall that stands still is rolled round at ``ΩR/c_r``, backward, for good."""
    found = drop_loads(cm.simulate(cm.load(RIGID), cm.drop(whirl("0.2 mm", "-150 Hz"))))
    (plane,) = found.planes
    assert found.outcome is Outcome.ROLLING
    assert plane.whirl.goes_on
    assert plane.whirl.direction == "backward"
    assert plane.whirl.frequency_si == pytest.approx(80.0 * 150.0, rel=1e-9)
    assert plane.whirl.angular_speed == pytest.approx(-80.0, rel=1e-9)
    assert found.settled_at == max(plane.in_contact_since, plane.whirl.since)
    assert found.settled_at < found.time


@pytest.mark.parametrize(
    ("machine", "released", "until"),
    [
        (BALLS, cm.drop(race_speed="500 rpm"), "60 ms"),
        (BALLS, cm.drop(regained_after="6 ms"), None),
        (RIGID, cm.drop(whirl("0.2 mm", "-150 Hz")), "60 ms"),
        ("examples/tum-flexible-rotor.toml", cm.drop(), "80 ms"),
    ],
)
def test_loads_added_up_in_pieces_are_those_of_the_whole_motion(machine, released, until, monkeypatch):
    """Contacts that go over many pieces count once, with the impulse of all."""
    case = cm.load(machine)
    whole = drop_loads(cm.simulate(case, released, until))
    monkeypatch.setattr(simulation, "CHUNK", 5)
    found = follow_loads(case, released, until)
    assert (found.outcome, found.time) == (whole.outcome, pytest.approx(whole.time, rel=1e-12))
    for one, other in zip(found.planes, whole.planes, strict=True):
        assert other.contacts
        assert (one.contacts, one.bounces) == (other.contacts, other.bounces)
        for name in (
            "first",
            "force_at",
            "impulse_at",
            "restitution",
            "race_at_end",
            "fastest_race",
            "in_contact_since",
        ):
            shown = getattr(other, name)
            assert getattr(one, name) == (shown if shown is None else pytest.approx(shown, rel=1e-9)), name
        for name in MEASURED:
            assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-9), name
        assert one.whirl.turned == pytest.approx(other.whirl.turned, rel=1e-6)
