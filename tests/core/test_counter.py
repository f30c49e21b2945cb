"""The counter that threads share."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from carom.core.compiling.decorators import kernel
from carom.core.counter import fresh_counter, next_number

DRAWS, THREADS = 20_000, 4


@kernel
def draw(counter, drawn):
    for i in range(drawn.shape[0]):
        drawn[i] = next_number(counter.numbers)


def test_a_counter_begins_with_zero_and_moves_on_by_one():
    counter, drawn = fresh_counter(), np.empty(5, np.int64)
    draw(counter, drawn)
    assert drawn.tolist() == [0, 1, 2, 3, 4]


def test_no_number_is_told_twice_and_none_is_left_out():
    counter, drawn = fresh_counter(), np.empty((THREADS, DRAWS), np.int64)
    with ThreadPoolExecutor(THREADS) as pool:
        list(pool.map(draw, [counter] * THREADS, drawn))
    assert np.array_equal(np.sort(drawn, axis=None), np.arange(THREADS * DRAWS))
    assert np.all(np.diff(drawn) > 0)
