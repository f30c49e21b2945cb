"""A new kind of rotor is one definition and one maker: every verb then takes it."""

import dataclasses
from functools import cached_property

import numpy as np
import pytest

import carom as cm
from carom.models import Definition, Force, LinearEquations, Rigid, Rotor, Touchdown, from_matrices
from carom.parameters import MACHINE_FIELDS


@dataclasses.dataclass(frozen=True)
class Overhung(Definition):
    """A disc on a massless overhung shaft: its tilt goes with its displacement, so that gyroscopic moments stiffen it."""

    friction: float = 0.1
    polar: float = 0.2

    @cached_property
    def equations(self) -> LinearEquations:
        """One coordinate, whose gyroscopic matrix is the polar inertia."""
        return from_matrices(
            mass=[[1.0]],
            damping=[[0.2]],
            stiffness=[[1.6]],
            gyroscopic=[[self.polar]],
            forcing=[0.2],
            touchdowns=[Touchdown([1.0], Rigid(0.8), self.friction, 20.0)],
        ).equations

    @property
    def varied(self):
        return {"friction": MACHINE_FIELDS["friction"]}

    def value(self, name):
        return getattr(self, name)

    def replace(self, **changes):
        return dataclasses.replace(self, **changes)


def test_a_new_kind_of_rotor_is_taken_by_the_verbs():
    rotor = Rotor(Overhung())
    assert cm.find_equilibria(rotor)[0].position == pytest.approx(0.2 / (1.6 - 1.0 + 0.2 + 0.2j), rel=1e-12)
    assert cm.simulate(rotor, cm.kick(0.05)).outcome.label == "levitated"
    assert cm.models.axis(rotor, "friction").move(rotor, 0.3).equations.touchdowns[0].friction == 0.3
    pulled = rotor.under(Force(-1j, np.array([-0.05j])))
    assert pulled.replace(friction=0.3).forces == pulled.forces
    again = cm.models.rotor_from(pulled.attributes())
    assert np.array_equal(again.system.arrays["exponents"], pulled.system.arrays["exponents"])
    assert not rotor.has_closed_forms
    assert rotor.planar is None
