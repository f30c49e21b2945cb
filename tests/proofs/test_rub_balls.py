"""Balls around rubs beside arithmetic of many digits, and beside bounces that a general integrator follows."""

from __future__ import annotations

import copy
import json
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from compilation import sized
from rub_bounces import Bouncing

from carom.outcome import InputError
from carom.proofs import check, prove
from carom.proofs.balls import at_precision, rational
from carom.proofs.evidence import Evidence, NotShownError
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.rotor import Rotor
from carom.proofs.rub_balls import Rub, bounce_spread, rub_ball_claims, trap_of
from carom.proofs.steady import steady_claims

DECIMAL = {"gamma": "0.2", "omega": "0.76", "rho": "3/7", "phi": "0.21", "mu": "0.15", "d": "0.6", "radius_ratio": "57"}
ABOUT = "ball at rub 1"
SIZES = ("angle", "rate", "radial_speed", "gap")


def claims_of(machine):
    """Claims about balls, if the rub attracts slides."""
    with at_precision(128):
        rotor = Rotor(hypotheses_of(machine))
        stable = any(
            claim.name == "rub 1 attracts sliding" and claim.status == "proven" for claim in steady_claims(rotor)
        )
        return {claim.kind: claim for claim in rub_ball_claims(rotor, Evidence())} if stable else {}


def random_machine(random):
    gamma, omega, rho = random.uniform(-0.1, 1.0), random.uniform(0.1, 1.2), random.uniform(0.1, 2.0)
    mu, d = random.choice((0.0, 0.02, 0.2, 0.6, 2.0)), random.choice((0.0, 0.3, 0.7, 0.95))
    return {
        "gamma": gamma,
        "omega": omega,
        "rho": rho,
        "phi": 0.0,
        "mu": mu,
        "d": d,
        "radius_ratio": random.uniform(0.5, 20.0),
    }


def corner(random, sizes):
    """A state of a ball, mostly on its surface."""
    return [size * random.choice((-1.0, 1.0, random.uniform(-1, 1))) for size in sizes]


def test_all_states_of_a_ball_of_slides_decay():
    random, followed = np.random.default_rng(1), 0
    while followed < sized(25, 4, 400):
        machine = random_machine(random)
        claim = claims_of(machine).get("slides in")
        if claim is None or claim.status != "proven" or machine["gamma"] + 2 * machine["mu"] < 0.05:
            continue
        peer = Bouncing(machine)
        angle, force = peer.rub()
        off, rate = corner(random, [claim.enclosures[name].value for name in SIZES[:2]])
        least, (end, turning) = peer.settled((angle + off, rate))
        assert least > float(claim.enclosures["least_normal_force"].low) > 0.9 * force / 16
        assert abs(end - angle) + abs(turning) < 1e-3 * (abs(off) + abs(rate))
        followed += 1


def test_all_states_of_a_ball_of_bounces_decay():
    random, followed = np.random.default_rng(2), 0
    while followed < sized(8, 1, 200):
        machine = random_machine(random)
        claim = claims_of(machine).get("bounces in")
        if claim is None or claim.status != "proven" or machine["gamma"] + 2 * machine["mu"] < 0.05:
            continue
        peer = Bouncing(machine)
        angle, force = peer.rub()
        sizes = [claim.enclosures[name].value for name in SIZES]
        if sizes[2] < 1e-4:
            continue
        off, rate, radial, _ = corner(random, sizes)
        gap = sizes[3] * random.choice((1.0, random.uniform(0, 1)))
        state, clock, speeds = peer.rest((1.0 - gap, radial, angle + off, rate))
        ratios = np.array(speeds[1:]) / speeds[:-1]
        assert (ratios < 0.5 + machine["d"] / 2).all()
        worth = (sizes[2] ** 2 + 2 * force * sizes[3]) ** 0.5
        assert clock < 2 * worth / (float(claim.enclosures["least_normal_force"].low) * (0.5 - machine["d"] / 2))
        least, (end, turning) = peer.settled(state)
        assert least > float(claim.enclosures["least_normal_force"].low)
        assert abs(end - angle) + abs(turning) < 1e-3 * (sizes[0] + sizes[1])
        followed += 1


def test_formulas_beside_quadrature():
    """``Π``, ``T`` and the bound of ``N`` at random places with thirty digits."""
    random = np.random.default_rng(3)
    with mpmath.workdps(30), at_precision(128):
        for _ in range(sized(20, 5, 200)):
            machine = random_machine(random)
            rotor = Rotor(hypotheses_of(machine))
            if not (rub := Rub.of(rotor.numbers)).stiffness > 0:
                continue
            gamma, mu, rho, kappa = (
                mpmath.mpf(machine["gamma"]),
                mpmath.mpf(machine["mu"]),
                mpmath.mpf(machine["rho"]),
                1 - mpmath.mpf(machine["omega"]) ** 2,
            )
            force = mpmath.mpf(float(rub.force.mid()))
            angle = mpmath.findroot(
                lambda x, g=gamma, m=mu, r=rho, k=kappa: g + r * mpmath.sin(x) + m * (r * mpmath.cos(x) + k),
                mpmath.atan2(-gamma - mu * force, force - kappa),
            )

            def torque(off, g=gamma, m=mu, r=rho, k=kappa, a=angle):
                return g + r * mpmath.sin(a + off) + m * (r * mpmath.cos(a + off) + k)

            for place in random.uniform(-1.5, 1.5, 3).tolist():
                ball = rational(Fraction(place))
                whole = mpmath.quad(lambda xi, m=mu, f=torque: f(xi) * mpmath.exp(2 * m * xi), [0, place])
                assert abs(float(rub.torque(ball).mid()) - float(torque(place))) < 1e-12
                assert abs(float(rub.potential(ball).mid()) - float(whole)) < 1e-12
                turned = abs(rho * (mpmath.cos(angle + place) - mpmath.cos(angle)))
                assert float(turned) <= float(rub.turn_of_force(rational(Fraction(abs(place)))).upper()) + 1e-12


