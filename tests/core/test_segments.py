"""Segment maps: their derivatives against differences, and their ends against the simulation."""

from __future__ import annotations

import numpy as np
import pytest

from carom.core.margins import local_motion
from carom.core.segments import carry_through_chatter
from carom.models import Rotor, jeffcott
from carom.motions import State, simulate
from carom.orbits.recognising import segments_of
from carom.orbits.shooting import Start, links_of, pack, unpack
from carom.orbits.word import Kind, Segment, Word
from carom.outcome import Phase
from tests.compilation import COMPILED, sized
from tests.linear_rotors import bending, tilting
from tests.machines import PAPER

FLIGHTS = [Kind.IMPACT_FORWARD, Kind.IMPACT_BACKWARD, Kind.IMPACT_STOPPED]
CONTACTS = [Kind.SLIDE_FORWARD, Kind.SLIDE_BACKWARD, Kind.ROLL]


def rotor_of(modes: int, planes: int, seed: int) -> Rotor:
    if modes == 2:
        return jeffcott(PAPER.replace(gamma=0.1 + 0.02 * seed, radius_ratio=1.5))
    return {4: tilting, 8: bending}[modes](planes=planes).model


def differences(rotor: Rotor, word: Word, start: Start, step: float = 1e-6) -> np.ndarray:
    unknowns = pack(start)
    columns = []
    for change in step * np.eye(len(unknowns)):
        ends = [links_of(rotor, word, unpack(unknowns + sign * change, len(word))).residual for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    return np.array(columns).T


def arbitrary(rotor: Rotor, word: Word, rng: np.random.Generator) -> Start:
    """Nodes with their planes on the wall, as fast as an impact, and durations about one."""
    arrays = rotor.system.arrays
    nodes = rng.normal(size=(len(word), arrays.rows.shape[1], 2)) @ [1.0, 1j]
    for node, plane in zip(nodes, word.planes, strict=True):
        y = node @ arrays.rows[plane] + arrays.offsets[plane]
        node += arrays.rows[plane].conj() / arrays.weights[plane] * (y / abs(y) - y)
    return Start(rotor.system.states_of(nodes), rng.uniform(0.3, 1.2, len(word)))


@pytest.mark.parametrize(("modes", "planes"), [(2, 1), (4, 2), (8, 2)])
def test_derivatives_of_flights_agree_with_differences(modes, planes):
    if modes > 2 and not COMPILED:
        pytest.skip("one number of modes goes through every line")
    rng = np.random.default_rng(modes)
    for seed in range(sized(4, 1)):
        rotor = rotor_of(modes, planes, seed)
        word = Word(tuple(Segment(kind, int(rng.integers(planes))) for kind in FLIGHTS))
        start = arbitrary(rotor, word, rng)
        links = links_of(rotor, word, start)
        # Central differences with a step of 1e-6 leave 1e-9 of derivatives and third derivatives of about 100.
        assert np.abs(differences(rotor, word, start) - links.jacobian).max() < 2e-7


@pytest.mark.jit_only
@pytest.mark.parametrize(("modes", "planes"), [(2, 1), (4, 2)])
def test_derivatives_of_lasting_contact_agree_with_differences(modes, planes):
    rng = np.random.default_rng(modes + 1)
    for seed in range(sized(3, 1)):
        rotor = rotor_of(modes, planes, seed)
        for words in (CONTACTS, [Kind.ROLL, Kind.SLIDE_BACKWARD], [Kind.ROLL, Kind.SLIDE_FORWARD]):
            word = Word.of(*words, plane=planes - 1)
            start = arbitrary(rotor, word, rng)
            links = links_of(rotor, word, start)
            scale = max(1.0, np.abs(links.jacobian).max())
            assert np.abs(differences(rotor, word, start) - links.jacobian).max() < 1e-7 * scale


def test_sliding_stays_on_the_wall_and_keeps_its_law():
    rotor = rotor_of(4, 2, 1) if COMPILED else rotor_of(2, 1, 1)
    word = Word.of(*CONTACTS, plane=1 if COMPILED else 0)
    start = arbitrary(rotor, word, np.random.default_rng(3))
    start = start if COMPILED else start._replace(durations=0.1 * start.durations)
    arrivals = rotor.system.amplitudes_of(links_of(rotor, word, start).arrivals)
    excess, radial, slip, *_ = local_motion(rotor.system.arrays, word.planes, arrivals).T
    assert np.abs(excess).max() < 1e-12 * (1.0 + np.abs(arrivals).max())
    assert np.abs(radial).max() < 1e-11 * (1.0 + np.abs(arrivals).max())
    assert abs(slip[2]) < 1e-11  # it rolls


@pytest.mark.jit_only
def test_a_motion_with_chatter_sliding_and_lift_off_is_made_of_its_segments():
    """Each segment, followed from its node for its duration, ends at the next node of the simulation."""
    rotor = jeffcott(PAPER.replace(gamma=0.03, omega=0.76, rho=0.3, mu=0.3, d=0.3))
    for angle in np.linspace(0.0, 6.0, sized(8, 2)):
        motion = simulate(rotor, State(0.3 * np.exp(1j * angle), 0.9j), 30.0)
        phases = motion.segment_phases[:, 0]
        landings = np.flatnonzero((phases[:-1] == Phase.FLIGHT) & (phases[1:] != Phase.FLIGHT))
        if not len(landings) or landings[0] == 0:
            continue
        lifts = np.flatnonzero((phases[:-1] != Phase.FLIGHT) & (phases[1:] == Phase.FLIGHT))
        later = lifts[lifts > landings[0]]
        if not len(later) or len(later) < 2:
            continue
        word, start = segments_of(motion, int(later[0]), int(later[1]))
        links = links_of(rotor, word, start)
        inner = np.abs(links.arrivals[:-1] - start.nodes[1:])
        assert inner.max() < 1e-10
        assert np.abs(links.values).max() < 1e-9


@pytest.mark.parametrize("slip", [1, -1, 0])
def test_after_a_chatter_no_change_leaves_the_wall(slip):
    rotor, rng = rotor_of(2, 1, 1), np.random.default_rng(7)
    arrays = rotor.system.arrays
    start = arbitrary(rotor, Word.of(*[Kind.IMPACT_FORWARD] * 3), rng)
    states = rotor.system.amplitudes_of(start.nodes)
    directions = rng.normal(size=(4, 2, 2)) @ [1.0, 1j]
    delays = np.empty(4)
    landing = states[2].copy()
    carry_through_chatter(arrays, 0, states[:2], np.array([0.3]), landing, slip, directions, delays)
    excess, radial, drift, *_ = local_motion(arrays, np.zeros(1, np.int64), landing[None])[0]
    assert abs(excess) < 1e-13
    assert abs(radial) < 1e-13
    position, velocity = rotor.system.at_plane(landing, 0)
    moved = directions @ arrays.rows[0]
    rate = directions @ arrays.rate_rows[0]
    size = 1e-12 * (1.0 + np.abs(directions).max())
    assert np.abs((np.conj(position) * moved).real).max() < size
    assert np.abs((np.conj(position) * rate + np.conj(moved) * velocity).real).max() < size
    assert np.isfinite(delays).all()
    if slip == 0:
        assert abs(drift) < 1e-12
        assert np.abs((np.conj(position) * rate + np.conj(moved) * velocity).imag).max() < size
