"""Claims about orbits with one impact a period beside arithmetic of fifty digits, simulation and the usual search."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from compilation import sized
from machines import DECIMAL, PAPER, ExactMotion, exact_return, path, random_parameters
from precise_orbits import PreciseOrbit, number
from scipy.optimize import brentq

import carom as cm
from carom.orbits import find_orbits, period_condition
from carom.parameters import Parameters
from carom.proofs import Proof, prove


def status(proof: Proof, name: str) -> str:
    return proof[name].status


def near_the_paper(random: np.random.Generator) -> Parameters:
    """Machines of which one in four has a stable orbit."""
    low, high = (0.02, 0.6, 0.3, 0.0, 0.8), (0.22, 0.9, 0.6, 0.3, 1.0)
    names = ("gamma", "omega", "rho", "mu", "d")
    return PAPER.replace(**dict(zip(names, random.uniform(low, high).tolist(), strict=True)))


def assert_agrees(parameters: Parameters, proof: Proof) -> None:
    """Compare with the usual search, whose tests share nothing with it."""
    orbits = find_orbits(parameters) if parameters.gamma > 0 else ()
    named = {orbit.name: orbit for orbit in orbits if orbit.slip > 0}
    periods = proof["machine periods"]
    if periods.status == "proven":
        assert int(periods.statement.split()[3]) == len(orbits.periods)
        assert set(named) == {claim.about for claim in proof if claim.kind == "admissible"}
    for claim in proof:
        orbit = named.get(claim.about)
        if orbit is None or claim.status == "undecided":
            continue
        shown = {"admissible": orbit.admissible, "stable": orbit.stable, "outward": orbit.radial_speed > 0}
        assert shown.get(claim.kind, claim.status == "proven") == (claim.status == "proven"), claim.name
        for name in ("period", "radial_speed", "angular_speed"):
            if name in claim.enclosures:
                value = getattr(orbit, name)
                assert claim.enclosures[name].value == pytest.approx(value, rel=1e-7, abs=1e-8)


def assert_true(parameters: Parameters, proof: Proof) -> int:
    """Compare with matrix exponentials and differences of the return map in fifty digits; number of comparisons."""
    if parameters.gamma == 2 * parameters.omega:
        return 0
    count = 0
    q = (1 + mpmath.mpf(parameters.d)) * mpmath.mpc(1, mpmath.mpf(parameters.mu))
    motion = ExactMotion(parameters)
    solutions = [claim for claim in proof if claim.kind == "solution" and "period" in claim.enclosures]
    for solution in solutions[:4]:
        ends = [number(text) for text in (solution.enclosures["period"].low, solution.enclosures["period"].high)]
        values = [1 + (q * exact_return(parameters, end)[0][1, 1]).real for end in ends]
        assert ends[1] - ends[0] > 1e-30 or values[0] * values[1] < 0
        period = sum(ends) / 2
        back, _ = exact_return(parameters, period)
        speed = number(Fraction(solution.enclosures["radial_speed"].low))
        rest = abs(motion.rest)
        defect = abs(1 + q * back[0, 1] * speed) - rest
        assert abs(defect) < 1e-12 * (1 + rest)
        stable = proof[f"{solution.about} stable"]
        if abs(speed) < 1e-6 or stable.status == "undecided":
            continue
        orbit = PreciseOrbit(parameters, period, speed)
        jacobian = orbit.jacobian()
        largest = np.abs(np.linalg.eigvals(jacobian)).max()
        assert (largest < 1) == (stable.status == "proven") or abs(largest - 1) < 1e-7 * (1 + np.abs(jacobian).max())
        assert stable.enclosures["trace"].value == pytest.approx(
            np.trace(jacobian), abs=1e-7 * (1 + np.abs(jacobian).max())
        )
        count += 1
        if speed > 0 and abs(motion.upper - motion.lower) > 1e-3:
            times = np.linspace(0, float(period), 4001)[1:-1]
            radius = np.abs(path(parameters, complex(orbit.position), complex(orbit.after), times)).max()
            inside = status(proof, f"{solution.about} inside")
            assert inside == "undecided" or (radius > 1) == (inside == "refuted") or abs(radius - 1) < 1e-7
            count += 1
    return count


def test_claims_of_the_papers_machine():
    proof = prove(DECIMAL)

    assert not proof.with_status("undecided")
    assert proof["machine periods"].statement == "F1 has exactly 2 roots T > 0, each of them simple."
    assert (
        "exactly these motions with one impact a period, synchronous with the shaft: B1,a, B1,b, B1,c, B1,d."
        in proof["machine orbits"].statement
    )
    stable = [claim.about for claim in proof if claim.kind == "stable" and claim.status == "proven"]
    assert stable == ["levitation", "B1,d"]
    period = proof["B1,d solution"].enclosures["period"]
    assert period.width < Fraction(1, 10**30)
    # Of the design's figures to match.
    assert period.low.startswith("2.8635671445")
    assert proof["B1,d solution"].enclosures["radial_speed"].low.startswith("0.7332305340")


def test_random_machines_beside_fifty_digits():
    random, compared, undecided, claims = np.random.default_rng(14), 0, 0, 0
    with mpmath.workdps(50):
        for k in range(sized(4, 4, 200)):
            parameters = near_the_paper(random) if k % 2 else random_parameters(random)
            proof = prove(parameters)
            compared += assert_true(parameters, proof)
            if parameters.radius_ratio > 3:
                undecided += len(proof.with_status("undecided"))
                claims += len(proof)
    assert compared > 2 * sized(4, 4, 200)
    assert undecided <= 0.01 * claims


def test_random_machines_beside_the_usual_search():
    random, stable, undecided, claims = np.random.default_rng(15), 0, 0, 0
    for k in range(sized(10, 2, 400)):
        parameters = near_the_paper(random) if k % 4 else random_parameters(random)
        proof = prove(parameters)
        assert_agrees(parameters, proof)
        names = [claim.about for claim in proof if claim.kind == "admissible" and claim.status == "proven"]
        stable += any(status(proof, f"{name} stable") == "proven" for name in names)
        if parameters.radius_ratio > 3:
            undecided, claims = undecided + len(proof.with_status("undecided")), claims + len(proof)
    assert stable >= sized(1, 0, 60)
    assert undecided <= 0.01 * claims


@pytest.mark.jit_only
def test_proven_orbits_run_in_simulation():
    random, followed = np.random.default_rng(16), 0
    while followed < 2:
        parameters = near_the_paper(random)
        proof = prove(parameters)
        for orbit in find_orbits(parameters):
            proven = status(proof, f"{orbit.name} admissible") == "proven"
            if proven and status(proof, f"{orbit.name} stable") == "proven":
                assert abs(orbit.trajectory(20).final.position - orbit.position) < 1e-9
                nudged = cm.State(orbit.departure.position * (1 - 1e-7), orbit.departure.velocity)
                left = cm.simulate(parameters, nudged, 400 * orbit.period)
                assert abs(left.contacts.radial_speed[-1] - orbit.radial_speed) < 1e-6
                followed += 1


# ------------------------------------------------------------------------------------------------ on both sides of a change


def zero(condition, low: float, high: float) -> float:
    """Where a function changes sign, to the spacing of doubles."""
    return brentq(lambda value: float(condition(value)), low, high, xtol=1e-17, rtol=1e-15)


def test_boundary_equilibrium_is_exact():
    """``ρ = 0.5``, ``1 − ω² = 0.3``, ``γ = 0.4``: levitation on the wall, one of the two radial speeds zero."""
    on_wall = {**DECIMAL, "rho": "0.5", "gamma": "0.4", "d": "1"}
    proof = prove({**on_wall, "omega": "0.7"}, longest_period=20)
    assert status(proof, "levitation inside") != "undecided"

    exact = prove({**DECIMAL, "rho": "5/16", "gamma": "3/16", "omega": "3/4"})  # 1 − ω² = 7/16: outside
    assert status(exact, "levitation inside") == "proven"
    pythagoras = prove({**DECIMAL, "omega": "1/2", "rho": "5/4", "gamma": "1"})  # 1 − ω² = 3/4
    assert status(pythagoras, "levitation inside") == "refuted"
    assert pythagoras["levitation inside"].reason == "it lies on the wall"
    assert status(pythagoras, "kick harmless") == "refuted"


# ------------------------------------------------------------------------------------------------ hard cases


@pytest.mark.parametrize(
    "changes",
    [
        {"d": "1"},
        {"d": "1", "gamma": "0.3"},  # γ = 2μ: F₁ vanishes to the third order at zero
        {"d": "1", "gamma": "0.2", "mu": "0.3"},
        {"d": "0"},
        {"d": "1", "mu": "0"},
        {"mu": "0"},
        {"gamma": "1.52"},  # critical damping
        {"gamma": "1.5200000000000001"},
        {"gamma": "10"},
        {"rho": "0.001"},
        {"omega": "3"},
    ],
)
def test_hard_machines_are_decided(changes):
    proof = prove({**DECIMAL, **changes})

    assert not proof.with_status("undecided")
    assert_agrees(Parameters(**{name: float(Fraction(text)) for name, text in {**DECIMAL, **changes}.items()}), proof)


def test_condition_that_vanishes_at_every_period_is_left_undecided():
    """Without losses and friction ``F₁ = 0`` for all ``T``."""
    assert np.abs(period_condition(PAPER.replace(gamma=0.0, d=1.0, mu=0.0), np.array([0.4, 1.3, 7.0]))).max() < 1e-14
    proof = prove({**DECIMAL, "gamma": "0", "d": "1", "mu": "0"}, longest_period=10)
    assert status(proof, "machine periods") == "undecided"
    assert "F1 may have roots" in proof["machine periods"].reason


@pytest.mark.parametrize("half", ["1/1000000000", "1/100000", "1/10"])
def test_boxes_of_machines_are_never_wrong(half):
    """What is proven for a box holds at its corners and in its middle."""
    names = ("gamma", "omega", "rho", "mu")
    box = {
        name: (Fraction(DECIMAL[name]) * (1 - Fraction(half)), Fraction(DECIMAL[name]) * (1 + Fraction(half)))
        for name in names
    }
    proof = prove({**DECIMAL, **box})
    random = np.random.default_rng(3)
    assert half != "1/1000000000" or status(proof, "B1,d stable") == "proven"

    for shares in [*random.uniform(0, 1, (2, 4)), np.zeros(4), np.ones(4), np.full(4, 0.5)]:
        values = {
            name: low + (high - low) * Fraction(share)
            for (name, (low, high)), share in zip(box.items(), shares, strict=True)
        }
        inside = prove({**DECIMAL, **values})
        for claim in proof:
            if claim.status != "undecided":
                assert status(inside, claim.name) == claim.status, claim.name
            for name, entry in claim.enclosures.items():
                value = inside[claim.name].enclosures[name]
                chosen = claim.kind in (
                    "harmless",
                    "slides in",
                    "bounces in",
                )  # sizes that hold, not numbers of a machine
                assert chosen or Fraction(entry.low) <= Fraction(value.low)
                assert chosen or Fraction(value.high) <= Fraction(entry.high)


def test_decay_bounds_hold_beside_fifty_digits():
    """The derivative of the response to an impulse stays below both bounds behind the longest period."""
    random, closest = np.random.default_rng(5), 0.0
    with mpmath.workdps(50):
        for _ in range(sized(60, 60, 2000)):
            parameters = random_parameters(random)
            if parameters.gamma == 2 * parameters.omega:
                continue
            motion, time = ExactMotion(parameters), mpmath.mpf(10 ** random.uniform(-1, 2))
            upper, lower = motion.upper, motion.lower
            slope = abs((upper * mpmath.exp(upper * time) - lower * mpmath.exp(lower * time)) / (upper - lower))
            slow = mpmath.exp(upper.real * time)
            share = slope / slow * abs(upper - lower) / (abs(upper) + abs(lower))
            assert share < 1 + mpmath.mpf(10) ** -30
            assert slope <= slow * (1 + abs(mpmath.mpc(parameters.gamma / 2, 1)) * time)
            closest = max(closest, float(share))
    assert closest > 0.5
