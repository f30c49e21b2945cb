"""What the report begins with: the basin now and after the change that was checked."""

import pytest
from studies import study_once

from carom import load, map_basins
from carom.disturbances import KickPlane
from carom.report import figures

KEOGH_COLE = "examples/keogh-cole.toml"

pytestmark = pytest.mark.jit_only


def drawn(monkeypatch, result):
    """The panels and the size with which the pair is drawn."""
    kept = []
    monkeypatch.setattr(figures, "CELLS", {"kick": [(12, 12)] * 2, "shock": [(2, 8)] * 2, "blade_loss": [(12,)] * 2})
    monkeypatch.setattr(figures, "map_cells", map_basins)
    monkeypatch.setattr("carom.plots.basin_pair", lambda *arguments: kept.append(arguments))
    figures.draw_basins(result)
    return kept[0]


def test_the_change_is_the_one_that_was_checked(monkeypatch):
    real = study_once(load(KEOGH_COLE))
    ((now, here), (after, there)), required = drawn(monkeypatch, real)
    change = real.recommendation.changes[0]
    assert here.rotor.parameters == real.case.parameters
    assert there.rotor.value(change.parameter) == change.check.value
    assert (
        there.rotor.parameters.replace(**{change.parameter: real.case.parameters.value(change.parameter)})
        == here.rotor.parameters
    )
    assert here.plan == there.plan
    assert here.plan.model == KickPlane(real.required.kick)
    assert required == real.required.kick
    assert now == "now\nstiffness 980,000 N/m"
    assert after == f"after the change\nstiffness {change.terms.text}"
    assert there.share_recovered.fraction == 1.0
