"""Reproduction of the source paper: its figures 2 to 6, and its numbers and misprints compared with ours.

>>> from carom.reproductions import mora2014
>>> found = mora2014.reproduce()                      # all results, in less than a second once compiled
>>> for picture in mora2014.figures(found):           # figures 2 to 6
...     print(picture.name, picture.caption)
...     figure = picture.draw()                    # a matplotlib figure; picture.result is what it shows
>>> for row in found.numbers:                      # every number that the paper prints
...     print(row.place, row.quantity, row.printed, row.value, row.agrees, row.note)
>>> for row in found.misprints:                    # formulas that do not hold, evaluated beside the correct ones
...     print(row.place, row.printed, row.right, row.printed_value, row.value)
>>> mora2014.write_paper(found, "out")                # figures/figure-2.svg, …, paper.json, table.md

``carom paper --out DIR`` does the same.  The parts are available separately: :func:`shown_motions` (figure 2),
:func:`period_functions`, :func:`period_pairs` and :func:`birth` (figure 3), :func:`first_pair` (figures 4 and 6a),
:func:`radius_diagram` (figure 5), :func:`four_curves` and :func:`damping_stiffness_plane` (figure 6b).
"""

from carom.reproductions.mora2014.branches import first_pair
from carom.reproductions.mora2014.document import Picture, figures, paper_document, write_paper
from carom.reproductions.mora2014.extrema import radius_diagram
from carom.reproductions.mora2014.misprinted_forms import Misprint, misprints
from carom.reproductions.mora2014.motions import shown_motions
from carom.reproductions.mora2014.periods import birth, period_functions, period_pairs
from carom.reproductions.mora2014.plane import damping_stiffness_plane, four_curves
from carom.reproductions.mora2014.printed_numbers import PrintedNumber, numbers
from carom.reproductions.mora2014.reproduction import Reproduction, reproduce
from carom.reproductions.mora2014.source import machine_at

__all__ = [
    "Misprint",
    "Picture",
    "PrintedNumber",
    "Reproduction",
    "birth",
    "damping_stiffness_plane",
    "figures",
    "first_pair",
    "four_curves",
    "machine_at",
    "misprints",
    "numbers",
    "paper_document",
    "period_functions",
    "period_pairs",
    "radius_diagram",
    "reproduce",
    "shown_motions",
    "write_paper",
]
