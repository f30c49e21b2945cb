"""The spin-down of a study: within its events, and only where the file says what slows the shaft down."""

from dataclasses import replace

import pytest
from studies import study_once

import carom as cm
from carom.models import rotor_of
from carom.motions.budget import Budget
from carom.parameters import Drive
from carom.studies.questions import SPIN_DOWN, about, events_for
from carom.studies.standstill import spin_down_facts, spin_down_of

pytestmark = pytest.mark.jit_only


def test_a_shaft_that_stands_and_one_for_which_the_events_do_not_suffice():
    case = replace(cm.load("tests/machines/drive.toml"), drive=Drive("1e-4 kg m^2", brake="0.5 N m"))
    for events in (events_for(rotor_of(case), SPIN_DOWN), 1000):
        with Budget().question(SPIN_DOWN, events) as question:
            slowed = spin_down_of(case)
        assert question.followed == 1
        assert slowed.stands == (events > 1000)
        assert question.left > -1000
        first, second = spin_down_facts(slowed)
        assert ("The shaft stands" in first.text) == slowed.stands
        assert first.values["turns"] == slowed.turns
        assert "0-to-peak in the fixed frame" in second.text
        assert second.text.startswith("Energy into bearing: ")


def test_nothing_is_said_without_a_drive():
    case = cm.load("examples/overhung-rotor.toml")
    assert not list(spin_down_facts(spin_down_of(case)))


def test_a_study_states_it():
    found = study_once(cm.load("tests/machines/drive.toml"))
    (said, _) = about(found.facts, "Spin-down")
    assert said.text.startswith("The shaft stands 23.8 s after the release")
    assert found.spin_down.stands
