"""The program that checks certificates by itself confirms what carom proves, and refuses what was forged."""

import ast
import copy
import importlib.util
import json
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from machines import DECIMAL as PAPER

from carom.proofs import prove, prove_kicks, prove_states

PROGRAM = Path(__file__).parents[2] / "tools" / "check_certificate.py"
KEOGH = Path("examples/keogh-cole.toml")


def loaded():
    spec = importlib.util.spec_from_file_location("check_certificate", PROGRAM)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


PROGRAM_OF = loaded()


def report_of(document):
    return PROGRAM_OF.check(json.dumps(document))


def refused(document):
    """What is refused of a certificate, or why all of it is."""
    try:
        return [f"{what}: {why}" for verdict, what, why in report_of(document).lines if verdict == "refused"]
    except PROGRAM_OF.RefusedError as problem:
        return [str(problem)]


@pytest.fixture(scope="module")
def paper():
    return prove(PAPER).document()


@pytest.fixture(scope="module")
def doubled():
    return prove({**PAPER, "gamma": "0.0832"}, impacts=2).document()


@pytest.fixture(scope="module")
def along():
    return prove(PAPER, along="rho", interval=("0.4340", "0.4341")).document()


OTHERS = {"whirl"}
"""What the program knows no claims about."""


def not_covered(document):
    """Subjects of the claims that the program leaves alone."""
    return {what.partition(":")[0] for verdict, what, _ in report_of(document).lines if verdict == "not covered"}


def decimal(number):
    """A rational number with 80 digits behind the point."""
    sign, size = "-" if number < 0 else "", abs(number)
    whole, rest = divmod(round(size * 10**80), 10**80)
    return f"{sign}{whole}.{rest:080d}"


def changed(document, about, kind, **entries):
    new = copy.deepcopy(document)
    claim = next(c for c in new["claims"] if (c["about"], c["kind"]) == (about, kind))
    claim.update(entries)
    return new


