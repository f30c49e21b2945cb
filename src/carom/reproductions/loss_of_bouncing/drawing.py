"""The figure: orbits and impacts over the damping, with exponents, half-lives and destinations below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from carom.attractors.names import SYNCHRONOUS_RUB
from carom.outcome import Outcome
from carom.plots.diagrams import POINTS, branch_line, mark_point
from carom.plots.figure import StyledFigure
from carom.plots.style import LOOKS, OUTCOMES, TWO_COLUMNS, styled
from carom.reproductions.loss_of_bouncing.following import CLOSE, RANGE

if TYPE_CHECKING:
    from carom.bifurcations import OrbitBranch
    from carom.reproductions.loss_of_bouncing.following import LossOfBouncing
    from carom.reproductions.loss_of_bouncing.samples import BouncingSample

INK, PALE = "#1a1a1a", "#9a9a9a"
WIDTHS = {"-": 1.2, "--": 0.55}
"""Widths of stable and unstable orbits: of the latter there are many."""
MARKED = ("period-doubling", "neimark-sacker", "grazing")
DAMPING = r"scaled damping $\gamma$"


@styled
def loss_figure(found: LossOfBouncing) -> Figure:
    """Draw the loss of bouncing.

    (a) Radial speeds at the impacts over the whole range: stable orbits solid, unstable ones dashed, simulated impacts as points.
    (b) The same from the period doubling down.  (c) Largest Lyapunov exponent.  (d) Half-life.  (e) Where motions ended.
    """
    figure = StyledFigure(figsize=(TWO_COLUMNS, 1.28 * TWO_COLUMNS))
    parts: Any = figure.subfigures(2, 1, height_ratios=(1.0, 1.75))
    upper, lower = parts
    whole = upper.subplots()
    near, exponents, lives, ends = lower.subplots(4, 1, sharex=True, height_ratios=(2.3, 1.0, 1.0, 0.42))
    for axes, limits, samples in ((whole, RANGE, found.samples), (near, CLOSE, found.close)):
        _orbits(axes, found, limits)
        _impacts(axes, samples)
        axes.set(xlim=limits, ylim=(-0.02, 1.06), ylabel=r"radial speed $\dot r$ ($c_\mathrm{r}\Omega$)")
    whole.axvspan(*CLOSE, color="#eef2f6", zorder=0)
    whole.set_xlabel(DAMPING)
    _exponents(exponents, found.close)
    _lives(lives, found.close)
    shown = _destinations(ends, found.close)
    ends.set(xlabel=DAMPING, xlim=CLOSE)
    headings = {
        "a": (whole, "orbits and impacts of motions started beside $B_{1,d}$"),
        "b": (near, "closer: from the period doubling down to the loss of bouncing"),
        "c": (exponents, "largest Lyapunov exponent across the motion"),
        "d": (lives, "half-life of irregular bouncing"),
        "e": (ends, "where the motions are in the end"),
    }
    for panel, (axes, words) in headings.items():
        axes.set_title(rf"$\mathbf{{({panel})}}$  {words}", loc="left")
    lower.align_ylabels([near, exponents, lives, ends])
    figure.legend(handles=[*_key(), *shown], loc="outside lower center", ncols=4)
    return figure


def _orbits(axes: Axes, found: LossOfBouncing, limits: tuple[float, float]) -> None:
    diagram = found.diagram
    for single in diagram.orbits:
        heights = np.array([point.radial_speed for point in single.special])
        branch_line(axes, single, np.arange(len(single)), single.values, single.radial_speed, heights)
    for branch in diagram.several:
        _branch(axes, branch)
    for line in axes.lines:
        line.set_linewidth(WIDTHS.get(str(line.get_linestyle()), 1.0) if line.get_alpha() == 1.0 else 0.4)
    for window in found.windows:
        first = len(axes.lines)
        _branch(axes, window)
        for line in list(axes.lines)[first:]:
            if line.get_linestyle() != "-" or line.get_alpha() != 1.0:
                line.remove()
    for point in diagram.points:
        if point.kind in MARKED and point.admissible and limits[0] < point.value < limits[1]:
            mark_point(axes, point.kind, point.value, point.radial_speed)


def _branch(axes: Axes, branch: OrbitBranch) -> None:
    """Draw the radial speeds of all impacts along a branch."""
    for k, speeds in enumerate(branch.radial_speeds.T):
        heights = np.array([point.orbit.impact_speeds[k] for point in branch.special])
        branch_line(axes, branch, np.arange(len(branch)), branch.values, speeds, heights)


def _impacts(axes: Axes, samples: tuple[BouncingSample, ...]) -> None:
    for ended, colour, size in ((True, PALE, 1.1), (False, INK, 1.3)):
        chosen = [sample for sample in samples if sample.ended == ended]
        if chosen:
            x = np.concatenate([np.full(len(sample.speeds), sample.gamma) for sample in chosen])
            y = np.concatenate([sample.speeds for sample in chosen])
            axes.plot(x, y, ls="none", marker=".", ms=size, mew=0.0, color=colour, zorder=3, rasterized=True)


def _exponents(axes: Axes, samples: tuple[BouncingSample, ...]) -> None:
    axes.axhline(0.0, color=INK, lw=0.5)
    for kind, style in _EXPONENTS.items():
        chosen = [sample for sample in samples if _kind(sample) == kind and np.isfinite(sample.exponent)]
        x, y = [sample.gamma for sample in chosen], [sample.exponent for sample in chosen]
        errors = [2.0 * sample.error for sample in chosen]
        axes.errorbar(x, y, errors, ls="none", elinewidth=0.5, ecolor=PALE, zorder=3, **style)
    axes.set_ylabel(r"exponent ($\Omega$)")


_EXPONENTS: dict[str, dict[str, Any]] = {
    "periodic": {"marker": "o", "ms": 2.4, "mew": 0.0, "color": LOOKS["stable"].colour},
    "irregular": {"marker": "^", "ms": 2.8, "mew": 0.0, "color": INK},
    "ended": {"marker": "x", "ms": 2.6, "mew": 0.6, "color": PALE},
}


def _kind(sample: BouncingSample) -> str:
    if sample.ended:
        return "ended"
    return "periodic" if sample.impacts else "irregular"


def _lives(axes: Axes, samples: tuple[BouncingSample, ...]) -> None:
    for sample in samples:
        survival, half_life = sample.lifetimes.survival, sample.lifetimes.half_life
        if half_life is not None:
            low, high = survival.interval
            axes.plot([sample.gamma] * 2, [low, high], color=PALE, lw=0.6)
            axes.plot([sample.gamma], [half_life], ls="none", marker="x", ms=2.8, mew=0.7, color=INK)
        elif survival.half_life is None and survival.motions:
            axes.plot(
                [sample.gamma], [survival.interval[0]], ls="none", marker="^", ms=3.0, mfc="none", mec=INK, mew=0.5
            )
    axes.set(yscale="log", ylabel="impacts")


def _destinations(axes: Axes, samples: tuple[BouncingSample, ...]) -> list[Patch]:
    """Shares of the motions by where they are in the end, as areas from bottom to top; return the legend entries."""
    x = np.array([sample.gamma for sample in samples])
    edges = np.concatenate([[x[0]], 0.5 * (x[1:] + x[:-1]), [x[-1]]])
    base, shown = np.zeros(len(x)), []
    for key, words in _ENDS.items():
        shares = np.array([_share(sample, key) for sample in samples])
        if not shares.any():
            continue
        # Irregular bouncing without a pattern: it has to differ from periodic bouncing in greyscale.
        look, pattern = OUTCOMES[key], "" if key == "irregular" else OUTCOMES[key].hatch
        axes.stairs(base + shares, edges, baseline=base, fill=True, fc=look.colour, ec="#ffffff", lw=0.0, hatch=pattern)
        shown.append(Patch(fc=look.colour, ec="#ffffff", lw=0.0, hatch=pattern, label=words))
        base += shares
    axes.set(ylim=(0.0, 1.0), yticks=[0.0, 1.0], ylabel="share")
    return shown


_ENDS = {
    "bouncing": "periodic bouncing",
    "irregular": "irregular bouncing, not seen to end",
    "mixed": Outcome.MIXED.words,
    "forward-rub": SYNCHRONOUS_RUB,
    "levitated": Outcome.LEVITATED.words,
    "backward-whirl": Outcome.BACKWARD_WHIRL.words,
    "rolling": Outcome.ROLLING.words,
}


def _share(sample: BouncingSample, key: str) -> float:
    ends = sample.lifetimes.destinations
    count = sum(number for end, number in ends.items() if end == key or (key == "bouncing" and "impact" in end))
    if key == "irregular":
        # A motion that was given up for its length has not ended either.
        count += ends.get("time-reached", 0) + ends.get("event-limit", 0)
    return count / len(sample.lifetimes)


def _key() -> list[Line2D]:
    lines = [LOOKS[look].entry(f"{look} orbit") for look in ("stable", "unstable", "virtual")]
    dots: dict[str, Any] = {"ls": "none", "marker": ".", "ms": 4.0, "mew": 0.0}
    return [
        *lines,
        Line2D([], [], color=INK, **dots, label="impact"),
        Line2D([], [], color=PALE, **dots, label="impact of a motion that ends"),
        *(POINTS[kind].entry() for kind in MARKED),
        Line2D([], [], ls="none", **_EXPONENTS["periodic"], label="exponent, periodic"),
        Line2D([], [], ls="none", **_EXPONENTS["irregular"], label="exponent, irregular"),
        Line2D([], [], ls="none", **_EXPONENTS["ended"], label="exponent, motion that ends"),
        Line2D([], [], ls="none", marker="x", ms=3.5, mew=0.7, color=INK, label="half-life, with 95 %"),
        Line2D([], [], ls="none", marker="^", ms=3.5, mfc="none", mec=INK, mew=0.5, label="half-life above (95 %)"),
    ]
