"""Diagrams of other models than the planar rotor: what their equilibria and simulated disturbances show."""

from __future__ import annotations

import pytest
from linear_rotors import tilting

import carom as cm
from carom.outcome import InputError

RANGE = (0.2, 0.5)


def test_closed_forms_alone_refuse_other_models():
    for options in ({}, {"lasting": True, "attractors": 3}, {"virtual": True, "attractors": 3}):
        with pytest.raises(InputError, match="the planar rotor") as caught:
            cm.find_bifurcations(tilting().model, "gamma", RANGE, **options)
        assert "\n" not in str(caught.value)
