"""The picture of the README: a basin of kicks, and the flights of two of them.  ``python docs/images/kicks.py`` draws it again."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

import carom as cm
from carom.base.outcome import Outcome
from carom.plots import LOOKS, OUTCOMES

HERE = Path(__file__).parent
CELLS = 240
FASTEST = 0.3
"""Largest kick, in m/s."""
KICKS = (("levitated", (-130.0, 178.0)), ("bouncing", (130.0, 178.0)))
"""Two kicks of the same size, outward and in the sense of rotation in mm/s, by where they lead."""


INK = "#12201a"
SHOWN = 60.0
"""Time that is drawn, in ``1/Ω``."""


def draw() -> Figure:
    """Draw the basin and the two flights."""
    case = cm.load(HERE.parent.parent / "examples" / "keogh-cole.toml", ["eccentricity=0.15 mm"])
    velocity = 1e3 * case.parameters.scales.velocity
    kicks = cm.disturbances.KickPlane.of(case, f"{FASTEST} m/s")
    basin = cm.map_basins(case, cm.Grid(kicks, (CELLS, CELLS)))
    outward = cm.disturbances.outward_from(case)
    settings = {"font.size": 12, "axes.linewidth": 0.8, "hatch.linewidth": 0.6, "font.family": "sans-serif"}
    with mpl.rc_context(settings):
        figure = Figure(figsize=(10.4, 5.9), layout="constrained", facecolor="white")
        left, right = figure.subplots(1, 2)
        shade(left, basin)
        right.add_patch(Circle((0.0, 0.0), 1.0, fill=False, ec=LOOKS["wall"].colour, lw=2.5))
        for label, kick in KICKS:
            start = outward * complex(*kick) / velocity
            motion = cm.simulate(case, cm.kick(abs(start), float(np.angle(start))), settle=True)
            if motion.outcome.label != label:
                raise ValueError(f"the kick {kick} mm/s ends in {motion.outcome.label}, not in {label}")
            mark(left, kick, label)
            fly(right, motion, outward)
        title(left, "Where does a kick end?", "kick outward (mm/s)", "kick along the rotation (mm/s)")
        title(right, "Two kicks of 220 mm/s", "", "")
        rest = motion.rotor.equilibrium / outward
        right.plot(rest.real, rest.imag, "o", ms=9, color=LOOKS["contact-free"].colour, mec="white", mew=1.5, zorder=5)
        right.set(xlim=(-1.06, 1.06), ylim=(-1.3, 1.06))
        right.set_axis_off()
    return figure


def title(axes: Axes, words: str, x: str, y: str) -> None:
    """Title and labels of a panel, which is square."""
    axes.set_title(words, fontsize=15, fontweight="bold", pad=8)
    axes.set(xlabel=x, ylabel=y, aspect="equal")


def shade(axes: Axes, basin: cm.basins.Basin) -> None:
    """Areas by outcome; hatched so that they differ in grey too."""
    reach = 1e3 * FASTEST
    along = np.linspace(-reach, reach, CELLS)
    for outcome in (Outcome.LEVITATED, Outcome.BOUNCING, Outcome.ROLLING, Outcome.FORWARD_RUB):
        look, where = OUTCOMES[outcome.label], basin.outcomes == outcome
        if where.any():
            options = {"colors": [look.colour], "hatches": [look.hatch], "levels": [0.5, 1.5]}
            axes.contourf(along, along, where.T.astype(float), **options).set_edgecolor("#ffffff90")
    outside = OUTCOMES["rolling"].colour
    for place, words, colour in (
        ((0, -30), "levitates", INK),
        ((0, -225), "bounces for ever", INK),
        ((232, -265), "rolls\nbackward", outside),
    ):
        axes.annotate(words, place, color=colour, ha="center", va="center", fontsize=13, fontweight="bold")


def mark(axes: Axes, kick: tuple[float, float], label: str) -> None:
    """The kick as an arrow."""
    axes.annotate("", kick, (0.0, 0.0), arrowprops={"arrowstyle": "-|>", "lw": 2.2, "color": INK})
    axes.plot(*kick, "o", ms=10, mec=INK, mew=2.0, color=OUTCOMES[label].colour)


def fly(axes: Axes, motion: cm.motions.Trajectory, outward: complex) -> None:
    """The path in the frame that turns with the shaft, with its impacts."""
    back = motion.outcome is Outcome.LEVITATED
    look = LOOKS["contact-free" if back else "stable"]  # lines are darker than areas
    last = np.linspace(motion.time - 5.0, motion.time, 2000)
    struck = motion.contacts.time
    motion = cm.simulate(motion.rotor, motion.start, until=motion.time + SHOWN)
    seen = np.linspace(0.0, SHOWN, 40000)
    path = motion.position(seen) / outward
    width = 2.4 if back else 1.0
    axes.plot(path.real, path.imag, color=look.colour, lw=width, zorder=3 if back else 2, alpha=1.0 if back else 0.75)
    if not back:
        last = motion.position(last) / outward
        axes.plot(last.real, last.imag, color=look.colour, lw=3.2, zorder=2.5)
    hits = motion.position(struck[struck <= seen[-1]]) / outward
    words = f"thick: comes back after {len(struck)} impacts" if back else "thin: never comes back"
    place = {"x": 0.0, "y": -1.13 if back else -1.26}
    axes.text(**place, s=words, color=look.colour, ha="center", va="center", fontsize=14, fontweight="bold")
    axes.scatter(
        hits.real,
        hits.imag,
        s=150 if back else 40,
        marker="*",
        c=LOOKS["backward"].colour,
        ec="#1a1a1a",
        lw=0.6,
        zorder=4,
    )


if __name__ == "__main__":
    draw().savefig(HERE / "kicks.png", dpi=150)
