"""Weight as a force on a rotor, and what is left of the rotor without its levitation."""

import math

import numpy as np
import pytest
from linear_rotors import single, tilting
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.models import Force, Stage, exact_rotor_of, in_stages, jeffcott, rotor_of
from carom.models.weight import levitation_of
from carom.parameters import Gravity, Parameters, Scales

HEAVY = cm.load("examples/dropped-rotor.toml")
ROTOR = rotor_of(HEAVY)
PULL = 9.81 / (0.25e-3 * (300.0 * math.pi) ** 2)


def test_the_model_of_a_heavy_case_has_its_weight():
    assert len(ROTOR.forces) == 1
    assert ROTOR.unforced == jeffcott(HEAVY.parameters)
    assert ROTOR.weight == pytest.approx(-1j * PULL)
    assert in_stages((Stage(ROTOR),)).weight == pytest.approx(-1j * PULL)
    assert rotor_of(HEAVY.replace(gravity=0)) == jeffcott(HEAVY.parameters)


def test_no_other_force_is_weight():
    assert jeffcott(PAPER).weight is None
    assert jeffcott(PAPER).under(Force(0.3j, np.array([0.1]))).weight is None


@pytest.mark.parametrize("changes", [{"speed": "6000 rpm"}, {"clearance": "0.4 mm"}, {"mass": "9 kg"}, {"gamma": 0.2}])
def test_weight_keeps_its_acceleration_in_si_whatever_is_varied(changes):
    varied, again = ROTOR.replace(**changes), rotor_of(HEAVY.replace(**changes))
    assert varied.weight == pytest.approx(again.weight, rel=1e-15)
    assert varied.value("omega") == pytest.approx(again.value("omega"), rel=1e-15)


def test_gravity_is_a_named_parameter():
    assert ROTOR.value("gravity") == pytest.approx(9.81, rel=1e-14)
    moved = ROTOR.replace(gravity=1.62, speed="6000 rpm")
    again = rotor_of(HEAVY.replace(gravity=1.62, speed="6000 rpm"))
    assert moved.weight == pytest.approx(again.weight, rel=1e-14)
    assert moved.value("gravity") == pytest.approx(1.62, rel=1e-14)
    assert ROTOR.replace(gravity="162 cm/s^2").value("gravity") == pytest.approx(1.62, rel=1e-14)
    # A weight of zero has no direction, in which it could grow again.
    with pytest.raises(InputError, match=r"^gravity = 0"):
        ROTOR.replace(gravity=0.0)
    # Of what pulls otherwise nobody knows an acceleration of free fall.
    shaken = ROTOR.unforced.under(Force(0.5j, np.array([0.1])))
    assert "gravity" not in shaken.varied
    assert "gravity" not in jeffcott(PAPER).under(Force(-1j, np.array([0.1]))).varied


def test_a_shaken_housing_keeps_its_frequency_when_the_shaft_turns_faster():
    shaken = ROTOR.unforced.under(Force(0.5j, np.array([0.1]))).replace(speed=1.25 * HEAVY.machine.speed)
    assert shaken.forces[0].exponent == pytest.approx(1j * (1.5 / 1.25 - 1.0))
    assert shaken.forces[0].accelerations == pytest.approx(0.1 / 1.25**2)


def test_all_masses_fall_alike():
    scales = Scales(5.0, 0.25e-3, 1000.0)
    rotor = tilting().model.replace(scales=scales)
    assert rotor.under_gravity(Gravity()).weight == pytest.approx(Gravity().pull(scales) * rotor.system.translated)
    with pytest.raises(InputError, match=r"^gravity = 9.81 m/s² at -90°: a rotor with mass, clearance and speed"):
        tilting().model.under_gravity(Gravity())


def test_levitation_is_a_circle_about_the_static_sag():
    position, velocity = levitation_of(ROTOR)
    sag = 5.0 * 9.81 / 5e5 / 0.25e-3
    whirl = ROTOR.unforced.equilibrium
    # Damping does not act on what stands still in the fixed frame.
    assert position[0] == pytest.approx(whirl - 1j * sag, abs=1e-14)
    assert velocity[0] + 1j * position[0] == pytest.approx(1j * whirl, abs=1e-14)


def test_a_rotor_that_sags_to_the_wall_does_not_levitate():
    with pytest.raises(InputError, match=r"^levitation = up to 1.97 clearances from the centre: .* inside the wall"):
        levitation_of(rotor_of(HEAVY.replace(stiffness="1e5 N/m")))
    with pytest.raises(InputError, match=r"^levitation = none, nothing holds the rotor"):
        levitation_of(ROTOR.without_levitation())


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


def test_levitation_and_shaft_of_a_rotor_of_several_coordinates_are_not_told_apart():
    with pytest.raises(
        InputError, match=r"^machine = .*: a rotor of one coordinate, or one that says by its unlevitated matrices"
    ):
        tilting().model.without_levitation()


@pytest.mark.parametrize(
    "asked",
    [
        cm.find_equilibria,
        cm.find_orbits,
        exact_rotor_of,
        lambda machine: rotor_of(machine).refuse_forces(),
    ],
)
def test_what_needs_a_rotor_at_rest_in_its_frame_names_gravity_and_the_remedy(asked):
    with pytest.raises(InputError) as problem:
        asked(HEAVY)
    assert str(problem.value).startswith("machine = a rotor under gravity: needs a rotor without gravity")
    assert "a setting gravity=0 leaves weight out" in str(problem.value)


def test_other_forces_are_not_called_gravity():
    shaken = jeffcott(PAPER).under(Force(0.3j, np.array([0.1])))
    with pytest.raises(InputError, match=r"^machine = a rotor under forces that change with time: "):
        shaken.refuse_forces()
    assert Parameters(**vars(PAPER)) == shaken.planar
