"""How the machine of the source paper loses its bouncing as the damping falls: orbits, simulated motions, exponents, half-lives.

``python docs/_cells/loss_of_bouncing.py`` computes for some minutes and draws the picture of the page again.  The source paper
follows the orbit ``B1,d`` and says where its bouncing is stable.  What happens below the period doubling is not in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from carom.attractors import Lifetimes, measure_lifetimes
from carom.attractors.names import SYNCHRONOUS_RUB
from carom.bifurcations import Diagram, OrbitBranch, continue_orbit, find_bifurcations
from carom.bifurcations.several import lies_on
from carom.models import Rotor, jeffcott
from carom.motions import State, Trajectory, simulate
from carom.orbits import find_orbits, lyapunov_exponents, orbit_exponents, orbit_of_motion
from carom.orbits.orbit import Orbit
from carom.outcome import CaromError, Outcome
from carom.plots import save
from carom.plots.diagrams import POINTS, branch_line, mark_point
from carom.plots.figure import StyledFigure
from carom.plots.style import LOOKS, OUTCOMES, TWO_COLUMNS, styled
from carom.reproductions.mora2014 import machine_at

BESIDE = 1e-3
"""Relative change of the velocity at the starts beside the orbit."""
SHOWN = 150
"""Impacts of irregular bouncing that are kept."""
DISCARDED = 100
"""Impacts discarded at the beginning: until then a motion depends on its start."""
MEASURED_IMPACTS, SHORTEST = 4000, 600
"""Impacts over which exponents are measured, and the fewest of a motion that ends."""
SEED = 1


@dataclass(frozen=True, eq=False)
class BouncingSample:
    """Motions started beside the orbit ``B1,d`` at one damping.

    Attributes
    ----------
    gamma : float
    speeds : ndarray
        Radial speeds just before impacts, in ``c_r Ω``: of one period, of the last impacts of irregular bouncing, or of a motion before
        it ends.
    orbit : Orbit or None
        The orbit on which it settled; ``None`` if it did not become periodic, or ended.
    ended : bool
        Whether this motion ended.
    exponent, error : float
        Its largest Lyapunov exponent across the motion, in ``Ω``, with its standard error (0 for a periodic orbit); ``nan`` where the
        motion ended too early.
    lifetimes : Lifetimes
        Lifetimes of all the motions.
    """

    gamma: float
    speeds: np.ndarray
    orbit: Orbit | None
    ended: bool
    exponent: float
    error: float
    lifetimes: Lifetimes

    @property
    def impacts(self) -> int:
        """Impacts per period; 0 without an orbit."""
        return self.orbit.impacts if self.orbit else 0


def sample_bouncing(rotor: Rotor, *, motions: int, impacts: int) -> BouncingSample:
    """Follow motions from beside ``B1,d``.

    Parameters
    ----------
    rotor : Rotor
        The machine at a damping where this orbit is a motion.
    motions : int
    impacts : int
        Impacts for which each is followed.
    """
    starts = _beside(find_orbits(rotor)["B1,d"], motions)
    lifetimes = measure_lifetimes(rotor, starts, impacts=impacts, discarded=DISCARDED)
    motion, start = _longest(rotor, starts, impacts)
    speeds = motion.contacts.radial_speed
    ended = motion.outcome not in (Outcome.BOUNCING, Outcome.MIXED)
    orbit = orbit_of_motion(motion) if motion.multiplicity else None
    if orbit is not None:
        speeds, exponent = orbit.impact_speeds, orbit_exponents(orbit).across
    else:
        # Before a motion ends in lasting contact, its last impacts are those of a chatter.
        speeds = speeds[DISCARDED : len(speeds) // 2] if ended else speeds
        exponent = _measured(rotor, start, min(MEASURED_IMPACTS, len(motion.contacts) // 2))
    return BouncingSample(rotor.parameters.gamma, speeds[-SHOWN:], orbit, ended, *exponent, lifetimes)


def _beside(orbit: Orbit, motions: int) -> list[State]:
    random, before = np.random.default_rng(SEED), orbit.departure
    return [State(before.position, before.velocity * (1.0 + BESIDE * random.normal())) for _ in range(motions)]


def _longest(rotor: Rotor, starts: Sequence[State], impacts: int) -> tuple[Trajectory, State]:
    """The first motion that does not end early, or the longest of them, and its start."""
    found = []
    for start in starts:
        found.append((simulate(rotor, start, settle=True, patience=impacts), start))
        if len(found[-1][0].contacts) > 4 * SHORTEST or found[-1][0].multiplicity:
            return found[-1]
    return max(found, key=lambda pair: len(pair[0].contacts))


def _measured(rotor: Rotor, start: State, impacts: int) -> tuple[float, float]:
    """Largest exponent across the motion over so many impacts, and its error."""
    if impacts < SHORTEST:
        return np.nan, np.nan
    try:
        return lyapunov_exponents(rotor, start, impacts, transient=DISCARDED).across
    except CaromError:
        return np.nan, np.nan


RANGE = (0.0785, 0.095)
"""Damping: from bouncing that ends after a few hundred impacts up to where ``B1,d`` is stable."""
MOST_IMPACTS = 12
"""Most impacts a period of the branches on which motions settled."""
CLOSE = (0.0795, 0.0836)
"""Part of it that is looked at closely: from the loss of bouncing up to the period doubling."""


@dataclass(frozen=True, eq=False)
class LossOfBouncing:
    """The loss of bouncing of the source paper's machine along the damping.

    Attributes
    ----------
    diagram : Diagram
        Orbits with up to some impacts a period.
    windows : tuple of OrbitBranch
        Branches of orbits with more impacts, up to 12, on which simulated motions settled.
    samples : tuple of BouncingSample
        Over the whole range, in ascending order.
    close : tuple of BouncingSample
        Over the part looked at closely.
    """

    diagram: Diagram
    windows: tuple[OrbitBranch, ...]
    samples: tuple[BouncingSample, ...]
    close: tuple[BouncingSample, ...]

    @property
    def every(self) -> list[BouncingSample]:
        """All samples, in ascending order of the damping."""
        return sorted((*self.samples, *self.close), key=lambda sample: sample.gamma)

    @property
    def lost(self) -> tuple[float, float]:
        """Dampings between which bouncing was lost: the largest sampled at which motions ended, the next at which none did."""
        ending = [sample.gamma for sample in self.every if _ends(sample)]
        low = max(ending, default=float("nan"))
        return low, min((sample.gamma for sample in self.every if sample.gamma > low), default=float("nan"))


def _ends(sample: BouncingSample) -> bool:
    """Whether motions stopped bouncing, and did not only become periodic."""
    ends = sample.lifetimes.destinations
    return any("bouncing" not in end and end in _OTHERS for end in ends)


_OTHERS = ("rolling", "levitated", "forward-rub", "backward-whirl")


def follow_loss(
    *,
    impacts: int = 4,
    values: int = 100,
    close: int = 206,
    motions: int = 40,
    patience: int = 20_000,
) -> LossOfBouncing:
    """Compute what the figure shows.

    Parameters
    ----------
    impacts : int
        Largest number of impacts a period of the orbits searched and followed.
    values, close : int
        Numbers of dampings over the whole range, and over the part looked at closely.
    motions, patience : int
        Number of motions simulated at each, and impacts for which each is followed.
    """
    diagram = find_bifurcations(machine_at(0.1), "gamma", RANGE, impacts=impacts)
    found: list[tuple[BouncingSample, ...]] = []
    for limits, count in ((RANGE, values), (CLOSE, close)):
        rotors = [jeffcott(machine_at(gamma)) for gamma in np.linspace(*limits, count).tolist()]
        found.append(tuple(sample_bouncing(rotor, motions=motions, impacts=patience) for rotor in rotors))
    return LossOfBouncing(diagram, _windows((*found[0], *found[1]), impacts), *found)


def _windows(samples: tuple[BouncingSample, ...], impacts: int) -> tuple[OrbitBranch, ...]:
    """Branches through the orbits on which motions settled and that have too many impacts for the search."""
    branches: list[OrbitBranch] = []
    for sample in samples:
        orbit = sample.orbit
        if orbit is None or not max(impacts, 1) < orbit.impacts <= MOST_IMPACTS:
            continue
        if not any(lies_on(orbit, sample.gamma, branch) for branch in branches):
            branches.append(continue_orbit(orbit, "gamma", RANGE, virtual=False))
    return tuple(branches)


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


if __name__ == "__main__":
    save(loss_figure(follow_loss()), Path(__file__).parent.parent / "images" / "loss-of-bouncing")
