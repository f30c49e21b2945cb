"""``paper.json``, ``table.md`` and the figures on disk."""

import json

import pytest

from carom.reproductions import mora2014


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
