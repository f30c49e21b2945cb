"""Sizes as people write them: one text for a size, wherever it is stated."""

import pytest
from machines import PAPER, SCALES

from carom.attractors import DisturbanceSet
from carom.basins import Population
from carom.disturbances import Single, VelocityKick
from carom.models import jeffcott
from carom.parameters.formats import format_quantity, number, rounded_down
from carom.studies import Wording


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (0.5, "velocity", "64.5 mm/s"),  # 0.5 * 0.7 mm * 184.2 rad/s
        (50.0, "velocity", "6,450 mm/s"),
        (0.5, "length", "0.35 mm"),
        (2.0, "acceleration", "4.84 g"),  # 2 * 0.7e-3 * 184.2² / 9.80665
        (0.5, "unbalance", "17,500 g mm"),
        (2.0, "time", "10.9 ms"),
    ],
)
def test_sizes_are_told_in_the_units_of_people(value, kind, text):
    assert format_quantity(value, kind, SCALES) == text


@pytest.mark.parametrize(
    ("value", "least"),
    [(109.5703, 109.5), (0.17310591, 0.1731), (99.9999, 99.99), (219.7, 219.7), (1.0, 1.0), (0.3, 0.3)],
)
def test_what_is_proven_is_rounded_down(value, least):
    assert rounded_down(value) == pytest.approx(least, rel=1e-12)
    assert float(number(rounded_down(value))) == least


@pytest.mark.parametrize("scales", [None, SCALES])
@pytest.mark.parametrize("speed", [0.0123456, 0.5, 12.3456, 98765.4])
def test_a_speed_is_the_same_text_wherever_it_is_told(scales, speed):
    text = format_quantity(speed, "velocity", scales)

    assert text.endswith("mm/s" if scales else "c_r Ω")
    assert Wording(scales).velocity(speed) == text
    assert VelocityKick(speed).coordinates[0].stated(speed, scales) == text
    assert Population.of_model(VelocityKick(speed), scales).words == f"kicks up to {text}"
    rotor = jeffcott(PAPER.replace(scales=scales))
    kick = Single(VelocityKick(speed), (speed, 0.0))
    assert kick.echo(rotor).words.startswith(f"Kick: {text} at 0°; angles are measured from ")
    assert f"at up to {text} in the fixed frame" in DisturbanceSet(10, fastest=speed).words(rotor)
