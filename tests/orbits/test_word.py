"""Words of orbits."""

from __future__ import annotations

import pytest

from carom.core import segments
from carom.orbits.word import Kind, Segment, Word
from carom.outcome import InputError

RUBBING = Word.of(Kind.LIFT, Kind.LAND, Kind.SLIDE_FORWARD)


def test_text_and_counts():
    word = Word((Segment(Kind.IMPACT_FORWARD), Segment(Kind.IMPACT_STOPPED, 1)))
    assert str(word) == "impact+ impact0@2"
    assert word.impacts == 2
    assert word.flies
    assert str(RUBBING) == "lift land slide+"
    assert RUBBING.impacts == 0
    assert not RUBBING.flies


def test_each_condition_follows_from_the_next_segment():
    assert RUBBING.conditions.tolist() == [segments.MEETS_WALL, segments.NO_CONDITION, segments.LEAVES]
    word = Word.of(Kind.ROLL, Kind.SLIDE_BACKWARD, Kind.SLIDE_FORWARD)
    assert word.conditions.tolist() == [segments.CONE_BACKWARD, segments.NO_SLIP, segments.NO_SLIP]
    assert Word.of(Kind.SLIDE_FORWARD, Kind.ROLL).conditions.tolist() == [segments.NO_SLIP, segments.CONE_FORWARD]
    # Sliding that never leaves the wall.
    assert Word.of(Kind.SLIDE_FORWARD).conditions.tolist() == [segments.LEAST_PUSH]


def test_an_impact_is_awaited_at_its_own_plane():
    word = Word((Segment(Kind.IMPACT_FORWARD, 1), Segment(Kind.IMPACT_FORWARD, 0)))
    assert word.targets.tolist() == [0, 1]


@pytest.mark.parametrize(
    "kinds", [(), (Kind.ROLL,), (Kind.LIFT,), (Kind.IMPACT_FORWARD, Kind.ROLL), (Kind.LAND, Kind.LIFT)]
)
def test_impossible_words_are_refused(kinds):
    with pytest.raises(InputError, match="word"):
        Word.of(*kinds)


def test_contact_stays_at_its_plane():
    with pytest.raises(InputError, match="slide\\+@2"):
        Word((Segment(Kind.LIFT), Segment(Kind.LAND), Segment(Kind.SLIDE_FORWARD, 1)))


def test_repeating_and_turning():
    word = Word.of(Kind.IMPACT_FORWARD, Kind.IMPACT_STOPPED)
    assert word.repeated(3).least == 2
    assert word.least == 2
    assert Word.of(*[Kind.IMPACT_FORWARD] * 6).least == 1
    assert str(word.turned(1)) == "impact0 impact+"


def test_kinds_of_phases():
    assert [Kind.of_phase(phase) for phase in range(4)] == [
        Kind.LIFT,
        Kind.SLIDE_FORWARD,
        Kind.SLIDE_BACKWARD,
        Kind.ROLL,
    ]
    assert Kind.ROLL.lasts
    assert not Kind.LAND.lasts
    assert Kind.LIFT.flies
    assert not Kind.LIFT.is_impact
