"""The common style of all figures: style sheet, widths, and what each colour means.

A colour, line or marker in a figure of carom always has the same meaning.  Every meaning is shown by colour *and* by
line or marker, so that figures can be read in greyscale and by colour-blind readers.  Most hues are those of Okabe and
Ito (2008); areas of levitation are a brighter green than its lines and marks, which would be lost on white.

=====================  ==========================  ====================================================
key of :data:`LOOKS`   drawn as                    means
=====================  ==========================  ====================================================
``"stable"``           blue, solid, disc           periodic orbit: admissible, stable
``"unstable"``         vermilion, dashed, diamond  periodic orbit: admissible, unstable
``"neutral"``          blue, dotted, hexagon       periodic orbit: admissible, neither stable nor unstable
``"virtual"``          grey, thin, cross           not physical: violates the wall or the contact law
``"outside"``          pale grey, dotted           the part of a virtual orbit beyond the wall
``"wall"``             near-black, solid           clearance circle: the touchdown bearing
``"path"``             dark slate, thin            a simulated motion
``"contact-free"``     green, pentagon             levitation
``"rub"``              magenta, square             synchronous rub
``"slide"``            magenta, broad              lasting contact that slides along the wall
``"roll"``             wine, broad, dashed         lasting contact that rolls round the wall
``"forward"``          sky blue, triangle up       impact in forward whirl (fixed frame)
``"backward"``         orange, triangle down       impact in backward whirl (fixed frame)
``"start"``, ``"end"`` hollow ring, filled cross   first and last instant of a motion
=====================  ==========================  ====================================================

Filled markers are stable or admissible, hollow ones unstable or virtual.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from types import MappingProxyType
from typing import Any, ParamSpec

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from carom.base.outcome import IRREGULAR_BOUNCING, STEADY_WORDS, Outcome
from carom.plots.figure import arrange, drawing

Arguments = ParamSpec("Arguments")
Drawn = dict[str, Any]
"""How something is drawn: arguments of matplotlib."""


ZONE_SHADES = ("#ffffff", "#faf7ef", "#f5f0e1", "#efe7d0")
"""Background of the vibration zones A, B, C, D; darker is worse."""


@dataclass(frozen=True)
class Look:
    """How one meaning is drawn, and the words the legend uses for it.

    Parameters
    ----------
    colour : str
        Hexadecimal colour.
    words : str
        Legend text.
    line : str or tuple
        Matplotlib line style; ``"none"`` if the meaning is a point.
    width : float
        Line width [pt].
    marker : str
        Matplotlib marker; ``"none"`` if the meaning is a line.
    hatch : str
        Matplotlib hatch of areas; empty if the colour alone differs from all others in greyscale.
    """

    colour: str
    words: str
    line: str | tuple[float, tuple[float, ...]] = "none"
    width: float = 0.9
    marker: str = "none"
    hatch: str = ""

    @property
    def stroke(self) -> Drawn:
        """Colour, style and width of a line, as arguments of matplotlib."""
        return {"color": self.colour, "ls": self.line, "lw": self.width}

    def mark(self, size: float, *, filled: bool = True) -> Drawn:
        """A point of a size [pt], filled or hollow, as arguments of matplotlib."""
        face = self.colour if filled else "none"
        return {"ls": "none", "marker": self.marker, "ms": size, "mfc": face, "mec": self.colour}

    def entry(self, words: str = "") -> Line2D:
        """Return a legend entry: the line, or the marker if the meaning is a point."""
        drawn = self.mark(5.0) if self.line == "none" else self.stroke
        return Line2D([], [], **drawn, label=words or self.words)


LOOKS = MappingProxyType(
    {
        "stable": Look("#0072b2", "admissible, stable", line="-", width=1.1, marker="o"),
        "unstable": Look("#d55e00", "admissible, unstable", line="--", width=0.9, marker="D"),
        "neutral": Look("#0072b2", "admissible, neutral", line=":", width=1.1, marker="h"),
        "virtual": Look("#808080", "virtual, not physical", line="-", width=0.6, marker="x"),
        "outside": Look("#a6a6a6", "virtual part, outside the clearance", line=":", width=0.8),
        "wall": Look("#1a1a1a", "clearance circle (touchdown bearing)", line="-", width=1.0),
        "path": Look("#3d4f66", "path of the rotor centre", line="-", width=0.6),
        "contact-free": Look("#009e73", STEADY_WORDS["contact-free"], marker="p"),
        "rub": Look("#a52f74", STEADY_WORDS["rub"], marker="s"),
        "slide": Look("#a52f74", "lasting contact, sliding", line="-", width=2.0),
        "roll": Look("#5c1236", "lasting contact, rolling", line="--", width=2.0),
        "forward": Look("#56b4e9", "impact, forward whirl", marker="^"),
        "backward": Look("#e69f00", "impact, backward whirl", marker="v", hatch="\\\\\\\\"),
        "start": Look("#1a1a1a", "start", marker="o"),
        "end": Look("#1a1a1a", "end", marker="X"),
    }
)
"""Every meaning a figure can show (read-only)."""

REGIMES = (
    Look("#dfe5ec", "flight"),
    Look("#a52f74", "sliding, slip forward"),
    Look("#532a94", "sliding, slip backward", hatch="...."),
    Look("#5c1236", "rolling", hatch="////"),
    Look("#b8c2cc", "lift-off from the wall", hatch="||||"),
)
"""Looks of the regimes of a touchdown, in the order of :class:`carom.base.outcome.Phase`."""

OUTCOMES = MappingProxyType(
    {
        "levitated": Look("#68e6a8", Outcome.LEVITATED.words),
        "bouncing": Look("#55aced", Outcome.BOUNCING.words, hatch="...."),
        "irregular": Look("#8a8578", IRREGULAR_BOUNCING, hatch="...."),
        "mixed": Look("#3f7cb4", Outcome.MIXED.words),
        "forward-rub": Look("#a52f74", Outcome.FORWARD_RUB.words, hatch="\\\\\\\\"),
        "backward-whirl": Look("#532a94", Outcome.BACKWARD_WHIRL.words, hatch="xxxx"),
        "rolling": Look("#5c1236", Outcome.ROLLING.words, hatch="////"),
        "at-rest": Look("#7d6a4f", Outcome.AT_REST.words, hatch="++++"),
        "grazing": Look("#000000", Outcome.GRAZING.words),
        "time-reached": Look("#dcdcdc", Outcome.TIME_REACHED.words),
        "event-limit": Look("#dcdcdc", Outcome.EVENT_LIMIT.words),
        "beyond-model": Look("#1a1a1a", Outcome.BEYOND_MODEL.words, hatch="xx"),
        "low-bounces": Look("#dcdcdc", Outcome.LOW_BOUNCES.words),
        "stalled": Look("#dcdcdc", Outcome.STALLED.words),
    }
)
"""Looks of endings, by the label of their :class:`~carom.base.outcome.Outcome`; irregular bouncing has a look of its own.

