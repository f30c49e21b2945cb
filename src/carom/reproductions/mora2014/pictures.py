"""The figures of the source paper, with captions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

from carom.reproductions.mora2014.reproduction import Reproduction
from carom.results import Result

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
    birth = results.pair.hopf.gamma
    fold = results.pair.special("fold", "d").value
    grazing = results.pair.special("grazing", "d").value
    doubling = results.pair.special("period-doubling", "d").value
    apart = results.pair.special("speed-fold", "c").value
    meeting = results.plane.meeting("fold", "boundary-equilibrium").value
    return (
        Picture(
            "figure-2",
            "abc",
            "Periodic motions in the fixed frame, in the co-rotating frame, and their radius over time. (a) Contact-free "
            f"equilibrium, γ = 0.3. (b) Impacting orbit B1,d near grazing, γ = 0.065; it grazes at γ = {grazing:.6f}. "
            f"(c) Impacting orbit B1,a near the non-smooth Hopf bifurcation at γ = {birth:.6f}, γ = 0.1.",
            results.motions,
            partial(_drawn, "figure_2", results.motions),
        ),
        Picture(
            "figure-3",
            "abc",
            "(a) The period condition F₁ over the period T for two dampings; its zeros are the periods of orbits with one "
            "impact. (b) The zeros over the damping: shorter and longer period of each pair, which meet in folds, the first at "
            f"γ = {fold:.6f}. (c) Birth of the orbits B1,a and B1,b from levitation at γ = {birth:.6f}: "
            "virtual below, admissible above (computed, where the source has a sketch).",
            results.periods,
            partial(_drawn, "figure_3", results.periods, birth),
        ),
        Picture(
            "figure-4",
            "abcd",
            "Radial speed (a, b) and angular speed (c, d) just before the impact of the orbits B1,a to B1,d over the damping. "
            f"B1,a and B1,c meet at γ = {apart:.6f}, a damping that no machine has. (b, d) The small orbits near their birth, with "
            "the local theory as straight lines.",
            results.pair,
            partial(_drawn, "figure_4", results.pair),
        ),
        Picture(
            "figure-5",
            "ab",
            "Local extrema of the radius between impacts over the damping, for (a) B1,a and B1,b, with the contact-free "
            f"equilibrium, and (b) B1,c and B1,d, which grazes at γ = {grazing:.6f}.",
            results.radii,
            partial(_drawn, "figure_5", results.pair, results.radii),
        ),
        Picture(
            "figure-6",
            "ab",
            f"(a) Largest modulus of the multipliers: only B1,d is ever stable, above γ = {doubling:.6f}. (b) The plane of "
            "damping and stiffness. Beside the fold and the line where levitation meets the wall, which is a non-smooth Hopf "
            f"bifurcation left of their meeting at ({meeting[0]:.5f}, {meeting[1]:.5f}), the curves of grazing and of period "
            "doubling of B1,d and the fold of the rubs. In R3 a stable synchronous rub exists left of the last.",
            (results.pair, results.plane),
            partial(_drawn, "figure_6", results.pair, results.plane),
        ),
    )


def _drawn(name: Literal["figure_2", "figure_3", "figure_4", "figure_5", "figure_6"], *results: object) -> Figure:
    # Importing the drawing modules takes longer than computing.
    from carom.reproductions.mora2014 import drawing

    draw: Callable[..., Figure] = getattr(drawing, name)
    return draw(*results)
