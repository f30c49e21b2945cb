"""Samples of starts: what they hold and that they repeat."""

import numpy as np
import pytest
from linear_rotors import bending, single, tilting
from machines import PAPER
from scipy.stats import chi2_contingency, chisquare, ks_2samp

from carom import State, find_orbits, settle
from carom.attractors import DisturbanceSet, known_starts
from carom.attractors.starts import disturbances_of
from carom.closed_forms import runaway_speed
from carom.models import jeffcott


def disturbances(rotor, *chosen, **named):
    single, _ = disturbances_of(rotor, DisturbanceSet(*chosen, **named))
    return single


ROTORS = {
    "planar": jeffcott(PAPER),
    "planar, cannot levitate": jeffcott(PAPER.replace(gamma=0.05)),
    "one coordinate of two": single(2).model.replace(translation=[2.0]),
    "two planes": tilting().model,
    "four masses": bending().model,
}


@pytest.mark.parametrize("name", ROTORS)
@pytest.mark.parametrize("fastest", [0.05, 1.7])
def test_speeds_seen_in_the_room_are_bounded(name, fastest):
    """With z = U exp(it) the velocity in the room is (U' + iU) exp(it)."""
    rotor = ROTORS[name]
    kicks, starts = (DisturbanceSet(400, 7, fastest).kicks(rotor), DisturbanceSet(400, 7, fastest).starts(rotor))
    room = starts.velocities + 1j * starts.positions
    levitating = 1j * rotor.system.rest if len(rotor.system.rest) > 1 else 1j * rotor.system.rest[0]
    pushes = rotor.system.translation_velocity(np.concatenate([room[:kicks] - levitating, room[kicks:]]))

    assert np.abs(pushes).max() <= fastest * (1.0 + 1e-14)  # a few roundings of the products
    assert np.abs(pushes).max() > 0.95 * fastest
    # The rotor moves as a whole: its coordinates have no other velocities than those of this push.
    whole = np.multiply.outer(
        pushes, rotor.system.translated if len(rotor.system.rest) > 1 else rotor.system.translated[0]
    )
    assert np.abs(room[kicks:] - whole[kicks:]).max() <= 1e-14 * (1.0 + fastest)
    singles = disturbances(rotor, 400, 7, fastest)
    scale = np.abs(rotor.system.translated).max()
    assert [start.speed for start in singles] == pytest.approx(scale * np.abs(pushes), rel=1e-12)


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("kind", ["kick", "start"])
def test_velocities_are_uniform_over_the_area_of_a_disc(kind, seed):
    """Chi-square over 8 rings of equal area times 12 sectors, seen in the room; positions likewise."""
    rotor = jeffcott(PAPER)
    chosen = [start.state for start in disturbances(rotor, 20_000, seed, 0.6) if start.kind == kind]
    positions, velocities = (np.array([getattr(one, name) for one in chosen]) for name in ("position", "velocity"))
    discs = [velocities / 0.6] if kind == "kick" else [(velocities + 1j * positions) / 0.6, positions]
    for disc in discs:
        rings = (8 * np.abs(disc) ** 2).astype(int)
        sectors = (12 * (np.angle(disc) / (2.0 * np.pi) + 0.5)).astype(int) % 12
        seen = np.bincount(12 * rings + sectors, minlength=96)
        assert chisquare(seen).pvalue > 1e-3


def test_velocity_does_not_depend_on_the_place():
    """Someone in the room sees the same velocities near the wall as in the middle; in the turning frame they differ."""
    sample = [start.state for start in disturbances(jeffcott(PAPER), 20_000, 5, 0.6) if start.kind == "start"]
    positions, velocities = (np.array([getattr(one, name) for one in sample]) for name in ("position", "velocity"))
    along = (positions.conj() * (velocities + 1j * positions)).imag / np.abs(positions)
    outside = np.abs(positions) > np.sqrt(0.5)
    assert ks_2samp(along[outside], along[~outside]).pvalue > 1e-3
    turning = (positions.conj() * velocities).imag / np.abs(positions)
    assert ks_2samp(turning[outside], turning[~outside]).pvalue < 1e-30


@pytest.mark.jit_only
def test_ends_do_not_depend_on_the_direction_of_the_real_axis():
    """Machine and starts turned together end alike; so do samples of the machine turned alone, within their spread."""
    turned = jeffcott(PAPER.replace(phi=PAPER.phi + 2.0))
    chosen, turn = DisturbanceSet(2000, 3, 1.0), np.exp(2.0j)
    starts = chosen.starts(jeffcott(PAPER))
    ends = settle(jeffcott(PAPER), State(*starts[:2]))
    again = settle(turned, State(starts.positions * turn, starts.velocities * turn))
    alone = settle(turned, State(*DisturbanceSet(2000, 4, 1.0).starts(turned)[:2]))

    assert np.count_nonzero(again.outcomes != ends.outcomes) <= 2  # a start at a boundary may go either way
    counts = [[found.count(outcome) for outcome in np.unique(ends.outcomes)] for found in (ends, alone)]
    assert chi2_contingency(counts).pvalue > 1e-3


def test_known_motions_are_approached_from_both_sides():
    rotor = jeffcott(PAPER)
    sample = known_starts(rotor, find_orbits(rotor))
    kinds = [start.kind for start in sample]

    assert (kinds.count("orbit"), kinds.count("rub"), kinds.count("whirl")) == (8, 4, 2)
    assert not any(start.disturbance for start in sample)
    for first, second in zip(sample[0:12:2], sample[1:12:2], strict=True):
        assert first.state.position == second.state.position
        assert first.state.velocity != second.state.velocity


def test_whirl_starts_beyond_the_runaway_speed_and_at_rolling():
    rotor = jeffcott(PAPER)
    speeds = [-1.0 - start.state.velocity.imag for start in known_starts(rotor, ()) if start.kind == "whirl"]

    assert speeds == pytest.approx([1.001 * runaway_speed(rotor).certain, 400 / 7])
