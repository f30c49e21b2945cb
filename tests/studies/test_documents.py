"""Results as JSON documents."""

import json

import numpy as np
import pytest
from linear_rotors import tilting
from machines import PAPER

from carom.files import as_json
from carom.models import Jeffcott
from carom.motions import State, simulate
from carom.studies import trajectory_document

pytestmark = pytest.mark.jit_only


def test_motion_of_any_rotor():
    rotor = tilting().model
    motion = simulate(rotor, State(np.zeros(2), np.array([0.5, 0.1j])), 60.0)
    document = json.loads(as_json(trajectory_document(motion)))

    assert "parameters" not in document
    assert type(rotor).from_attributes(document["rotor"]).attributes() == rotor.attributes()
    assert document["start"]["V"] == [[0.5, 0.0], [0.0, 0.1]]
    assert np.shape(document["final"]["U"]) == (2, 2)
    assert [entry["time"] for entry in document["impacts"]] == motion.contacts.time.tolist() != []


def test_motion_of_the_planar_rotor_has_its_parameters():
    motion = simulate(Jeffcott(PAPER), State(0.3, 0.9), 30.0)
    document = json.loads(as_json(trajectory_document(motion)))

    assert document["parameters"] == PAPER.as_dict()
    assert document["start"] == {"U": 0.3, "V": 0.9}
