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

``carom paper --out DIR`` does the same.  :func:`first_pair` follows the orbits of figures 4 and 6a alone.
"""

from carom.reproductions.mora2014.branches import first_pair
from carom.reproductions.mora2014.document import Picture, figures, paper_document, write_paper
from carom.reproductions.mora2014.misprinted_forms import Misprint
from carom.reproductions.mora2014.printed_numbers import PrintedNumber
from carom.reproductions.mora2014.reproduction import Reproduction, reproduce
from carom.reproductions.mora2014.source import machine_at

__all__ = [
    "Misprint",
    "Picture",
    "PrintedNumber",
    "Reproduction",
    "figures",
    "first_pair",
    "machine_at",
    "paper_document",
    "reproduce",
    "write_paper",
]
