"""Bifurcation points beside fifty digits, and what is claimed of them beside differences and simulation."""

import json
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import DECIMAL, PAPER, exact_return

import carom as cm
from carom.base.outcome import InputError
from carom.bifurcations.conditions import jacobian_at, profile_at
from carom.orbits import find_orbits
from carom.parameters import Numbers as Doubles
from carom.proofs import check, hypotheses_of, prove
from carom.proofs.balls import at_precision, exact_ends
from carom.proofs.claims import Evidence, NotShownError
from carom.proofs.lines import line_of
from carom.proofs.points import _searched, _system, point_claims
from carom.proofs.proving import proof_of
from carom.proofs.rotor import ProvenRotor
from carom.proofs.zeros import enclosed_zero, newton

KNOWN = {
    "boundary-equilibrium of contact-free": "0.07246867866709798125333961",
    "fold of B1,d": "0.1780277256707203794962817",
    "grazing of B1,d": "0.06361056090439136535321339",
    "period-doubling of B1,d": "0.08338141751248091027538083",
}
"""Values of γ of the machine with ρ = 3/7, found with mpmath."""


def points(machine, along, low, high):
    hypotheses = hypotheses_of(machine)
    with at_precision(128):
        claims = point_claims(ProvenRotor(hypotheses), Evidence(), {"along": along, "from": low, "to": high})
    return {claim.name: claim for claim in claims}


@pytest.fixture(scope="module")
def paper():
    return points(DECIMAL, "gamma", "0.05", "0.2")


@pytest.mark.parametrize("name", KNOWN)
def test_points_of_the_paper_have_twenty_digits(paper, name):
    value = paper[name].enclosures["value"]

    assert paper[name].status == "proven"
    assert value.width < Fraction(1, 10**21)
    assert Fraction(value.low) <= Fraction(KNOWN[name]) + Fraction(1, 10**25)
    assert Fraction(value.high) >= Fraction(KNOWN[name]) - Fraction(1, 10**25)


def test_natures_of_the_paper_are_proven(paper):
    assert {name for name, claim in paper.items() if claim.status != "proven"} == set()
    assert {
        "period-doubling of B1,d transversal",
        "non-smooth-hopf of B1,a subcritical",
        "non-smooth-hopf of B1,b motion",
        "boundary-equilibrium of contact-free non-smooth fold",
        "grazing of B1,d motion",
        "fold of B1,d transversal",
    } <= set(paper)


def test_fold_and_period_doubling_in_fifty_digits(paper):
    with mpmath.workdps(50):
        q = (1 + mpmath.mpf("0.95")) * mpmath.mpc(1, mpmath.mpf("0.15"))

        def closing(period, gamma):
            at = PAPER.replace(gamma=0.1)
            object.__setattr__(at, "gamma", gamma)
            object.__setattr__(at, "omega", mpmath.mpf("0.76"))
            return 1 + (q * exact_return(at, period)[0][1, 1]).real

        entry = paper["fold of B1,d"].enclosures
        gamma = mpmath.mpf(entry["value"].low)
        period = mpmath.mpf(entry["period"].low)
        assert abs(closing(period, gamma)) < mpmath.mpf("1e-24")
        assert abs(mpmath.diff(lambda time: closing(time, gamma), period)) < mpmath.mpf("1e-20")


@pytest.mark.parametrize(
    ("name", "kind", "low", "high"),
    [
        ("period-doubling of B1,d", "stable", "refuted", "proven"),
        ("grazing of B1,d", "admissible", "refuted", "proven"),
    ],
)
def test_claims_flip_within_1e_12_of_the_point(paper, name, kind, low, high):
    value = Fraction(paper[name].enclosures["value"].low)
    for side, status in ((-1, low), (1, high)):
        proof = prove({**DECIMAL, "gamma": value + side * Fraction(1, 10**12)})
        assert proof[f"B1,d {kind}"].status == status


def test_fold_flips_within_1e_12(paper):
    value = Fraction(paper["fold of B1,d"].enclosures["value"].low)
    counts = [prove({**DECIMAL, "gamma": value + side * Fraction(1, 10**12)})["machine periods"] for side in (-1, 1)]

    assert [claim.status for claim in counts] == ["proven", "proven"]
    assert [claim.statement.split()[3] for claim in counts] == ["2", "0"]


def test_points_of_random_machines_agree_with_double_precision():
    random, agreed = np.random.default_rng(8), 0
    for along in ("mu", "omega", "gamma", "rho", "d")[: sized(2, 1, 5)] * sized(1, 1, 30):
        near = {name: getattr(PAPER, name) * random.uniform(0.998, 1.002) for name in ("omega", "rho", "mu", "d")}
        at = PAPER.replace(**near, gamma=0.0834)
        value = getattr(at, along)
        for claim in points(at, along, f"double {value * 0.97!r}", f"double {value * 1.03!r}").values():
            if claim.status != "proven" or "radial_speed" not in claim.enclosures or "touch" in claim.enclosures:
                continue
            entry = {name: end.value for name, end in claim.enclosures.items()}
            numbers = Doubles.of(at.replace(**{along: entry["value"]}))
            matrix = jacobian_at(numbers, entry["period"], entry["radial_speed"])
            if claim.about == "period-doubling":
                assert abs(np.linalg.det(matrix + np.eye(3))) < 1e-6 * (1 + np.abs(matrix).max() ** 3)
                agreed += 1
            elif claim.about == "neimark-sacker":
                values = np.linalg.eigvals(matrix)
                assert min(abs(values[j] * values[k] - 1) for j, k in ((0, 1), (0, 2), (1, 2))) < 1e-5
                agreed += 1
    assert agreed > 0


