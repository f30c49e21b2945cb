"""The two objects that browser and server share: what the page asks for, and what the server answers."""

from __future__ import annotations

from bokeh.core import properties
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

    machine = properties.Any(default=None)
    kick = properties.Any(default=None)
    cancel = properties.Any(default=0)
    resume = properties.Any(default=0)
    wish = properties.Any(default=None)


class Answers(DataModel):
    """What the server has found; each answer is a dictionary made by :mod:`carom.explorer.page.messages`.

    ``reply`` answers each request for a machine at once: ``number`` of the request, ``shown``, the number of the request whose
    machine is shown, ``values`` of its controls in their units, and in ``text`` and ``names`` what could not be used.
    ``motion`` and ``beside`` are those after the kicks that are drawn.
    """

    state = properties.Any(default=None)
    reply = properties.Any(default=None)
    basin = properties.Any(default=None)
    motion = properties.Any(default=None)
    beside = properties.Any(default=None)
    table = properties.Any(default=None)
    loss = properties.Any(default=None)
    hardest = properties.Any(default=None)
    verdict = properties.Any(default=None)
    proven = properties.Any(default=None)
    diagram = properties.Any(default=None)
    exports = properties.Any(default=None)
    levitating = properties.Any(default=None)
    response = properties.Any(default=None)
