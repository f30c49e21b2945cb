"""Contacts with compliant walls: closed forms of a free mass, and the reference."""

import math

import numpy as np
import pytest
from compliant_reference import ROLLING, SEPARATED
from linear_rotors import single, tilting
from scipy.optimize import brentq
from yielding_walls import SUMS, contacts_of, free_mass, with_walls

from carom.base.outcome import Phase
from carom.core.wall_work import DEPTH, FORCE, FORCE_TIME, FRICTION, HEAT, NORMAL, POWER
from carom.models import HuntCrossley, KelvinVoigt
from carom.motions import State, energy_ledger, simulate
from carom.motions.contacts import contact_works
from carom.motions.kinematics import presses, slip_velocity
from carom.motions.ledger import NODES, WEIGHTS

pytestmark = pytest.mark.jit_only
SPEED = 0.7
COMPARED = ("time", "end", "radial_speed", "radial_speed_after", "peak_force", "deepest", *SUMS)
MEETS_AGAIN = (0.1347377930935035 - 0.37505867749253735j, 0.5369589511310852 + 1.3589087556179946j)
"""A start that does, found by following many."""


def hit_of(law):
    """The one contact of a free mass that flies straight at its wall, at 0.7."""
    motion = simulate(free_mass(law), State(0j, SPEED + 0j), 2.5)
    assert len(motion.contacts) == 1
    return motion.contacts, motion


@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e7])
@pytest.mark.parametrize("ratio", [0.0, 0.0164982, 0.3, 0.49, 0.51, 0.9, 2.0])
def test_free_mass_on_a_kelvin_voigt_wall(stiffness, ratio):
    """``ẍ + cẋ + κx = 0`` until the force vanishes; then free flight until the wall's place is left, ``c/κ`` later."""
    damping = 2.0 * ratio * math.sqrt(stiffness)
    hit, _ = hit_of(KelvinVoigt(stiffness, damping))
    root, angle = math.sqrt(abs(1.0 - ratio**2)), math.acos(ratio) if ratio < 1.0 else math.acosh(ratio)
    restitution = math.exp(-2.0 * ratio * angle / root)
    held = 2.0 * angle / root / math.sqrt(stiffness)
    depth = SPEED / math.sqrt(stiffness) * math.exp(-ratio * angle / root)
    sine = math.asin(min(ratio, 1.0))
    peak = SPEED * damping
    if ratio < 0.5:
        peak = SPEED * math.sqrt(stiffness) * math.exp(-math.tan(sine) * (0.5 * math.pi - 3.0 * sine))
    # A depth is known to the rounding of the radius, 1e-16, beside at least 7e-5.
    assert -hit.radial_speed_after[0] / hit.radial_speed[0] == pytest.approx(restitution, rel=1e-10)
    assert hit.duration[0] == pytest.approx(held + damping / stiffness, rel=1e-9)
    assert hit.deepest[0] == pytest.approx(depth, rel=1e-10)
    assert hit.peak_force[0] == pytest.approx(peak, rel=1e-10)
    assert hit.normal_impulse[0] == pytest.approx(SPEED * (1.0 + restitution), rel=1e-10)
    assert hit.normal_loss[0] == pytest.approx(0.5 * SPEED**2 * (1.0 - restitution**2), rel=1e-9, abs=1e-13)
    assert hit.heat[0] == hit.friction_impulse[0] == 0.0
    assert hit.time[0] == pytest.approx(1.0 / SPEED, rel=1e-12)
    if 0.0 < ratio < 0.5:
        time = (0.5 * math.pi - 3.0 * sine) / (math.sqrt(stiffness) * math.cos(sine))
        # A maximum is flat: its place is known to the root of the rounding of its value.
        assert hit.peak_time[0] - hit.time[0] == pytest.approx(time, abs=1e-6 * held)


@pytest.mark.parametrize("stiffness", [1e2, 1e5, 1e7])
@pytest.mark.parametrize("dissipation", [0.02, 0.5, 3.0])
def test_free_mass_on_a_hunt_crossley_wall(stiffness, dissipation):
    """The restitution is independent of the stiffness; the depth follows from ``u du/(1 + χu) = −κδ dδ``."""
    hit, motion = hit_of(HuntCrossley(stiffness, dissipation))
    grown = dissipation * SPEED

    def off(share):
        return math.log((1.0 + grown) / (1.0 - share * grown)) - grown * (1.0 + share)

    restitution = brentq(off, 1e-6, min(1.0, (1.0 - 1e-12) / grown), xtol=1e-15)
    depth = math.sqrt(2.0 * (SPEED / dissipation - math.log1p(grown) / dissipation**2) / stiffness)
    assert -hit.radial_speed_after[0] / hit.radial_speed[0] == pytest.approx(restitution, rel=1e-9)
    assert hit.deepest[0] == pytest.approx(depth, rel=1e-9)
    assert hit.normal_loss[0] == pytest.approx(0.5 * SPEED**2 * (1.0 - restitution**2), rel=1e-9)
    assert Phase.SEPARATED not in motion.segment_phases


