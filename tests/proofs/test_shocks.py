"""Shocks and steps of the unbalance that are proven to come back do, by simulations that share nothing with the proof."""

import json

import numpy as np
import pytest
from compilation import sized

from carom import BaseShock, State, settle
from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.proofs import check, prove_kicks, prove_shocks, prove_unbalance_steps
from carom.proofs.kick_cells import IMPACTS, OPEN, leaves, read
from carom.proofs.seeds import doubles_of

SPINDLE = "examples/spindle.toml"
SLIPPING = {"gamma": 0.6, "omega": 1.2, "rho": 0.02, "phi": 1, "mu": 0.4, "d": 0.5, "radius_ratio": 0.05}
SLOW = {"gamma": 0.5, "omega": 0.4, "rho": 0.1, "phi": 1, "mu": 0.2, "d": 0.6, "radius_ratio": 5}
CASES = {
    # Nothing is left open of any.
    "short shocks": (prove_shocks, SPINDLE, "89 g, 0.2 ms", 1),
    "shocks": (prove_shocks, SLIPPING, "5, 0.7", 2),
    "steps by an unbalance": (prove_unbalance_steps, SPINDLE, "140 g mm", 1),
    "steps": (prove_unbalance_steps, SLOW, "0.7", 2),
}


@pytest.fixture(scope="module", params=CASES, ids=str)
def proof(request):
    prove, machine, largest, most = CASES[request.param]
    return prove(machine, largest, most_impacts=most, time_limit=None, workers=1)


def drawn(proof, number):
    """Complex sizes, as shares of the largest one, in proven cells and the impacts allowed; angles are from the levitating rotor."""
    cells = [(c, IMPACTS.index(x)) for c, x in leaves(read(proof.evidence["cells"])) if x in IMPACTS]
    random = np.random.default_rng(2)
    areas = np.array([float(cell.share) for cell, _ in cells])
    # Half of them where the cells are small.
    picked = np.append(
        random.choice(len(cells), number // 2, p=areas / areas.sum()),
        random.integers(0, len(cells), number - number // 2),
    )
    ends = np.array([[float(end) for end in (*cell.speeds, *cell.angles)] for cell, _ in cells])[picked]
    within = random.uniform(1e-9, 1 - 1e-9, (2, number))
    sizes, turns = (ends[:, k] + (ends[:, k + 1] - ends[:, k]) * within[k // 2] for k in (0, 2))
    return sizes * np.exp(2j * np.pi * turns), np.array([most for _, most in cells])[picked]


def largest_of(proof):
    """Its largest size, dimensionless, and the duration of a shock in ``1/Ω``."""
    text = next(iter(proof.options.values()))
    peak, _, duration = text.partition(",")
    if proof.hypotheses.table == "dimensionless":
        return float(peak), float(duration or 0)
    clearance, speed, mass = 0.25e-3, 24000 * np.pi / 30, 3.2
    size = float(peak.split()[0])
    scale = {"um": 1e-6 / clearance, "g mm": 1e-6 / mass / clearance, "g": 9.80665 / (clearance * speed**2)}
    return size * scale[peak.partition(" ")[2]], float(duration.split()[0]) * 1e-3 * speed if duration else 0.0


def test_all_are_proven_to_return(proof):
    recover, everything = proof

    assert recover.status == everything.status == "proven"
    assert recover.enclosures["share_proven"].low == "1"
    assert float(recover.enclosures["impacts"].low) > 0


def test_simulations_return_with_at_most_as_many_impacts(proof):
    shares, most = drawn(proof, sized(2000, 200, 100_000))
    (largest, duration), rotor = largest_of(proof), jeffcott(doubles_of(proof.hypotheses))
    levitation = rotor.equilibrium
    ahead = levitation / abs(levitation)
    if duration:
        # The rotor feels the opposite of the acceleration of its base.
        starts = BaseShock(largest, duration).starts(rotor, largest * np.abs(shares), np.angle(-shares * ahead))
        assert not (starts.touched | starts.ended).any()
        endings = settle(rotor, State(starts.positions, starts.velocities))
    else:
        p = rotor.parameters
        gain = 1 / abs(complex(p.omega**2 - 1, p.gamma))
        endings = settle(rotor, State(levitation + largest * gain * shares * ahead, np.zeros_like(shares)))

    assert endings.recovered.all()
    assert (endings.impacts <= most).all()
    assert endings.impacts.max() > 0


def test_certificates_stand_alone_and_forged_ones_are_refused():
    prove, machine, largest, most = CASES["shocks"]
    document = json.loads(json.dumps(prove(machine, largest, most_impacts=most, time_limit=None, workers=1).document()))
    cells, option = document["evidence"]["cells"], next(iter(document["options"]))

    assert list(check(document))[1].status == "proven"
    for change in (
        {"evidence": {"cells": cells.replace("1", "0")}},
        {"evidence": {"cells": cells[:-1]}},
        {"options": {**document["options"], option: "9" + largest}},
        {"theorem": "kicks"},
        {"theorem": "unbalance steps"},
    ):
        with pytest.raises(InputError, match="is refused"):
            check({**document, **change})


def test_a_shock_that_lasts_is_left_open_where_it_meets_the_wall():
    machine = {"gamma": 0.3, "omega": 0.7, "rho": 0.1, "phi": 0, "mu": 0.1, "d": 0.5, "radius_ratio": 50}
    proof = prove_shocks(machine, "6, 3", most_impacts=2, time_limit=3, workers=1)

    assert OPEN["e"] in proof["shocks all recover"].reason


def test_a_rotor_that_did_not_levitate_before_is_left_open():
    machine = {"gamma": 0.6, "omega": 1.2, "rho": 0.1, "phi": 0, "mu": 0.1, "d": 0.5, "radius_ratio": 50}
    proof = prove_unbalance_steps(machine, "2", most_impacts=2, time_limit=2, workers=1)

    assert OPEN["o"] in proof["unbalance steps all recover"].reason


def test_a_very_short_shock_is_a_kick():
    """The same cells of the disc are proven with the same change of velocity."""
    machine = {"gamma": 0.6, "omega": 1.2, "rho": 0.02, "phi": 1, "mu": 0.4, "d": 0.5, "radius_ratio": 0.05}
    kicks = prove_kicks(machine, "1.6", most_impacts=1, time_limit=None, workers=1)
    # A pulse of the peak a changes the velocity by 2aT/π.
    shocks = prove_shocks(machine, f"{1.6 * np.pi / 2 * 1e6!r}, 1e-6", most_impacts=1, time_limit=None, workers=1)

    assert shocks.evidence["cells"] == kicks.evidence["cells"]


@pytest.mark.parametrize(
    ("prove", "largest", "words"),
    [
        (prove_shocks, "5 g", "must be the largest peak and the duration"),
        (prove_shocks, "5, 11 ms", "has no unit"),
        (prove_shocks, "5 g, 11", "has no unit"),
        (prove_shocks, "5 g, 1 ms, 2 ms", "must be the largest peak and the duration"),
        (prove_unbalance_steps, "[1 um, 2 um]", "must be one length"),
        (prove_shocks, "5 mm, 11 ms", "not a unit of acceleration"),
        (prove_unbalance_steps, "5 kg", "unbalance_up_to"),
        (prove_unbalance_steps, "5", "has no unit"),
        (prove_unbalance_steps, "0 um", "unbalance_up_to"),
    ],
)
def test_bad_sizes_are_one_line(prove, largest, words):
    with pytest.raises(InputError, match=words):
        prove(SPINDLE, largest)
