"""The reference for compliant walls, against closed forms, polar coordinates in high precision, and itself in others."""

import math

import numpy as np
import pytest
from compliant_reference import (
    AWAY,
    FORWARD,
    ROLLING,
    HuntCrossley,
    KelvinVoigt,
    Plane,
    Rotor,
    follow,
)
from scipy.special import lambertw

STIFFNESS, SPEED = 1e4, 1.3
ERROR = 1e-11
"""The integrator's tolerances of 1e-13 and 1e-14 over some dozens of steps, most of them of one sign."""


def free_mass(law, friction=0.0):
    """A mass that nothing but the wall acts on, in a frame at rest, from inside the clearance."""
    none = np.zeros((1, 1))
    return Rotor(np.eye(1), none, none, np.zeros(1), [Plane((1.0,), law, friction, 5.0)])


# ------------------------------------------------------------------------------------------------ a free mass


@pytest.mark.parametrize("exponent", [1.0, 10 / 9, 1.5])
@pytest.mark.parametrize("dissipation", [0.0, 0.1, 8.0])
def test_a_hunt_crossley_wall_restitutes_as_it_should(exponent, dissipation):
    above = 1.0 + dissipation * SPEED  # w e^(-w) has the same value at 1 - (restitution)(dissipation)(speed)
    restitution = (1.0 + lambertw(-above * math.exp(-above)).real) / (above - 1.0) if dissipation else 1.0
    motion = follow(free_mass(HuntCrossley(STIFFNESS, dissipation, exponent)), [0.9], [SPEED], 0.5)

    assert [event.phase for event in motion.events] == [FORWARD, AWAY]
    assert motion.velocity[0] == pytest.approx(-SPEED * restitution, rel=ERROR)


# ------------------------------------------------------------------------------------- polar coordinates, 20 digits


# ------------------------------------------------------------------------------------------------ several planes


LAWS = (KelvinVoigt(2e3, 10.0), HuntCrossley(3e3, 0.5, 1.5))


def test_coupled_planes_are_planar_rotors_in_other_coordinates():
    """Any coordinates ``X`` with ``U = QX`` describe the same: slides, rolling at both planes at once, weights, all."""
    # Two planar rotors side by side that do not know of each other, each with its plane.
    rotors = [
        Rotor.planar(0.1, 0.76, 3 / 7, 0.21, Plane((1.0,), LAWS[0], 0.3, 4.0), weight=0.1),
        Rotor.planar(0.05, 0.5, 0.3, -0.4, Plane((1.0,), LAWS[1], 0.2, 6.0), weight=0.2),
    ]
    places, speeds, until = [0.9, 0.9 + 0.1j], [2.0 - 4.0j, 2.0 - 5.5j], 0.3
    alone = [follow(rotor, [u], [v], until) for rotor, u, v in zip(rotors, places, speeds, strict=True)]

    random = np.random.default_rng(4)
    turned = random.normal(size=(2, 2)) + 1j * random.normal(size=(2, 2))
    masses = np.diag([1.0, 3.0])
    mass, damping, stiffness = (
        turned.conj().T @ masses @ np.diag([getattr(rotor, name)[0, 0] for rotor in rotors]) @ turned
        for name in ("mass", "damping", "stiffness")
    )
    force = turned.conj().T @ masses @ np.array([rotor.forcing[0] for rotor in rotors])
    weight = turned.conj().T @ masses @ np.array([rotor.turning[0][1][0] for rotor in rotors])
    planes = [
        Plane(tuple(row), plane.law, plane.friction, plane.surface_speed)
        for row, plane in zip(turned, [rotor.planes[0] for rotor in rotors], strict=True)
    ]
    coupled = Rotor(mass, damping, stiffness, force, planes, [(-1j, weight)])
    together = follow(coupled, np.linalg.solve(turned, places), np.linalg.solve(turned, speeds), until)

    for plane, motion in enumerate(alone):
        events = [event for event in together.events if event.plane == plane]
        assert [event.phase for event in events] == [event.phase for event in motion.events]
        np.testing.assert_allclose([e.time for e in events], [e.time for e in motion.events], rtol=0.0, atol=ERROR)
    assert [ROLLING in {event.phase for event in motion.events} for motion in alone] == [True, True]
    ends = [[motion.position[0], motion.velocity[0]] for motion in alone]
    np.testing.assert_allclose(
        np.array([turned @ together.position, turned @ together.velocity]).T, ends, rtol=0.0, atol=ERROR
    )
