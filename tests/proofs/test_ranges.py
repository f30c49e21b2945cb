"""Orbits on intervals of a parameter: beside the usual search at fresh values, and where nothing can be shown."""

from fractions import Fraction

import numpy as np
import pytest
from compilation import sized
from machines import DECIMAL, PAPER
from refusals import assert_refused

from carom.base.outcome import InputError
from carom.orbits import find_orbits
from carom.proofs import Claim, Proof, check, hypotheses_of, prove
from carom.proofs.claims import Evidence
from carom.proofs.proving import proof_of
from carom.proofs.ranges import range_claims
from carom.proofs.rotor import ProvenRotor

LIMITS = {"blocks": 60, "narrowest": "1/200"}


def proven_along(machine, along, low, high, **limits) -> Proof:
    options = {"along": along, "from": low, "to": high, **LIMITS, **limits}
    return proof_of("along a parameter", hypotheses_of(machine), options)


def ranges(machine, along, low, high, **limits) -> list[Claim]:
    """Claims of ranges alone: the search for points takes longer."""
    options = {"along": along, "from": low, "to": high, **LIMITS, **limits}
    return range_claims(ProvenRotor(hypotheses_of(machine)), Evidence(), options)


def named(claims, name) -> Claim:
    return next(claim for claim in claims if claim.name == name)


def assert_holds_at(proof, parameters, along, value) -> int:
    """Compare the claim about the stretch with this value with all orbits there."""
    for claim in proof:
        if claim.kind != "orbits" or claim.status != "proven" or " in [" not in claim.about:
            continue
        low, high = (float(end) for end in claim.about.partition("[")[2][:-1].split(", "))
        if not low <= value <= high:
            continue
        orbits = find_orbits(parameters.replace(**{along: value}))
        stated = claim.statement.partition(": ")[2]
        parts = dict(part.split(": ", 1) for part in stated.split("; ")) if stated != "none" else {}
        assert set(parts) == {orbit.name for orbit in orbits}
        for orbit in orbits:
            words = parts[orbit.name]
            assert words.startswith("motion of") == orbit.admissible, (parameters, along, value, orbit.name)
            assert ("unstable" not in words) == orbit.stable, (parameters, along, value, orbit.name)
            period, speed = (claim.enclosures[f"{orbit.name} {name}"] for name in ("period", "radial_speed"))
            assert float(period.low) - 1e-7 < orbit.period < float(period.high) + 1e-7
            assert float(speed.low) - 1e-7 < orbit.radial_speed < float(speed.high) + 1e-7
        return 1
    return 0


def test_orbits_of_the_paper_on_an_interval():
    proof = proven_along(DECIMAL, "gamma", "0.1", "0.1002")

    assert proof["machine all-single-impact-orbits"].status == "proven"
    assert {name: proof[f"{name} stable"].status for name in ("B1,a", "B1,b", "B1,c", "B1,d")} == {
        "B1,a": "refuted",
        "B1,b": "refuted",
        "B1,c": "refuted",
        "B1,d": "proven",
    }
    assert proof["B1,d admissible"].enclosures["from"].low == "0.1"
    assert proof["B1,d admissible"].enclosures["to"].high == "0.1002"
    (whole,) = (claim for claim in proof if claim.kind == "orbits")
    assert (whole.interval, whole.motions) == (("0.1", "0.1002"), ("B1,a", "B1,c", "B1,b", "B1,d"))
    assert check(proof.document()).claims == proof.claims
    for key, other in (("interval", ["0.1", "0.2"]), ("motions", ["B1,a", "B1,c", "B1,b"])):
        document = proof.document()
        (stated,) = (claim for claim in document["claims"] if claim["kind"] == "orbits")
        stated[key] = other
        with pytest.raises(InputError, match="does not show what it claims"):
            check(document)


def test_points_leave_gaps_and_the_largest_interval_is_told():
    proof = proven_along(DECIMAL, "gamma", "0.083", "0.0838", narrowest="1/8")
    claim = proof["B1,d stable"]

    assert claim.status == "refuted"
    assert Fraction("0.08338141751248") < Fraction(claim.enclosures["from"].low) < Fraction("0.0836")
    assert claim.enclosures["to"].high == "0.0838"
    assert "the contrary on [0.083, " in claim.reason
    assert "open on " in claim.reason
    assert proof["period-doubling of B1,d"].status == "proven"


