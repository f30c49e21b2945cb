"""Smallest loss, hardest impulse and verdict are those of the library."""

import math

import pytest
from machines import PAPER
from studies import study_once

import carom
from carom.basins import smallest_unrecovered
from carom.disturbances import VelocityKick
from carom.explorer.computing import judgement
from carom.explorer.computing.judgement import find_hardest, find_loss, judge
from carom.explorer.computing.planes import DisturbancePlane
from carom.explorer.computing.rest import rest_of
from carom.models import jeffcott

ROTOR = jeffcott(PAPER.replace(gamma=0.2))
KICKS = DisturbancePlane("kick", "velocity", 1.0, 1.0)


@pytest.mark.jit_only
def test_the_smallest_loss_is_that_of_the_search():
    found = find_loss(ROTOR, KICKS, 1.0)
    assert found["size"] == smallest_unrecovered(ROTOR, VelocityKick(1.0)).size
    assert found["remark"].startswith("smallest of ")


def test_no_kick_of_the_set_strikes_harder(monkeypatch):
    monkeypatch.setattr(judgement, "SIZES", 2)
    monkeypatch.setattr(judgement, "DIRECTIONS", 5)
    found, rest = find_hardest(ROTOR, KICKS, 1.5), rest_of(ROTOR)
    impulses = [
        carom.simulate(
            ROTOR, rest.kicked(speed * math.cos(angle), speed * math.sin(angle)), settle=True
        ).contacts.normal_impulse.max(initial=0)
        for speed in (0.375, 1.125)
        for angle in (2.0 * math.pi * (place + 0.5) / 5 for place in range(5))
    ]
    assert found["peak_load"] == pytest.approx(max(impulses), rel=1e-12)
    assert found["remark"] == "in 10 kicks up to 1.5 c_r Ω"


def test_the_verdict_is_that_of_the_study_with_what_to_change(monkeypatch):
    case = carom.load("examples/keogh-cole.toml")
    monkeypatch.setattr(judgement, "study", lambda case, progress: study_once(case))
    found, verdict = judge(case), study_once(case).verdict
    assert (found["lead"], found["survived"]) == (verdict.lead, list(verdict.survived))
    assert found["advice"].startswith("Change: stiffness 980,000 N/m → at least ")
    assert found["advice"][len("Change: ") : -1] in [fact.text for fact in study_once(case).facts]
