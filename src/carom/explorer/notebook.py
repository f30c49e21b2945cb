"""The figure for notebooks: the plane of kicks and the motion after one of them, with the parts and the session of the page."""

from __future__ import annotations

import json
import math
import threading
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from carom.arguments import checked
from carom.explorer.computing.exports import Origin
from carom.explorer.page.kinds import explored_case_of, kind_of
from carom.explorer.page.scripts import PICTURES, joined
from carom.explorer.page.session import Session
from carom.models import Subject
from carom.outcome import CaromError
from carom.plots.style import LOOKS


@checked
def explore(machine: Subject) -> Any:
    """Where kicks of a machine lead, as a figure in a notebook: point at a kick, and the motion after it is shown.

    The figure is that of ``carom explore`` without its sliders.  Of a planar rotor two kicks are followed: of those
    that come back, and of those that are lost.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        A planar rotor in a touchdown bearing of any kind, or the case or model of a flexible machine, of which one kick is followed at
        each touchdown bearing.

    Returns
    -------
    anywidget.AnyWidget
        A notebook shows it if it stands at the end of a cell.  ``close()`` ends its work.

    Raises
    ------
    CaromError
        The extra ``carom[notebook]`` is not installed.
    InputError
        It is another model.

    See Also
    --------
    carom.map_basins : the ends of kicks and other disturbances as data, and as a figure on paper
    """
    origin = Origin("", (), explored_case_of(machine))
    kind = kind_of(origin)
    return _figure_class(kind.slots, kind.planes_shown, kind.frame, kind.reading)(origin)


@cache
def _figure_class(slots: tuple[str, ...], planes: int, frame: str, reading: str) -> type:
    """Class of the figure of machines with so many kicks and touchdown bearings."""
    try:
        from anywidget import AnyWidget
    except ModuleNotFoundError:
        raise CaromError(
            'figures in notebooks need anywidget; install it with: pip install "carom[notebook]"'
        ) from None

    class KickFigure(AnyWidget):  # type: ignore[misc]
        """The figure of one machine: what the browser asks for goes to a session of the page, and its answers come back."""

        _esm = script(slots, planes, frame, reading)

        def __init__(self, origin: Origin) -> None:
            super().__init__()
            self.case = origin.case
            ready = threading.Event()
            ready.set()  # kernels compile where they are first called
            self._session = Session(origin, self._answer, ready, wanted=("basin",))
            self._asked = {"machine": self._session.show, "kick": self._session.kick}
            self.on_msg(lambda _, content, buffers: self._asked[content["name"]](content["value"]))

        def _answer(self, name: str, value: Any) -> None:
            buffers: list[bytes] = []
            self.send({"name": name, "value": encoded(value, buffers)}, buffers)

        def close(self) -> None:
            """End all work."""
            self._session.close()
            super().close()

    return KickFigure


def encoded(value: Any, buffers: list[bytes]) -> Any:
    """A message as JSON; arrays become buffers, in the place of which their number and type stand."""
    if isinstance(value, dict):
        return {name: encoded(entry, buffers) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [encoded(entry, buffers) for entry in value]
    if isinstance(value, np.ndarray):
        buffers.append(value.tobytes())
        return {"buffer": len(buffers) - 1, "type": value.dtype.name}
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


@cache
def script(slots: tuple[str, ...], planes: int, frame: str, reading: str) -> str:
    """The figure as a module of JavaScript; see :class:`carom.explorer.page.kind.Kind`."""
    page = {
        "body": _beside("notebook.html"),
        "looks": {name: look.colour for name, look in LOOKS.items()},
        "slots": slots,
        "planes": planes,
        "frame": frame,
        "reading": reading,
    }
    return joined(PICTURES) + _beside("notebook.js").replace("PAGE", json.dumps(page), 1)


def _beside(name: str) -> str:
    return files("carom.explorer").joinpath(name).read_text(encoding="utf-8")