def test_fresh_values_in_ranges_of_random_machines():
    random, compared = np.random.default_rng(5), 0
    for along in ("rho", "omega", "mu", "gamma", "d", "radius_ratio")[: sized(3, 1, 6)] * sized(1, 1, 40):
        names, low, high = (
            ("gamma", "omega", "rho", "mu", "d"),
            (0.05, 0.65, 0.3, 0.02, 0.8),
            (0.25, 0.9, 0.6, 0.3, 0.99),
        )
        at = PAPER.replace(**dict(zip(names, random.uniform(low, high).tolist(), strict=True)))
        value = getattr(at, along)
        end = value + 1e-4
        proof = ranges(at, along, f"double {value!r}", f"double {end!r}", blocks=12)
        for place in random.uniform(value, end, 5).tolist():
            compared += assert_holds_at(proof, at, along, place)
    assert compared > 0


@pytest.mark.parametrize(
    ("change", "along", "interval", "words"),
    [
        ({}, "gamma", ("0", "0.001"), "without damping"),
        ({}, "gamma", ("-0.01", "0.01"), "without damping"),
        ({"mu": "0.05", "d": "1"}, "gamma", ("0.09999999", "0.1000001"), "next to T = 0"),
        ({"gamma": "0.17802772567072037949628176478"}, "omega", ("0.76", "0.7600001"), "period"),
        ({"gamma": "1.52"}, "omega", ("0.7599999999", "0.7600000001"), ""),
        ({"mu": "0"}, "gamma", ("0.1", "0.1001"), ""),
        ({"d": "0"}, "gamma", ("0.1", "0.1001"), ""),
        ({"d": "1", "mu": "0.1"}, "gamma", ("0.1", "0.1001"), ""),
        ({"rho": "0"}, "gamma", ("0.1", "0.1001"), ""),
        ({"omega": "1"}, "gamma", ("0.1", "0.1001"), ""),
    ],
)
def test_degenerate_machines_end_in_bounded_work_and_never_in_a_wrong_theorem(change, along, interval, words):
    machine = {**DECIMAL, **change}
    proof = ranges(machine, along, *interval, blocks=2, narrowest="1/2")

    claim = named(proof, "machine all-single-impact-orbits")
    assert claim.status in ("proven", "undecided")
    assert claim.status == "proven" or claim.reason
    if words:
        assert claim.status == "undecided" or words == "open"
    parameters = hypotheses_of(machine)
    numbers = {name: float(Fraction(text)) for name, text in parameters.values.items()}
    at = PAPER.replace(**{**numbers, "gamma": max(numbers["gamma"], 0.01)})
    value = 0.5 * (float(interval[0]) + float(interval[1]))
    if claim.status == "proven" and value > 0:
        assert assert_holds_at(proof, at, along, value)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"along": "phi", "interval": ("0", "1")}, "only turns motions"),
        ({"along": "gama", "interval": ("0", "1")}, "gamma"),
        ({"along": "gamma", "interval": ("0.2", "0.1")}, "must begin below its end"),
        ({"along": "damping", "interval": ("100", "200")}, "damping"),
        ({"along": "gamma"}, "needs an interval"),
        ({"interval": ("0.1", "0.2")}, "needs an interval"),
        ({"along": "gamma", "interval": ("0.1", "0.2"), "impacts": 2}, "cannot be combined"),
        ({"impacts": 0}, "1 to 24"),
        ({"impacts": 25}, "1 to 24"),
    ],
)
def test_what_cannot_be_asked_is_told_in_one_line(arguments, words):
    assert_refused(lambda: prove(DECIMAL, **arguments), words)


def test_why_a_block_is_open_is_found_again_by_the_check():
    """Nothing of the text that is printed comes from the certificate."""
    options = {"along": "gamma", "from": "0.08338", "to": "0.08339", "blocks": 6, "narrowest": "1/4"}
    rotor, searched = ProvenRotor(hypotheses_of(DECIMAL)), Evidence()
    found = range_claims(rotor, searched, options)
    document = searched.document()
    assert "open" in {known for _, known in document["blocks"]} <= {"", "open", "ended"}
    again = range_claims(rotor, Evidence(document), options)
    assert [claim.reason for claim in again] == [claim.reason for claim in found]
    assert any(claim.reason for claim in found)


def test_an_open_interval_around_a_bifurcation_of_one_orbit_leaves_the_others_decided():
    """Where B1,d doubles its period only its stability is open: all else is proven for all values."""
    claims = ranges(DECIMAL, "gamma", "0.0833", "0.0834", narrowest="1/10000")
    for name in "abcd":
        assert named(claims, f"B1,{name} exists").status == "proven"
        assert named(claims, f"B1,{name} admissible").status == "proven"
    assert named(claims, "machine all-single-impact-orbits").status == "proven"
    assert "open on" in named(claims, "B1,d stable").reason
    assert not any("open on" in named(claims, f"B1,{name} stable").reason for name in "abc")
    for value in np.random.default_rng(5).uniform(0.0833, 0.0834, 5):
        orbits = {orbit.name: orbit for orbit in find_orbits(PAPER.replace(gamma=float(value)))}
        assert all(orbits[f"B1,{name}"].admissible for name in "abcd")