def test_it_needs_python_flint_and_nothing_else():
    imported = set()
    for node in ast.walk(ast.parse(PROGRAM.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            imported |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            imported.add(node.module.split(".")[0])
    assert imported - set(sys.stdlib_module_names) == {"flint"}


def test_it_is_run_with_a_file_and_prints_a_line_for_each_claim(tmp_path, paper):
    file = tmp_path / "proof.json"
    file.write_text(json.dumps(paper), encoding="utf-8")
    done = subprocess.run([sys.executable, "-I", PROGRAM, file], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (3, "")
    *lines, last = done.stdout.splitlines()
    assert len(lines) == len(paper["claims"]) + 2
    assert re.fullmatch(r"Not the whole certificate is confirmed: \d+ claims are not covered by this program\.", last)
    file.write_text(json.dumps(changed(paper, "B1,d", "stable", status="refuted")), encoding="utf-8")
    done = subprocess.run([sys.executable, "-I", PROGRAM, file], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "refused        B1,d: stable" in done.stdout
    assert (
        subprocess.run([sys.executable, PROGRAM, tmp_path / "none"], capture_output=True, check=False).returncode == 1
    )


def test_claims_options_and_lists_that_are_not_known_are_refused_in_every_kind(
    paper, doubled, along, kicks, box, states
):
    # A certificate of each kind.
    kinds = {document["theorem"]: document for document in (paper, doubled, along, kicks, box, states)}
    assert set(kinds) | {"shocks", "unbalance steps"} == set(PROGRAM_OF.THEOREMS) == set(PROGRAM_OF.FORMS)
    for document in kinds.values():
        unknown = {**document["claims"][0], "kind": "recovers at once"}
        for change in (
            {"claims": [*document["claims"], unknown]},
            {"options": {**document["options"], "further": 1}},
            {"not_claimed": document["not_claimed"][1:]},
        ):
            assert len(refused({**document, **change})) == 1


MACHINES = {
    "paper": PAPER,
    "no rebound": {**PAPER, "d": "0", "gamma": "0.05"},
    "elastic": {**PAPER, "d": "1", "mu": "0.21", "gamma": "0.21", "omega": "0.93", "rho": "0.35"},
    "no friction": {**PAPER, "mu": "0"},
    "no damping": {**PAPER, "gamma": "0", "rho": "0.8"},
    "critical damping": {**PAPER, "omega": "0.5", "gamma": "1"},
    "strong damping": {**PAPER, "gamma": "2.5"},
    "small rotor": {**PAPER, "radius_ratio": "0.7"},
    "no levitation": {**PAPER, "gamma": "0.05"},
}


@pytest.mark.parametrize("name", MACHINES)
def test_machines_of_every_sort_are_confirmed(name):
    document = prove(MACHINES[name], longest_period="12" if name == "no damping" else None).document()
    assert refused(document) == []
    assert not_covered(document) <= OTHERS


def test_orbits_of_several_impacts_are_confirmed(doubled):
    lines = {what: verdict for verdict, what, _ in report_of(doubled).lines}
    assert refused(doubled) == []
    assert {lines[f"orbit 1: {kind}"] for kind in ("exists", "admissible", "stable")} == {"checked"}


def test_points_and_intervals_are_confirmed(along):
    found = report_of(along)
    assert not found.refused
    assert not_covered(along) <= OTHERS | {"levitation", "rub 1", "rub 2", "kick"}
    assert ("checked", "non-smooth-hopf: of B1,a", "") in found.lines


@pytest.mark.parametrize(
    ("interval", "point"),
    [
        (("0.176", "0.181"), "fold: of B1,b"),
        (("0.0635", "0.0637"), "grazing: of B1,d"),
        (("0.36", "0.38"), "rub-fold: of rub"),
    ],
)
def test_points_along_the_damping_are_confirmed(interval, point):
    document = prove(PAPER, along="gamma", interval=interval).document()
    about = {what: verdict for verdict, what, _ in points_only(document)}
    assert about[point] == about[f"{point} transversal"] == "checked"
    assert "refused" not in about.values()


def points_only(document):
    """The lines about points, without the work that intervals take."""
    report = PROGRAM_OF.Report()
    PROGRAM_OF.ctx.prec = PROGRAM_OF.BITS
    exact = PROGRAM_OF.exact_numbers(document["hypotheses"])
    along = PROGRAM_OF.Along(document["hypotheses"], exact, document["options"]["along"])
    for (about, first), facts in PROGRAM_OF.points_of(along, document["claims"], report).items():
        for claim in document["claims"]:
            if claim["about"] == about and claim["kind"].startswith(first):
                report.each([claim], lambda c, f=first, of=facts: PROGRAM_OF.judge(c, of[c["kind"][len(f) :].strip()]))
    return report.lines


# ---------------------------------------------------------------------------------------------------------- forgeries


def test_a_number_that_is_not_in_its_interval_is_refused(paper, doubled):
    for document, picks in ((paper, (0, 4, 7, 11, -1)), (doubled, (-1,))):
        stating = [c for c in document["claims"] if c["enclosures"] and c["about"] not in OTHERS]
        for pick in picks:
            claim = stating[pick]
            name, (low, high) = list(claim["enclosures"].items())[-1]
            width = Fraction(high) - Fraction(low)
            ends = [decimal(Fraction(high) + k * width + Fraction(1, 10**60)) for k in (3, 5)]
            forged = changed(document, claim["about"], claim["kind"], enclosures={**claim["enclosures"], name: ends})
            assert len(refused(forged)) >= 1, (claim["about"], claim["kind"])
            turned = changed(
                document, claim["about"], claim["kind"], enclosures={**claim["enclosures"], name: [high, low]}
            )
            assert len(refused(turned)) >= 1


@pytest.mark.parametrize(
    ("about", "kind"),
    [("levitation", "inside"), ("rub 2", "attracts sliding"), ("kick", "harmless"), ("machine", "periods"), ("machine", "slip"),
     ("machine", "orbits"), ("B1,a", "stable"), ("B1,d", "stable"), ("B1,b", "inside"), ("B1,c", "admissible")],
)  # fmt: skip
def test_a_status_turned_round_is_refused(paper, about, kind):
    was = next(c for c in paper["claims"] if (c["about"], c["kind"]) == (about, kind))["status"]
    forged = changed(paper, about, kind, status="refuted" if was == "proven" else "proven", reason="")
    assert [line for line in refused(forged) if line.startswith(f"{about}: {kind}")]


def test_claims_missing_twice_and_swapped_are_refused(paper, doubled):
    for k, claim in enumerate(paper["claims"]):
        if claim["about"] in OTHERS:
            continue
        without = {**paper, "claims": paper["claims"][:k] + paper["claims"][k + 1 :]}
        assert any("missing" in line for line in refused(without))
    assert refused({**paper, "claims": [*paper["claims"], paper["claims"][3]]}) == ["rub 1: pressed: it is there twice"]
    names = {"B1,b": "B1,d", "B1,d": "B1,b"}
    swapped = copy.deepcopy(paper)
    for claim in swapped["claims"]:
        claim["about"] = names.get(claim["about"], claim["about"])
    assert refused(swapped)
    listed = [c for c in doubled["claims"] if c["about"] == "orbit 1"]
    twice = {**doubled, "claims": [*doubled["claims"], *({**c, "about": "orbit 9"} for c in listed)]}
    assert refused(twice) == ["orbit 9: it is orbit 1, listed twice"]
    run_on = copy.deepcopy(listed)
    exists = next(c for c in run_on if c["kind"] == "exists")
    exists["enclosures"] = {name: exists["enclosures"][name.replace("2", "1")] for name in exists["enclosures"]}
    assert refused({**doubled, "claims": [*doubled["claims"], *({**c, "about": "orbit 9"} for c in run_on)]})


def test_an_orbit_that_is_a_shorter_one_run_twice_is_refused(doubled):
    one = {c["kind"]: c for c in doubled["claims"] if c["about"] == "B1,d"}["solution"]["enclosures"]
    document = copy.deepcopy(doubled)
    exists = next(c for c in document["claims"] if c["about"] == "orbit 1" and c["kind"] == "exists")
    numbers = {"radial_speed": one["radial_speed"], "angular_speed": one["angular_speed"], "duration": one["period"]}
    for k in (1, 2):
        exists["enclosures"].update({f"{name} {k}": pair for name, pair in numbers.items()})
    assert any(line.startswith("orbit 1") for line in refused(document))


def test_other_lists_of_motions_counts_and_texts_are_refused(paper):
    orbits = next(c for c in paper["claims"] if c["kind"] == "orbits")["statement"]
    assert refused(changed(paper, "machine", "orbits", statement=orbits.replace(", B1,d", "")))
    assert refused(changed(paper, "machine", "periods", statement="F1 has exactly 3 roots T > 0, each of them simple."))
    assert refused(changed(paper, "B1,d", "stable", statement="All multipliers are real."))
    assert refused(changed(paper, "B1,a", "stable", reason="a multiplier is below -1"))
    assert refused(changed(paper, "B1,d", "stable", reason="as everybody knows"))


def test_hypotheses_and_formats_that_are_not_right_are_refused(paper):
    exact = paper["hypotheses"]["exact"]
    other = {**paper, "hypotheses": {**paper["hypotheses"], "exact": {**exact, "gamma": "11/100"}}}
    assert refused(other) == ["the exact numbers do not follow from the values: gamma"]
    assert refused({**paper, "format": "carom proof 2"})
    assert refused({**paper, "theorem": "all is well"})
    assert refused({**paper, "more": 1})
    for text in ("", "[]", '{"format": 1, "format": 2}', "{", "[" * 100_000):
        with pytest.raises(PROGRAM_OF.RefusedError):
            PROGRAM_OF.check(text)


def test_points_and_intervals_that_are_forged_are_refused(along):
    by_kind = {(c["about"], c["kind"]): c for c in along["claims"]}
    point = by_kind["non-smooth-hopf", "of B1,a"]
    moved = {**point["enclosures"], "value": ["0.43408", "0.43409"]}
    slope = {"speed_slope": ["0.4", "0.5"], "reach": ["-5.7", "-5.6"]}
    wide = {**point["enclosures"], "period box": ["0.5", "9"]}
    for kind, entries in (
        ("of B1,a", {"enclosures": moved}),
        ("of B1,a", {"enclosures": wide}),
        ("of B1,a transversal", {"enclosures": slope}),
        ("of B1,a motion", {"status": "refuted", "reason": "it would cross the wall between its impacts"}),
    ):
        claims = [
            c for c in changed(along, "non-smooth-hopf", kind, **entries)["claims"] if c["about"] in PROGRAM_OF.POINTS
        ]
        lines = points_only_safe({**along, "claims": claims})
        assert lines, kind
    gap = [c for c in along["claims"] if not (c["kind"] == "orbits" and c["status"] == "undecided")]
    assert refused({**along, "claims": gap}) == ["the stretches do not cover the interval in order"]


def points_only_safe(document):
    """What is refused of points, also where the point itself is."""
    report = PROGRAM_OF.Report()
    PROGRAM_OF.ctx.prec = PROGRAM_OF.BITS
    exact = PROGRAM_OF.exact_numbers(document["hypotheses"])
    along = PROGRAM_OF.Along(document["hypotheses"], exact, document["options"]["along"])
    points = PROGRAM_OF.points_of(along, document["claims"], report)
    problems = [facts for facts in points.values() if isinstance(facts, str)]
    return problems or [line for line in points_only(document) if line[0] == "refused"]


# ------------------------------------------------------------------------------------------------------------- kicks


@pytest.fixture(scope="module")
def kicks():
    """Of a spindle, kicks up to 120 mm/s."""
    return json.loads((Path(__file__).parent / "kicks.json").read_text(encoding="utf-8"))


def test_the_shares_of_kicks_follow_from_the_cells_and_kicks_in_them_return(kicks, monkeypatch):
    monkeypatch.setattr(PROGRAM_OF, "MOST_FLIGHTS", 40)
    monkeypatch.setattr(PROGRAM_OF, "MOST_PARTS", 20)
    verdict, what, why = next(line for line in report_of(kicks).lines if "recover" in line[1])
    assert (verdict, what) == ("not covered", "kicks: recover")
    assert "40 kicks" in why
    assert float(re.search("all kicks of (\\S+) of", why)[1]) > 0.6


def test_cells_of_kicks_that_are_forged_are_refused(kicks, monkeypatch):
    monkeypatch.setattr(PROGRAM_OF, "MOST_FLIGHTS", 60)
    monkeypatch.setattr(PROGRAM_OF, "MOST_PARTS", 2)
    cells = kicks["evidence"]["cells"]
    first = cells.index("1")
    for letters in (
        cells.replace("1", "0"),
        cells[:-1],
        cells + "1",
        cells[:first] + "g" + cells[first + 1 :],
        cells.replace("v", "!"),
    ):
        assert refused({**kicks, "evidence": {**kicks["evidence"], "cells": letters}})
    claim = kicks["claims"][0]
    for name in claim["enclosures"]:
        forged = changed(kicks, "kicks", "recover", enclosures={**claim["enclosures"], name: ["0.5", "0.6"]})
        assert refused(forged)
    assert refused(changed(kicks, "kicks", "all recover", status="proven", reason=""))
    for claims in ([], kicks["claims"][:1], kicks["claims"][1:]):
        assert refused({**kicks, "claims": claims})


@pytest.fixture(scope="module")
def box():
    """Of the spindle for all dampings within 20 %, kicks up to 111 mm/s."""
    spindle, along = KEOGH.with_name("spindle.toml"), {"damping": ("280 N s/m", "420 N s/m")}
    proof = prove_kicks(str(spindle), "111 mm/s", along=along, most_impacts=1, time_limit=None, workers=1)
    return json.loads(json.dumps(proof.document()))


def test_kicks_of_machines_of_a_box_return(box):
    lines = {what: (verdict, why) for verdict, what, why in report_of(box).lines}
    closed = sum(letter in "01" for letter in box["evidence"]["cells"])
    assert lines["kicks: all recover"] == (
        "not covered",
        f"it follows from the cells; {closed} kicks in the middle of cells return",
    )
    assert refused(box) == []


def test_boxes_of_kicks_that_are_forged_are_refused(box):
    cells, (entry,) = box["evidence"]["cells"], box["options"]["box"]
    for letters in (cells[:-1], f"{cells}0", cells.replace("1", "0"), cells.replace("1", "g", 1), "q00"):
        assert refused({**box, "evidence": {"cells": letters}})
    for entries in (
        [["damping", "280 N s/m", "430 N s/m"]],
        [],
        [entry, entry],
        [["damping", "420 N s/m", "280 N s/m"]],
    ):
        assert refused({**box, "options": {**box["options"], "box": entries}})
    claim = box["claims"][0]
    for name in ("share_proven", "share_open", "speed_si"):
        assert refused(changed(box, "kicks", "recover", enclosures={**claim["enclosures"], name: ["0.5", "0.6"]}))
    (all_recover,) = (each for each in box["claims"] if each["kind"] == "all recover")
    forged = all_recover["statement"].replace("at most 1 impact", "at most 0 impacts")
    assert forged != all_recover["statement"]
    assert refused({**box, "claims": [*box["claims"], all_recover]})
    others = [each for each in box["claims"] if each is not all_recover]
    assert refused({**box, "claims": [*others, {**all_recover, "statement": forged}]})


@pytest.fixture(scope="module")
def states():
    return prove_states({**PAPER, "gamma": "1"}, "1").document()


def test_all_states_are_not_covered(states):
    assert {verdict for verdict, what, _ in report_of(states).lines if "states" in what} == {"not covered"}
