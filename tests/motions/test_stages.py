"""Motions in stages: their triggers against the log of contacts, and one start like many."""

import math

import numpy as np
import pytest
from compilation import sized
from linear_rotors import tilting
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError, Outcome
from carom.models import Force, Stage, Trigger, in_stages, jeffcott

pytestmark = pytest.mark.jit_only

ROTOR = jeffcott(PAPER.replace(gamma=0.1))
HELPED = ROTOR.replace(gamma=0.8)
KICK = cm.kick(0.7, 0.4)
WEIGHT = Force(-1j, np.array([-5e-4]))


def starts(count, seed=0):
    random = np.random.default_rng(seed)
    kicks = random.uniform(0.3, 1.2, count) * np.exp(1j * random.uniform(0.0, 6.3, count))
    return np.full(count, ROTOR.equilibrium), kicks


def touching(motion):
    """Beginning and end of each time at the wall, in chronological order."""
    times = [(time, time) for time in motion.contacts.time]
    return sorted(times + [(each.start, each.end) for each in motion.lasting_contacts])


def persisted_at(touches, gap, least):
    """Time at which contact has lasted for so long, with flights up to ``gap``; infinite if it never has.

    While it flies nobody knows whether it will touch again: contact counts as lasting until the gap is over.
    """
    begun, last = math.inf, -math.inf
    for begins, ends in [*touches, (math.inf, math.inf)]:
        if begun + least <= min(begins, last + gap):
            return begun + least
        if begins - last > gap:
            begun = begins
        if begun + least <= ends < math.inf:
            return begun + least
        last = ends
    return math.inf


@pytest.mark.parametrize(("least", "gap"), [(5.0, 2.0), (3.0, 0.8), (12.0, 3.0), (0.5, 0.0), (2.0, 0.0)])
def test_contact_that_persists_triggers_when_the_log_says_so(least, gap):
    staged = in_stages((Stage(ROTOR, Trigger(contact_time=least, contact_gap=gap)), Stage(HELPED)))
    positions, kicks = starts(sized(40, 10))
    triggered = 0
    for position, kick in zip(positions, kicks, strict=True):
        whole = cm.simulate(ROTOR, cm.State(position, kick), 200.0)
        expected = persisted_at(touching(whole), gap, least)
        first = cm.simulate(staged, cm.State(position, kick), 200.0).parts[0]
        if expected == math.inf:
            assert first.outcome is not Outcome.TRIGGERED
            continue
        assert first.outcome is Outcome.TRIGGERED
        assert first.time == pytest.approx(expected, abs=1e-9)
        place, _ = whole.at(np.array([first.time - 1e-9]))
        assert first.final.position == pytest.approx(place[0], abs=1e-6)
        triggered += 1
    assert triggered > (0 if gap == 0.0 else 3)


def test_a_hard_impact_triggers_just_after_it():
    staged = in_stages((Stage(ROTOR, Trigger(impact_speed=0.5)), Stage(HELPED)))
    seen = set()
    for position, kick in zip(*starts(20), strict=True):
        whole = cm.simulate(ROTOR, cm.State(position, kick), 100.0)
        hard = np.flatnonzero(whole.contacts.radial_speed >= 0.5)
        parts = cm.simulate(staged, cm.State(position, kick), 100.0).parts
        seen.add(bool(len(hard)))
        if len(hard):
            assert parts[0].time == pytest.approx(whole.contacts.time[hard[0]], abs=1e-10)
            assert len(parts[0].contacts) == hard[0] + 1
            assert parts[1].contacts.time[0] > 0.0 if len(parts[1].contacts) else True
        else:
            assert len(parts) == 1
    assert seen == {True, False}


def test_the_next_stage_is_a_motion_of_its_rotor():
    motion = cm.simulate(in_stages((Stage(ROTOR, Trigger(time=7.0)), Stage(HELPED))), KICK)
    first, second = motion.parts
    assert (first.outcome, first.time, second.begins) == (Outcome.TRIGGERED, 7.0, 7.0)
    assert first.final == cm.simulate(ROTOR, KICK, 7.0).final
    alone = cm.simulate(HELPED, first.final)
    assert (motion.outcome, motion.time, motion.final) == (alone.outcome, alone.time, alone.final)
    assert motion.parts[0].earlier == ()


def test_what_is_carried_over_may_change():
    """The rotor stops dead in the fixed frame where its stage ends."""
    stop = np.array([[1.0, 0.0], [-1j, 0.0]])
    staged = in_stages((Stage(ROTOR, Trigger(time=3.0), carry=stop), Stage(HELPED)))
    first, second = cm.simulate(staged, KICK).parts
    assert second.start.position == pytest.approx(first.final.position, abs=1e-15)
    assert second.start.velocity == pytest.approx(-1j * first.final.position, abs=1e-15)
    ends = cm.settle(staged, cm.State(*starts(12)))
    for place, (position, kick) in enumerate(zip(*starts(12), strict=True)):
        assert cm.simulate(staged, cm.State(position, kick)).outcome == ends.outcomes[place]


