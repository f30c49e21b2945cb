"""Studies of machines that weigh something."""

import math

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.closed_forms.sag import Levitation
from carom.studies.questions import about

pytestmark = pytest.mark.jit_only
HEAVY = "examples/dropped-rotor.toml"


@pytest.fixture(scope="module")
def found():
    return cm.study(cm.load(HEAVY), requirement=cm.parameters.Requirement.of(cm.load(HEAVY), kick="60 mm/s"))


def test_levitation_is_told_as_a_circle_about_the_sag(found):
    (held,) = found.equilibria
    assert isinstance(held, Levitation)
    case = cm.load(HEAVY)
    sag = case.machine.mass * case.gravity.acceleration / case.machine.stiffness
    assert float(held.sags[0]) * case.machine.clearance == pytest.approx(sag, rel=1e-12)
    text = about(found.facts, "Levitation")[0].text
    assert f"sags {1e6 * sag:.1f} µm from the bearing centre" in text
    assert found.levitates
    assert found.zone == case.zones.zone(held.reach)


def test_nothing_is_claimed_that_rests_on_the_symmetry_of_a_turn(found):
    assert found.rubs == ()
    words = " ".join(fact.text for fact in found.facts)
    assert "rotational symmetry" in words
    assert "No synchronous rub exists" not in words
    assert "Changes of speed, gravity" not in words
    assert found.bearing_demand is None
    with pytest.raises(InputError, match="of a rotor under gravity"):
        found.plot()


def test_what_it_survives_holds_for_fresh_kicks(found):
    """Of other directions and sizes up to the largest that came back, each followed by itself."""
    kick = found.survives.kick
    largest = kick.largest if kick.size is None else 0.999 * kick.size
    random = np.random.default_rng(11)
    for _ in range(30):
        size, angle = largest * math.sqrt(random.random()), random.uniform(0.0, 360.0)
        motion = cm.simulate(cm.load(HEAVY), cm.kick(size, f"{angle} deg"))
        assert motion.outcome.label == "levitated"


def test_a_harmless_kick_never_touches(found):
    contact_free = found.survives.kick.contact_free
    assert contact_free > 0.0
    for angle in range(0, 360, 15):
        motion = cm.simulate(cm.load(HEAVY), cm.kick(0.9999 * contact_free, f"{angle} deg"))
        assert not len(motion.contacts)
        assert not motion.lasting_contacts
