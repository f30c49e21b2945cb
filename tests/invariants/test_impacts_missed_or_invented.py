"""No impact is missed and none invented, where that is hardest: near grazing, along the wall, and far from equilibrium.

Every flight is compared with the high-precision reference, as the event loop of single motions flies it and as lanes do.
"""

import math

import numpy as np
import pytest
from compilation import sized
from flights import (
    EPSILON,
    Tally,
    by_advance,
    by_lane,
    compare,
    near_grazing_task,
    parameters,
    random_parameters,
    task_from_state,
    wall_task,
)

from carom.core.layout import LANES
from carom.models import jeffcott

FLIGHTS = sized(150, 6, 15_000)
HORIZON = 4.0


def ordinary(rng, index):
    return random_parameters(rng, index)


def undamped(rng, index):
    """No damping, very little, or negative; every third rotor is balanced."""
    gamma = (0.0, 10.0 ** rng.uniform(-8.0, -3.0), -(10.0 ** rng.uniform(-4.0, -0.5)))[index % 3]
    return parameters(
        gamma, rng.uniform(0.1, 3.0), rho=rng.uniform(0.0, 1.5) * (index % 9 > 2), phi=rng.uniform(-3.0, 3.0)
    )


def stiff(rng, index):
    """Modes up to a thousand times as fast as the shaft, one of them much faster than the other in every other rotor."""
    omega = 10.0 ** rng.uniform(0.0, 2.0)
    gamma = 10.0 ** rng.uniform(2.0, 3.0) if index % 2 else omega * 10.0 ** rng.uniform(-3.0, 0.0)
    return parameters(gamma, omega, rho=rng.uniform(0.0, 2.0) * min(omega**2, 400.0))


def far(rng, index):
    """Contact-free equilibria 30 to 1e5 clearances away, near resonance and by unbalance."""
    if index % 2:
        return parameters(10.0 ** rng.uniform(-3.0, 0.0), rng.uniform(0.3, 2.5), rho=10.0 ** rng.uniform(2.0, 3.0))
    resonance = 1.0 + rng.choice([-1.0, 0.0, 1.0]) * 10.0 ** rng.uniform(-6.0, -3.0)
    return parameters(10.0 ** rng.uniform(-5.0, -3.0), resonance, rho=rng.uniform(0.1, 1.0))


def grazing(rotor, rng):
    drawn = near_grazing_task(rotor, rng)
    return None if drawn is None else drawn[0]


def on_the_wall(rotor, rng):
    return wall_task(rotor, rng.uniform(0.0, 6.0), -(10.0 ** rng.uniform(-8.0, 0.5)), rng.normal())


def crawling(rotor, rng):
    """Off the wall as slowly as rounding allows and slower: such a start counts as at rest there."""
    return wall_task(rotor, rng.uniform(0.0, 6.0), -(10.0 ** rng.uniform(-13.0, -7.0)), 3.0 * rng.normal())


def beside_the_wall(rotor, rng):
    """Slow, and as close to the wall as counts as inside."""
    height = 64.0 * EPSILON * (1.0 + abs(rotor.equilibrium)) + 10.0 ** rng.uniform(-13.0, -2.0)
    direction, speed = np.exp(1j * rng.uniform(0.0, 6.0, 2))
    return task_from_state(rotor, (1.0 - height) * direction, 10.0 ** rng.uniform(-9.0, -2.0) * speed)


def along_the_wall(rotor, rng):
    """On an arc that keeps close to the wall: neither force nor speed lead away from it, but for a little."""
    height, angle = 10.0 ** rng.uniform(-10.0, -3.0), rng.uniform(0.0, 6.0)
    direction = complex(math.cos(angle), math.sin(angle))
    forces = [
        float(task_from_state(rotor, (1.0 - height) * direction, 1j * spin * direction).flight.level(0.0)[2])
        for spin in (-1.0, 0.0, 1.0)
    ]
    bend, slope = 0.5 * (forces[0] + forces[2]) - forces[1], 0.5 * (forces[2] - forces[0])
    square = slope**2 - 4.0 * bend * forces[1]
    if square < 0.0:
        return None
    spin = (-slope + rng.choice([-1.0, 1.0]) * math.sqrt(square)) / (2.0 * bend) + rng.normal() * 10.0 ** rng.uniform(
        -9.0, 0.0
    )
    return task_from_state(rotor, (1.0 - height) * direction, 1j * spin * direction)


def flies(task):
    """Whether a start on the wall leaves it, clearly: the others may land, and are no flights."""
    return task.radial_speed is None or float(task.flight.level(0.0)[2]) < -1e-3


@pytest.mark.parametrize("start", [grazing, on_the_wall, crawling, beside_the_wall, along_the_wall])
@pytest.mark.parametrize("machine", [ordinary, undamped, stiff, far])
def test_no_impact_is_missed_and_none_invented(machine, start):
    by_itself, side_by_side = Tally(f"{start.__name__}, {machine.__name__}"), Tally("the same in lanes")
    for index in range(FLIGHTS):
        rng = np.random.default_rng([47, index])
        rotor = jeffcott(machine(rng, index))
        task = start(rotor, rng)
        if task is None or not flies(task):
            continue
        compare(task, HORIZON, by_itself, by_advance)
        if task.radial_speed is None or task.radial_speed < -1e-6:
            compare(task, HORIZON, side_by_side, by_lane(index % LANES, []))
    by_itself.check()
    side_by_side.check()
    assert by_itself.tried > 0.1 * FLIGHTS
