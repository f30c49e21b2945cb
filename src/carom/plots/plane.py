"""Parts that all pictures of the clearance share: the circle, paths, bands of lasting contact, arrows, impacts and the legend."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from carom.plots.figure import StyledFigure
from carom.plots.style import LOOKS, ZONE_SHADES, Drawn, Look
from carom.plots.words import axis_label, clearance, times_larger

if TYPE_CHECKING:
    from carom.orbits.orbit import Orbit
    from carom.parameters import Scales

Complex = NDArray[np.complex128]
Floats = NDArray[np.float64]

MANY_POINTS = 40_000
MANY_MARKERS = 2_000
"""Numbers above which a line or markers are stored as pixels inside vector files, to keep the files small."""

Frame = Literal["rotating", "fixed"]

_MARGIN = 1.25
"""Size of an enlarged square, relative to what it shows."""
_FRAMES = {"rotating": ("co-rotating frame", "U"), "fixed": ("fixed frame", "Z")}


def clearance_circle(axes: Axes, reach: float = 1.12, wall: float = 1.0) -> None:
    """Draw the circle that the rotor centre cannot leave, and set equal axes around it.

    `reach` is how far the axes extend, in clearances; `wall` is the clearance as it is drawn.
    """
    _wall(axes, np.linspace(0.0, 2.0 * np.pi, 721), wall)
    reach = reach * wall
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    decade = 10.0 ** np.floor(np.log10(0.5 * reach))
    step = decade * max(nice for nice in (1.0, 2.0, 5.0) if nice * decade <= 0.5 * reach)
    whole = np.floor(reach / step)
    ticks = step * np.arange(-whole, whole + 1.0)
    axes.set(xticks=ticks, yticks=ticks)


def _wall(axes: Axes, angle: Floats, wall: float) -> None:
    axes.plot(*around(angle, wall), **LOOKS["wall"].stroke, label=LOOKS["wall"].words, gid="wall")
    axes.set_aspect("equal")


def around(angle: Floats, radius: float | Floats) -> tuple[Floats, Floats]:
    """Places in the plane at angles and distances."""
    return radius * np.cos(angle), radius * np.sin(angle)


def circle(axes: Axes, radius: float, **look: Any) -> None:
    """Draw a circle around the origin."""
    axes.plot(*around(np.linspace(0.0, 2.0 * np.pi, 361), radius), **look)


def label_frame(axes: Axes, frame: Frame, scales: Scales | None, note: str = "") -> None:
    """Set title and axis labels of a picture in the frame ``"rotating"`` or ``"fixed"``."""
    words, symbol = _FRAMES[frame]
    # With a given height, matplotlib need not measure the labels that the title must keep clear of.
    free = axes.xaxis.get_ticks_position() in ("bottom", "default")
    axes.set_title(f"{words}{', ' if note else ''}{note}", y=1.0 if free else None)
    along = ("$x$", "$y$") if frame == "fixed" else (rf"Re ${symbol}$", rf"Im ${symbol}$")
    axes.set_xlabel(axis_label(f"position {along[0]}", "length", scales))
    axes.set_ylabel(axis_label(f"position {along[1]}", "length", scales))


def path(
    axes: Axes,
    position: Complex,
    look: Look,
    label: str | None = None,
    width: float | None = None,
    wall: float = np.inf,
) -> None:
    """Draw a path; parts beyond a radius `wall` are faint and dotted, whatever its look, for an orbit that goes there is virtual.

    An empty `label` keeps the path out of the legend.
    """
    # A small tolerance keeps the impact points themselves, on the wall, out of the faint part.
    outside = np.abs(position) > wall * (1.0 + 1e-9)
    beyond = LOOKS["outside"]
    for part, drawn, words in ((~outside, look, look.words), (outside, beyond, beyond.words)):
        if not part.any():
            continue
        shown = with_neighbours(part) if drawn is beyond else part
        named = words if drawn is beyond or label is None else label
        axes.plot(
            np.where(shown, position.real, np.nan),
            np.where(shown, position.imag, np.nan),
            linestyle=drawn.line,
            color=drawn.colour,
            lw=drawn.width if width is None else min(width, drawn.width),
            rasterized=len(position) > MANY_POINTS,
            label="_" if label == "" else named,
            gid="outside" if drawn is beyond else "path",
        )


def with_neighbours(part: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Widen each run by one sample on both sides, so that adjacent parts of a line meet."""
    wide = part.copy()
    wide[1:] |= part[:-1]
    wide[:-1] |= part[1:]
    return wide


def direction_arrow(axes: Axes, position: Complex, look: Look, fraction: float = 0.4) -> None:
    """Draw an arrow head on a path, at a fraction of its length, pointing forward in time."""
    position = _longest_piece(position)
    length = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(position)))))
    if length[-1] == 0.0:
        return
    here = fraction * length[-1]
    step = 0.01 * length[-1]
    x = np.interp((here - step, here + step), length, position.real)
    y = np.interp((here - step, here + step), length, position.imag)
    head = {"arrowstyle": "-|>", "color": look.colour, "lw": 0, "mutation_scale": 9, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=(x[1], y[1]), xytext=(x[0], y[0]), arrowprops=head, gid="direction")


def _longest_piece(position: Complex) -> Complex:
    """Return the piece with the most samples of a path with gaps (nan)."""
    pieces = np.split(position, np.flatnonzero(np.isnan(position)))
    longest = max(pieces, key=len)
    return longest[~np.isnan(longest)]


