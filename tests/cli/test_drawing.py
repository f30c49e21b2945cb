"""Every command that draws writes SVG and PNG, with the name of the machine and its present values."""

import pytest
from drawn_legends import fits

from carom import plots
from carom.cli.app import main

MACHINE = "examples/keogh-cole.toml"
NAMED = "keogh-cole: damping 1,400 N s/m, stiffness 980,000 N/m, speed 1,759 rpm"
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


@pytest.mark.parametrize("command", COMMANDS)
def test_both_formats_with_name_and_present_values(command, drawn, tmp_path, capsys):
    words, stems = COMMANDS[command]
    assert main((*words, "--out", str(tmp_path / "out"))) == 0
    written = {str(file.relative_to(tmp_path / "out")) for file in (tmp_path / "out").rglob("*.*")}
    figures = {name for name in written if name.endswith((".svg", ".png"))}
    assert figures == {f"{stem}.{ending}" for stem in stems for ending in ("svg", "png")}
    assert [figure.get_suptitle().split("\n")[0] for figure in drawn] == [NAMED] * len(stems)
    assert all(fits(figure) for figure in drawn)
    if command == "bifurcations":
        (line,) = [line for line in drawn[0].axes[0].lines if line.get_gid() == "present"]
        assert line.get_xdata()[0] == pytest.approx(1758.98, abs=0.01)
        assert "present value: 1,759 rpm" in [text.get_text() for text in drawn[0].legends[0].get_texts()]
