"""One standard: a verdict and its advice follow what must be survived alone, and say so where too little of it was followed."""

import pytest
from machines import machine_file

import carom as cm
from carom.studies import questions
from carom.studies.advice import GAIN_FACTOR
from carom.studies.questions import about

pytestmark = pytest.mark.jit_only


def with_kick(machine, kick, settings=()):
    case = cm.load(machine, settings)
    return cm.study(case, requirement=cm.parameters.Requirement.of(case, kick=kick))


def test_no_change_beyond_what_a_controller_can_give_is_advised():
    """Damping of 3,600 N s/m brings all back (``tests/studies/test_advice.py``), 4.8 times the present one."""
    result = with_kick("examples/keogh-cole.toml", "166 mm/s", ["damping=750 N s/m"])
    assert all(1.0 / GAIN_FACTOR <= change.ratio <= GAIN_FACTOR for change in result.recommendation.changes)


def test_a_study_that_follows_too_few_says_neither_back_nor_lost(monkeypatch):
    monkeypatch.setattr(questions, "EVENTS", dict.fromkeys(questions.EVENTS, 1500))
    result = cm.study(cm.load(machine_file("heavy")))
    verdict = result.verdict
    assert verdict.level == "not-decided"
    assert verdict.lead.count("Undecided") == 1
    assert result.recommendation.kind == "not-decided"
    text = " ".join(fact.text for fact in result.facts).lower()
    assert "came back in every trial" not in text
    assert "none needed" not in text
    assert "at no damping tried" not in text
    assert not any(each.complete for each in result.recoveries)
    document = result.to_dict()
    missed = {each["question"]: each for each in document["not_reached"]}
    kicks = missed["the share of kicks that comes back"]
    assert kicks["followed"] < kicks["asked"]
    shown = about(result.facts, "Not reached")[0].text
    assert f"({kicks['followed']:,} of {kicks['asked']:,} motions)" in shown
