"""Disturbances of any linear rotor: shocks against integration of its matrices in the fixed frame, starts against its planes."""

import cmath
import math
from dataclasses import dataclass

import numpy as np
import pytest
from compilation import sized
from linear_rotors import FixedFrame, random_rotor, single, tilting

from carom.disturbances import BaseShock
from carom.disturbances.shocks import states_after

pytestmark = pytest.mark.jit_only


@dataclass(frozen=True, eq=False)
class Shaken(FixedFrame):
    """Coordinates relative to a housing that is accelerated by a half-sine pulse."""

    peak: float = 0.0
    duration: float = 1.0
    direction: float = 0.0

    def free(self, time, position, velocity):
        push = self.peak * math.sin(math.pi * time / self.duration) * cmath.rect(1.0, self.direction)
        return super().free(time, position, velocity) - self.translation * push

    def after(self):
        """State in the co-rotating frame at the end of the pulse, and the number of impacts."""
        start = self.model.system.rest
        met = self.bounces(start, 1j * start, self.duration, 100)
        time, position, velocity = 0.0, start, 1j * start
        if met:
            time, plane, position, velocity = met[-1]
            velocity = self.struck(plane, position, velocity)
        position, velocity = self.follow(time, self.duration, position, velocity)
        turn = cmath.exp(-1j * self.duration)
        return position * turn, (velocity - 1j * position) * turn, len(met)


def shaken(rotor, peak, duration, direction):
    return Shaken(**vars(rotor), peak=peak, duration=duration, direction=direction)


def three_masses():
    """Three coordinates that are not those of a chain, two planes; eight modes with those of the pulse."""
    return FixedFrame(
        mass=np.array([[1.0, 0.1, 0.0], [0.1, 0.6, 0.2], [0.0, 0.2, 0.8]]),
        damping=0.1 * np.eye(3),
        stiffness=np.array([[0.7, -0.1, 0.0], [-0.1, 0.9, -0.2], [0.0, -0.2, 0.5]]),
        gyroscopic=np.diag([0.0, 0.0, 0.3]),
        forcing=np.array([0.1, 0.05j, 0.02]),
        planes=np.array([[1.0, 0.3, 0.0], [0.2, 1.0, 0.4]]),
        friction=0.15,
        restitution=0.7,
        radius_ratio=12.0,
        translation=np.array([1.0, 0.8, 0.0]),
    )


@pytest.mark.parametrize(
    "rotor",
    [single(), three_masses(), pytest.param(tilting(), marks=pytest.mark.deep)],
    ids=["one coordinate", "three coordinates", "two coordinates"],
)
@pytest.mark.parametrize(
    ("peak", "duration", "direction"), [(0.1, 1.3, 0.3), (3.0, 1.5, 2.0), (1.5, 4.0, 4.0), (5.0, 0.7, 1.0)]
)
def test_state_after_a_shock_is_that_of_the_matrices(rotor, peak, duration, direction):
    place, speed, impacts = shaken(rotor, peak, duration, direction).after()
    positions, velocities, ended, touched = states_after(
        BaseShock(peak, duration), rotor.model, np.array([peak]), np.array([direction])
    )
    assert not ended[0]
    assert touched[0] == (impacts > 0)
    assert np.allclose(positions[0], place, rtol=0, atol=1e-9)
    assert np.allclose(velocities[0], speed, rtol=0, atol=1e-9)


def test_random_rotors_and_shocks():
    checked = 0
    for seed in range(sized(4, 1, 60)):
        model = random_rotor(seed, n=3, planes=2, damping=0.2, friction=0.1)
        fixed, random = model.matrices, np.random.default_rng(seed)
        if np.abs(model.equations.planes @ model.system.rest).max() >= 1.0:
            model = model.replace(forcing=0.0 * model.equations.forcing)
            fixed = model.matrices
        if len({each.wall(1.0) for each in model.equations.touchdowns}) > 1:
            model = model.replace(restitution=0.6, radius_ratio=8.0)
        rotor = FixedFrame(
            *(part.real for part in (fixed.mass, fixed.damping, fixed.stiffness, fixed.gyroscopic)),
            fixed.forcing,
            model.equations.planes.real,
            0.1,
            0.6,
            8.0,
            model.equations.translation.real,
        )
        peak, duration, direction = random.uniform(0.5, 4.0), random.uniform(0.3, 2.0), random.uniform(0.0, 6.0)
        place, speed, impacts = shaken(rotor, peak, duration, direction).after()
        if impacts > 10:  # chatter, which the reference follows bounce by bounce
            continue
        positions, velocities, _, _ = states_after(
            BaseShock(peak, duration), model, np.array([peak]), np.array([direction])
        )
        assert np.allclose(positions[0], place, rtol=0, atol=1e-7), seed
        assert np.allclose(velocities[0], speed, rtol=0, atol=1e-6), seed
        checked += 1
    assert checked > 0
