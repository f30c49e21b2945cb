"""Everything in one picture."""

import numpy as np
import pytest

import carom
from carom import plots


def _texts(axes):
    return {text.get_text() for text in axes.texts} - {""}


def test_every_equilibrium_is_at_its_place(damped, read):
    figure = plots.equilibria_and_orbits(damped.orbits, damped.equilibria)
    whole = figure.axes[0]
    for kind in ("contact-free", "rub"):
        drawn = [complex(line.get_xdata()[0], line.get_ydata()[0]) for line in read.lines(whole, kind)]
        wanted = [damped.mm * point.position for point in damped.equilibria if point.kind == kind]
        np.testing.assert_allclose(sorted(drawn, key=abs), sorted(wanted, key=abs))
    saddle, stable = sorted(read.lines(whole, "rub"), key=lambda line: line.get_xdata()[0])
    assert saddle.get_markerfacecolor() == "white"
    assert stable.get_markerfacecolor() == plots.LOOKS["rub"].colour


def test_equilibria_alone_are_drawn_in_the_units_of_the_machine(damped, read):
    (axes,) = plots.equilibria(carom.find_equilibria(damped.rotor)).axes
    (wall,) = read.lines(axes, "wall")
    np.testing.assert_allclose(np.hypot(*wall.get_data()), damped.mm)
    assert axes.get_xlabel() == "position Re $U$ (mm)"
    drawn = [complex(*line.get_xydata()[0]) for line in axes.get_lines() if line.get_gid() in ("contact-free", "rub")]
    np.testing.assert_allclose(drawn, [damped.mm * entry.position for entry in damped.equilibria])


def test_words(damped, read):
    figure = plots.equilibria_and_orbits(damped.orbits, damped.equilibria, title="A machine")
    assert figure.get_suptitle() == "A machine"
    assert set(read.legend(figure)) == {
        "clearance circle (touchdown bearing)",
        "levitation: admissible, stable",
        "synchronous rub: admissible, stable",
        "synchronous rub: admissible, unstable",
        "periodic orbit: admissible, stable",
        "periodic orbit: admissible, unstable",
    }
    assert figure.axes[0].get_xlabel() == "position Re $U$ (mm)"


def test_virtual_orbits_are_hidden_unless_asked_for(weak, read):
    figure = plots.equilibria_and_orbits(weak.orbits, weak.equilibria)
    (axes, *_) = figure.axes
    assert len(read.lines(axes, "path")) == 1
    assert read.lines(axes, "outside") == read.lines(axes, "virtual") == []
    assert not any("virtual" in words for words in read.legend(figure) if "orbit" in words)


def test_virtual_orbits_are_faint(weak, read):
    figure = plots.equilibria_and_orbits(weak.orbits, weak.equilibria, virtual=True)
    whole = figure.axes[0]
    pale = plots.LOOKS["outside"]
    virtual = [orbit for orbit in weak.orbits if not orbit.admissible]
    drawn = read.lines(whole, "path") + read.lines(whole, "outside")
    faint = [line for line in drawn if line.get_color() == pale.colour and line.get_linestyle() == pale.line]
    strong = [line for line in drawn if line not in faint]
    assert len(faint) >= len(virtual)
    assert len(strong) == 1
    assert strong[0].get_color() == plots.LOOKS["unstable"].colour
    assert "levitation: virtual, not physical" in read.legend(figure)


@pytest.mark.parametrize("case", ["damped", "weak"])
def test_names_do_not_overlap(case, request, read):
    motions = request.getfixturevalue(case)
    figure = plots.equilibria_and_orbits(motions.orbits, motions.equilibria)
    for axes in figure.axes:
        boxes = read.boxes(axes)
        for i, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[i + 1 :])
