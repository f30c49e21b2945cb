"""What is proven of kicks, cell by cell."""

import pytest
from drawn_legends import fits, legend_words
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

from carom import plots
from carom.proofs import ProvenKicks, hypotheses_of
from carom.proofs.claims import Evidence
from carom.proofs.families import KICKS
from carom.proofs.kick_search import BITS
from carom.proofs.proving import proof_at

pytestmark = pytest.mark.jit_only


def test_cells_have_the_colour_of_their_part():
    # The slower half is proven, and nothing of the others.
    machine, options = hypotheses_of("examples/spindle.toml"), {"kicks_up_to": "150 mm/s", "most_impacts": 2}
    kicks = ProvenKicks.of(proof_at(BITS, KICKS.about, machine, options, Evidence({"cells": "v0vagmx"})))
    figure = kicks.plot()
    (axes,) = figure.axes
    drawn = [cells for cells in axes.collections if isinstance(cells, PolyCollection) and cells.get_gid()]
    assert [cells.get_gid() for cells in drawn] == ["proven" if part.proven else "open" for part in kicks.parts]
    counts = [len(cells.get_paths()) for cells in drawn]
    assert counts == [int((kicks.places == place).sum()) for place in range(len(kicks.parts))]
    colours = [tuple(cells.get_facecolor()[0, :3]) for cells in drawn]
    assert len(set(colours)) == len(colours)
    assert all(colour != to_rgb(look.colour) for colour in colours for look in plots.OUTCOMES.values())
    assert "proven, no contact: 25 %" in legend_words(figure)
    assert "no contact below 109.8 mm/s" in legend_words(figure)
    assert fits(figure)
