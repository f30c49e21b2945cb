"""Words of orbits."""

from __future__ import annotations

import pytest

from carom.base.outcome import InputError
from carom.orbits.word import Kind, Word


def test_a_word_without_segments_is_refused():
    with pytest.raises(InputError, match="word"):
        Word.of()


def test_repeating_and_turning():
    word = Word.of(Kind.IMPACT_FORWARD, Kind.IMPACT_STOPPED)
    assert word.repeated(3).least == 2
    assert word.least == 2
    assert Word.of(*[Kind.IMPACT_FORWARD] * 6).least == 1
    assert str(word.turned(1)) == "impact0 impact+"
