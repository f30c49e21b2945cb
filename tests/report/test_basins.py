"""What the report begins with: the basin now and after the change that was checked, or words where there is none."""

from dataclasses import replace
from pathlib import Path

import pytest
from studies import study_once

from carom.basins import map_basins
from carom.disturbances import BladeLoss, KickPlane
from carom.loading import load
from carom.parameters import Parameters, Requirement
from carom.report import basins, report_page
from carom.report.figures import pictures
from carom.studies import study
from carom.studies.advice import Recommendation

KEOGH_COLE = Path(__file__).parents[2] / "examples" / "keogh-cole.toml"
SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def real():
    return study_once(load(KEOGH_COLE))


def drawn(monkeypatch, result):
    """The panels and the size with which the pair is drawn."""
    kept = []
    monkeypatch.setattr(basins, "CELLS", {"kick": (12, 12), "shock": (2, 8), "blade_loss": (12,)})
    monkeypatch.setattr(basins, "map_cells", map_basins)
    monkeypatch.setattr("carom.plots.basin_pair", lambda *arguments: kept.append(arguments))
    basins.draw(result)
    return kept[0]


def test_the_change_is_the_one_that_was_checked(real, monkeypatch):
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


def test_more_than_must_be_survived_is_shown_where_that_is_survived(monkeypatch):
    case = load(KEOGH_COLE, ("eccentricity=0.1 mm",))
    result = study(replace(case, requirement=Requirement(kick=0.1)))
    assert result.verdict.level == "all-tried-came-back"
    ((_, here), (title, words)), required = drawn(monkeypatch, result)
    assert here.plan.model.fastest == pytest.approx(basins.BEYOND * result.survives.kick.size)
    assert required == pytest.approx(result.required.kick)
    assert title == "after a change"
    assert words.startswith("No change is needed")


def test_the_kind_most_often_lost_is_shown(monkeypatch):
    case = load(KEOGH_COLE, ("eccentricity=0.1 mm",))
    result = study(replace(case, requirement=Requirement(kick=0.1, blade_loss=12e-3, source="option")))
    ((_, here), (_, there)), required = drawn(monkeypatch, result)
    assert here.plan.model == there.plan.model == BladeLoss(result.required.blade_loss)
    assert required is None
    assert not here.recovered.all()
    assert there.recovered.all()
    assert result.verdict.reason == "most losses of a blade are not survived"
    assert result.present.returned[1].fraction < 0.5


@pytest.mark.parametrize(
    ("kind", "said"), [("no-change-found", "no damping or stiffness"), ("nothing-buildable", "magnetic bearings")]
)
def test_without_advice_words_say_so(kind, said, real, monkeypatch):
    changes = real.recommendation.changes if kind == "nothing-buildable" else ()
    result = replace(real, recommendation=Recommendation(kind, changes, ()))
    (_, (_, words)), _ = drawn(monkeypatch, result)
    assert words.startswith("No change is advised")
    assert said in words
    page = report_page(result, [])
    assert "after the change" not in page
    assert ("Beyond the limits" in page) == (kind == "nothing-buildable")


def test_without_levitation_only_the_changed_machine_has_a_basin(monkeypatch):
    result = study_once(SOURCE.replace(gamma=0.05))
    ((_, words), (_, there)), _ = drawn(monkeypatch, result)
    assert words == "There is no stable levitation to come back to."
    assert there.recovered[there.exists].all()
    told = {fact.label: fact for fact in result.facts if fact.topic == "Recommendation"}
    assert "worse" not in told["Then"].text
    assert next(fact.text for fact in result.facts if fact.label == "Coexisting").startswith("there ")

    hopeless = replace(result, recommendation=Recommendation("no-change-found", (), ()))
    assert not basins.drawable(hopeless)
    assert "basins" not in {picture.name for picture in pictures(hopeless)}
    assert "No basin is drawn" in report_page(hopeless, [])


def test_what_is_lost_is_said_by_its_share(real):
    share = real.present.returned[0]
    assert real.verdict.reason == "nearly all kicks of up to 166 mm/s do not come back"
    assert share.fraction < 0.05
    for fraction, said in ((0.3, "most kicks"), (0.7, "some kicks")):
        back = replace(share, fraction=fraction)
        changed = replace(real, present=replace(real.present, returned=(back, *real.present.returned[1:])))
        assert changed.verdict.reason.startswith(said)
