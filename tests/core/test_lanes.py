"""Motions side by side: no crossing missed or invented, no lane disturbed by another."""

import math

import numpy as np
import pytest
from compilation import sized
from flights import (
    Tally,
    board,
    by_lane,
    compare,
    inside_task,
    near_grazing_task,
    parameters,
    random_wall_task,
    rotors,
    task_from_state,
)

from carom.core.lanes import LATE, OPEN, fly_lanes, lanes_record
from carom.core.layout import LANES
from carom.models import jeffcott

HORIZON = 15.0
STATE = ("lower_re", "lower_im", "upper_re", "upper_im", "level", "clock", "verdict")


def count(flights: int) -> int:
    """How many flights to try: all in a deep run, every tenth by day."""
    return sized(math.ceil(0.1 * flights), math.ceil(0.002 * flights), flights)


def test_random_flights():
    tally, undecided = Tally("random flights in lanes"), []
    for number, (rotor, rng) in enumerate(rotors(900, count(1_000))):
        for _ in range(20):
            compare(inside_task(rotor, rng), HORIZON, tally, by_lane(number % LANES, undecided))
    tally.check()
    assert len(undecided) < 0.1 * tally.tried


def test_starts_on_the_wall():
    tally, undecided = Tally("starts on the wall in lanes"), []
    for number, (rotor, rng) in enumerate(rotors(901, count(1_000))):
        for kind in range(10):
            task = random_wall_task(rotor, rng, kind % 3)
            if task is not None:
                compare(task, HORIZON, tally, by_lane(number % LANES, undecided))
    tally.check()
    assert len(undecided) < 0.5 * tally.tried


def test_near_grazing_flights():
    tally, undecided = Tally("near-grazing flights in lanes"), []
    for number, (rotor, rng) in enumerate(rotors(902, count(1_000))):
        for _ in range(20):
            drawn = near_grazing_task(rotor, rng)
            if drawn is not None:
                compare(drawn[0], drawn[1] + 5.0, tally, by_lane(number % LANES, undecided))
    tally.check()
    assert tally.tried >= count(2_000)
    assert len(undecided) < 0.9 * tally.tried


@pytest.mark.parametrize("lane", [0, LANES - 1])
def test_no_impact_is_invented_just_below_the_wall(lane):
    """A flight on which the kernel for single motions once took a short step for a root."""
    rotor = jeffcott(parameters(0.0030054630001825683, 2.2353614960095, rho=0.0, phi=0.590663075529207))
    start = 0.6664892755162684 - 0.7428473474126268j, 0.11154170556637309 - 0.06737417390679983j
    tally = Tally("just below the wall, in a lane")
    assert compare(task_from_state(rotor, *start), HORIZON, tally, by_lane(lane, [])) is None
    tally.check()


@pytest.mark.parametrize("seed", range(3))
def test_a_lane_knows_nothing_of_the_others(seed):
    rotor, rng = rotors(910 + seed, 1)[0]
    tasks = [inside_task(rotor, rng) for _ in range(LANES)]
    straight, turned = lanes_record(), lanes_record()
    for lane, task in enumerate(tasks):
        board(straight, lane, task)
        board(turned, (5 * lane + 3) % LANES, task)
    for _ in range(20):
        fly_lanes(rotor.system.arrays, rotor.system.table, 1e9, straight)
        fly_lanes(rotor.system.arrays, rotor.system.table, 1e9, turned)
    places = [(5 * lane + 3) % LANES for lane in range(LANES)]
    for name in STATE:
        np.testing.assert_array_equal(getattr(straight, name), getattr(turned, name)[places], err_msg=name)


def test_what_is_open_or_late_stays_where_it_was():
    rotor, rng = rotors(920, 1)[0]
    lanes = lanes_record()
    for lane in range(LANES):
        board(lanes, lane, inside_task(rotor, rng))
    before = {name: getattr(lanes, name).copy() for name in STATE}
    fly_lanes(rotor.system.arrays, rotor.system.table, 1e-9, lanes)
    assert np.isin(lanes.verdict, (LATE, OPEN)).all()
    for name in STATE[:-1]:
        np.testing.assert_array_equal(getattr(lanes, name), before[name], err_msg=name)
