"""All results of the source paper, computed once."""

from __future__ import annotations

from dataclasses import dataclass

from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result
from carom.reproductions.mora2014.branches import FirstPair, first_pair
from carom.reproductions.mora2014.extrema import RadiusDiagram, radius_diagram
from carom.reproductions.mora2014.misprinted_forms import Misprint, misprints
from carom.reproductions.mora2014.motions import ShownMotion, shown_motions
from carom.reproductions.mora2014.periods import (
    Birth,
    PeriodFunction,
    PeriodPair,
    birth,
    period_functions,
    period_pairs,
)
from carom.reproductions.mora2014.plane import DampingStiffnessPlane, damping_stiffness_plane
from carom.reproductions.mora2014.printed_numbers import PrintedNumber, numbers


@dataclass(frozen=True, eq=False, repr=False)
class Periods(Result):
    """The data of figure 3."""

    functions: tuple[PeriodFunction, ...]
    pairs: tuple[PeriodPair, ...]
    births: tuple[Birth, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Reproduction(Result):
    """All results of the source paper, computed.

    Attributes
    ----------
    motions : tuple of ShownMotion
        Figure 2.
    periods : Periods
        Figure 3.
    pair : FirstPair
        Figures 4 and 6a.
    radii : RadiusDiagram
        Figure 5.
    plane : DampingStiffnessPlane
        Figure 6b.
    numbers : tuple of PrintedNumber
    misprints : tuple of Misprint
    """

    motions: tuple[ShownMotion, ...]
    periods: Periods
    pair: FirstPair
    radii: RadiusDiagram
    plane: DampingStiffnessPlane
    numbers: tuple[PrintedNumber, ...]
    misprints: tuple[Misprint, ...]


@shows_progress
def reproduce(*, progress: ShowProgress = None) -> Reproduction:
    """Compute the data of all figures of the source paper and all numbers that it prints."""
    tell = Reporter.of(progress, "reproducing the paper")
    tell(0.0, "finding the motions of figure 2 (the kernels are compiled on first use)")
    motions = shown_motions()
    tell(0.3, "following the periods")
    periods = Periods(period_functions(), period_pairs(), birth())
    tell(0.5, "following the orbits")
    pair = first_pair()
    radii = radius_diagram(pair)
    tell(0.7, "following the curves of figure 6b")
    plane = damping_stiffness_plane(pair)
    tell(0.9, "comparing the numbers")
    compared = numbers(pair, plane), misprints(pair, plane)
    return Reproduction(motions, periods, pair, radii, plane, *compared)
