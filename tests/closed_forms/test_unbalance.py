"""The response over speed in closed form, against the matrices of the rotor solved at each speed of a fine sweep."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from compilation import sized
from scipy.optimize import minimize_scalar

from carom.closed_forms import find_equilibria, rolling, speed_response
from carom.models import jeffcott
from carom.parameters import Machine

MACHINES = sized(compiled=100, interpreted=20, deep=2000)
SWEPT = sized(compiled=8, interpreted=3, deep=100)


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


def solved(machine: Machine, speeds: np.ndarray) -> np.ndarray:
    """Displacement in clearances along the unbalance, from the two real equations of motion in the fixed frame.

    With ``z = Re(Z e^{iΩt})`` in both directions, ``(−Ω² M + iΩ C + K) Z = m e Ω² (1, −i)``.
    """
    speeds = np.atleast_1d(speeds)
    unit = np.eye(2)[None]
    dynamic = (machine.stiffness - machine.mass * speeds**2 + 1j * machine.damping * speeds)[:, None, None] * unit
    force = machine.mass * machine.eccentricity * speeds[:, None] ** 2 * np.array([1.0, -1.0j])
    found = np.linalg.solve(dynamic, force[..., None])[..., 0]
    # A forward circle: the second direction follows a quarter of a turn later.
    np.testing.assert_allclose(found[:, 1], -1j * found[:, 0], rtol=1e-12)
    return found[:, 0] / machine.clearance


def test_critical_speed_and_amplification_against_a_fine_sweep():
    """The peak is searched numerically, and the half-power speeds read off a fine grid, as from a measured curve."""
    random = np.random.default_rng(3)
    for _ in range(SWEPT):
        machine = random_machine(random)
        free = speed_response(machine)
        near = free.natural_frequency

        def height(speed: float, machine: Machine = machine) -> float:
            return -float(abs(solved(machine, np.array(speed))[0]))

        grid = near * np.linspace(0.5, 2.0, 4001)
        coarse = grid[np.abs(solved(machine, grid)).argmax()]
        peak = minimize_scalar(
            height, bounds=(0.99 * coarse, 1.01 * coarse), method="bounded", options={"xatol": 1e-9 * near}
        )
        # A maximum is flat: its place is known to the square root of the precision of its height.
        assert free.critical_speed == pytest.approx(peak.x, rel=1e-6)
        assert free.peak == pytest.approx(-peak.fun, rel=1e-9)
        fine = near * np.linspace(0.3, 6.0, 200_001)
        above = fine[np.abs(solved(machine, fine)) >= -peak.fun / math.sqrt(2.0)]
        step = fine[1] - fine[0]
        assert free.half_power is not None
        assert free.half_power[0] == pytest.approx(above[0], abs=step)
        assert free.half_power[1] == pytest.approx(above[-1], abs=step)
        factor = peak.x / (free.half_power[1] - free.half_power[0])
        assert free.amplification_factor == pytest.approx(factor, rel=1e-6)


def test_ranges_beyond_a_radius_against_a_fine_sweep():
    random = np.random.default_rng(4)
    for _ in range(MACHINES):
        machine = random_machine(random, most_damped=3.0)
        free, radius = speed_response(machine), 10 ** random.uniform(-2, 0.5)
        speeds = free.natural_frequency * 10 ** random.uniform(-1.5, 2.5, 2000)
        exceeds = np.abs(solved(machine, speeds)) > radius
        low, high = free.beyond(radius) or (np.inf, np.inf)
        clear = np.abs(np.abs(solved(machine, speeds)) - radius) > 1e-9 * radius
        np.testing.assert_array_equal(exceeds[clear], ((speeds > low) & (speeds < high))[clear])


def test_steady_motions_change_only_at_the_speeds_listed():
    """Fresh speeds in each stretch between two of them have the same steady motions."""
    random = np.random.default_rng(6)
    changes = 0
    for _ in range(sized(compiled=60, interpreted=10, deep=600)):
        machine = random_machine(random)
        free = speed_response(machine)
        ends = [0.05 * free.natural_frequency, *free.contact_changes(), 20.0 * free.natural_frequency]
        ends = [end for end in ends if 0.05 <= end / free.natural_frequency <= 20.0]
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
