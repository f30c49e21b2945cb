"""Advice: attacked with fresh disturbances of the fixed frame, in the terms of the file, within what the bearings can give."""

import math
import re

import numpy as np
import pytest
from machines import REAL

import carom as cm
from carom.models import jeffcott
from carom.motions import settle
from carom.parameters import Case, Machine, Zones
from carom.studies.advice import with_setting
from carom.studies.questions import about

pytestmark = pytest.mark.jit_only

GAINS = {
    "proportional_gain": "9000 A/m",
    "derivative_gain": "7 A s/m",
    "force_current_factor": "100 N/A",
    "negative_stiffness": "4.1e5 N/m",
    "magnetic_bearings": 2,
}


def machine_of(**changes):
    """The machine of the examples by the gains of its magnetic bearings."""
    given = dict(REAL.given_texts)
    fields = {name: next(iter(texts.values())) for name, texts in given.items() if name not in ("damping", "stiffness")}
    return Machine(**fields, **GAINS, **changes)


def case_of(machine):
    return Case("machine", machine.parameters, machine, Zones())


def fresh(rotor, speed, count, seed):
    """Kicks up to a speed, a tenth of them at it."""
    random = np.random.default_rng(seed)
    sizes = np.minimum(1.0, np.sqrt(1.1 * random.random(count)))
    kicks = speed * sizes * np.exp(2j * math.pi * random.random(count))
    return np.full(count, rotor.equilibrium), kicks


@pytest.mark.parametrize("kick", ["166 mm/s", "258 mm/s"])
def test_nothing_fresh_is_lost_at_advised_values(kick):
    case = cm.load("examples/keogh-cole.toml")
    result = cm.study(case, requirement=cm.parameters.Requirement.of(case, kick=kick))
    assert result.recommendation.kind == "change"
    for change in result.recommendation.changes:
        rotor = jeffcott(with_setting(case, change.terms).parameters)
        lost = ~settle(rotor, cm.State(*fresh(rotor, result.required.kick, 2000, 77))).recovered
        assert lost.sum() == 0, (kick, change.terms.setting)


def test_the_setting_can_be_pasted():
    result = cm.study(cm.load("examples/keogh-cole.toml"))
    for change in result.recommendation.changes:
        after = cm.load("examples/keogh-cole.toml", [change.terms.setting])
        assert after.parameters.value(change.parameter) == change.value
        shown = [fact.text for fact in about(result.facts, "Recommendation") if fact.label == "Set"]
        assert f'--set "{change.terms.setting}"' in shown


def test_gains_are_advised_where_the_file_has_gains():
    case = case_of(machine_of())
    result = cm.study(case)
    assert result.recommendation.kind == "change"
    entries = {change.parameter: change.terms.entry for change in result.recommendation.changes}
    assert set(entries.items()) <= {("gamma", "derivative_gain"), ("omega", "proportional_gain")}
    for change in result.recommendation.changes:
        text = next(fact.text for fact in about(result.facts, "Recommendation") if change.terms.text in fact.text)
        unit = "A s/m" if change.parameter == "gamma" else "A/m"
        assert re.search(rf"at least .*, searched to [\d,.]+ {unit}$", text)
        assert change.check.recovers
