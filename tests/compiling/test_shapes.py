"""Conditions on the shapes of records are decided before compilation."""

import numpy as np
import pytest

from carom.core.compiling.decorators import expanded, kernel
from carom.core.records import record

pytestmark = pytest.mark.jit_only


@expanded
def _first_of_several(values):
    if values.rows.shape[0] > 1:
        return values.only_with_several[0]
    return values.rows[0, 0]


@kernel
def _first(values):
    return _first_of_several(values)


@kernel
def _second_or_length(values):
    if values.rows.shape[0] == 1 or values.rows[1, 0] < 0.0:
        return 1.0 * values.rows.shape[1]
    return values.rows[1, 0] + values.only_with_several[1]


def test_a_branch_for_other_shapes_is_not_compiled():
    one = record(rows=np.full((1, 3), 7.0))
    assert _first(one) == 7.0
    assert _second_or_length(one) == 3.0


def test_both_sides_work_where_the_shape_asks_for_them():
    several = record(rows=np.array([[7.0, 0.0], [4.0, 0.0]]), only_with_several=np.array([2.0, 3.0]))
    assert _first(several) == 2.0
    assert _second_or_length(several) == 7.0
    assert _second_or_length(record(rows=np.array([[7.0], [-4.0]]), only_with_several=np.zeros(2))) == 1.0


def test_a_branch_that_is_needed_is_compiled():
    with pytest.raises(Exception, match="only_with_several"):
        _first(record(rows=np.full((2, 3), 7.0)))