@pytest.mark.parametrize(
    "trigger",
    [
        Trigger(time=5.0),
        Trigger(contact_time=4.0, contact_gap=2.0),
        Trigger(impact_speed=0.6),
        Trigger(6.0, 4.0, 2.0, 0.6),
    ],
    ids=["time", "contact", "impact", "all"],
)
def test_many_starts_end_as_each_alone(trigger):
    staged = in_stages((Stage(ROTOR, trigger), Stage(HELPED, Trigger(time=4.0)), Stage(ROTOR)))
    positions, kicks = starts(sized(60, 20), seed=3)
    ends = cm.settle(staged, cm.State(positions, kicks), threads=2)
    for place, (position, kick) in enumerate(zip(positions, kicks, strict=True)):
        motion = cm.simulate(staged, cm.State(position, kick))
        assert motion.outcome == ends.outcomes[place]
        if motion.outcome is not Outcome.FORWARD_RUB:  # which settle proves before it is reached
            assert sum(len(part.contacts) for part in motion.parts) == ends.impacts[place]
    until = cm.settle(staged, cm.State(positions, kicks), until=20.0, patience=0)
    for place, (position, kick) in enumerate(zip(positions, kicks, strict=True)):
        motion = cm.simulate(staged, cm.State(position, kick), 20.0)
        assert motion.outcome == until.outcomes[place]
        assert motion.begins + motion.time == pytest.approx(until.times[place], abs=1e-9)
        assert motion.final.position == pytest.approx(until.positions[place], abs=1e-7)


@pytest.mark.parametrize(
    ("field", "made"),
    [
        ("stages", lambda: in_stages(())),
        ("time", lambda: Trigger(time=0.0)),
        ("contact_gap", lambda: Trigger(contact_gap=-1.0)),
        ("carry", lambda: Stage(ROTOR, carry=np.eye(3))),
        ("carry", lambda: Stage(ROTOR, carry=np.full((2, 2), np.nan))),
        ("rotor", lambda: Stage(PAPER)),
        ("rotor", lambda: Stage(in_stages((Stage(ROTOR),)))),
        ("rotor", lambda: in_stages((Stage(ROTOR),)).under(WEIGHT)),
        ("forces", lambda: ROTOR.under()),
        ("exponent", lambda: ROTOR.under(Force(np.nan, [0.1]))),
        ("accelerations", lambda: ROTOR.under(Force(-1j, [0.1, 0.2]))),
    ],
)
def test_bad_stages_are_refused(field, made):
    with pytest.raises(InputError, match=field):
        made()


def test_a_motion_of_several_stages_is_saved_whole_and_part_by_part(tmp_path):
    motion = cm.simulate(in_stages((Stage(ROTOR, Trigger(time=7.0)), Stage(HELPED))), KICK)
    motion.save(tmp_path / "whole.nc")
    assert [part.begins for part in cm.motions.Trajectory.load(tmp_path / "whole.nc").parts] == [0.0, 7.0]
    motion.parts[0].save(tmp_path / "first.nc")
    again = cm.motions.Trajectory.load(tmp_path / "first.nc")
    assert (again.begins, again.time, again.outcome) == (0.0, 7.0, Outcome.TRIGGERED)


@pytest.mark.parametrize(("least", "gap"), [(30.0, 4.0), (100.0, 6.0), (1000.0, 10.0)])
def test_contact_that_would_settle_triggers_once_it_has_persisted(least, gap):
    """Periodic bouncing and a rub that attracts are known long before."""
    for rotor in (ROTOR, ROTOR.replace(gamma=0.2)):
        staged = in_stages((Stage(rotor, Trigger(contact_time=least, contact_gap=gap)), Stage(HELPED)))
        positions, kicks = starts(12, 1)
        ends = cm.settle(staged, cm.State(positions, kicks))
        for position, kick, outcome in zip(positions, kicks, ends.outcomes, strict=True):
            motion = cm.simulate(staged, cm.State(position, kick))
            followed = cm.simulate(staged, cm.State(position, kick), 5000.0, settle=False)
            assert motion.outcome == outcome
            assert [part.begins for part in motion.parts] == pytest.approx([part.begins for part in followed.parts])
            alone = cm.simulate(rotor, cm.State(position, kick))
            assert len(motion.parts) == (1 if alone.outcome is Outcome.LEVITATED else 2)


def test_every_plane_of_a_joint_impact_may_trigger():
    rotor = tilting(arms=(0.8, -0.8), forcing=np.zeros(2)).model
    position, velocity = np.linalg.solve(rotor.equations.planes, np.array([[1.0, 0.1], [1.0, 1.0]], complex)).T
    staged = in_stages((Stage(rotor, Trigger(impact_speed=0.5)), Stage(rotor)))
    first = cm.simulate(staged, cm.State(position, velocity), 20.0).parts[0]
    assert (first.outcome, first.time) == (Outcome.TRIGGERED, 0.0)


def test_a_flight_next_to_the_wall_is_no_contact():
    """What follows lasting contact of a plane next to others is followed by Taylor series, as if there still were contact."""
    rotor = tilting().model
    position = np.array([np.exp(2j), 0.0])
    staged = in_stages((Stage(rotor, Trigger(contact_time=1.0)), Stage(rotor)))
    whole = cm.simulate(
        rotor, cm.State(position / np.abs(rotor.equations.planes @ position).max(), np.zeros(2, complex)), 60.0
    )
    first = cm.simulate(staged, whole.start, 60.0).parts[0]
    logs = [whole.seen_at(plane) for plane in (0, 1)]
    expected = persisted_at(sorted(each for log in logs for each in touching(log)), 0.0, 1.0)
    assert first.time == pytest.approx(min(expected, 60.0), abs=1e-9)
