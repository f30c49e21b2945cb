"""Weighted averages and rotation numbers of sequences that are known."""

from __future__ import annotations

import numpy as np
import pytest

from carom.attractors.regularity import rotation_of

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


@pytest.mark.parametrize("number", [GOLDEN - 0.5, np.sqrt(2.0) - 1.2, 0.013579])
def test_a_torus_is_regular_and_has_its_rotation_number(number):
    turns = 2.0 * np.pi * number * np.arange(20_000)
    states = np.array([np.exp(0.3j * np.cos(turns)), 0.2 + np.sin(turns) + 0.1j * np.cos(2.0 * turns)]).T
    found = rotation_of(states)
    assert found.regular
    assert not found.locked
    assert found.number == pytest.approx(number, abs=1e-9)


def test_curves_that_are_visited_in_turn_are_counted():
    number = GOLDEN / 7.0
    turns = 2.0 * np.pi * number * np.arange(21_000)
    middles = np.resize([1.0 + 1.0j, -2.0, 0.5j], 21_000)
    found = rotation_of(np.array([middles + 0.1 * np.exp(1j * turns), 2.0 * middles]).T)
    assert found.regular
    assert not found.locked
    assert found.loops == 3
    assert found.number == pytest.approx(3.0 * number, abs=1e-8)


def test_a_cycle_is_regular_and_locked():
    states = np.resize(np.array([[1.0, 2.0j], [0.5, 1.0], [-1.0, 1.0 + 1.0j], [0.3, 2.0], [0.1, 0.7]]), (20_000, 2))
    found = rotation_of(states)
    assert found.regular
    assert found.locked
    assert (found.loops, found.number) == (5, 0.0)


def test_chaos_is_not_regular():
    values = np.empty(20_000)
    values[0] = 0.3
    for i in range(1, len(values)):
        values[i] = 3.99 * values[i - 1] * (1.0 - values[i - 1])
    found = rotation_of(np.array([values, np.roll(values, 1)], complex).T)
    assert found.digits < 6.0
    assert not found.regular
