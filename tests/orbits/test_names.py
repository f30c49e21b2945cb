"""Names of orbits: a text, and what it says."""

import dataclasses
import json

import pytest

from carom.orbits.names import OrbitName


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
