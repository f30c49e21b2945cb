"""The style sheet is carom's own affair, and every meaning can be stated without colour."""

import itertools
import subprocess
import sys

import matplotlib as mpl
import pytest

from carom import plots


def _draw_everything(damped, bouncing) -> None:
    plots.orbit(damped.orbits["B1,d"])
    plots.motion(bouncing)
    plots.radius(bouncing)
    plots.multipliers(damped.orbits)
    plots.equilibria_and_orbits(damped.orbits, damped.equilibria)


@pytest.mark.parametrize("settings", [{}, {"font.size": 23.0, "lines.linewidth": 9.0, "axes.grid": True}])
def test_settings_of_the_user_stay(damped, bouncing, settings):
    with mpl.rc_context(settings):
        before = dict(mpl.rcParams)
        _draw_everything(damped, bouncing)
        assert dict(mpl.rcParams) == before


def test_no_window_system_is_touched():
    """Pyplot holds global state and picks a backend; drawing and saving must do without."""
    program = """
import io, sys
import matplotlib
from carom import plots
figure = plots.multipliers([])
figure.savefig(io.BytesIO(), format="png")
print("matplotlib.pyplot" in sys.modules)
"""
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "False"


def test_what_draws_loads_nothing_that_computes():
    program = "import sys, carom.plots; print('numba' in sys.modules, 'carom.core' in sys.modules)"
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "False False"


def test_meanings_differ_in_line_or_marker_or_width_not_in_colour_alone():
    for (one, look), (other, another) in itertools.combinations(plots.LOOKS.items(), 2):
        same_shape = (look.line, look.marker) == (another.line, another.marker)
        # Solid lines without a marker are distinguished by their width.
        widths = sorted((look.width, another.width))
        assert not same_shape or widths[1] > 1.5 * widths[0], (one, other)


def test_meanings_have_words_and_colours_of_their_own():
    words = [look.words for look in plots.LOOKS.values()]
    assert len(set(words)) == len(words)
    hues = [plots.LOOKS[key].colour for key in ("stable", "unstable", "virtual", "contact-free", "rub", "wall")]
    assert len(set(hues)) == len(hues)
    with pytest.raises(TypeError):
        plots.LOOKS["stable"] = plots.LOOKS["unstable"]
