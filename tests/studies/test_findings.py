"""What a study says of backward whirl: one limit of the damping or two, each for what it is."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import carom
from carom.attractors import MotionName
from carom.closed_forms.whirl import rolling
from carom.outcome import Outcome
from carom.studies import Wording
from carom.studies.endings import KickSize
from carom.studies.findings import _backward_whirl, _smallest_kick
from carom.studies.ranges import steady_range

SCALES = carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=184.2)
SOURCE = carom.parameters.Parameters(
    gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7, scales=SCALES
)


def said_of(parameters: carom.parameters.Parameters) -> str:
    study = SimpleNamespace(
        rotor=carom.models.Jeffcott(parameters),
        wording=Wording(parameters.scales),
        case=SimpleNamespace(parameters=parameters),
    )
    return _backward_whirl(study)


def test_two_limits_of_rolling_are_told_apart():
    text = said_of(SOURCE)
    roll, say = rolling(carom.models.Jeffcott(SOURCE)), Wording(SCALES)
    every_angle, bound = say.gain("gamma", roll.largest_damping), say.gain("gamma", roll.damping_bound)
    assert every_angle != bound
    assert (
        f"only damping above {bound} rules that out (from {every_angle} on it can roll for a part of each turn only, "
        "and slides in between)"
    ) in text
    # The smaller one is the threshold in the table.
    (threshold,) = steady_range(SOURCE, "rolling", "gamma").thresholds
    assert threshold.edge.value == roll.largest_damping


def test_a_balanced_rotor_has_one_limit_of_rolling():
    parameters = SOURCE.replace(rho=0.0)
    roll = rolling(carom.models.Jeffcott(parameters))
    assert roll.largest_damping == pytest.approx(roll.damping_bound, rel=1e-15)
    text = said_of(parameters)
    assert "rules that out. It surely gets there" in text
    # The two speeds of the runaway agree as well.
    assert "it may get there" not in text


def test_a_wall_of_steel_would_not_bear_it():
    """3.88 MN on a shaft of 80 mm: by the sentence, and by the numbers of the machine."""
    force = (SOURCE.radius_ratio**2 - SOURCE.omega**2 + SOURCE.rho) * SCALES.force
    share = force / (210e9 * 0.08) / 0.7e-3
    assert 0.1 < share < 1.0
    assert (
        f"a rigid wall is no model there: even solid steel gives way by at least {100 * share:.0f} % of the"
        in said_of(SOURCE)
    )
    # A rotor that turns slowly rolls with a force that steel bears; of a machine that is not known nothing is said.
    slow = SOURCE.replace(scales=carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=20.0))
    assert "rigid wall" not in said_of(slow)
    assert "rigid wall" not in said_of(SOURCE.replace(scales=None))
    fast = SOURCE.replace(scales=carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=3e4))
    assert "times the clearance" in said_of(fast)


@pytest.mark.parametrize(
    ("lost", "words"), [((0, 0, 5), "Kicks up to"), ((2, 3, 5), "the smallest tried"), ((0, 0, 0), "")]
)
def test_smallest_kick_is_a_bracket(lost, words):
    study = SimpleNamespace(wording=Wording(None))
    sizes = tuple(
        KickSize(speed, 12, 12 - count, {MotionName(Outcome.ROLLING): count} if count else {})
        for speed, count in zip((0.1, 0.2, 0.4), lost, strict=True)
    )
    text = _smallest_kick(study, sizes)
    assert words in text
    assert (text == "") == (not any(lost))
    if lost[0] == 0 and any(lost):
        assert "up to 0.2 c_r Ω came back in all directions tried; of 0.4 c_r Ω they did not in 5 of 12" in text


def test_dimensionless_limits_are_bare_numbers():
    text = said_of(SOURCE.replace(scales=None))
    assert "only γ above 8.57 rules that out (from 8.562 on it can roll" in text
    assert "that takes γ = 8.57)" in said_of(SOURCE.replace(scales=None, gamma=9.0))
