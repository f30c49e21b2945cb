"""Cells whose kicks surely do not return: simulated kicks in them end in the rub, and what is forged is refused."""

import json

import numpy as np
import pytest
from compilation import sized

from carom.base.outcome import InputError, Outcome
from carom.closed_forms import contact_free_kick
from carom.models import jeffcott
from carom.motions import State, settle
from carom.proofs import Proof, check, hypotheses_of
from carom.proofs.claims import Evidence
from carom.proofs.families import KICKS
from carom.proofs.kick_cells import BY_ANGLE, BY_SPEED, DISC, LOST, REFUTED, Cell, written
from carom.proofs.kick_search import BITS
from carom.proofs.proving import proof_at
from carom.proofs.seeds import doubles_of

REFUTABLE, RETURNING = Cell((63, 6), (13, 6)), Cell((8, 6), (13, 6))
"""A cell of kicks of the source paper's machine at γ = 0.3 that end in the rub, and one of kicks that never touch."""


def tree_of(*shown):
    """Letters of a tree with some cells of which something is said; all others are open."""
    tree = {DISC: LOST}
    for target, letter in shown:
        cell = DISC
        while cell != target:
            by = BY_SPEED if cell.ring[1] < target.ring[1] else BY_ANGLE
            if tree.get(cell, LOST) not in (BY_SPEED, BY_ANGLE):
                tree[cell] = by
                tree |= dict.fromkeys(cell.halves(by), LOST)
            cell = next(half for half in cell.halves(by) if _within(target, half))
        tree[target] = letter
    return written(tree)


def _within(cell, other):
    pairs = zip((cell.ring, cell.sector), (other.ring, other.sector), strict=True)
    return all(place >> (deep - halvings) == k for (place, deep), (k, halvings) in pairs)


@pytest.fixture(scope="module")
def machine():
    return hypotheses_of("examples/source-paper.toml", ["gamma=0.3"])


@pytest.fixture(scope="module")
def largest(machine):
    """Twice the harmless kick, which has few digits so."""
    return f"{2 * contact_free_kick(jeffcott(doubles_of(machine))):.4f}"


@pytest.fixture(scope="module")
def document(machine, largest):
    cells = {"cells": tree_of((REFUTABLE, REFUTED), (RETURNING, "0"))}
    proof = proof_at(BITS, KICKS.about, machine, {"kicks_up_to": largest, "most_impacts": 3}, Evidence(cells))
    return json.loads(json.dumps(proof.document()))


def claims(document):
    return {(claim["about"], claim["kind"]): claim for claim in document["claims"]}


def test_a_cell_is_refuted_and_verified(document):
    found = claims(document)

    assert found["kicks", "recover"]["status"] == "proven"
    assert found["kicks", "do not recover"]["status"] == "proven"
    assert found["kicks", "all recover"]["status"] == "refuted"
    assert "does not return" in found["kicks", "all recover"]["reason"]
    share = float(found["kicks", "do not recover"]["enclosures"]["share_refuted"][0])
    assert share == float(found["kicks", "recover"]["enclosures"]["share_refuted"][0]) == float(REFUTABLE.share)
    assert isinstance(check(document), Proof)


def test_kicks_of_a_refuted_cell_end_in_the_rub(machine, largest):
    rotor, random, number = jeffcott(doubles_of(machine)), np.random.default_rng(5), sized(2000, 100, 100_000)
    within = random.uniform(0, 1, (2, number))
    within[:, ::4] = np.round(within[:, ::4])
    sizes, turns = (
        float(ends[0]) + float(ends[1] - ends[0]) * x
        for ends, x in zip((REFUTABLE.speeds, REFUTABLE.angles), within, strict=True)
    )
    ahead = rotor.equilibrium / abs(rotor.equilibrium)
    kicks = float(largest) * sizes * np.exp(2j * np.pi * turns) * ahead
    endings = settle(rotor, State(np.full(number, rotor.equilibrium), kicks))

    assert set(endings.outcomes.tolist()) <= {Outcome.FORWARD_RUB}


def test_what_is_forged_is_refused(document):
    for cells in (
        tree_of((REFUTABLE, REFUTED), (RETURNING, REFUTED)),
        tree_of((REFUTABLE, "3"), (RETURNING, "0")),
        tree_of((Cell((15, 4), (3, 4)), REFUTED), (RETURNING, "0")),
        tree_of((RETURNING, "0")),
    ):
        with pytest.raises(InputError, match="is refused"):
            check({**document, "evidence": {"cells": cells}})
    found = claims(document)
    found["kicks", "do not recover"]["enclosures"]["share_refuted"] = ["0.5", "0.5"]
    with pytest.raises(InputError, match="is refused"):
        check({**document, "claims": list(found.values())})
