"""Multipliers next to the unit circle."""

import numpy as np

import carom
from carom import plots
from carom.plots.words import orbit_words


def _values(axes, name):
    (line,) = [line for line in axes.get_lines() if line.get_gid() == name]
    return np.sort_complex(np.asarray(line.get_xdata()) + 1j * np.asarray(line.get_ydata())), line


def test_multipliers_are_drawn_as_they_are(damped):
    orbit = damped.orbits["B1,d"]
    (axes,) = plots.multipliers([orbit]).axes
    values, _ = _values(axes, "B1,d")
    np.testing.assert_allclose(values, np.sort_complex(orbit.multipliers.values))
    (circle,) = [line for line in axes.get_lines() if line.get_gid() == "unit-circle"]
    np.testing.assert_allclose(np.hypot(*circle.get_data()), 1.0)
    assert axes.get_aspect() == 1.0
    assert axes.get_xlabel() == r"Re $\lambda$ (no unit)"
    (axes,) = plots.multipliers(damped.orbits).axes
    for each in damped.orbits:
        np.testing.assert_allclose(_values(axes, each.name)[0], np.sort_complex(each.multipliers.values))
    assert (axes.get_xscale(), axes.get_xlabel()) == ("symlog", r"Re $\lambda$ (no unit; logarithmic beyond 1)")


def test_many_virtual_orbits_share_a_marker(damped, read):
    orbits = carom.find_orbits(carom.models.jeffcott(damped.rotor.parameters.replace(gamma=0.02)))
    virtual = sum(not orbit.admissible for orbit in orbits)
    figure = plots.multipliers(orbits, virtual=True)
    assert len(read.legend(figure)) == len(orbits) - virtual + 1
    values, _ = _values(figure.axes[0], "virtual")
    assert len(values) == 3 * virtual


def test_no_orbits(read):
    assert read.legend(plots.multipliers([])) == ["no possible periodic orbit"]


def test_virtual_orbits_are_hidden_unless_asked_for(weak):
    possible = {orbit_words(orbit) for orbit in weak.orbits if orbit.admissible}
    (axes,) = plots.multipliers(weak.orbits).axes
    assert {text.get_text() for text in axes.figure.legends[0].get_texts()} == possible
    asked = plots.multipliers(weak.orbits, virtual=True)
    assert len(asked.legends[0].get_texts()) == len(weak.orbits) > len(possible)
