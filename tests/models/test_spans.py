"""Intervals of a parameter: what others leave of one, and overlaps."""

import math

import pytest

from carom.models import Edge, Span
from carom.models.spans import common, outside


def spans(*ends):
    return tuple(Span(Edge(low), Edge(high)) for low, high in ends)


def ends(found):
    return [(span.low.value, span.high.value) for span in found]


@pytest.mark.parametrize(
    ("covered", "gaps"),
    [
        ((), [(1, 9)]),
        (((0, 10),), []),
        (((2, 3),), [(1, 2), (3, 9)]),
        (((0, 2), (4, 5), (8, 12)), [(2, 4), (5, 8)]),
        (((1, 9),), []),
        (((10, 11),), [(1, 9)]),
    ],
)
def test_outside(covered, gaps):
    assert ends(outside(spans(*covered), Span(Edge(1.0), Edge(9.0)))) == gaps


def test_common():
    assert ends(common(spans((0, 3), (5, 9)), spans((2, 6), (8, math.inf)))) == [(2, 3), (5, 6), (8, 9)]
    assert common(spans((0, 1)), spans((1, 2))) == ()
