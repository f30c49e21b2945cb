"""The reference for compliant walls, against closed forms, polar coordinates in high precision, and itself in others."""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from compliant_reference import (
    AWAY,
    BACKWARD,
    FORWARD,
    ROLLING,
    SEPARATED,
    HuntCrossley,
    KelvinVoigt,
    Plane,
    Rotor,
    follow,
)
from mpmath import mpf
from scipy.special import lambertw

from carom.parameters.restitution import half_contact

STIFFNESS, SPEED = 1e4, 1.3
ERROR = 1e-11
"""The integrator's tolerances of 1e-13 and 1e-14 over some dozens of steps, most of them of one sign."""


def free_mass(law, friction=0.0):
    """A mass that nothing but the wall acts on, in a frame at rest, from inside the clearance."""
    none = np.zeros((1, 1))
    return Rotor(np.eye(1), none, none, np.zeros(1), [Plane((1.0,), law, friction, 5.0)])


# ------------------------------------------------------------------------------------------------ a free mass


@pytest.mark.parametrize("damping", [0.0, 1.0, 10.0, 100.0, 200.0, 300.0, 2000.0])
def test_a_spring_and_a_dashpot_restitute_as_they_should(damping):
    frequency = math.sqrt(STIFFNESS)
    ratio = damping / (2.0 * frequency)
    restitution = math.exp(-2.0 * ratio * half_contact(ratio))
    motion = follow(free_mass(KelvinVoigt(STIFFNESS, damping)), [0.9], [SPEED], 0.4)

    assert [event.phase for event in motion.events] == [FORWARD, *[SEPARATED] * (damping > 0.0), AWAY]
    assert motion.velocity[0] == pytest.approx(-SPEED * restitution, rel=ERROR)
    first, last = motion.events[:2]
    assert first.time == pytest.approx(0.1 / SPEED, rel=1e-15)
    assert last.time - first.time == pytest.approx(2.0 * half_contact(ratio) / frequency, rel=ERROR)
    # Indented while it is let go, by what the dashpot holds back.
    assert last.position[0].real - 1.0 == pytest.approx(damping / STIFFNESS * SPEED * restitution, abs=ERROR)


@pytest.mark.parametrize("exponent", [1.0, 10 / 9, 1.5])
@pytest.mark.parametrize("dissipation", [0.0, 0.1, 8.0])
def test_a_hunt_crossley_wall_restitutes_as_it_should(exponent, dissipation):
    above = 1.0 + dissipation * SPEED  # w e^(-w) has the same value at 1 - (restitution)(dissipation)(speed)
    restitution = (1.0 + lambertw(-above * math.exp(-above)).real) / (above - 1.0) if dissipation else 1.0
    motion = follow(free_mass(HuntCrossley(STIFFNESS, dissipation, exponent)), [0.9], [SPEED], 0.5)

    assert [event.phase for event in motion.events] == [FORWARD, AWAY]
    assert motion.velocity[0] == pytest.approx(-SPEED * restitution, rel=ERROR)


def test_friction_takes_its_share_of_the_normal_impulse():
    """A free mass that slips all the time turns by ``μ(1 + d)v``: in the limit of a short contact, as ``n`` hardly turns."""
    misses = []
    for stiffness in (1e6, 1e8):
        law = KelvinVoigt(stiffness, 0.2 * np.sqrt(stiffness))
        motion = follow(free_mass(law, friction=0.3), [1.0 - 1e-9], [SPEED], 100.0 / np.sqrt(stiffness))
        share = math.exp(-0.2 * half_contact(0.1))
        misses.append(motion.velocity[0].imag + 0.3 * (1.0 + share) * SPEED)
    assert abs(misses[0]) < 1e-2
    assert misses[0] / misses[1] == pytest.approx(10.0, rel=0.05)  # an error of the order 1/√k


# ------------------------------------------------------------------------------------- polar coordinates, 20 digits


PARAMETERS = {"gamma": 0.1, "omega": 0.76, "rho": 3 / 7, "phi": 0.21}


def in_polar(law, friction, ratio, parameters, phase, span, state):
    """State ``r, ṙ, θ, W = 1 + θ̇`` after a phase, by Taylor series.  Rolling is ``rW = −s``, without any friction force."""
    gamma, omega, rho, phi = (mpf(parameters[name]) for name in ("gamma", "omega", "rho", "phi"))

    def rates(_time, at):
        radius, speed, angle, whirl = at
        depth, push = radius - 1, mpf(0)
        if phase in (FORWARD, BACKWARD, ROLLING):
            push = law.stiffness * depth + law.damping * speed if isinstance(law, KelvinVoigt) else None
            if push is None:
                power = depth if law.exponent == 1.0 else mpmath.exp(mpf(law.exponent) * mpmath.log(depth))
                push = law.stiffness * power * (1 + law.dissipation * speed)
        if phase == ROLLING:
            whirl = -mpf(ratio) / radius
        drag = mpf(friction) * push * {FORWARD: -1, BACKWARD: 1}.get(phase, 0)
        along = -gamma * radius * whirl - rho * mpmath.sin(angle - phi) + drag
        turning = (along - 2 * speed * whirl) / radius
        if phase == ROLLING:
            turning = mpf(ratio) * speed / radius**2
        outward = radius * whirl**2 - gamma * speed - omega**2 * radius + rho * mpmath.cos(angle - phi) - push
        return [speed, outward, whirl - 1, turning]

    return mpmath.odefun(rates, 0, state, tol=mpf(10) ** -15)(mpf(span))