def test_rise_bounds_what_bounces_do_to_the_function():
    """``V`` before the first bounce and after the last one, along the integrator's flights."""
    random, followed = np.random.default_rng(4), 0
    while followed < sized(5, 1, 100):
        machine = random_machine(random)
        claim = claims_of(machine).get("bounces in")
        if claim is None or claim.status != "proven" or claim.enclosures["radial_speed"].value < 1e-4:
            continue
        sizes = [Fraction(claim.enclosures[name].low) for name in SIZES]
        peer, spread = Bouncing(machine), bounce_spread(Fraction(machine["d"]))
        angle, _ = peer.rub()
        off, rate, radial, _ = corner(random, [float(size) for size in sizes])
        with at_precision(128):
            rub = Rub.of(Rotor(hypotheses_of(machine)).numbers)
            trap = trap_of(rub, spread, 2 * sizes[0], sizes[2], sizes[3])

            def height(x, q, rub=rub, mu=peer.mu, angle=angle):
                return 0.5 * q * q * np.exp(2 * mu * (x - angle)) + float(
                    rub.potential(rational(Fraction(x - angle))).mid()
                )

            before = height(angle + off, rate - peer.mu * radial)
            (x, y), _, _ = peer.rest((1.0 - float(sizes[3]), radial, angle + off, rate))
            assert height(x, y) - before < float(trap.rise.upper())
        followed += 1


@pytest.mark.parametrize(
    ("changes", "slides", "bounces"),
    [
        ({}, "proven", "proven"),
        ({"d": "0"}, "proven", "proven"),
        ({"d": "1"}, "proven", None),
        ({"d": "0.9999999999"}, "proven", "undecided"),
        ({"mu": "0"}, "proven", "proven"),
        ({"gamma": "0.3700060"}, "proven", "proven"),
        ({"gamma": "0.38"}, None, None),
        ({"gamma": "-0.29"}, "proven", "proven"),
        ({"gamma": "-0.31"}, None, None),
        ({"omega": "1"}, "proven", "proven"),
        ({"rho": "1000"}, "proven", "proven"),
        ({"gamma": ("0.19", "0.21"), "d": ("0.5", "0.6")}, "proven", "proven"),
        ({"gamma": ("0.1", "0.3")}, "proven", "proven"),
    ],
)
def test_limits(changes, slides, bounces):
    claims = claims_of({**DECIMAL, **changes})
    assert (claims["slides in"].status if slides else claims.get("slides in")) == slides
    assert (claims["bounces in"].status if bounces else claims.get("bounces in")) == bounces


@pytest.fixture(scope="module")
def document():
    return json.loads(json.dumps(prove(DECIMAL).document()))


def test_certificate_is_verified_and_larger_balls_are_refused(document):
    assert check(document)[f"{ABOUT} bounces in"].status == "proven"
    for evidence, names, kind in (
        ("ball of slides", ("angle", "rate"), "slides in"),
        ("ball of bounces", SIZES, "bounces in"),
    ):
        place = next(
            k for k, claim in enumerate(document["claims"]) if (claim["about"], claim["kind"]) == (ABOUT, kind)
        )
        for k, name in enumerate(names):
            forged = copy.deepcopy(document)
            larger = str(2 * Fraction(forged["evidence"][evidence][k + 1]))
            forged["evidence"][evidence][k + 1] = larger
            with pytest.raises(InputError, match="not shown to be kept"):
                check(forged)
            alone = copy.deepcopy(document)
            alone["claims"][place]["enclosures"][name] = [
                f"{2 * float(end):.12f}" for end in alone["claims"][place]["enclosures"][name]
            ]
            with pytest.raises(InputError, match="is refused"):
                check(alone)


@pytest.mark.parametrize(
    "sizes",
    [None, [], ["1"], ["1", "0", "0"], ["-1", "1/10", "1/10"], ["100", "1/1000", "1/1000"], "1/2", ["1", "x", "1"]],
)
def test_false_evidence_is_refused(document, sizes):
    with pytest.raises(InputError, match="is refused"):
        check({**document, "evidence": {**document["evidence"], "ball of slides": sizes}})


def test_smaller_ball_is_no_other_claim_of_the_same_evidence():
    with at_precision(128), pytest.raises(NotShownError, match="other sizes"):
        rub_ball_claims(
            Rotor(hypotheses_of(DECIMAL)), Evidence({"ball of slides": ["1", "1"], "ball of bounces": None})
        )
