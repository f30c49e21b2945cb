"""The figure for notebooks: the plane of kicks and the motion after one of them, with the parts and the session of the page."""

from __future__ import annotations

import json
import math
import threading
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import CaromError
from carom.explorer.computing.exports import Origin
from carom.explorer.page.questions import Questions
from carom.explorer.page.scripts import PICTURES, joined
from carom.explorer.page.session import Session
from carom.explorer.page.view import SLOTS
from carom.models import Subject, case_of
from carom.plots.style import LOOKS


@checked
def explore(machine: Subject) -> Any:
    """Where kicks of a machine lead, as a figure in a notebook: point at a kick, and the motion after it is shown.

    The figure is that of ``carom explore`` without its sliders.  Two kicks are followed at each touchdown bearing: of those that come
    back, and of those that are lost.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model

    Returns
    -------
    anywidget.AnyWidget
        A notebook shows it if it stands at the end of a cell.  ``close()`` ends its work.

    Raises
    ------
    CaromError
        The extra ``carom[notebook]`` is not installed.
    InputError
        It is none of these.

    See Also
    --------
    carom.map_basins : the ends of kicks and other disturbances as data, and as a figure on paper
    """
    origin = Origin("", (), case_of(machine))
    questions = Questions(origin)
    return _figure_class(questions.bearings, questions.frame)(origin)


@cache
def _figure_class(planes: int, frame: str) -> type:
    """Class of the figure of machines with so many touchdown bearings."""
    try:
        from anywidget import AnyWidget
    except ModuleNotFoundError:
        raise CaromError(
            'figures in notebooks need anywidget; install it with: pip install "carom[notebook]"'
        ) from None

    class KickFigure(AnyWidget):  # type: ignore[misc]
        """The figure of one machine: what the browser asks for goes to a session of the page, and its answers come back."""

        _esm = script(planes, frame)

        def __init__(self, origin: Origin) -> None:
            super().__init__()
            self.case = origin.case
            ready = threading.Event()
            ready.set()  # kernels compile where they are first called
            self._session = Session(origin, self._answer, ready, wanted=("basin",))
            self._asked = {"machine": self._session.show, "kick": self._session.kick}
            self.on_msg(lambda _, content, buffers: self._asked[content["name"]](content["value"]))

        def _answer(self, name: str, value: object) -> None:
            buffers: list[bytes] = []
            self.send({"name": name, "value": encoded(value, buffers)}, buffers)

        def close(self) -> None:
            """End all work."""
            self._session.close()
            super().close()

    return KickFigure


def encoded(value: object, buffers: list[bytes]) -> object:
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
def script(planes: int, frame: str) -> str:
    """The figure as a module of JavaScript; see :class:`carom.explorer.page.questions.Questions`."""
    page = {
        "body": _beside("notebook.html"),
        "looks": {name: look.colour for name, look in LOOKS.items()},
        "slots": SLOTS,
        "planes": planes,
        "frame": frame,
    }
    return joined(PICTURES) + _beside("notebook.js").replace("PAGE", json.dumps(page), 1)


def _beside(name: str) -> str:
    return files("carom.explorer").joinpath(name).read_text(encoding="utf-8")
