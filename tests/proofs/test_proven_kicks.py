"""What a proof of kicks shows, for figures: each kick belongs to the part of its cell, and words say no more than is proven."""

from dataclasses import replace

import numpy as np
import pytest

from carom.base.outcome import InputError
from carom.proofs import ProvenKicks, hypotheses_of, prove, prove_kicks
from carom.proofs.claims import Evidence
from carom.proofs.families import KICKS
from carom.proofs.kick_search import BITS
from carom.proofs.proven_kicks import BEYOND
from carom.proofs.proving import proof_at

SPINDLE = "examples/spindle.toml"
BALANCED = {"gamma": "0.6", "omega": "1.2", "rho": "0.02", "phi": "1", "mu": "0.4", "d": "0.5", "radius_ratio": "0.05"}


@pytest.fixture(scope="module")
def whole():
    return ProvenKicks.of(prove_kicks(BALANCED, "2", most_impacts=2, time_limit=None, workers=1))


@pytest.fixture(scope="module")
def half():
    """Kicks of which the slower half and most of the next quarter are proven."""
    return proven(SPINDLE, "140 mm/s", "v0va0a0gasatx")


def proven(machine, largest, cells):
    """What cells show, which nothing is searched for."""
    options = {"kicks_up_to": largest, "most_impacts": 2}
    return ProvenKicks.of(proof_at(BITS, KICKS.about, hypotheses_of(machine), options, Evidence({"cells": cells})))


@pytest.mark.parametrize("name", ["whole", "half"])
def test_each_kick_belongs_to_the_part_of_its_cell(name, request):
    kicks = request.getfixturevalue(name)
    slow, fast, first, last = kicks.edges.T
    random = np.random.default_rng(3).random((2, 20, len(slow)))
    share, turn = slow + (fast - slow) * random[0], first + (last - first) * random[1]
    velocity = kicks.largest * share * np.exp(2j * np.pi * turn)
    assert np.array_equal(kicks.at(velocity.real, velocity.imag), np.broadcast_to(kicks.places, share.shape))


def test_beyond_the_disc_there_is_no_part(whole):
    reach = 1.001 * whole.largest
    assert kicks_at(whole, reach) == kicks_at(whole, -reach) == kicks_at(whole, reach * 1j) == BEYOND
    assert whole.parts[kicks_at(whole, 0.0)].impacts == 0


def kicks_at(kicks, velocity):
    return int(kicks.at(np.array([complex(velocity).real]), np.array([complex(velocity).imag]))[0])


def test_parts_fill_the_disc_and_agree_with_the_claims(whole, half):
    for kicks in (whole, half):
        assert sum(part.share for part in kicks.parts) == pytest.approx(1.0, abs=1e-12)
        assert sum(part.share for part in kicks.parts if part.proven) == pytest.approx(kicks.share, abs=1e-12)
        slow, fast, first, last = kicks.edges.T
        assert ((fast**2 - slow**2) * (last - first)).sum() == pytest.approx(1.0, abs=1e-12)
    assert (whole.whole, whole.share, whole.open_share, whole.impacts) == (True, 1.0, 0.0, 1)
    assert (half.whole, half.share, half.impacts) == (False, 31 / 64, 0)
    assert half.all_up_to == pytest.approx(0.5 * half.largest)
    left = [part.share for part in half.parts if not part.proven]
    assert left == sorted(left, reverse=True)
    assert len({part.reason for part in half.parts if not part.proven}) == len(left) == 4


def test_words_say_no_more_than_is_proven(whole, half):
    assert whole.words == "every kick up to 2 c_r Ω comes back, after at most 1 impact"
    shown = half.words
    assert shown.startswith(
        f"{np.floor(1e4 * half.share) / 100.0:.4g} % of the kicks up to 140 mm/s come back, without an impact"
    )
    # Harmless kicks come back, whatever cells show of them.
    assert shown.endswith("and every one up to 109.8 mm/s")
    more = replace(half, all_up_to=2 * half.all_up_to)
    assert more.words.endswith("and every one up to 140 mm/s")
    assert replace(half, all_up_to=2 * half.all_up_to * (1 - 1e-9)).words.endswith("and every one up to 139.9 mm/s")
    assert replace(half, share=0.0).words == (
        "every kick up to 109.8 mm/s comes back; of those up to 140 mm/s no more is proven"
    )


def test_other_proofs_are_refused():
    with pytest.raises(InputError, match="proof = single-impact orbits: a proof of kicks"):
        ProvenKicks.of(prove({**BALANCED, "gamma": "3"}))
