"""Margins of contact in walls that give way, against sampled motions."""

from __future__ import annotations

import numpy as np
import pytest
from yielding_rotors import Yielding, packed

from carom.core.layout import rub_workspace
from carom.core.yielding_margins import margins_in_walls
from carom.models import HuntCrossley, KelvinVoigt
from carom.orbits.word import Kind, Word

pytestmark = pytest.mark.jit_only
SAMPLES = 4000


def margins(rotor, word, nodes, durations):
    """Arrival, least force, cone, slip and pressing of a word's segments."""
    system = rotor.model.system
    at = word.kinds, word.planes, system.amplitudes_of(np.array(nodes)), np.array(durations)
    return margins_in_walls(system.arrays, *at, rub_workspace(system.modes, 1))


def along(rotor, node, duration, contact):
    """Depth, rate and slip at even times of a segment, by the general integrator."""
    rows, state, step = [], packed(*node), duration / SAMPLES
    for _ in range(SAMPLES):
        u, v = complex(*state[:2]), complex(*state[2:])
        local = np.conj(u / abs(u)) * v
        rows.append((abs(u) - 1.0, local.real, rotor.surface_speed + abs(u) - 1.0 + local.imag))
        state = state + step * np.array(_stage(rotor, state, step, contact))
    return np.array(rows).T


def _stage(rotor, state, step, contact):
    """Slope of the classical Runge–Kutta step."""
    a = np.array(rotor.rates(state, contact))
    b = np.array(rotor.rates(state + 0.5 * step * a, contact))
    c = np.array(rotor.rates(state + 0.5 * step * b, contact))
    d = np.array(rotor.rates(state + step * c, contact))
    return (a + 2.0 * b + 2.0 * c + d) / 6.0


@pytest.mark.parametrize("law", [KelvinVoigt(60.0, 0.5), HuntCrossley(60.0, 0.1, 1.0), HuntCrossley(90.0, 0.1, 1.5)])
def test_least_force_and_slip_inside_a_slide(law):
    rotor, node, duration = Yielding(law, mu=0.05, surface_speed=1.5), (1.35 + 0j, -0.6 + 3.0j), 0.5
    depth, rate, slip = along(rotor, node, duration, "+")
    forces = np.array([rotor.force(*each) for each in zip(depth, rate, strict=True)])
    assert depth.min() > 0.0
    assert 0 < np.argmin(forces) < SAMPLES - 1
    _, least, cone, sliding, pressing = margins(rotor, Word.of(Kind.SLIDE_FORWARD), [node], [duration])
    assert pressing == pytest.approx(forces.min(), abs=1e-5 * forces.max())
    assert least == pytest.approx(forces[0], rel=1e-12)
    assert cone == np.inf
    inside = 0 < np.argmin(slip) < SAMPLES - 1
    assert sliding == (pytest.approx(slip.min(), abs=1e-5) if inside else np.inf)


def test_arrivals_and_the_way_out_of_a_wall_that_comes_back_slowly():
    rotor = Yielding(KelvinVoigt(300.0, 40.0), omega=3.0)
    word = Word.of(Kind.SLIDE_FORWARD, Kind.FREE, Kind.LIFT)
    nodes = [(1.0 + 0j, 0.4 - 0.2j), (1.05 + 0j, -0.45 - 1.0j), (1.0 + 0j, -0.4 - 0.3j)]
    approach, _, _, _, pressing = margins(rotor, word, nodes, [0.02, 0.2, 0.3])
    assert approach == pytest.approx(0.4, rel=1e-12)
    depth, rate, _ = along(rotor, nodes[1], 0.2, "")
    pulls = -np.array([rotor.parts(*each) for each in zip(depth, rate, strict=True)])
    expected = [values.min() for values in (300.0 * depth, pulls) if 0 < np.argmin(values) < SAMPLES - 1]
    assert pressing == (pytest.approx(min(expected), abs=1e-4) if expected else np.inf)


def test_the_cone_where_rolling_begins_and_where_the_slip_reverses():
    rotor = Yielding(KelvinVoigt(300.0, 4.0), mu=0.3, surface_speed=1.4)
    node = (1.05 + 0j, 0.1 - 1j * (1.4 + 0.05))
    free, rolls = (np.array(rotor.rates(packed(*node), contact)) for contact in ("", "0"))
    grip, force = (rolls - free)[3], -(rolls - free)[2]
    duration = 1e-4
    _, _, rolling, _, _ = margins(rotor, Word.of(Kind.SLIDE_FORWARD, Kind.ROLL), [node, node], [duration] * 2)
    assert rolling == pytest.approx(rotor.mu * force - abs(grip), rel=1e-9)
    _, _, reversing, _, _ = margins(
        rotor, Word.of(Kind.SLIDE_FORWARD, Kind.SLIDE_BACKWARD), [node, node], [duration] * 2
    )
    # Beyond the cone on the side of each slip; both turns of the word count.
    assert reversing == pytest.approx(-(rotor.mu * force + abs(grip)), rel=1e-9)
