"""Every command that draws writes SVG and PNG, with the name of the machine and its present values."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_legends import fits

from carom import plots
from carom.cli.app import main

MACHINE = "examples/keogh-cole.toml"
NAMED = "keogh-cole: damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm"
SWEEP = """
machine = "{machine}"
[axes.stiffness]
from = "8e5 N/m"
to = "2e6 N/m"
count = 3
[axes.speed]
from = "1500 rpm"
to = "4000 rpm"
count = 3
[basins]
starts = 10
[basins.disturbance]
kind = "kick"
"""
COMMANDS = {
    "simulate": (
        ("simulate", MACHINE, "--kick", "51.576 mm/s,0.2 rad", "--until", "60"),
        {"figures/motion", "figures/touchdown"},
    ),
    "attractors": (("attractors", MACHINE, "--starts", "10"), {"figures/attractors"}),
    "basins": (("basins", MACHINE, "--grid", "6x6"), {"figures/basins"}),
    "response": (("response", MACHINE), {"figures/response"}),
    "bifurcations": (
        ("bifurcations", MACHINE, "--along", "speed", "--from", "1700 rpm", "--to", "1800 rpm"),
        {"figures/bifurcations-speed"},
    ),
    "regions": (
        ("regions", MACHINE, "--plane", "gamma,omega", "--x", "0.14,0.16", "--y", "0.75,0.77", "--grid", "3"),
        {"figures/regions-gamma-omega"},
    ),
}

pytestmark = pytest.mark.jit_only


@pytest.fixture
def drawn(monkeypatch):
    """The figures that are saved."""
    found, save = [], plots.save

    def kept(figure, *args):
        found.append(figure)
        return save(figure, *args)

    monkeypatch.setattr(plots, "save", kept)
    return found


def headings(figures):
    return [figure.get_suptitle().split("\n")[0] for figure in figures]


@pytest.mark.parametrize("command", COMMANDS)
def test_both_formats_with_name_and_present_values(command, drawn, tmp_path, capsys):
    words, stems = COMMANDS[command]
    assert main((*words, "--out", str(tmp_path / "out"))) == 0
    written = {str(file.relative_to(tmp_path / "out")) for file in (tmp_path / "out").rglob("*.*")}
    figures = {name for name in written if name.endswith((".svg", ".png"))}
    assert figures == {f"{stem}.{ending}" for stem in stems for ending in ("svg", "png")}
    assert headings(drawn) == [NAMED] * len(stems)
    assert all(fits(figure) for figure in drawn)
    if command == "bifurcations":
        (line,) = [line for line in drawn[0].axes[0].lines if line.get_gid() == "present"]
        assert line.get_xdata()[0] == pytest.approx(1758.98, abs=0.01)
        assert "present value: 1,759 rpm" in [text.get_text() for text in drawn[0].legends[0].get_texts()]


def test_maps_of_a_sweep(drawn, tmp_path, capsys):
    from pathlib import Path

    file = tmp_path / "sweep.toml"
    file.write_text(SWEEP.format(machine=Path(MACHINE).absolute()), encoding="utf-8")
    words = ("sweep", str(file), "--out", str(tmp_path / "store"), "--threads")
    assert main((*words, "--figures", str(tmp_path / "maps"))) == 0
    stems = ("recovered", "smallest_unrecovered_kick")
    assert {path.name for path in (tmp_path / "maps" / "figures").iterdir()} == {
        f"{s}.{e}" for s in stems for e in ("svg", "png")
    }
    assert headings(drawn) == [NAMED] * 2
    assert drawn[1].axes[1].get_ylabel().endswith("(mm/s)")
    (star,) = [line for line in drawn[0].axes[0].lines if line.get_gid() == "present"]
    assert (star.get_xdata()[0], star.get_ydata()[0]) == pytest.approx((980_000.0, 1758.98), rel=1e-5)


def test_a_sweep_over_three_axes_has_no_maps(tmp_path, capsys):
    file = tmp_path / "sweep.toml"
    more = "[axes.friction]\nfrom = 0.1\nto = 0.2\ncount = 2\n[basins]\nstarts"
    from pathlib import Path

    text = SWEEP.format(machine=Path(MACHINE).absolute()).replace("[basins]\nstarts", more)
    file.write_text(text, encoding="utf-8")
    assert main(("sweep", str(file), "--out", str(tmp_path / "store"), "--figures", str(tmp_path / "maps"))) == 2
    assert "--figures = " in capsys.readouterr().err
    assert not (tmp_path / "store").exists()


def test_a_kick_that_is_known_to_return_at_once_is_drawn_until_it_has_decayed(drawn, tmp_path, capsys):
    assert main(["simulate", "examples/tum-test-rig.toml", "--kick", "1 mm/s", "--out", str(tmp_path / "out")]) == 0
    assert "Decided at once" in capsys.readouterr().out
    (path, radius) = drawn
    assert "no impact in" in path.get_suptitle()
    assert "returns to levitation" in path.get_suptitle()
    (line,) = (line for line in radius.axes[0].lines if line.get_label() == "radius")
    assert np.ptp(line.get_xdata()) > 1.0
    assert line.get_ydata()[-1] == pytest.approx(line.get_ydata()[0], rel=0.01)