def compared(rotor, law, start, until):
    """A motion and its contacts by the reference, after comparing them."""
    model = with_walls(rotor, law)
    others = contacts_of(model, *map(np.atleast_1d, start), until)
    motion = simulate(model, State(*start), until)
    for plane in range(len(rotor.planes)):
        touches, here = motion.seen_at(plane).contacts, [touch for touch in others if touch.plane == plane]
        assert len(here) == len(touches) - touches.lasts.sum()
        for place, other in enumerate(here):
            for name in COMPARED:
                expected = pytest.approx(getattr(other, name), rel=1e-8, abs=1e-9)
                assert getattr(touches, name)[place] == expected, (name, plane, place)
    return others, motion


def meetings(motion):
    """How often the plane meets a wall again from which it has parted, before it has left its place."""
    phases = motion.segment_phases[:, 0]
    return ((phases[:-1] == Phase.SEPARATED) & presses(phases[1:])).sum()


@pytest.mark.parametrize(
    ("law", "friction", "ratio", "until"),
    [
        (KelvinVoigt(1e3, 1.0), 0.15, 20.0, 3.0),
        (KelvinVoigt(1e4, 250.0), 0.15, 20.0, 8.0),
        (HuntCrossley(1e4, 0.1), 0.15, 20.0, 3.0),
        (KelvinVoigt(1e3, 1.0), 0.8, 1.5, 3.0),
        (HuntCrossley(1e4, 0.1), 0.8, 1.5, 3.0),
    ],
)
def test_one_plane_against_the_reference(law, friction, ratio, until):
    others, motion = compared(single(1, friction=friction, radius_ratio=ratio), law, (0.2 + 0.1j, 1.0 + 0.3j), until)
    assert len(others) >= 2
    phases = {phase for touch in others for phase in touch.phases}
    assert (ROLLING in phases) == (Phase.ROLLING in motion.segment_phases) == (ratio < 2.0)
    assert (SEPARATED in phases) == (Phase.SEPARATED in motion.segment_phases) == isinstance(law, KelvinVoigt)


def test_a_plane_that_meets_its_wall_again():
    """Strongly damped walls come back so slowly that the plane parts from them, turns, and meets them at another depth."""
    rotor = single(1, friction=0.8, radius_ratio=1.5)
    _, motion = compared(rotor, KelvinVoigt(1e3, 60.0), MEETS_AGAIN, 5.2)
    assert meetings(motion) == 1
    assert energy_ledger(motion).imbalance < 1e-12


@pytest.mark.parametrize(
    ("law", "friction", "ratio"), [(KelvinVoigt(3e2, 1.0), 0.15, 20.0), (HuntCrossley(1e3, 0.2), 0.8, 1.5)]
)
def test_two_planes_against_the_reference(law, friction, ratio):
    rotor = tilting(2, friction=friction, radius_ratio=ratio)
    others, motion = compared(rotor, law, (np.array([0.1, 0.02j]), np.array([0.9 + 0.2j, 0.02])), 5.0)
    assert {touch.plane for touch in others} == {0, 1}
    assert (motion.segment_phases != Phase.FLIGHT).all(axis=1).any()


@pytest.mark.parametrize("law", [None, KelvinVoigt(300.0, 8.0), HuntCrossley(300.0, 0.2, 1.5)])
def test_what_contact_does_in_a_step_is_that_of_its_states(law):
    """By one series for each segment, against the amplitudes at 16 nodes for the sums, and at a thousand instants for the largest."""
    rotor = single(1).model if law is None else with_walls(single(1), law)
    motion = simulate(rotor, State(0.8, 1.6j) if law is None else State(0.3 + 0.1j, 1.2 + 0.4j), 12.0)
    works = contact_works(motion)
    segments, lasts = works.segments, motion.durations[works.segments]

    def at(places):
        elapsed = lasts[:, None] * places
        amplitudes, phases = motion.amplitudes_in(np.repeat(segments[:, None], len(places), axis=1), elapsed)
        normal, friction = motion.forces_of(amplitudes, phases, motion.segment_starts[segments, None] + elapsed)
        (place, _), slip = motion.rotor.system.at_plane(amplitudes, 0), slip_velocity(rotor.system, 0, amplitudes)
        return normal, friction, -friction * slip, (np.abs(place) - 1.0) * (law is not None)

    found = works.found[:, 0].T
    normal, friction, power, _ = at(0.5 * (1.0 + NODES))
    assert len(segments) > 4
    # Rounding of a radius of one, which the wall multiplies by its stiffness.
    for column, sums in ((NORMAL, normal), (FRICTION, friction), (HEAT, power)):
        assert found[column] == pytest.approx(0.5 * lasts * (sums @ WEIGHTS), abs=1e-12)
    assert law is None or max(found[FORCE_TIME] / lasts) > 0.1
    normal, _, power, depth = at(np.linspace(0.0, 1.0, 1001))
    for column, values in ((FORCE, normal), (POWER, power), (DEPTH, depth)):
        below = found[column] - values.max(axis=1)
        assert below.min() > -1e-11
        assert below.max() <= 1e-5 * values.max()
