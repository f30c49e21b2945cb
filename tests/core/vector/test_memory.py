"""Lanes come from where they are said to, go there and nowhere else, and rows are looked up at every place."""

import numpy as np
import pytest
from compilation import COMPILED
from lane_programs import program

from carom.core import vector
from carom.core.layout import LANE_NODES, LEVELS, OCTET, WIDTH

MARK = -7.25
BEYOND = 2 * OCTET


@pytest.fixture(scope="module")
def moves():
    return program(
        "source, first, target, second",
        [
            "align_stack()",
            "store(target[0], second, load(source, first))",
            "store(target[1], second, 3)",
            "store(target[2], second, 0.5)",
        ],
    )


@pytest.fixture(scope="module")
def look_up():
    return program(
        "row, few, places, levels, out",
        ["store(out[0], 0, take(row, load(places, 0)))", "store(out[1], 0, choose(few, load(levels, 0)))"],
    )


def test_lanes_go_where_they_belong_and_nowhere_else(moves):
    source = np.random.default_rng(40).normal(size=WIDTH + BEYOND)
    for first in range(BEYOND + 1):
        for second in (0, 1, first, BEYOND):
            target = np.full((3, WIDTH + BEYOND), MARK)
            expected = target.copy()
            expected[0, second : second + WIDTH] = source[first : first + WIDTH]
            expected[1, second : second + WIDTH] = 3.0
            expected[2, second : second + WIDTH] = 0.5
            moves(source, first, target, second)
            np.testing.assert_array_equal(target, expected)


def test_what_is_loaded_stays_when_the_array_changes():
    lines = ["before = load(array, 0)", "store(array, 0, before + 1.0)", "store(array, 0, before * 2.0)"]
    array = np.arange(float(WIDTH))
    program("array", lines)(array)
    np.testing.assert_array_equal(array, 2.0 * np.arange(WIDTH))


@pytest.mark.parametrize("shift", range(3))
def test_rows_are_looked_up_at_every_place(look_up, shift):
    """Wherever the row begins, and whatever else is in it."""
    random = np.random.default_rng(50 + shift)
    row, few = random.normal(size=LANE_NODES + shift)[shift:], random.normal(size=OCTET + shift)[shift:]
    row[random.integers(LANE_NODES, size=3)] = [np.inf, -np.inf, np.nan]
    few[LEVELS:] = np.nan
    for turn in range(LANE_NODES):
        places = (turn + 5 * np.arange(WIDTH)) % LANE_NODES
        levels = (turn + np.arange(WIDTH) ** 2) % LEVELS
        out = np.empty((2, WIDTH))
        look_up(row, few, places.astype(float), levels.astype(float), out)
        np.testing.assert_array_equal(out, [row[places], few[levels]])


def test_lanes_in_which_a_condition_holds():
    holds = program(
        "a, b",
        [
            "a, b = load(a, 0), load(b, 0)",
            "return lanes_of(a < b), lanes_of(~(a < b)), lanes_of((a < b) | (b <= 0.0))",
        ],
    )
    random = np.random.default_rng(60)
    everywhere = (1 << WIDTH) - 1
    drawn = [random.random(WIDTH) < share for share in (0.1, 0.5, 0.9)]
    for which in [*drawn, np.zeros(WIDTH, bool), np.ones(WIDTH, bool), *np.eye(WIDTH, dtype=bool)]:
        bits = sum(1 << lane for lane in range(WIDTH) if which[lane])
        a, b = np.where(which, 0.0, 2.0), np.ones(WIDTH)
        assert holds(a, b) == (bits, everywhere ^ bits, bits)
        b[-1] = np.nan
        last = bits & 1 << WIDTH - 1
        assert holds(a, b) == (bits ^ last, everywhere ^ bits | 1 << WIDTH - 1, bits ^ last)


def test_the_stack_is_aligned_where_that_is_asked_for(moves, look_up):
    assert vector.align_stack() is None
    if COMPILED:
        moves(np.zeros(WIDTH), 0, np.zeros((3, WIDTH)), 0)
        look_up(np.zeros(LANE_NODES), np.zeros(OCTET), np.zeros(WIDTH), np.zeros(WIDTH), np.zeros((2, WIDTH)))
        (aligned,), (not_aligned,) = moves.inspect_llvm().values(), look_up.inspect_llvm().values()
        assert "alignstack(64)" in aligned
        assert "alignstack" not in not_aligned