def test_motion_at_a_grazing_touches_and_stays_below_elsewhere(paper):
    entry = {name: end.value for name, end in paper["grazing of B1,d"].enclosures.items()}
    profile = profile_at(Doubles.of(PAPER.replace(gamma=entry["value"])), entry["period"], entry["radial_speed"])
    assert profile.top == pytest.approx(entry["touch"], abs=1e-6)
    assert profile.height == pytest.approx(0.0, abs=1e-12)


def test_speed_grows_from_the_non_smooth_hopf_point_with_the_slope_that_is_told(paper):
    for name in ("B1,a", "B1,b"):
        point = paper[f"non-smooth-hopf of {name}"].enclosures["value"].value
        slope = paper[f"non-smooth-hopf of {name} transversal"].enclosures["speed_slope"].value
        speeds = [find_orbits(PAPER.replace(gamma=point + step))[name].radial_speed for step in (-1e-6, 1e-6)]
        assert (speeds[1] - speeds[0]) / 2e-6 == pytest.approx(slope, rel=1e-4)


def test_certificate_of_points_is_verified_and_refused_when_changed():
    options = {"along": "gamma", "from": "0.08338", "to": "0.08339", "blocks": 6, "narrowest": "1/4"}
    proof = proof_of("along a parameter", hypotheses_of(DECIMAL), options)
    document = json.loads(json.dumps(proof.document()))
    assert check(document).claims == proof.claims

    for change in (
        lambda d: d["evidence"]["points"][0]["centre"].__setitem__(2, "1/12"),
        lambda d: d["evidence"]["points"][0].__setitem__("kind", "fold"),
        lambda d: d["evidence"]["points"][0].__setitem__("width", 2),
        lambda d: d["evidence"]["points"].clear(),
        lambda d: d["evidence"]["blocks"][1].__setitem__(0, "1/11"),
        lambda d: [entry.__setitem__(1, "") for entry in d["evidence"]["blocks"]],
        lambda d: d["evidence"]["blocks"].pop(),
        lambda d: d["options"].__setitem__("to", "0.084"),
        lambda d: d["hypotheses"]["values"].__setitem__("mu", "0.1500000001"),
        lambda d: d["claims"].pop(),
        lambda d: d["claims"][0].__setitem__("status", "refuted"),
        lambda d: d["claims"][0]["enclosures"]["value"].__setitem__(0, "0.08338141751248092"),
    ):
        changed = json.loads(json.dumps(document))
        change(changed)
        with pytest.raises(InputError, match="is refused"):
            check(changed)


def test_simulated_motion_stays_on_the_orbit_at_the_grazing_side(paper):
    value = paper["grazing of B1,d"].enclosures["value"].value
    orbit = find_orbits(PAPER.replace(gamma=value + 1e-6))["B1,d"]
    assert orbit.admissible
    log = cm.simulate(orbit.rotor, orbit.departure, 1.5 * orbit.period).contacts
    assert log.time[0] == pytest.approx(orbit.period, abs=1e-9)


@pytest.mark.parametrize(
    ("kind", "guess", "low", "high"),
    [
        ("fold", [-11.5215292, -0.024264], "-0.1", "0.2"),
        ("period-doubling", [2.9951852, 0.6931453, 0.0833814], "0.1", "0.2"),
        ("grazing", [-7.906810, -1.343989, -0.133367, 0.352405], "0.1", "0.4"),
    ],
    ids=["negative period", "value outside of the interval", "touch before the impact"],
)
def test_zero_that_is_no_point_of_the_interval_is_refused(kind, guess, low, high):
    hypotheses = hypotheses_of(DECIMAL)
    line = line_of(hypotheses, "gamma", low, high)
    with at_precision(128):
        system = _system(line, kind)
        centre = newton(system, guess)
        found = enclosed_zero(system, centre)
        assert found is not None
        entry = {"kind": kind, "label": "B1,d", "width": found[1]}
        entry["centre"] = [str(exact_ends(x)[0]) for x in centre]
        assert "centre" not in _searched(line, kind, "B1,d", guess)
        with pytest.raises(NotShownError, match="not at a value and at times"):
            point_claims(
                ProvenRotor(hypotheses), Evidence({"points": [entry]}), {"along": "gamma", "from": low, "to": high}
            )


def test_a_pair_of_multipliers_leaves_the_unit_circle_where_continuation_says():
    """The rotor on a softer bearing and better balanced: B1,d loses its stability to a torus."""
    found = points({**DECIMAL, "omega": "0.35", "rho": "0.2"}, "gamma", "0.0772", "0.0773")
    claims = [found[f"neimark-sacker of B1,d{part}"] for part in ("", " transversal", " complex", " motion")]
    assert [claim.status for claim in claims] == ["proven"] * 4

    branch = cm.continue_orbit(find_orbits(PAPER.replace(omega=0.35, rho=0.2))["B1,d"], "gamma", (0.07, 0.11))
    (torus,) = [point for point in branch.special if point.kind == "neimark-sacker"]
    assert claims[0].enclosures["value"].value == pytest.approx(torus.value, rel=1e-9)
    pair = 2.0 * torus.orbit.multipliers.values[0].real
    assert claims[2].enclosures["pair_sum"].value == pytest.approx(pair, abs=1e-7)
    low, high = claims[0].enclosures["value"].low, claims[0].enclosures["value"].high
    assert Fraction(high) - Fraction(low) < Fraction(1, 10**20)
