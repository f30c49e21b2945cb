"""A flexible rotor that is made stiffer and stiffer moves as the planar rotor of its mass, through contact too."""

import numpy as np
import pytest

import carom as cm
from carom.parameters import Gravity, TouchdownBearing
from carom.rotors import (
    PID,
    FlexibleMachine,
    FlexibleRotor,
    MagneticBearing,
    Material,
    ProportionalDamping,
    ShaftSection,
    TouchdownPlane,
    Unbalance,
)

RATE, UNBALANCE = 40.0, 50e-6
"""Damping per mass, 1/s, and mass times eccentricity, kg m."""
UNTIL = "50 ms"


def flexible(stiffer, gravity):
    """Two bearings of each kind at the same distance from the middle, where the unbalance is; proportional controllers."""
    shaft = [ShaftSection(length, 0.03, 0.0, Material(2.1e11 * stiffer, 7800.0)) for length in (0.1, 0.2, 0.2, 0.1)]
    wall = TouchdownBearing("kelvin-voigt", stiffness=2e7, damping=200.0)
    return FlexibleMachine(
        rotor=FlexibleRotor(shaft, [], ProportionalDamping(RATE, 0.0)),
        speed=300.0,
        clearance=0.2e-3,
        bearings=[MagneticBearing(node, 50.0, -1e5, PID(9000.0)) for node in (1, 3)],
        touchdowns=[TouchdownPlane(node, wall, 0.015, 0.1) for node in (1, 3)],
        unbalances=[Unbalance(2, UNBALANCE)],
        gravity=gravity,
    )


def planar(tmp_path, mass, gravity):
    """Both bearings of each kind as one."""
    path = tmp_path / "planar.toml"
    path.write_text(f"""
[machine]
mass = {mass!r}
stiffness = {2.0 * (50.0 * 9000.0 - 1e5)!r}
damping = {RATE * mass!r}
eccentricity = {UNBALANCE / mass!r}
clearance = "0.2 mm"
rotor_radius = "15 mm"
speed = "300 rad/s"
friction = 0.1
[touchdown]
law = "kelvin-voigt"
stiffness = "4e7 N/m"
damping = "400 N s/m"
{"[gravity]" if gravity else ""}
""")
    return cm.models.rotor_of(cm.load(path))


@pytest.mark.parametrize("gravity", [None, Gravity()])
def test_the_distance_falls_like_one_over_the_stiffness_of_the_shaft(tmp_path, gravity):
    machines = [flexible(stiffer, gravity) for stiffer in (100.0, 400.0)]
    kick = cm.kick("150 mm/s", angle=0.7)
    rotor = planar(tmp_path, machines[0].rotor.mass, gravity)
    reference = cm.simulate(rotor, kick, UNTIL)
    assert len(reference.contacts.time) >= 3
    times = np.linspace(0.0, reference.time, 400)
    away = []
    for machine in machines:
        motion = cm.simulate(machine.with_modes(4).model, kick, UNTIL)
        first, second = (motion.seen_at(plane) for plane in (0, 1))
        assert len(first.contacts.time) == len(reference.contacts.time)
        # What is left is rounding of stiff exponents, with contacts that magnify it.
        np.testing.assert_allclose(first.position(times), second.position(times), atol=1e-8)
        away.append(np.abs(first.position(times) - reference.position(times)).max())
    assert away[1] < 1e-3  # clearances
    assert away[0] / away[1] == pytest.approx(4.0, rel=0.3)
