"""Figures reach the disk whole or not at all, and always as the same bytes."""

import os

import pytest

from carom import plots
from carom.base.outcome import InputError


@pytest.fixture(scope="module")
def figure(damped):
    """To be left as it is."""
    return plots.orbit(damped.orbits["B1,b"])


@pytest.fixture
def changing(damped):
    return plots.multipliers(damped.orbits)


def test_name_may_hold_dots_and_folders_are_made(figure, tmp_path):
    written = plots.save(figure, tmp_path / "gamma=0.1" / "B1.b", formats=("svg", "png", "pdf"))
    assert [path.name for path in written] == ["B1.b.svg", "B1.b.png", "B1.b.pdf"]
    assert written[0].read_bytes().startswith(b"<?xml")
    assert written[1].read_bytes().startswith(b"\x89PNG")
    assert written[2].read_bytes().startswith(b"%PDF")


def test_same_figure_same_bytes(figure, damped, tmp_path):
    formats = ("svg", "png", "pdf")
    first = [path.read_bytes() for path in plots.save(figure, tmp_path / "a", formats)]
    again = [path.read_bytes() for path in plots.save(figure, tmp_path / "b", formats)]
    drawn_anew = plots.orbit(damped.orbits["B1,b"])
    anew = [path.read_bytes() for path in plots.save(drawn_anew, tmp_path / "c", formats)]
    assert first == again == anew


def test_words_need_no_font_of_the_reader(figure, tmp_path):
    (svg,) = plots.save(figure, tmp_path / "a", ("svg",))
    assert b"<text" not in svg.read_bytes()


def test_unknown_format_writes_nothing(figure, tmp_path):
    with pytest.raises(InputError, match="each entry one of: svg, pdf, png"):
        plots.save(figure, tmp_path / "a", ("svg", "bmp"))
    assert list(tmp_path.iterdir()) == []


def test_a_figure_that_cannot_be_drawn_leaves_the_old_file(changing, tmp_path):
    (old,) = plots.save(changing, tmp_path / "a", ("png",))
    before = old.read_bytes()
    changing.axes[0].set_xlabel("$\\broken{$")
    with pytest.raises(ValueError, match="broken"):
        plots.save(changing, tmp_path / "a", ("png",))
    assert old.read_bytes() == before
    assert list(tmp_path.iterdir()) == [old]


def test_a_write_that_fails_leaves_the_old_file_and_no_part(changing, tmp_path, monkeypatch):
    (old,) = plots.save(changing, tmp_path / "a", ("png",))
    before = old.read_bytes()
    changing.suptitle("another title")

    def fail(*_):
        raise OSError("disk full")

    monkeypatch.setattr(os, "replace", fail)
    monkeypatch.setattr("pathlib.Path.replace", fail)
    with pytest.raises(OSError, match="disk full"):
        plots.save(changing, tmp_path / "a", ("png",))
    assert old.read_bytes() == before
    assert list(tmp_path.iterdir()) == [old]
