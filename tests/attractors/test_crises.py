"""Where bouncing begins to end along a parameter."""

from __future__ import annotations

import pytest

from carom.attractors.crises import locate_crisis
from carom.outcome import CaromError, InputError
from tests.machines import PAPER


@pytest.mark.jit_only
def test_the_crisis_of_the_machine_of_the_paper_is_bracketed():
    found = locate_crisis(PAPER, "gamma", 0.081, 0.0795, steps=4, count=80, impacts=6000)
    assert 0.0802 < found.ending < found.lasting < 0.0806
    assert found.lasting - found.ending == pytest.approx(0.0015 / 16)
    lives = [half_life for _, half_life in found.half_lives if half_life is not None]
    # They grow without bound toward the crisis.
    assert lives == sorted(lives)
    assert found.half_lives[-1] == (0.081, None)
    assert "evidence from samples" in found.words
    wide = locate_crisis(PAPER, "gamma", 0.081, 0.0795, tolerance=0.001, count=80, impacts=6000)
    assert abs(wide.lasting - wide.ending) <= 0.001


@pytest.mark.jit_only
def test_ends_that_do_not_differ_are_refused():
    with pytest.raises(CaromError, match="is not seen to end at gamma"):
        locate_crisis(PAPER, "gamma", 0.081, 0.0815, count=40, impacts=2000)
    with pytest.raises(CaromError, match="is seen to end at gamma"):
        locate_crisis(PAPER, "gamma", 0.079, 0.081, count=40, impacts=2000)


def test_bad_input_is_named():
    with pytest.raises(InputError, match="ending"):
        locate_crisis(PAPER, "gamma", 0.08, 0.08)
    with pytest.raises(InputError, match="gama"):
        locate_crisis(PAPER, "gama", 0.08, 0.07)
