"""Nodes of orbits: states, and under weight its direction."""

import numpy as np
import pytest
from linear_rotors import tilting
from machines import PAPER

from carom.models import Force, Rotor, jeffcott

ROTORS = {
    "planar": jeffcott(PAPER),
    "heavy": jeffcott(PAPER).under(Force(-1j, np.array([0.1 - 0.2j]))),
    "of two coordinates": tilting().model.under(Force(-1j, np.array([0.3, 0.1j]))),
    "pulled twice": Rotor(tilting().model, (Force(-1j, np.array([0.3, 0.1j])),)).under(
        Force(-1j, np.array([0.0, 0.2]))
    ),
}


@pytest.mark.parametrize("name", ROTORS)
def test_nodes_and_amplitudes_follow_from_each_other(name):
    system, random = ROTORS[name].system, np.random.default_rng(2)
    states = random.normal(size=(5, 2 * len(system.rest), 2)) @ [1.0, 1j]
    for time in (0.0, 2.3):
        amplitudes = system.amplitudes_of(states, time)
        nodes = system.nodes.of(amplitudes)
        assert nodes[:, : states.shape[1]] == pytest.approx(states, abs=1e-12)
        assert system.nodes.amplitudes(nodes) == pytest.approx(amplitudes, abs=1e-12)
        if system.forced is None:
            assert nodes.shape == states.shape
        else:
            assert nodes[:, -1] == pytest.approx(np.exp(-1j * time), abs=1e-12)
