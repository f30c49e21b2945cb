"""All states up to the proven speed return in the simulator; the lemmas hold of states drawn at random; certificates stand alone."""

import copy
import json

import numpy as np
import pytest
from compilation import sized
from machines import dimensionless
from scipy.linalg import expm

import carom as cm
from carom.base.outcome import InputError, Outcome
from carom.models import jeffcott
from carom.motions import settle
from carom.proofs import check, prove_states
from carom.proofs.balls import at_precision
from carom.proofs.forms import Surface, limits_of, read_forms, traps_of
from carom.proofs.rotor import ProvenRotor
from carom.proofs.seeds import doubles_of

CASES = {
    # What a machine is, and a speed up to which all states return.
    "spindle": ("examples/spindle.toml", "140 mm/s"),
    "source paper, strongly damped": (dimensionless("1 0.76 3/7 0.21 0.15 0.95 400/7"), "2"),
    "much unbalance": (dimensionless("0.6 0.76 3/7 0.21 0.15 0.95 400/7"), "1"),
    "no friction": (dimensionless("0.9 1.3 0.05 0 0 0.8 3"), "3"),
    "slip that stops": (dimensionless("0.8 1.2 0.02 1 0.4 0.5 0.3"), "0.8"),
    "wall without rebound": (dimensionless("0.7 0.4 0.1 2 0.3 0 9"), "1"),
    "elastic wall": (dimensionless("0.6 0.5 0.01 0 0.1 1 20"), "2"),
    "overdamped": (dimensionless("2.5 0.4 0.2 0 0.3 0.6 5"), "3"),
}


@pytest.fixture(scope="module", params=CASES, ids=str)
def proof(request):
    machine, largest = CASES[request.param]
    return prove_states(machine, largest)


def drawn(speed, number, seed=0):
    """States in the co-rotating frame, no faster than a speed in the fixed one; many at the wall, at full speed, and whirling backward on it."""
    rng = np.random.default_rng(seed)
    place = np.sqrt(rng.random(number)) * np.exp(2j * np.pi * rng.random(number))
    velocity = speed * np.sqrt(rng.random(number)) * np.exp(2j * np.pi * rng.random(number))
    place[::3] *= (1 - 1e-15) / abs(place[::3])
    velocity[::4] *= speed / abs(velocity[::4])
    place[::7] *= (1 - 1e-15) / abs(place[::7])
    velocity[::7] = -1j * place[::7] * abs(velocity[::7])
    return place, velocity * (1 - 1e-12) - 1j * place


def test_all_states_are_proven_to_return(proof):
    assert proof["states all recover"].status == proof["states recover"].status == "proven"


def test_simulated_states_return(proof):
    rotor = jeffcott(doubles_of(proof.hypotheses))
    starts = drawn(proof["states recover"].enclosures["speed"].value, sized(10_000, 300, 100_000))

    assert settle(rotor, cm.State(*starts)).recovered.all()


def valued(form, place, velocity, circle):
    """A form, written out anew, of positions and velocities in the fixed frame while levitation is at some places."""
    alpha, beta, k, shift, _ = (float(value.mid()) for value in form)
    away, rate = place - shift * circle, velocity - 1j * shift * circle
    cross = away.conj() * rate
    return abs(rate) ** 2 + 2 * alpha * cross.real + 2 * beta * cross.imag + k * abs(away) ** 2


def test_forms_fall_in_flight_and_at_every_impact_in_their_trap(proof):
    """Forms written out anew; flights by a matrix exponential, impacts with any friction within the cone."""
    rng, p = np.random.default_rng(5), doubles_of(proof.hypotheses)
    levitation = abs(p.rho / (p.omega**2 - 1 + 1j * p.gamma))
    with at_precision(proof.bits):
        wall = Surface.of(ProvenRotor(proof.hypotheses).numbers)
        traps = traps_of(wall, read_forms(proof.evidence["forms"][1]))
    step = expm(np.array([[0, 1], [-(p.omega**2), -p.gamma]]) * 0.01)
    number = 4000
    for trap in traps:
        shift, core = float(trap.form.shift.mid()), float(trap.form.core(wall).mid()) ** 2
        circle = levitation * np.exp(2j * np.pi * rng.random(number))
        away, rate = np.sqrt(float(trap.bound)) * (rng.standard_normal((2, number, 2)) @ [1, 1j])
        later = np.exp(0.01j) * circle, *(step @ np.array([away, rate]))
        before, after = (valued(trap.form, u + c, w + 1j * c, c) for c, u, w in ((circle, away, rate), later))
        assert (after < before)[before > 1.01 * core].all()
        assert float(trap.bound) > core
        assert 0 <= shift <= 1

        outward = rng.random(number) ** 3 * 3 * np.sqrt(float(trap.bound))
        outward[::4] = 0
        velocity = outward + 1j * rng.standard_normal(number) * np.sqrt(float(trap.bound))
        size = valued(trap.form, 1, velocity, circle)
        inside = size <= float(trap.bound)
        friction = p.mu * np.where(rng.random(number) < 0.5, 1, 2 * rng.random(number) - 1)
        # Lasting contact is an impact so weak that its square does not count.
        impulse = np.where(outward > 0, (1 + p.d) * outward, 1e-9)
        after = velocity - (1 + 1j * friction) * impulse
        change = valued(trap.form, 1, after, circle) - size
        assert inside.sum() > number / 100
        assert (change[inside] <= 1e-12).all()  # rounding of numbers next to 1


