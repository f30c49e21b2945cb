"""Intervals of a parameter: where something holds between edges."""

import math

import pytest

from carom.models import Edge, Span
from carom.models.spans import paired, spans_where


def spans(*ends):
    return tuple(Span(Edge(low), Edge(high)) for low, high in ends)


@pytest.mark.parametrize(
    ("covered", "gaps"),
    [
        ((), [(1, 9)]),
        (((1, 9),), []),
        (((2, 3),), [(1, 2), (3, 9)]),
        (((1, 2), (4, 5), (8, 9)), [(2, 4), (5, 8)]),
        (((2, 4), (4, 5)), [(1, 2), (5, 9)]),
    ],
)
def test_what_is_left_of_an_interval(covered, gaps):
    others = spans(*covered)
    edges = [Edge(1), Edge(9), *(edge for span in others for edge in span)]
    found = spans_where(edges, lambda value: not any(value in span for span in others))
    assert [(span.low.value, span.high.value) for span in found] == gaps


def test_neighbouring_parts_are_one_and_the_first_of_edges_at_one_place_counts():
    edges = [Edge(5.0, "fold"), Edge(1.0), Edge(9.0, "grazing"), Edge(9.0), Edge(3.0, "rub-fold"), Edge(5.0)]
    assert spans_where(edges, lambda value: value > 3.5) == (Span(Edge(3.0, "rub-fold"), Edge(9.0, "grazing")),)
    assert spans_where(edges, lambda value: value < 5.0) == (Span(Edge(1.0), Edge(5.0, "fold")),)


def test_a_span_holds_its_ends_and_is_told_by_them():
    span = Span(Edge(1.0), Edge(math.inf))
    assert 1.0 in span
    assert 0.999 not in span
    assert [edge.value for edge in span] == [1.0, math.inf]
    assert paired([Edge(1.0), Edge(2.0), Edge(4.0), Edge(5.0)]) == spans((1.0, 2.0), (4.0, 5.0))
