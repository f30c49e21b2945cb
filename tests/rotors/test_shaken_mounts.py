"""Shocks of the base shake the mounts of touchdown bearings too: against the finite elements in coordinates that stand still, by SciPy."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.parameters import TouchdownBearing
from carom.rotors import Disc, FlexibleRotor, Material, ProportionalDamping, ShaftSection
from tests.flexible_machines import symmetric

pytestmark = pytest.mark.jit_only

PEAK, LASTS, END = 400.0, 2e-3, 3e-3
MODES = 8
"""All of the finite elements."""
STIFFNESS, MOUNT = 2e7, {"mount_mass": 0.2, "mount_stiffness": 2e6, "mount_damping": 100.0}
SHAFT = [ShaftSection(length, 0.03, 0.0, Material(2.1e11, 7800.0)) for length in (0.1, 0.4, 0.1)]
MACHINE = symmetric(
    touchdown=TouchdownBearing("kelvin-voigt", stiffness=STIFFNESS, damping=0.0, **MOUNT),
    rotor=FlexibleRotor(SHAFT, [Disc(1, 1.0, 1e-4, 1e-4)], ProportionalDamping(0.0, 1e-7), 0.5),
    gravity=None,
)


def housing(time):
    """Place and velocity of a housing that a half sine of acceleration has moved from rest."""
    rate, within = math.pi / LASTS, min(time, LASTS)
    velocity = PEAK / rate * (1.0 - math.cos(rate * within))
    return PEAK / rate * (within - math.sin(rate * within) / rate) + (time - within) * velocity, velocity


def solved():
    """Times and forces (P, T) on the rotor, in coordinates of the ground: of the nodes, the mounts and the controllers."""
    rotor, bearings = MACHINE.rotor, MACHINE.bearings
    mass, stiffness = rotor.matrices.mass, rotor.matrices.stiffness
    spin = rotor.damping_matrix - 1j * MACHINE.speed * rotor.matrices.gyroscopic
    n, nodes = len(mass), [2 * rotor.place_of(each.node) for each in MACHINE.touchdowns]
    states = [each.loop.states for each in bearings]
    ends = np.cumsum([2 * n, 2, 2, *states])

    def pressed(place, mounts):
        gap = place[nodes] - mounts
        radius = np.abs(gap)
        return STIFFNESS * np.maximum(radius - MACHINE.clearance, 0.0) * gap / np.maximum(radius, 1e-300)

    def rates(time, state):
        moved, mounts, moving, *loops = np.split(state, ends[:-1])
        place, velocity = moved[:n], moved[n:]
        at, speed = housing(time)
        contact = pressed(place, mounts)
        forces = -stiffness @ place - spin @ velocity
        forces[nodes] -= contact
        changes = []
        for bearing, own in zip(bearings, loops, strict=True):
            node = 2 * rotor.place_of(bearing.node)
            seen, loop = place[node] - at, bearing.loop
            forces[node] -= bearing.ki * (loop.C[0] @ own + loop.D[0, 0] * seen) + bearing.ks * seen
            changes.append(loop.A @ own + loop.B[:, 0] * seen)
        held = MOUNT["mount_stiffness"] * (mounts - at) + MOUNT["mount_damping"] * (moving - speed)
        return np.concatenate(
            [velocity, np.linalg.solve(mass, forces), moving, (contact - held) / MOUNT["mount_mass"], *changes]
        )

    times = np.linspace(0.0, END, 3001)
    found = solve_ivp(rates, (0.0, END), np.zeros(ends[-1], complex), "DOP853", times, rtol=1e-9, atol=1e-15)
    return times, np.abs([pressed(y[:n], y[2 * n : 2 * n + 2]) for y in found.y.T]).T


def test_shocks_shake_the_mounts_of_flexible_machines():
    model = MACHINE.with_modes(MODES).model
    shock = cm.BaseShock.of(model, f"{PEAK} m/s^2", f"{LASTS} s")
    motion = cm.simulate(*shock.apply(model), f"{END} s")
    times, forces = solved()
    scales = model.scales
    for plane in (0, 1):
        stages = [part.seen_at(plane).contacts for part in motion.parts]
        starts = [begun for log, part in zip(stages, motion.parts, strict=True) for begun in part.begins + log.time]
        # SciPy's solution is sampled each microsecond.
        assert starts[0] * scales.time == pytest.approx(times[forces[plane] > 0.0][0], abs=1.01e-6)
        hardest = max(log.peak_force.max(initial=0.0) for log in stages) * motion.seen_at(plane).scales.force
        # In a microsecond the force changes by 1e-5 of its peak at most, and SciPy's contact begins within a step.
        assert hardest == pytest.approx(forces[plane].max(), rel=1e-5)


def test_the_bound_of_harmless_shocks_counts_the_mount():
    """A heavy mount swings towards the rotor, which a bound from the rotor alone leaves out."""
    settings = [
        "touchdown_mount_mass=50 kg",
        "touchdown_mount_stiffness=5e4",
        "touchdown_mount_damping=0",
        "damping=20",
        "gravity=0",
    ]
    machine = cm.load("examples/touchdown-balls.toml", settings)
    duration = 0.5
    peak = cm.closed_forms.contact_free_shock(machine, duration)
    assert peak > 0.0
    for angle in (0.0, 1.5, 3.0, 4.5):
        motion = cm.simulate(*cm.BaseShock(0.999 * peak, duration).apply(machine, angle), 60.0)
        assert not any(len(part.contacts) for part in motion.parts)
