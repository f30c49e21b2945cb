"""Names of motions: a text, and what it says."""

from __future__ import annotations

import copy
import dataclasses
import json
import pickle

import pytest

from carom.attractors import MotionName
from carom.base.outcome import Outcome
from carom.orbits.names import OrbitName

FAST = OrbitName(1, True, True)
NAMES = {
    "levitation": MotionName(Outcome.LEVITATED),
    "B1,d": MotionName(Outcome.BOUNCING, 1, orbit=FAST),
    "B1,d (2)": MotionName(Outcome.BOUNCING, 1, orbit=FAST, number=2),
    "R3,b": MotionName(Outcome.BOUNCING, 1, orbit=OrbitName(3, True, False, -1)),
    "1-impact bouncing": MotionName(Outcome.BOUNCING, 1),
    "2-impact bouncing (3)": MotionName(Outcome.BOUNCING, 2, number=3),
    "irregular bouncing": MotionName(Outcome.BOUNCING),
    "4-impact bouncing with rub": MotionName(Outcome.MIXED, 4),
    "irregular bouncing with rub": MotionName(Outcome.MIXED),
    "synchronous rub": MotionName(Outcome.FORWARD_RUB),
    "drifting rub": MotionName(Outcome.FORWARD_RUB, drifting=True),
    "sliding backward whirl": MotionName(Outcome.BACKWARD_WHIRL),
    "rolling backward whirl": MotionName(Outcome.ROLLING),
    "unresolved: time-reached": MotionName(Outcome.TIME_REACHED),
    "unresolved: grazing": MotionName(Outcome.GRAZING),
}


@pytest.mark.parametrize(("text", "name"), NAMES.items())
def test_a_name_is_a_text_that_carries_its_parts(text, name):
    assert name == text
    assert f"{name}" == text
    assert json.loads(json.dumps({name: name})) == {text: text}
    assert name.irregular == text.startswith("irregular")
    assert name.outcome.settled != text.startswith("unresolved")
    for other in (
        copy.deepcopy(name),
        pickle.loads(pickle.dumps(name)),
        MotionName.of(json.loads(json.dumps(dataclasses.asdict(name)))),
    ):
        assert type(other) is MotionName
        assert other == name
        assert type(other.outcome) is Outcome
        assert type(other.orbit) is type(name.orbit)
        assert dataclasses.asdict(other) == dataclasses.asdict(name)
    with pytest.raises(dataclasses.FrozenInstanceError):
        name.number = 3