def polar(position, velocity):
    place, speed = mpmath.mpc(complex(position)), mpmath.mpc(complex(velocity))
    radius = abs(place)
    local = speed * place.conjugate() / radius
    return [radius, local.real, mpmath.arg(place), 1 + local.imag / radius]


def cartesian(state):
    radius, speed, angle, whirl = state
    normal = mpmath.expj(angle)
    return complex(radius * normal), complex((speed + 1j * radius * (whirl - 1)) * normal)


@pytest.mark.parametrize(
    ("law", "friction", "ratio", "start", "until", "phases"),
    [
        (KelvinVoigt(1e3, 10.0), 0.3, 3.0, (0.9, 2.0 - 5.0j), 0.3, [BACKWARD, ROLLING, BACKWARD, SEPARATED, AWAY]),
        # Pressed out by a fast whirl, it comes back before it has left.
        (KelvinVoigt(1e4, 30.0), 0.1, 57.0, (1.012, -4.05 - 31.0j), 0.02, [SEPARATED, FORWARD]),
        (HuntCrossley(1e3, 0.4, 1.0), 0.3, 3.0, (0.9, 2.0 - 5.0j), 0.3, [BACKWARD, ROLLING, BACKWARD, AWAY]),
        (HuntCrossley(1e3, 0.4, 1.5), 0.3, 3.0, (1.01, 2.0 - 4.5j), 0.162, [BACKWARD, ROLLING, BACKWARD]),
        # Faster than 1/χ on the way out: the rotor's own spring tears it away.
        (HuntCrossley(1e3, 3.0, 10 / 9), 0.3, 9.0, (1.002, 1.0 + 0.1j), 0.03, [FORWARD, SEPARATED, AWAY]),
    ],
)
def test_phases_in_polar_coordinates(law, friction, ratio, start, until, phases):
    parameters = {**PARAMETERS, "omega": 10.0} if SEPARATED in phases and isinstance(law, HuntCrossley) else PARAMETERS
    rotor = Rotor.planar(**parameters, plane=Plane((1.0,), law, friction, ratio + 1.0))
    position, velocity = np.array([start[0]]), np.array([start[1]])
    motion = follow(rotor, position, velocity, until)
    first = AWAY if abs(start[0]) < 1.0 else phases[0]
    seen = [*([] if first == AWAY else [first]), *(event.phase for event in motion.events)]
    assert seen == phases

    times = [0.0, *(event.time for event in motion.events), motion.time]
    with mpmath.workdps(20):
        state = polar(*start)
        for phase, (begin, end) in zip(
            [first, *(event.phase for event in motion.events)], pairwise(times), strict=True
        ):
            state = in_polar(law, friction, ratio, parameters, phase, end - begin, state)
    np.testing.assert_allclose(cartesian(state), [motion.position[0], motion.velocity[0]], rtol=0.0, atol=ERROR)


# ------------------------------------------------------------------------------------------------ several planes


LAWS = (KelvinVoigt(2e3, 10.0), HuntCrossley(3e3, 0.5, 1.5))


def two_planar_rotors():
    """Two planar rotors side by side that do not know of each other, each with its plane."""
    return [
        Rotor.planar(0.1, 0.76, 3 / 7, 0.21, Plane((1.0,), LAWS[0], 0.3, 4.0), weight=0.1),
        Rotor.planar(0.05, 0.5, 0.3, -0.4, Plane((1.0,), LAWS[1], 0.2, 6.0), weight=0.2),
    ]


def test_coupled_planes_are_planar_rotors_in_other_coordinates():
    """Any coordinates ``X`` with ``U = QX`` describe the same: slides, rolling at both planes at once, weights, all."""
    rotors = two_planar_rotors()
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


def test_a_motion_may_be_followed_in_parts():
    rotor = two_planar_rotors()[0]
    whole = follow(rotor, [0.9], [2.0 - 4.0j], 0.3)
    (rolls,) = [k for k, event in enumerate(whole.events) if event.phase == ROLLING]
    cut = whole.events[rolls].time + 1e-3
    first = follow(rotor, [0.9], [2.0 - 4.0j], cut)
    second = follow(rotor, first.position, first.velocity, 0.3, start=cut, phases=first.phases)

    assert first.phases == (ROLLING,)
    assert [event.phase for event in first.events + second.events] == [event.phase for event in whole.events]
    np.testing.assert_allclose(second.position, whole.position, rtol=0.0, atol=ERROR)
