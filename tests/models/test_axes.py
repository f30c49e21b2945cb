"""Parameters that are varied, against the machine they belong to."""

import math

import numpy as np
import pytest
from machines import PAPER, SCALES, machine_of

from carom.base.outcome import InputError
from carom.models import Edge, Span, axis, jeffcott
from carom.models.axes import interval_around, paired, read_interval, spans_where
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Numbers

MACHINE = machine_of(PAPER, SCALES)


@pytest.mark.parametrize("name", MACHINE_FIELDS)
def test_physical_parameters_move_what_the_machine_moves(name):
    along = axis(MACHINE, name)
    assert along.name == name
    assert along.field is MACHINE_FIELDS[name]
    for factor in (0.7, 0.99):
        value = factor * getattr(MACHINE, name)
        expected = MACHINE.replace(**{name: value}).parameters
        got = along.move(jeffcott(MACHINE.parameters), value)
        assert got.parameters.as_dict() == pytest.approx(expected.as_dict(), rel=1e-13)
        assert got.scales is not None
        assert vars(got.scales) == pytest.approx(vars(expected.scales), rel=1e-13)
        assert along.value(got) == got.parameters.value(name) == pytest.approx(value, rel=1e-13)
        if name not in ("mass", "clearance", "speed"):
            assert got.parameters == expected, "the same bits as with --set"


@pytest.mark.parametrize("name", DIMENSIONLESS_FIELDS)
def test_dimensionless_parameters_move_alone(name):
    along = axis(PAPER, name)
    got = along.move(jeffcott(PAPER), 0.8)
    assert got.parameters == PAPER.replace(**{name: 0.8})
    assert along.value(got) == 0.8


@pytest.mark.parametrize("name", MACHINE_FIELDS)
def test_numbers_are_analytic_functions_of_each_parameter(name):
    numbers, size = Numbers.of(MACHINE.parameters), 1e-6 * MACHINE.parameters.value(name)
    value = numbers.value(name)
    rates = np.array(numbers.moved(name, complex(value, 1e-30))[:7]).imag / 1e-30
    low, high = (np.array(numbers.moved(name, value + change)[:7]) for change in (-size, size))
    np.testing.assert_allclose(rates, (high - low) / (2.0 * size), rtol=1e-9, atol=1e-9 / value)


def test_names_that_cannot_be_varied():
    with pytest.raises(InputError, match="did you mean gamma"):
        axis(PAPER, "gama")
    with pytest.raises(InputError, match="did you mean gamma"):
        PAPER.value("gama")
    for call in (axis, lambda machine, name: machine.value(name), lambda machine, name: machine.replace(**{name: 1.0})):
        with pytest.raises(InputError, match="mass, clearance and speed are not known"):
            call(PAPER, "speed")
    with pytest.raises(InputError, match="d = "):
        axis(PAPER, "d").move(jeffcott(PAPER), 1.2)


def test_ranges():
    damping = axis(MACHINE, "damping")
    assert read_interval(damping, ("300 N s/m", 2000.0)) == read_interval("damping", (300, "2 kN s/m")) == (300, 2000)
    for ends in ((2.0, 1.0), (1.0, 1.0)):
        with pytest.raises(InputError, match="a range of two finite values in ascending order"):
            read_interval("damping", ends)
    with pytest.raises(InputError, match="damping = "):
        read_interval(damping, (1.0, np.inf))
    assert interval_around(damping, 300.0 * (1.0 - 1e-14), (300.0, 400.0)) == (300.0, (300.0, 400.0))
    with pytest.raises(InputError, match="the motion's own value 299"):
        interval_around(damping, 299.0, (300.0, 400.0))


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
