"""Numbers in words."""

import math

import pytest

from carom.models import Edge, Span
from carom.parameters import Scales
from carom.studies.wording import Wording

SI = Wording(Scales(mass=50.0, clearance=0.7e-3, speed=184.2))
PLAIN = Wording(None)


def test_quantities_with_units():
    assert SI.radius(0.954806) == "0.955 c_r (0.668 mm)"
    assert SI.time(2.328416) == "12.6 ms"
    assert SI.velocity(0.05) == "6.45 mm/s"
    assert SI.name("gamma") == "damping"
    assert SI.force(0.75853) == "901 N"
    assert SI.impulse(1.4359) == "9.26 N s"
    assert SI.power(0.11378 * 58.142857) == "1.01 kW"
    assert SI.per_second(2.328416) == "79.1 times a second"
    assert SI.value("gamma", 0.37001594) == "3,408 N s/m"


def span(low, high):
    return Span(Edge(low), Edge(high))


@pytest.mark.parametrize(
    ("spans", "searched", "text"),
    [
        ((), None, "for no value"),
        ((), span(0.1, 8.0), "for no value searched (0.1 to 8)"),
        ((span(0.0, math.inf),), None, "for every value"),
        ((span(0.1, 8.0),), span(0.1, 8.0), "for every value searched (0.1 to 8)"),
        ((span(0.0, 0.37),), None, "below 0.37"),
        ((span(0.1, 0.37),), span(0.1, 8.0), "below 0.37"),
        ((span(0.07, math.inf),), None, "above 0.07"),
        ((span(0.0, 0.7), span(1.2, math.inf)), None, "below 0.7 and above 1.2"),
        ((span(0.2, 0.7),), span(0.1, 8.0), "from 0.2 to 0.7"),
    ],
)
def test_where(spans, searched, text):
    assert PLAIN.where("gamma", spans, searched) == text