def impacts(
    axes: Axes, position: Complex, angular_speed: Floats, size: float | None = None, *, clip: bool = True
) -> None:
    """Mark impact points, one marker for forward and one for backward whirl in the fixed frame.

    The rotor whirls forward if its fixed-frame angular speed, the co-rotating one plus 1, is positive just before the
    impact.
    """
    forward = np.asarray(angular_speed) > -1.0
    size = marker_size(len(forward)) if size is None else size
    for which, chosen in (("forward", forward), ("backward", ~forward)):
        if chosen.any():
            point(axes, position[chosen], which, size=size, clip=clip)


def orbit_path(orbit: Orbit, periods: int, plane: int | None = None) -> tuple[Floats, Complex]:
    """Return evenly spaced times [1/Omega] from an impact over whole periods, and positions as they are drawn.

    They are those of a contact plane, by default that of the first impact.
    """
    seen = orbit.leading_plane if plane is None else plane
    times = np.linspace(0.0, periods * orbit.period, periods * max(400, int(60.0 * orbit.period)) + 1)
    scales = orbit.rotor.system.scales_at(seen, orbit.rotor.scales)
    return times, orbit.path(times, seen) * complex(clearance(scales))


def marker_size(count: int) -> float:
    """Return the marker size [pt], which decreases with the number of markers."""
    return float(np.clip(5.0 - 0.9 * np.log10(max(count, 1) / 6.0), 2.2, 5.0))


def point(
    axes: Axes,
    position: complex | Complex,
    meaning: str,
    *,
    hollow: bool = False,
    size: float = 5.0,
    label: str | None = None,
    colour: str | None = None,
    clip: bool = True,
) -> None:
    """Mark one or more points with the look of `meaning`; hollow means unstable or virtual.

    The position is ``x + iy``.  With `clip` a marker ends at the frame.
    """
    look = LOOKS[meaning]
    drawn = colour or look.colour
    where = np.atleast_1d(position)
    ring = meaning == "start"
    axes.plot(
        where.real,
        where.imag,
        linestyle="none",
        marker=look.marker,
        markersize=size + 3.0 if ring else size,
        markerfacecolor="none" if ring else ("white" if hollow else drawn),
        markeredgecolor=drawn if hollow or ring else "#1a1a1a",
        markeredgewidth=0.8 if hollow or ring else 0.4,
        rasterized=len(where) > MANY_MARKERS,
        label=look.words if label is None else label or "_",
        zorder=4.0 + ring,
        clip_on=clip,
        gid=meaning,
    )


def magnifier(axes: Axes, shown: Complex, words: str = "enlarged ", wall: float = 1.0) -> Axes | None:
    """Open an enlarged view of the square around `shown` in the free part of the clearance circle.

    Its title is how many times it is enlarged, with `words` before it.  None if `shown` is large enough to be visible.
    """
    low, high = complex(shown.real.min(), shown.imag.min()), complex(shown.real.max(), shown.imag.max())
    middle, half = (low + high) / 2.0, _MARGIN * max(high.real - low.real, high.imag - low.imag) / 2.0
    if half > 0.2 * wall or half == 0.0:
        return None
    centre = -0.28 * wall * middle / abs(middle)
    side = 0.9 * wall
    corner = centre - complex(side, side) / 2.0
    place = (corner.real, corner.imag, side, side)
    inner = axes.inset_axes(place, transform=axes.transData, gid="magnifier")
    # Only the visible arc, so finely resolved that impact points lie on it at any enlargement.
    _wall(inner, np.angle(middle) + np.linspace(-4.0, 4.0, 361) * half / wall, wall)
    inner.set(xlim=(middle.real - half, middle.real + half), ylim=(middle.imag - half, middle.imag + half))
    inner.set(xticks=(), yticks=())
    inner.set_title(f"{words}{times_larger(side / (2.0 * half))} times", fontsize=7, pad=2)
    # Otherwise the layout would reserve space for the enlarged piece.
    inner.set_in_layout(False)
    axes.indicate_inset_zoom(inner, edgecolor="#808080", lw=0.4, alpha=1.0)
    return inner


def shade_zones(axes: Axes, edges: Sequence[float], letters: Sequence[str]) -> None:
    """Shade vibration zones between their edges, each with its letter at the right."""
    for low, high, letter, shade in zip(edges[:-1], edges[1:], letters, ZONE_SHADES, strict=False):
        axes.axhspan(low, high, color=shade, lw=0.0, zorder=0, gid=f"zone {letter}")
        words: Drawn = {"transform": axes.get_yaxis_transform(), "ha": "right", "va": "center", "fontsize": 7}
        axes.text(0.992, (low + high) / 2.0, letter, **words)


def one_axes(size: tuple[float, float]) -> tuple[Figure, Axes]:
    """Return axes of a new figure of that size [inch]."""
    figure = StyledFigure(figsize=size)
    return figure, figure.subplots()


def key(figure: Figure, drawn: Iterable[Axes], columns: int, title: str | None = None) -> Figure:
    """Add a title, if there is one, and below the figure a legend of everything labelled in the axes, without duplicates; return the figure."""
    if title:
        figure.suptitle(title)
    handles, words = unique_entries(drawn)
    figure.legend(handles, words, loc="outside lower center", ncols=min(columns, len(words)))
    return figure


def unique_entries(drawn: Iterable[Axes]) -> tuple[Sequence[Artist], list[str]]:
    """Everything labelled in axes, without duplicates, and its words."""
    found: dict[str, Artist] = {}
    for axes in drawn:
        for handle, words in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(words, handle)
    return list(found.values()), list(found)