def test_states_up_to_a_speed_arrive_within_its_bounds(proof):
    rng, p = np.random.default_rng(6), doubles_of(proof.hypotheses)
    levitation = abs(p.rho / (p.omega**2 - 1 + 1j * p.gamma))
    speed = proof["states recover"].enclosures["speed"].value
    with at_precision(proof.bits):
        wall = Surface.of(ProvenRotor(proof.hypotheses).numbers)
        limits = limits_of(wall, wall.gamma * 0 + speed, read_forms(proof.evidence["forms"][2]))
    place, turning = drawn(speed, 2000, seed=int(rng.integers(100)))
    circle = levitation * np.exp(2j * np.pi * rng.random(2000))
    for limit in limits:
        assert (valued(limit.form, place, turning + 1j * place, circle) <= float(limit.bound)).all()


@pytest.mark.parametrize(
    ("machine", "largest", "settings", "words"),
    [
        ("examples/spindle.toml", "240 mm/s", (), "runs away to rolling"),
        ("examples/source-paper.toml", "1.2", ("gamma=0.3",), "synchronous rub 1"),
        ("examples/source-paper.toml", "0.9", ("gamma=0.1",), "orbit B1,d"),
        ("examples/source-paper.toml", "0.9", ("gamma=0.05",), "no levitation"),
    ],
    ids=["whirl", "rub", "orbit", "no levitation"],
)
def test_another_motion_refutes(machine, largest, settings, words):
    proof = prove_states(machine, largest, settings)

    assert proof["states all recover"].status == "refuted"
    assert words in proof["states all recover"].reason
    assert check(proof.document()).claims == proof.claims


def test_states_that_are_said_to_be_lost_are():
    """Just above the speed a backward whirl on the wall of the spindle rolls; the orbit of the paper's machine passes the speed stated."""
    spindle = prove_states("examples/spindle.toml", "200 mm/s")
    speed = spindle["states lost"].enclosures["speed"].value
    place = np.exp(1j * np.linspace(0, 6, 50))
    endings = settle(cm.load("examples/spindle.toml"), cm.State(place, -1j * place * (1.001 * speed + 1)))

    assert spindle["states all recover"].status == "undecided"
    assert endings.count(Outcome.ROLLING) == len(place)

    paper = prove_states("examples/source-paper.toml", "0.5", ("gamma=0.1",))
    orbit = 0.7332305341, 1 - 1.3682985853  # radial and angular speed before the impact
    assert paper["states lost"].enclosures["speed"].value <= np.hypot(*orbit) + 1e-9


@pytest.fixture(scope="module")
def document():
    machine, largest = CASES["source paper, strongly damped"]
    return json.loads(json.dumps(prove_states(machine, largest).document()))


def test_certificate_is_checked_without_a_search(document, monkeypatch):
    monkeypatch.setattr("carom.proofs.state_claims.search", None)

    assert check(document)["states all recover"].status == "proven"


@pytest.mark.parametrize(
    "change",
    [
        lambda d: d["options"].update(states_up_to="6"),
        lambda d: d["evidence"]["forms"].__setitem__(1, []),
        lambda d: d["evidence"]["forms"][1][0].__setitem__(0, "2"),
        lambda d: d["evidence"]["forms"].__setitem__(0, "3/2"),
        lambda d: d["evidence"].pop("forms"),
        lambda d: d["claims"].pop(),
        lambda d: d["claims"][0]["enclosures"].update(speed=["3", "3"]),
        lambda d: d["hypotheses"]["values"].update(gamma="0.5"),
    ],
)
def test_forged_certificates_are_refused(document, change):
    forged = copy.deepcopy(document)
    change(forged)

    with pytest.raises(InputError, match="is refused"):
        check(forged)


@pytest.mark.parametrize(
    ("largest", "words"), [("-1", "out of range"), ("fast", "states_up_to"), ("[1, 2]", "must be one speed")]
)
def test_bad_speeds_are_refused(largest, words):
    with pytest.raises(InputError, match=words):
        prove_states(CASES["overdamped"][0], largest)