The worse an ending, the darker it is, in nearly even steps: what comes back is the brightest area, and backward whirl the darkest,
also in print without colour.
"""

WORKS = MappingProxyType(
    {
        "energy": Look("#1a1a1a", "energy of the rotor", line="-", width=1.3),
        "drive": Look("#009e73", "work of the drive", line="-", width=0.9),
        "impacts": Look("#d55e00", "work at the contact in impacts", line="--", width=0.9),
        "friction": Look("#cc79a7", "work of friction in lasting contact", line="-.", width=0.9),
        "damping": Look("#0072b2", "work of damping", line=":", width=1.1),
        "circulatory": Look("#56b4e9", "work of circulatory forces", line=(0, (3, 1, 1, 1, 1, 1)), width=0.9),
        "unbalance": Look("#e69f00", "work of unbalance", line=(0, (6, 1, 1, 1)), width=0.9),
        "wall_loss": Look("#a6761d", "lost in the wall", line=(0, (2, 1)), width=0.9),
        "forces": Look("#7d6a4f", "work of weight and external forces", line=(0, (5, 2)), width=0.9),
    }
)
"""Looks of the entries of an energy ledger."""


def styled(draw: Callable[Arguments, Figure]) -> Callable[Arguments, Figure]:
    """Run a drawing function under carom's style sheet.

    A new figure is laid out before the style sheet is removed, and its layout is then fixed.  Ticks created later would
    take the settings of the user, and a new layout for each file would make the files differ slightly.
    """

    @wraps(draw)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Figure:
        with drawing():
            figure = draw(*args, **kwargs)
            arrange(figure)
        return figure

    return wrapper
