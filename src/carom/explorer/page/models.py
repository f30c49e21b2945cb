"""The two objects that browser and server share: what the page asks for, and what the server answers."""

from __future__ import annotations

from bokeh.core.properties import Any
from bokeh.model import DataModel


class Requests(DataModel):
    """What the page asks for; each request is a plain dictionary that the browser replaces as a whole.

    ``machine`` holds ``number``, ``settings`` (text by name), ``held`` (whether a slider is being dragged), ``along``
    (the control moved last) and ``view``: the ``kind`` of disturbances shown, the ``largest`` of the picture and the
    ``kicks`` that are drawn, all of which may be missing.  ``kick`` holds ``number``, ``slot`` (from 0), ``first`` and
    ``second``: one of them, by its components.  Sizes are in the unit that people see.
    ``cancel`` and ``resume`` count how often what takes long was stopped, and begun again.  ``wish`` holds the ``name`` of what takes long and is
    begun only so, and counts how often it was asked for.
    """

    machine = Any(default=None)
    kick = Any(default=None)
    cancel = Any(default=0)
    resume = Any(default=0)
    wish = Any(default=None)


class Answers(DataModel):
    """What the server has found; each answer is a dictionary made by :mod:`carom.explorer.page.messages`.

    ``reply`` answers each request for a machine at once: ``number`` of the request, ``shown``, the number of the request whose
    machine is shown, ``values`` of its controls in their units, and in ``text`` and ``names`` what could not be used.
    ``motion`` and ``beside`` are those after the kicks that are drawn.
    """

    state = Any(default=None)
    reply = Any(default=None)
    basin = Any(default=None)
    motion = Any(default=None)
    beside = Any(default=None)
    table = Any(default=None)
    loss = Any(default=None)
    hardest = Any(default=None)
    verdict = Any(default=None)
    proven = Any(default=None)
    diagram = Any(default=None)
    exports = Any(default=None)
    levitating = Any(default=None)
    response = Any(default=None)
