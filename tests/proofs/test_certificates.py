"""A certificate is verified by itself, and one that was changed is refused."""

import copy
import json
import random
import re
from fractions import Fraction

import machines
import pytest
from compilation import sized
from machines import PAPER
from refusals import assert_refused

from carom.base.outcome import InputError
from carom.proofs import Enclosure, check, prove

DECIMAL = {**machines.DECIMAL, "radius_ratio": "57"}


@pytest.fixture(scope="module")
def document():
    return json.loads(json.dumps(prove(DECIMAL).document()))


@pytest.mark.parametrize(
    "machine",
    [
        DECIMAL,
        {**DECIMAL, "d": "0"},
        {**DECIMAL, "gamma": ("0.1", "0.1000000001")},
        {**DECIMAL, "gamma": "0.05"},
        PAPER,
        "examples/keogh-cole.toml",
    ],
)
def test_certificate_is_verified(machine, tmp_path):
    proof = prove(machine)
    proof.save(tmp_path / "proof.json")

    assert check(tmp_path / "proof.json").claims == proof.claims


def test_check_searches_nothing(document, monkeypatch):
    for name in ("cells_of", "_longest_period", "_first_cell"):
        monkeypatch.setattr(f"carom.proofs.periods.{name}", None)

    assert len(check(document)) == len(document["claims"])


def test_any_digit_that_matters_is_refused(document):
    """A change that is not refused leaves all claims true: a cut of a cell elsewhere, or a wider enclosure."""
    original, text = prove(DECIMAL), json.dumps(document)
    drawn, refused = random.Random(4), 0
    places = [match.start() for match in re.finditer(r"[0-9]", text)]
    for place in drawn.sample(places, sized(20, 10, len(places))):
        digit = drawn.choice([other for other in "0123456789" if other != text[place]])
        try:
            changed = check(json.loads(text[:place] + digit + text[place + 1 :]))
        except InputError:
            refused += 1
            continue
        except json.JSONDecodeError:  # a number that begins with a zero
            continue
        assert changed.hypotheses == original.hypotheses
        for claim, known in zip(changed, original, strict=True):
            assert (claim.name, claim.statement, claim.status) == (known.name, known.statement, known.status)
            assert all(claim.enclosures[name].holds(entry) for name, entry in known.enclosures.items())
    assert refused > sized(5, 3, 2000)


def narrower(ends: list[str]) -> list[str]:
    low, high = (Fraction(end) for end in ends)
    return [f"{float(low):.12f}", f"{float(low):.12f}"] if low != high else [ends[0] + "1", ends[1] + "1"]


def test_every_enclosure_counts(document):
    for index in range(0, len(document["claims"]), sized(3, 9, 1)):
        claim = document["claims"][index]
        for name, ends in claim["enclosures"].items():
            changed = copy.deepcopy(document)
            changed["claims"][index]["enclosures"][name] = narrower(ends)
            with pytest.raises(InputError, match="is refused"):
                check(changed)


def test_every_status_statement_and_piece_of_evidence_counts(document):
    for index in range(0, len(document["claims"]), sized(5, 9, 1)):
        claim = document["claims"][index]
        other = "refuted" if claim["status"] == "proven" else "proven"
        for key, value in (
            ("status", other),
            ("statement", claim["statement"].replace("2", "3") + " "),
            ("about", "B9,d"),
        ):
            changed = copy.deepcopy(document)
            changed["claims"][index][key] = value
            with pytest.raises(InputError, match="is refused"):
                check(changed)
    for name in document["evidence"]:
        changed = copy.deepcopy(document)
        del changed["evidence"][name]
        with pytest.raises(InputError, match="is refused"):
            check(changed)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("format", "carom proof 2"),
        ("theorem", "all"),
        ("bits", 8),
        ("bits", 10**9),
        ("bits", "128"),
        ("claims", []),
        ("not_claimed", []),
        ("options", {"longest_period": "1e9999999999", "cells": 2000}),
        ("evidence", {}),
        ("hypotheses", {}),
        ("hypotheses", "machine"),
    ],
)
def test_damaged_certificate_is_refused_in_one_line(document, key, value):
    assert_refused(lambda: check({**document, key: value}), "is refused")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("cells of F1", 3),
        ("cells of F1", {"cuts": ["0", "1"], "kinds": "+"}),
        ("cells of F1", {"cuts": ["1", "1/2"], "kinds": "+"}),
        ("no period beyond", "1"),
        ("no period beyond", None),
        ("first cell", "10"),
        ("root 1 of F1", ["1", "2"]),
        ("root 1 of F1", ["1e999999999", "2"]),
    ],
)
def test_false_evidence_is_refused(document, name, value):
    with pytest.raises(InputError, match="is refused"):
        check({**document, "evidence": {**document["evidence"], name: value}})


def test_number_stated_much_wider_than_known_is_refused(document):
    changed = copy.deepcopy(document)
    claim = next(entry for entry in changed["claims"] if entry["kind"] == "solution" and entry["about"] == "B1,a")
    claim["enclosures"]["period"] = ["0", "100"]

    with pytest.raises(InputError, match="much wider"):
        check(changed)


def test_option_that_the_theorem_does_not_know_is_refused(document):
    with pytest.raises(InputError, match="its options must be longest_period, cells"):
        check({**document, "options": {**document["options"], "note": "no other motion of any kind"}})


def test_key_that_is_twice_in_a_file_is_refused(document, tmp_path):
    text = json.dumps(document)
    (tmp_path / "proof.json").write_text(text.replace('"gamma": "0.1"', '"gamma": "0.2", "gamma": "0.1"', 1))
    with pytest.raises(InputError, match="must be a JSON file"):
        check(tmp_path / "proof.json")


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        ("12", "123", "[12, 123]"),
        ("15", "16", "[15, 16]"),
        ("10.5", "105.2", "[10.5, 105.2]"),
        ("12345678901234567.1", "12345678901234567.2", "[12345678901234567.1, 12345678901234567.2]"),
        ("15.1", "15.2", "15.…"),
        ("15", "15", "15"),
    ],
)
def test_short_number_shows_no_digits_that_are_not_certain(low, high, words):
    assert Enclosure(low, high, (Fraction(low), Fraction(high))).short == words
