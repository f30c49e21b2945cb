"""``carom paper`` as a user calls it."""

import json

import pytest

from carom.reproductions import mora2014
from carom.reproductions.mora2014 import document as written


@pytest.fixture(scope="module")
def found():
    return mora2014.reproduce()


@pytest.fixture(autouse=True)
def computed_once(monkeypatch, found):
    monkeypatch.setattr(mora2014, "reproduce", lambda *, progress: found)


def test_table_alone(carom, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = carom("paper")
    assert (code, err) == (0, "")
    for word in ("0.0636", "0.0636105609", "0.178", "0.1780277257", "-0.497", "Misprints", "R3.1", "Used as given"):
        assert word in out
    assert list(tmp_path.iterdir()) == []


def test_json_is_one_object_and_nothing_else(carom):
    code, out, err = carom("paper", "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    rows = {row["quantity"]: row for row in document["numbers"]}
    assert rows["γ_graze, where B1,d grazes"]["value"] == pytest.approx(0.0636105609, abs=5e-11)
    assert rows["γ_graze, where B1,d grazes"]["agrees"] is True
    assert document["figures"] == []


def test_everything_to_a_directory(carom, tmp_path, monkeypatch):
    # The others are drawn in tests/reproductions/mora2014/test_drawing.py.
    for module in (mora2014, written):
        monkeypatch.setattr(module, "figures", lambda found, all_of=module.figures: all_of(found)[-1:])
    code, out, err = carom("paper", "--out", tmp_path / "deep" / "out", "--json")
    assert code == 0
    place = tmp_path / "deep" / "out"
    document = json.loads(out)
    assert document == json.loads((place / "paper.json").read_text(encoding="utf-8"))
    assert len(err.strip().splitlines()) == 1
    assert "figure-6.svg" in err
    assert [entry["name"] for entry in document["figures"]] == ["figure-6"]
    for ending in ("svg", "png"):
        assert (place / "figures" / f"figure-6.{ending}").stat().st_size > 20_000
    assert not list(tmp_path.glob("deep/.*"))
