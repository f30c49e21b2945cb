"""What is advised where no damping and no stiffness leaves levitation alone: the nearest value that brings back 99 %."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from machines import PAPER
from studies import study_once

from carom.attractors import DisturbanceSet
from carom.models import Jeffcott
from carom.motions.ensembles import settle
from carom.studies.advice import CHECKED, STEP, WANTED, advise
from carom.studies.one_page import recommendation_lines
from carom.studies.orbit_ranges import single_impact_ranges

pytestmark = pytest.mark.jit_only


def returned(parameters, count, seed):
    rotor = Jeffcott(parameters)
    ends = settle(rotor, *DisturbanceSet(count, seed).starts(rotor)[:2])
    return np.count_nonzero(ends.recovered) / count


@pytest.fixture(scope="module")
def advised():
    ranges = single_impact_ranges(PAPER, "gamma")
    (found,) = advise(PAPER, (), ranges)
    return found


def test_the_value_brings_back_the_share_of_a_fresh_sample_too(advised):
    assert (advised.gain, advised.alone, advised.margin) == ("gamma", False, 0.0)
    assert advised.returned.total == CHECKED
    assert advised.returned.fraction >= WANTED
    # Three standard deviations of a share of 99 % in 4000.
    assert returned(PAPER.replace(gamma=advised.value), 4000, 977) > WANTED - 3.0 * np.sqrt(
        WANTED * (1 - WANTED) / 4000
    )


def test_no_nearer_value_tried_brings_it_back(advised):
    steps = round(np.log(advised.change) / np.log(STEP))
    assert advised.value == pytest.approx(PAPER.gamma * STEP**steps, rel=1e-12)
    nearer = [PAPER.gamma * STEP**step for step in range(1 - abs(steps), abs(steps))]
    shares = [returned(PAPER.replace(gamma=gamma), 1000, 978) for gamma in nearer]
    assert max(shares) < WANTED + 3.0 * np.sqrt(WANTED * (1 - WANTED) / 1000)


def test_a_machine_that_brings_back_the_share_is_not_told_to_change(advised):
    there = PAPER.replace(gamma=advised.value)
    assert advise(there, (), single_impact_ranges(there, "gamma")) == ()


def test_the_words_promise_a_share_and_not_levitation_alone(advised):
    lines = recommendation_lines(dataclasses.replace(study_once(PAPER), advice=(advised,)))
    said = {line.label: line.text for line in lines}
    assert said["Change"] == "γ 0.1 → 0.4046 (× 4.05)"
    assert "brings back at least 99 %" in said["Margin"]
    assert "of 2,000 fresh disturbances of up to 2 c_r Ω came back" in said["Tried"]
