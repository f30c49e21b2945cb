"""Weight as a force on a rotor, and what is left of the rotor without its levitation."""

import math

import numpy as np
import pytest
from linear_rotors import single, tilting
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.models import Force, Stage, exact_rotor_of, in_stages, jeffcott, rotor_of
from carom.models.subjects import refuse_forces
from carom.parameters import Gravity, Scales

HEAVY = cm.load("examples/dropped-rotor.toml")
ROTOR = rotor_of(HEAVY)
PULL = 9.81 / (0.25e-3 * (300.0 * math.pi) ** 2)


def test_the_model_of_a_heavy_case_has_its_weight():
    assert len(ROTOR.forces) == 1
    assert ROTOR.unforced == jeffcott(HEAVY.parameters)
    assert ROTOR.acting.weight == pytest.approx(-1j * PULL)
    assert in_stages((Stage(ROTOR),)).acting.weight == pytest.approx(-1j * PULL)
    assert rotor_of(HEAVY.replace(gravity=0)) == jeffcott(HEAVY.parameters)


def test_gravity_is_a_named_parameter():
    assert ROTOR.value("gravity") == pytest.approx(9.81, rel=1e-14)
    moved = ROTOR.replace(gravity=1.62, speed="6000 rpm")
    again = rotor_of(HEAVY.replace(gravity=1.62, speed="6000 rpm"))
    assert moved.acting.weight == pytest.approx(again.acting.weight, rel=1e-14)
    assert moved.value("gravity") == pytest.approx(1.62, rel=1e-14)
    assert ROTOR.replace(gravity="162 cm/s^2").value("gravity") == pytest.approx(1.62, rel=1e-14)
    # A weight of zero has no direction, in which it could grow again.
    with pytest.raises(InputError, match=r"^gravity = 0"):
        ROTOR.replace(gravity=0.0)
    # Of what pulls otherwise nobody knows an acceleration of free fall.
    shaken = ROTOR.unforced.under(Force(0.5j, np.array([0.1])))
    assert "gravity" not in shaken.varied
    assert "gravity" not in jeffcott(PAPER).under(Force(-1j, np.array([0.1]))).varied


def test_all_masses_fall_alike():
    scales = Scales(5.0, 0.25e-3, 1000.0)
    rotor = tilting().model.replace(scales=scales)
    assert rotor.under_gravity(Gravity()).acting.whole_weight == pytest.approx(
        Gravity().pull(scales) * rotor.system.translated
    )
    with pytest.raises(InputError, match=r"^gravity = 9.81 m/s² at -90°: a rotor with mass, clearance and speed"):
        tilting().model.under_gravity(Gravity())


@pytest.mark.parametrize("rotor", [ROTOR.unforced, single(1).model], ids=["by parameters", "by matrices"])
def test_without_levitation_no_spring_and_no_damper_acts(rotor):
    free = rotor.without_levitation()
    assert not free.matrices.stiffness.any()
    assert not free.matrices.damping.any()
    for name in ("mass", "gyroscopic", "forcing"):
        assert np.array_equal(getattr(free.matrices, name), getattr(rotor.matrices, name))
    for name in ("friction", "restitution", "surface_speed", "law"):
        assert np.array_equal(free.system.arrays[name], rotor.system.arrays[name])
    assert free.scales == rotor.scales


@pytest.mark.parametrize(
    "asked",
    [
        cm.find_equilibria,
        exact_rotor_of,
        lambda machine: refuse_forces(rotor_of(machine)),
    ],
)
def test_what_needs_a_rotor_at_rest_in_its_frame_names_gravity_and_the_remedy(asked):
    with pytest.raises(InputError) as problem:
        asked(HEAVY)
    assert str(problem.value).startswith("machine = a rotor under gravity: needs a rotor without gravity")
    assert "a setting gravity=0 leaves weight out" in str(problem.value)
