"""Kicks that are proven to come back do, in programs that share nothing with the proof; certificates stand alone."""

import json
import random

import numpy as np
import pytest
from compilation import sized
from machines import DECIMAL, dimensionless

from carom.base.outcome import InputError
from carom.models import jeffcott
from carom.motions import State, settle
from carom.proofs import check, hypotheses_of, prove_kicks
from carom.proofs.kick_cells import IMPACTS, leaves, read
from carom.proofs.seeds import doubles_of

SPINDLE = "examples/spindle.toml"


CASES = {
    # What a machine is, the largest kick, and how many impacts are allowed; nothing is left open of any.
    "spindle": (SPINDLE, "111 mm/s", 1),
    "elastic wall, no unbalance": (dimensionless("1.66 1.86 0 0 0.26 1 1.6"), "6.7", 3),
    "overdamped": (dimensionless("1.1 0.21 0 0.3 0.46 0.31 0.69"), "4", 2),
    "slip that stops": (dimensionless("0.6 1.2 0.02 1 0.4 0.5 0.05"), "2", 2),
    "wall without rebound": (dimensionless("0.38 2.7 0 0 0.16 0 0.86"), "3.3", 2),
}


@pytest.fixture(scope="module", params=CASES, ids=str)
def proof(request):
    machine, largest, most = CASES[request.param]
    return prove_kicks(machine, largest, most_impacts=most, time_limit=None, workers=1)


def drawn(proof, number):
    """Kicks in proven cells, some of them on corners: of each its velocity in the fixed frame and the impacts allowed."""
    cells = [
        (cell, IMPACTS.index(letter)) for cell, letter in leaves(read(proof.evidence["cells"])) if letter in IMPACTS
    ]
    rotor, random_ = jeffcott(doubles_of(proof.hypotheses)), np.random.default_rng(7)
    largest = proof["kicks recover"].enclosures["speed"].value  # nothing is open
    picked = random_.integers(0, len(cells), number)
    ends = np.array([[float(end) for end in (*cell.speeds, *cell.angles)] for cell, _ in cells])[picked]
    within = random_.random((2, number))
    within[:, ::5] = np.round(within[:, ::5])
    speeds, angles = (ends[:, k] + (ends[:, k + 1] - ends[:, k]) * within[k // 2] for k in (0, 2))
    # On the rim, and on corners next to a graze, the last digit decides: stay inside by less than any width of a cell.
    speeds *= 1 - 1e-12
    ahead = np.exp(1j * np.angle(rotor.equilibrium)) if rotor.equilibrium else 1.0
    return rotor, largest * speeds * np.exp(2j * np.pi * angles) * ahead, np.array([most for _, most in cells])[picked]


def test_all_kicks_are_proven_to_return(proof):
    numbers = proof["kicks recover"].enclosures

    assert proof["kicks all recover"].status == proof["kicks recover"].status == "proven"
    assert numbers["share_proven"].low == numbers["share_proven"].high == "1"
    assert numbers["share_open"].high == "0"


def test_simulated_kicks_return_with_at_most_as_many_impacts(proof):
    rotor, kicks, most = drawn(proof, sized(10_000, 300, 100_000))
    endings = settle(rotor, State(np.full(len(kicks), rotor.equilibrium), kicks))

    assert endings.recovered.all()
    assert (endings.impacts <= most).all()
    assert endings.impacts.max() > 0


@pytest.fixture(scope="module")
def document():
    machine, largest, most = CASES["elastic wall, no unbalance"]
    proof = prove_kicks(machine, largest, most_impacts=most, time_limit=None, workers=1)
    return json.loads(json.dumps(proof.document()))


def changed(document, cells):
    return {**document, "evidence": {"cells": cells}}


def test_certificate_is_verified_without_a_search(document, monkeypatch):
    monkeypatch.setattr("carom.proofs.kick_discs.settle", None)
    monkeypatch.setattr("carom.proofs.recovering.search", None)

    assert check(document)["kicks all recover"].status == "proven"


def test_forged_cells_are_refused(document):
    """Cells missing, too many, swapped, of another kind, or said to need fewer impacts than they do."""
    cells = document["evidence"]["cells"]
    first, last = (find(letter) for find, letter in ((cells.index, "1"), (cells.rindex, "0")))
    swapped = list(cells)
    swapped[first], swapped[last] = swapped[last], swapped[first]
    forged = [
        cells[:-1],
        cells + "0",
        "".join(swapped),
        cells.replace("1", "0"),
        cells[:first] + "?" + cells[first + 1 :],
        cells[:first] + "g" + cells[first + 1 :],
        "0",
        "",
        None,
    ]
    for text in forged:
        with pytest.raises(InputError, match="is refused"):
            check(changed(document, text))


def test_any_letter_that_matters_is_refused(document):
    cells, picked = document["evidence"]["cells"], random.Random(3)
    for place in picked.sample(range(len(cells)), sized(20, 4, len(cells))):
        letter = picked.choice([other for other in "va012g" if other != cells[place]])
        try:
            proof = check(changed(document, cells[:place] + letter + cells[place + 1 :]))
        except InputError:
            continue
        # A cell said to need more impacts than it does is no false claim.
        assert "0" <= cells[place] < letter <= "2"
        assert proof["kicks all recover"].statement == document["claims"][1]["statement"]


@pytest.mark.parametrize(
    ("machine", "largest", "words"),
    [
        (SPINDLE, "120", "has no unit"),
        (SPINDLE, "0 mm/s", "kicks_up_to"),
        (SPINDLE, "[100 mm/s, 120 mm/s]", "must be one velocity"),
        ({**dict.fromkeys(DECIMAL, "0.1"), "rho": "2"}, "1", "must levitate inside the wall"),
        ({**dict.fromkeys(DECIMAL, "0.1"), "gamma": "0"}, "1", "must levitate inside the wall"),
    ],
)
def test_what_cannot_be_proven_is_refused_at_once(machine, largest, words):
    with pytest.raises(InputError, match=words):
        prove_kicks(machine, largest)


def test_intervals_of_a_machine_are_followed_at_once():
    """All dampings of an interval together: the proof is of each."""
    machine = {
        **{name: str(hypotheses_of(SPINDLE).numbers[name].low) for name in ("mu", "d", "radius_ratio")},
        "phi": "0",
    }
    machine |= {"gamma": ("0.0435", "0.04351"), "omega": "0.1407", "rho": "0"}
    proof = prove_kicks(machine, "0.18", most_impacts=1, time_limit=1, workers=1)

    assert check(proof.document()).claims == proof.claims
    assert proof["kicks recover"].status == "proven"
