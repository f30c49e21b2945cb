"""carom's style sheet: applied while a figure is made, drawn or written, and at no other time."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Literal

from matplotlib import style

Purpose = Literal["page", "column", "slide"]

ONE_COLUMN, TWO_COLUMNS = 88 / 25.4, 180 / 25.4
"""Widths of figures of one column and of two [inch]."""
_SHEETS = ["carom.plots.carom", "carom.plots.slide"]
_in_use = ContextVar("_in_use", default=False)
made_for: ContextVar[Purpose] = ContextVar("made_for", default="page")
"""What figures are made for now."""


@contextmanager
def applied() -> Iterator[None]:
    """Apply carom's style sheet inside a ``with`` block.

    The sheet starts from matplotlib's defaults, so a figure does not depend on the settings of the user.  When the
    block ends, ``matplotlib.rcParams`` is restored.  Inside such a block nothing is changed: changing all settings takes
    milliseconds.
    """
    if _in_use.get():
        yield
        return
    with style.context(_SHEETS[: 1 + (made_for.get() == "slide")], after_reset=True):
        before = _in_use.set(True)
        try:
            yield
        finally:
            _in_use.reset(before)


@contextmanager
def drawing() -> Iterator[None]:
    """Apply the style sheet for a drawing, with the garbage collector switched off.

    A figure consists of tens of thousands of small objects that refer to each other. Collecting garbage while they are
    created finds none, and takes a quarter of the time.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        with applied():
            yield
    finally:
        if collecting:
            gc.enable()
