"""The figures of the source paper, with captions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from carom.base.results import Result
from carom.reproductions.mora2014.reproduction import Reproduction
from carom.reproductions.mora2014.source import printed_texts

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Picture(Result):
    """A figure to draw.

    Attributes
    ----------
    name : str
        File name without ending, ``"figure-2"`` to ``"figure-6"``.
    panels : str
        Letters of its panels.
    caption : str
    result : object
        The result drawn.
    draw : callable
        Returns the figure.
    """

    name: str
    panels: str
    caption: str
    result: object
    draw: Callable[[], Figure]


def figures(results: Reproduction) -> tuple[Picture, ...]:
    """List figures 2 to 6.  Nothing is drawn before :attr:`Picture.draw` is called."""
    pair, birth = results.pair, results.pair.hopf.gamma
    gammas = {
        "birth": birth,
        "fold": pair.special("fold", "d").value,
        "grazing": pair.special("grazing", "d").value,
        "doubling": pair.special("period-doubling", "d").value,
        "apart": pair.special("speed-fold", "c").value,
    }
    meeting = results.plane.meeting("fold", "boundary-equilibrium").value
    found = {name: f"{gamma:.6f}" for name, gamma in gammas.items()}
    found["meeting"] = f"{meeting[0]:.5f}, {meeting[1]:.5f}"
    # What is shown, and what is drawn: the same, or its parts.
    shown: dict[str, tuple[object, tuple[object, ...]]] = {
        "figure-2": (results.motions, (results.motions,)),
        "figure-3": (results.periods, (results.periods, birth)),
        "figure-4": (pair, (pair,)),
        "figure-5": (results.radii, (pair, results.radii)),
        "figure-6": ((pair, results.plane), (pair, results.plane)),
    }
    return tuple(
        Picture(**row, result=result, draw=partial(_drawn, row["name"], *parts))
        for row in printed_texts("figures", found)
        for result, parts in [shown[row["name"]]]
    )


def _drawn(name: str, *results: object) -> Figure:
    # Importing the drawing modules takes longer than computing.
    from carom.reproductions.mora2014 import drawing

    draw: Callable[..., Figure] = getattr(drawing, name.replace("-", "_"))
    return draw(*results)
