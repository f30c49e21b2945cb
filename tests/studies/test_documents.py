"""Results as JSON documents."""

import json

import numpy as np
import pytest
from linear_rotors import tilting
from machines import PAPER
from yielding_walls import with_walls

from carom.base.files import as_json
from carom.models import KelvinVoigt, jeffcott, rotor_from
from carom.motions import State, simulate
from carom.parameters import Scales
from carom.studies import trajectory_document

pytestmark = pytest.mark.jit_only


def test_motion_of_any_rotor():
    rotor = tilting().model
    motion = simulate(rotor, State(np.zeros(2), np.array([0.5, 0.1j])), 60.0)
    document = json.loads(as_json(trajectory_document(motion)))

    assert "parameters" not in document
    assert rotor_from(document["rotor"]).attributes() == rotor.attributes()
    assert document["start"]["V"] == [[0.5, 0.0], [0.0, 0.1]]
    assert np.shape(document["final"]["U"]) == (2, 2)
    logs = [motion.seen_at(plane).contacts for plane in (0, 1)]
    assert [entry["time"] for entry in document["impacts"]] == sorted(np.concatenate([log.time for log in logs]))
    here = [[entry for entry in document["impacts"] if entry["touchdown_bearing"] == number] for number in (1, 2)]
    assert list(map(len, here)) == list(map(len, logs))
    assert all(here)


def test_motion_of_the_planar_rotor_has_its_parameters():
    motion = simulate(jeffcott(PAPER), State(0.3, 0.9), 30.0)
    document = json.loads(as_json(trajectory_document(motion)))

    assert document["parameters"] == PAPER.as_dict()
    assert document["start"] == {"U": 0.3, "V": 0.9}


def test_contacts_with_walls_that_give_way():
    """One entry for each contact at any plane, by the kind that takes most of it; in SI too."""
    scales = Scales(mass=50.0, clearance=0.7e-3, speed=184.2)
    rotor = with_walls(tilting(friction=0.6, radius_ratio=2.0), KelvinVoigt(1e4, 3.0), scales)
    motion = simulate(rotor, State(np.array([0.1, 0.02j]), np.array([0.9 + 0.2j, 0.1])), 10.0)
    contacts = json.loads(as_json(trajectory_document(motion)))["contacts"]

    logs = [motion.seen_at(plane).contacts for plane in (0, 1)]
    assert len(contacts) == sum(map(len, logs))
    assert {entry["touchdown_bearing"] for entry in contacts} == {1, 2}
    assert [entry["start"] for entry in contacts] == sorted(np.concatenate([log.time for log in logs]).tolist())
    assert {entry["kind"] for entry in contacts} == {"slide", "roll"}
    here = [entry for entry in contacts if entry["touchdown_bearing"] == 2]
    assert [entry["end"] for entry in here] == logs[1].end.tolist()
    assert [entry["impulse_si"] for entry in here] == (logs[1].normal_impulse * scales.impulse).tolist()
    assert [entry["peak_force_si"] for entry in here] == (logs[1].peak_force * scales.force).tolist()
    assert [entry["deepest_si"] for entry in here] == (logs[1].deepest * scales.length).tolist()
