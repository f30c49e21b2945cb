"""Names of orbits: a text, and what it says."""

from __future__ import annotations

import copy
import dataclasses
import json
import pickle

import pytest

from carom.orbits.names import OrbitName, combined, in_order


@pytest.mark.parametrize(
    ("parts", "text", "letter"),
    [
        ((1, False, False), "B1,a", "a"),
        ((1, True, False), "B1,b", "b"),
        ((2, False, True), "B2,c", "c"),
        ((12, True, True), "B12,d", "d"),
        ((1, True, True, -1), "R1,d", "d"),
    ],
)
def test_a_name_is_a_text_that_carries_its_parts(parts, text, letter):
    name = OrbitName(*parts)
    assert name == text
    assert f"{name}" == repr(name).strip("'") == text
    assert json.dumps({name: name}) == f'{{"{text}": "{text}"}}'
    assert (name.pair, name.longer, name.faster, name.slip) == (*parts, 1)[:4]
    assert name.letter == letter
    assert {text: 1}[name] == 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        name.pair = 3


@pytest.mark.parametrize(
    "copied", [copy.copy, copy.deepcopy, *(lambda n, p=p: pickle.loads(pickle.dumps(n, p)) for p in range(6))]
)
def test_copies_and_pickles_keep_the_parts(copied):
    name = OrbitName(2, True, False, -1)
    other = copied(name)
    assert type(other) is OrbitName
    assert other == name
    assert (other.pair, other.longer, other.faster, other.slip) == (2, True, False, -1)
    assert dataclasses.replace(other, faster=True) == "R2,d"


def test_lists_of_names():
    names = [
        OrbitName(10, False, False),
        OrbitName(2, True, False),
        OrbitName(1, True, True, -1),
        OrbitName(2, True, True),
    ]
    assert in_order(names) == ("B2,b", "B2,d", "B10,a", "R1,d")
    assert combined(names) == "B2,b/d, B10,a, R1,d"
    assert combined(()) == ""
