"""Segment maps: their derivatives against differences."""

import numpy as np
import pytest

from carom.models import Rotor, jeffcott
from carom.orbits.shooting import ShootingStart, links_of, pack, unpack
from carom.orbits.word import Kind, Word
from tests.compilation import COMPILED, sized
from tests.linear_rotors import bending, tilting
from tests.machines import PAPER

FLIGHTS = [Kind.IMPACT_FORWARD, Kind.IMPACT_BACKWARD, Kind.IMPACT_STOPPED]


def rotor_of(modes: int, planes: int, seed: int) -> Rotor:
    if modes == 2:
        return jeffcott(PAPER.replace(gamma=0.1 + 0.02 * seed, radius_ratio=1.5))
    return {4: tilting, 8: bending}[modes](planes=planes).model


def differences(rotor: Rotor, word: Word, start: ShootingStart, step: float = 1e-6) -> np.ndarray:
    unknowns = pack(start)
    columns = []
    for change in step * np.eye(len(unknowns)):
        ends = [links_of(rotor, word, unpack(unknowns + sign * change, len(word))).residual for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    return np.array(columns).T


def arbitrary(rotor: Rotor, word: Word, rng: np.random.Generator) -> ShootingStart:
    """Nodes with their planes on the wall, as fast as an impact, and durations about one."""
    arrays = rotor.system.arrays
    nodes = rng.normal(size=(len(word), arrays.rows.shape[1], 2)) @ [1.0, 1j]
    for node, plane in zip(nodes, word.planes, strict=True):
        y = node @ arrays.rows[plane] + arrays.offsets[plane]
        node += arrays.rows[plane].conj() / arrays.weights[plane] * (y / abs(y) - y)
    return ShootingStart(rotor.system.states_of(nodes), rng.uniform(0.3, 1.2, len(word)))


@pytest.mark.parametrize(("modes", "planes"), [(2, 1), (4, 2), (8, 2)])
def test_derivatives_of_flights_agree_with_differences(modes, planes):
    if modes > 2 and not COMPILED:
        pytest.skip("one number of modes goes through every line")
    rng = np.random.default_rng(modes)
    for seed in range(sized(4, 1)):
        rotor = rotor_of(modes, planes, seed)
        word = Word.of(*FLIGHTS)
        start = arbitrary(rotor, word, rng)
        links = links_of(rotor, word, start)
        # Central differences with a step of 1e-6 leave 1e-9 of derivatives and third derivatives of about 100.
        assert np.abs(differences(rotor, word, start) - links.jacobian).max() < 2e-7
