"""Figures of the source paper: what is drawn, in which look, under which words, and that nothing lies on anything."""

import json

import numpy as np
import pytest

from carom.plots.diagrams import POINTS
from carom.reproductions import mora2014


@pytest.fixture(scope="module")
def drawn():
    found = mora2014.reproduce()
    return found, {picture.name: (picture, picture.draw()) for picture in mora2014.figures(found)}


def test_orbits_of_figure_2_strike_the_circle_that_is_drawn(drawn):
    _, figures = drawn
    axes = figures["figure-2"][1].axes[:9]
    for fixed, rotating, radius in (axes[3:6], axes[6:9]):
        for frame in (fixed, rotating):
            struck = [line.get_xydata() for line in frame.lines if line.get_gid() in ("forward", "backward")]
            assert struck
            np.testing.assert_allclose(np.hypot(*np.concatenate(struck).T), 1.0, rtol=1e-9)
        assert max(line.get_ydata().max() for line in radius.lines if len(line.get_xdata()) > 100) == pytest.approx(1.0)


def test_zeros_of_figure_3(drawn):
    found, figures = drawn
    condition, zeros = figures["figure-3"][1].axes[:2]
    points = [line for line in condition.lines if line.get_marker() == "o"]
    for line, function in zip(points, found.periods.functions, strict=True):
        np.testing.assert_allclose(line.get_xdata(), function.roots[function.roots < 30.0])
    folds = [line for line in zeros.lines if line.get_marker() == POINTS["fold"].marker]
    assert len(folds) == len(found.periods.pairs) >= 5


@pytest.fixture(scope="module")
def written(found, tmp_path_factory):
    place = tmp_path_factory.mktemp("paper") / "out"
    shares = []
    files = mora2014.write_paper(found, str(place), progress=lambda report: shares.append(report.share))
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    return place, files


def test_all_files_are_there(written):
    place, files = written
    names = {f"figure-{number}.{ending}" for number in range(2, 7) for ending in ("svg", "png")}
    assert {path.name for path in (place / "figures").iterdir()} == names
    assert {path.name for path in place.iterdir()} == {"figures", "paper.json", "table.md"}
    assert {path.resolve() for path in files} == {path.resolve() for path in place.rglob("*.*")}
    assert all((place / "figures" / name).stat().st_size > 20_000 for name in names)


def test_document_has_every_row(found, written):
    place, _ = written
    document = json.loads((place / "paper.json").read_text(encoding="utf-8"))
    assert len(document["numbers"]) == len(found.numbers)
    for entry, row in zip(document["numbers"], found.numbers, strict=True):
        assert (entry["where"], entry["printed"], entry["value"]) == (row.place, row.printed, row.value)
        assert entry["difference"] == entry["value"] - entry["printed_value"]
    assert [entry["value"] for entry in document["misprints"]] == [row.value for row in found.misprints]
    assert [entry["name"] for entry in document["figures"]] == [f"figure-{number}" for number in range(2, 7)]
    assert "".join(panel for entry in document["figures"] for panel in entry["panels"]) == "abcabcabcdabab"
    assert {entry["kind"] for entry in document["curves"]} == {
        "fold",
        "boundary-equilibrium",
        "grazing",
        "period-doubling",
        "rub-fold",
    }
    assert {entry["name"] for entry in document["regions"]} == {"R1", "R2", "R3", "R4"}
    meeting = next(entry for entry in document["codim2"] if entry["kind"] == "fold + boundary-equilibrium")
    assert meeting["value"] == pytest.approx([0.1779723, 0.7811076], abs=5e-8)


def test_nothing_is_left_of_an_interrupted_write(found, tmp_path):
    def interrupt(report):
        if report.share > 0.0:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        mora2014.write_paper(found, str(tmp_path / "out"), progress=interrupt)
    assert list(tmp_path.iterdir()) == []
