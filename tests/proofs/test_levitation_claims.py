"""Any rotor: levitation, and kicks and steps of the unbalance that never touch, attacked by simulations and forgeries."""

import copy
import re

import numpy as np
import pytest
from machines import machine_file

import carom as cm
from carom.base.outcome import InputError
from carom.closed_forms import levitation
from carom.disturbances import kick
from carom.models import rotor_of
from carom.proofs import check, prove, prove_kicks
from carom.proofs.headlines import headline


@pytest.fixture(scope="module")
def case():
    return cm.load(machine_file("sagging"))


@pytest.mark.jit_only
def test_kicks_at_the_bound_never_touch_and_some_beyond_it_do(case):
    proof, rotor = prove(case), rotor_of(case)
    assert {claim.status for claim in proof} == {"proven"}
    bearing = proof["levitation clear"].enclosures["bearing_1"]
    assert float(bearing.low) <= levitation(rotor).reach * (1.0 + 1e-12) <= float(bearing.high) * (1.0 + 2e-12)
    speed, random = float(proof["kicks never touch"].enclosures["speed"].low), np.random.default_rng(5)

    def touches(share: float, angle: float, instant: float) -> bool:
        motion = cm.simulate(rotor, kick(share * speed, angle, instant), 200.0, max_events=3)
        return len(motion.contacts) > 0

    tried = random.uniform(0.0, 2.0 * np.pi, (12, 2)).tolist()
    assert not any(touches(1.0, *each) for each in tried)
    assert any(touches(1.6, *each) for each in tried)


def test_kicks_that_are_asked_for_and_a_certificate(case):
    proof = prove_kicks(case, "30 mm/s")
    assert proof["kicks asked never touch"].status == "proven"
    assert headline(proof).startswith("Theorem: No kick up to 30 mm/s, in any direction")
    below = proof["kicks never touch"].enclosures
    assert float(below["speed_si"].low) == pytest.approx(
        float(below["speed"].low) * rotor_of(case).scales.velocity, rel=1e-9
    )
    shown = float(re.search(r"No kick below (\S+) mm/s", headline(prove(case)))[1]) * 1e-3
    assert shown <= float(below["speed_si"].low) < 1.001 * shown
    assert prove_kicks(case, "100 mm/s")["kicks asked never touch"].status == "undecided"
    document = proof.document()
    assert check(document).claims == proof.claims
    forged = copy.deepcopy(document)
    forged["hypotheses"]["numbers"]["damping"]["doubles"] = (-0.1).hex() + " 0"
    with pytest.raises(InputError, match="is refused"):
        check(forged)
    forged = copy.deepcopy(document)
    (speed,) = [
        claim["enclosures"]
        for claim in forged["claims"]
        if claim["kind"] == "never touch" and claim["about"] == "kicks"
    ]
    speed["speed"] = [f"{1.01 * float(end)}" for end in speed["speed"]]
    with pytest.raises(InputError, match="is refused"):
        check(forged)


def test_levitation_that_grows_is_not_proven(case):
    grows = prove(rotor_of(case).replace(gamma=-0.01))
    assert grows["levitation stable"].status == "undecided"
    assert all(claim.about == "levitation" for claim in grows)


@pytest.mark.jit_only
def test_bias_currents_take_their_part_of_a_limit(tmp_path):
    """A vertical load of 1.96 A by a bias current, of 3 A: kicks up to the bound stay below the limit, in every direction."""
    path, text = tmp_path / "heavy.toml", machine_file("flywheel").read_text(encoding="utf-8")
    text = text.replace("700 g mm", "70 g mm") + '[gravity]\nacceleration = "9.81 m/s^2"\n'
    path.write_text(
        text.replace('"-1.348e7 N/m"', '"-1.348e7 N/m"\namplifier_bandwidth = "5 kHz"\ncurrent_limit = "3 A"'), "utf-8"
    )
    case = cm.load(path)
    speed = float(prove(case)["kicks never touch"].enclosures["speed"].low)

    def reaches(share: float, angle: float) -> bool:
        return bool(cm.simulate(rotor_of(case), kick(share * speed, angle, 0.0), 30.0).segment_limits.max() > 1)

    angles = np.linspace(-np.pi, np.pi, 12, endpoint=False).tolist()
    assert not any(reaches(1.0, angle) for angle in angles)
    assert any(reaches(2.0, angle) for angle in angles)
