"""Texts of single disturbances in Python: the same motion as by numbers."""

from __future__ import annotations

import numpy as np
import pytest

import carom as cm
from carom.disturbances import BaseShock, BladeLoss, VelocityKick
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
