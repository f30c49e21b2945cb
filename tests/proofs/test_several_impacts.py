"""Periodic motions with several impacts a period, beside simulation and the kernels."""

import json
from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from flint import arb
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.orbits import Section, impact_map
from carom.proofs import check, hypotheses_of, prove
from carom.proofs.balls import at_precision
from carom.proofs.claims import Evidence, NotShownError
from carom.proofs.rotor import ProvenRotor
from carom.proofs.several_impacts import ShootingOrbit, equations_of, several_impact_claims
from carom.proofs.zeros import enclosed_zero, newton

NEAR_DOUBLING = PAPER.replace(gamma=0.0832)
"""Just below the period doubling of B1,d, which is supercritical."""


BORN = 3
"""Number of the stable orbit among those that the search finds there; two unstable ones have shorter periods."""


@pytest.fixture(scope="module")
def proof():
    return prove(NEAR_DOUBLING, impacts=2)


def test_orbit_born_at_the_period_doubling_is_proven(proof):
    for number in (1, 2, BORN):
        assert {proof[f"orbit {number} {kind}"].status for kind in ("exists", "admissible")} == {"proven"}
        assert proof[f"orbit {number} stable"].status == ("proven" if number == BORN else "refuted")
    assert proof["B1,d stable"].status == "refuted"
    assert any("search found" in words for words in proof.not_claimed)


def test_simulation_from_the_enclosure_repeats(proof):
    entry = {name: end.value for name, end in proof[f"orbit {BORN} exists"].enclosures.items()}
    rotor = jeffcott(NEAR_DOUBLING)
    angle = entry["angle 1"] + float(np.angle(rotor.equilibrium))
    state = Section(angle, entry["radial_speed 1"], entry["angular_speed 1"])
    for number in (2, 1):
        step = impact_map(rotor, state)
        assert step.duration == pytest.approx(entry[f"duration {3 - number}"], abs=1e-10)
        assert step.image.radial_speed == pytest.approx(entry[f"radial_speed {number}"], abs=1e-10)
        assert step.image.angular_speed == pytest.approx(entry[f"angular_speed {number}"], abs=1e-10)
        state = step.image
    log = cm.simulate(rotor, cm.State(state.state.position * 0.999, state.state.velocity), 8000.0).contacts
    assert min(abs(log.radial_speed[-1] - entry[f"radial_speed {k}"]) for k in (1, 2)) < 1e-6


def test_derivative_over_a_period_is_that_of_the_kernels(proof):
    with at_precision(128):
        numbers = ProvenRotor(hypotheses_of(NEAR_DOUBLING)).numbers
        equations = partial(equations_of, numbers)
        centre = [
            arb(Fraction(text).numerator) / Fraction(text).denominator
            for text in proof.evidence["orbits"][BORN - 1]["centre"]
        ]
        found, _ = enclosed_zero(equations, [x.mid() for x in centre])
        orbit = ShootingOrbit(numbers, (tuple(found[:4]), tuple(found[4:])))
        jacobian = orbit.jacobian()
        margins = orbit.margins()
    rotor = jeffcott(NEAR_DOUBLING)
    turned = float(np.angle(rotor.equilibrium))
    product = np.eye(3)
    for impact in orbit.impacts:
        angle, radial, angular, _ = (float(x) for x in impact)
        product = impact_map(rotor, Section(angle + turned, radial, angular)).jacobian @ product
    mine = np.array([[float(jacobian[i, j]) for j in range(3)] for i in range(3)])
    assert np.abs(mine - product).max() < 1e-7 * np.abs(product).max()
    assert float(margins["a multiplier is above 1"]) == pytest.approx(np.linalg.det(np.eye(3) - product), abs=1e-6)
    assert float(margins["a multiplier is below -1"]) == pytest.approx(np.linalg.det(np.eye(3) + product), abs=1e-6)


def test_certificate_is_verified_and_refused_when_changed(proof):
    document = json.loads(json.dumps(proof.document()))
    assert check(document).claims == proof.claims
    for change in (
        lambda d: d["evidence"]["orbits"][0]["centre"].__setitem__(1, "3/4"),
        lambda d: d["evidence"]["orbits"][0]["centre"].pop(),
        lambda d: d["evidence"]["orbits"].append(d["evidence"]["orbits"][0]),
        lambda d: d["options"].__setitem__("impacts", 1),
        lambda d: d["hypotheses"]["values"].__setitem__("gamma", "double 0.0833"),
    ):
        changed = json.loads(json.dumps(document))
        change(changed)
        with pytest.raises(InputError, match="is refused"):
            check(changed)


def test_orbit_of_one_impact_run_twice_is_not_told_as_one_of_two():
    orbit = cm.find_orbits(PAPER)["B1,d"]
    angle = orbit.angle - float(np.angle(orbit.rotor.equilibrium))
    guess = [angle, orbit.radial_speed, orbit.angular_speed, orbit.period] * 2
    with at_precision(128):
        numbers = ProvenRotor(hypotheses_of(PAPER)).numbers
        equations = partial(equations_of, numbers)
        found, _ = enclosed_zero(equations, newton(equations, guess))
        assert ShootingOrbit(numbers, (tuple(found[:4]), tuple(found[4:]))).repeats() is None


def test_orbit_of_one_impact_by_shooting_has_the_claims_of_the_closed_form():
    orbit, closed = cm.find_orbits(PAPER)["B1,d"], prove(PAPER)["B1,d solution"]
    angle = orbit.angle - float(np.angle(orbit.rotor.equilibrium))
    with at_precision(128):
        numbers = ProvenRotor(hypotheses_of(PAPER)).numbers
        equations = partial(equations_of, numbers)
        guess = newton(equations, [angle, orbit.radial_speed, orbit.angular_speed, orbit.period])
        found, _ = enclosed_zero(equations, guess)
        shot = ShootingOrbit(numbers, (tuple(found),))
        assert shot.stays_inside() is True
        assert min(float(margin) for margin in shot.margins().values()) > 0
        assert abs(found[3] - arb(closed.enclosures["period"].low)) < 1e-25
        assert abs(found[1] - arb(closed.enclosures["radial_speed"].low)) < 1e-25


def test_flight_through_the_wall_is_told():
    at = PAPER.replace(gamma=0.0636)
    orbit = cm.find_orbits(at)["B1,d"]
    assert not orbit.admissible
    angle = orbit.angle - float(np.angle(orbit.rotor.equilibrium))
    with at_precision(128):
        numbers = ProvenRotor(hypotheses_of(at)).numbers
        equations = partial(equations_of, numbers)
        guess = newton(equations, [angle, orbit.radial_speed, orbit.angular_speed, orbit.period])
        found, _ = enclosed_zero(equations, guess)
        assert ShootingOrbit(numbers, (tuple(found),)).stays_inside() is False


@pytest.mark.parametrize("first", [0, 4], ids=["the same", "from its other impact"])
def test_orbit_that_is_listed_twice_is_refused(proof, first):
    entry = proof.evidence["orbits"][0]
    again = {**entry, "centre": [*entry["centre"][first:], *entry["centre"][:first]]}
    evidence = Evidence({**proof.evidence, "orbits": [entry, again]})
    with at_precision(proof.bits), pytest.raises(NotShownError, match="lists an orbit twice"):
        several_impact_claims(ProvenRotor(proof.hypotheses), evidence, proof.options)
