"""Steady motions in contact over the speed of the shaft, against those at each speed alone."""

import math
from itertools import pairwise

import numpy as np
from compilation import sized

from carom.closed_forms import contact_changes, find_equilibria, rolling
from carom.models import jeffcott
from carom.parameters import Machine


def random_machine(random: np.random.Generator, most_damped: float = 0.35) -> Machine:
    """A machine of any size, with a damping ratio up to a largest one."""
    mass, natural = 10 ** random.uniform(-1, 4), 10 ** random.uniform(1.5, 3.5)
    ratio = 10 ** random.uniform(-2, math.log10(most_damped))
    clearance = 10 ** random.uniform(-4, -3)
    return Machine(
        mass=mass,
        damping=2.0 * ratio * mass * natural,
        stiffness=mass * natural**2,
        eccentricity=clearance * 10 ** random.uniform(-3, 0.3),
        clearance=clearance,
        rotor_radius=clearance * random.uniform(20, 200),
        speed=natural * random.uniform(0.3, 3.0),
        unbalance_phase=random.uniform(-3, 3),
        friction=random.uniform(0.02, 0.5),
        restitution=random.uniform(0.2, 0.95),
    )


def test_steady_motions_change_only_at_the_speeds_listed():
    """Fresh speeds in each stretch between two of them have the same steady motions."""
    random = np.random.default_rng(6)
    changes = 0
    for _ in range(sized(compiled=60, interpreted=10, deep=600)):
        machine = random_machine(random)
        natural = math.sqrt(machine.stiffness / machine.mass)
        ends = [0.05 * natural, *contact_changes(machine), 20.0 * natural]
        ends = [end for end in ends if 0.05 <= end / natural <= 20.0]
        before = None
        for low, high in pairwise(ends):
            if high - low < 1e-6 * high:
                continue
            found = {steady(machine, low + (high - low) * share) for share in random.uniform(1e-3, 1.0 - 1e-3, 4)}
            assert len(found) == 1
            changes += before is not None and before not in found
            before = next(iter(found))
    assert changes > 20


def steady(machine: Machine, speed: float) -> tuple[object, ...]:
    rotor = jeffcott(machine.parameters.replace(speed=speed))
    found = [(one.kind, one.stable) for one in find_equilibria(rotor) if one.status == "admissible"]
    return (*sorted(found), rolling(rotor).holds)
