"""The loss of bouncing: what the figure shows, on few dampings, and what the page says, with fresh motions."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from carom.models import jeffcott
from carom.orbits import find_orbits
from carom.reproductions.mora2014 import machine_at
from docs._cells.loss_of_bouncing import LossOfBouncing, follow_loss, loss_figure, sample_bouncing

pytestmark = pytest.mark.jit_only


@cache
def few() -> LossOfBouncing:
    return follow_loss(impacts=2, values=2, close=6, motions=6, patience=2500)


def test_samples_tell_periodic_irregular_and_ending_motions_apart():
    for gamma, impacts in ((0.083, 2), (0.0818, 6), (0.09, 1)):
        # Before they settle, motions may bounce irregularly for many thousands of impacts, how many is a matter of rounding.
        sample = sample_bouncing(jeffcott(machine_at(gamma)), motions=4, impacts=16_000)
        assert (sample.impacts, len(sample.speeds), sample.ended) == (impacts, impacts, False)
        assert sample.exponent < 0.0
        assert set(sample.lifetimes.destinations) == {f"{impacts}-impact bouncing"}
    sample = sample_bouncing(jeffcott(machine_at(0.0825)), motions=4, impacts=4000)
    assert (sample.impacts, sample.ended, len(sample.speeds)) == (0, False, 150)
    assert sample.exponent > 3.0 * sample.error > 0.0
    assert sample.lifetimes.verdict == "not seen to end"
    # Chaotic motions part from a last bit: long enough for none to be left on any processor.
    sample = sample_bouncing(jeffcott(machine_at(0.079)), motions=12, impacts=40_000)
    assert sample.ended
    assert set(sample.lifetimes.destinations) == {"rolling"}
    assert sample.lifetimes.half_life < 1000.0


def test_exponent_of_a_periodic_motion_is_that_of_its_orbit():
    sample = sample_bouncing(jeffcott(machine_at(0.1)), motions=2, impacts=1000)
    orbit = find_orbits(machine_at(0.1))["B1,d"]
    assert sample.exponent == pytest.approx(np.log(orbit.multipliers.spectral_radius) / orbit.period, abs=1e-9)


def test_figure():
    low, high = few().lost
    assert 0.0785 <= low < high < 0.0825
    figure = loss_figure(few())
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert [title.split("(")[1][0] for title in titles] == list("abcde")
    assert all(axes.get_ylabel() for axes in figure.axes)


def test_motions_that_take_long_to_become_periodic_have_no_half_life():
    """Beside the period doubling motions settle on two impacts a period slowly, all at about the same age."""
    sample = sample_bouncing(jeffcott(machine_at(0.08338)), motions=20, impacts=20_000)
    assert sample.lifetimes.survival.half_life is not None
    drawn = loss_figure(replace(few(), close=(sample,))).axes[3]
    assert "half-life" in drawn.get_title(loc="left")
    assert not drawn.lines


@pytest.mark.deep
def test_what_the_page_says_holds_of_fresh_motions():
    """Other dampings than those of the figure, on both sides of each border."""
    for gamma, impacts in ((0.08268, 2), (0.0833, 2), (0.0834, 1)):
        assert sample_bouncing(jeffcott(machine_at(gamma)), motions=40, impacts=20_000).impacts == impacts
    for gamma in (0.0806, 0.0809, 0.08205, 0.08265):
        found = sample_bouncing(jeffcott(machine_at(gamma)), motions=40, impacts=100_000)
        assert "rolling" not in found.lifetimes.destinations
    for gamma in (0.0788, 0.0793, 0.0797, 0.0801):
        found = sample_bouncing(jeffcott(machine_at(gamma)), motions=100, impacts=100_000)
        ends = {end for end in found.lifetimes.destinations if "bouncing" not in end and end != "irregular"}
        # In narrow windows motions may become periodic before they leave.
        assert ends == {"rolling"}
