"""Texts of single disturbances in Python: the same motion as by numbers."""

import numpy as np
import pytest

import carom as cm
from carom.disturbances import BaseShock, BladeLoss, GivenState, VelocityKick, Whirl, whirl
from carom.models import rotor_of

MACHINE = cm.load("examples/keogh-cole.toml")


@pytest.mark.parametrize(
    "kind", [(VelocityKick, "60 mm/s, 30 deg"), (BaseShock, "2 g, 5 ms, 30 deg"), (BladeLoss, "900 g mm")]
)
def test_a_text_is_what_it_says_in_python(kind):
    model, text = kind
    rotor = rotor_of(MACHINE)
    first, *_ = text.split(", ")
    sizes = [first, "5 ms"] if model is BaseShock else [first]
    stated, angle = model.of(MACHINE, *sizes), np.pi / 6.0 if "deg" in text else 0.0
    found, expected = model.read(text, MACHINE).stages(rotor)[1], stated.apply(rotor, angle)[1]
    assert (found.position, found.velocity) == pytest.approx((expected.position, expected.velocity), rel=1e-12)


def test_whirls_and_states_are_read_and_told_like_others():
    found = Whirl.read("0.1 mm, -80 Hz, 30 deg", MACHINE)
    assert found.stages(MACHINE)[1] == whirl("0.1 mm", "-80 Hz", "30 deg").stages(MACHINE)[1]
    start = GivenState.read("0.35 mm, 0, 0, 0.1", MACHINE)
    assert start.stages(MACHINE)[1].position == pytest.approx(0.5, rel=1e-15)
    for one, kind, sizes in ((found, "whirl", {"radius", "speed", "angle"}), (start, "start", {"radius", "direction"})):
        echo = one.echo(rotor_of(MACHINE))
        assert echo.kind == kind
        assert sizes <= set(echo.sizes)
