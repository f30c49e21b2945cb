"""Figure 6b: the plane of damping and stiffness, with the curves that the source paper leaves to future work."""

from __future__ import annotations

from dataclasses import dataclass

from carom.base.results import Result
from carom.bifurcations import Bifurcation, Codimension2Point, Curve, Motions, Plane, continue_curve, motions_at
from carom.closed_forms.thresholds import rub_limit
from carom.continuation import Steps
from carom.reproductions.mora2014.branches import FirstPair
from carom.reproductions.mora2014.source import machine_at

PLANE = Plane("gamma", "omega", (0.02, 0.42), (0.68, 0.9))
STEPS = Steps(first=0.01, largest=0.05, sharpest_turn=0.15)
REGIONS = (
    ("R1", (0.125, 0.84), "B1,d is stable"),
    ("R1", (0.0735, 0.86), "B1,d has lost its stability in a period doubling"),
    ("R1", (0.04, 0.82), "B1,d has grazed and is virtual"),
    ("R2", (0.28, 0.86), "the text names no motion: a synchronous rub is stable"),
    ("R3", (0.27, 0.745), "the text names levitation alone: a synchronous rub is stable too"),
    ("R3", (0.395, 0.715), "beyond the fold of the rubs no synchronous rub is left"),
    ("R4", (0.13, 0.72), "B1,d is stable"),
    ("R4", (0.0765, 0.7), "B1,d has lost its stability in a period doubling"),
    ("R4", (0.04, 0.72), "B1,d has grazed and is virtual"),
)
"""Name in the source paper, a point inside, and what our refinement adds."""


@dataclass(frozen=True)
class NamedRegion:
    """A part of a region of the source paper with the same motions throughout.

    Attributes
    ----------
    source : str
        ``"R1"`` to ``"R4"``.
    part : str
        ``"R1.1"`` and so on, with the same motions throughout; for an undivided region its name in the source paper.
    point : tuple of float
        Damping and stiffness of a point inside.
    motions : Motions
        Motions counted at this point.
    """

    source: str
    part: str
    point: tuple[float, float]
    motions: Motions
    words: str


@dataclass(frozen=True, eq=False, repr=False)
class DampingStiffnessPlane(Result):
    """Curves and regions of the plane of ``γ`` and ``ω``.

    Attributes
    ----------
    curves : tuple of Curve
        Fold of the first pair, boundary equilibrium with its part that is a non-smooth Hopf bifurcation, grazing and
        period doubling of ``B1,d``, and the fold of the rubs.
    """

    plane: Plane
    curves: tuple[Curve, ...]
    regions: tuple[NamedRegion, ...]

    @property
    def everywhere(self) -> tuple[str, ...]:
        """Motions that all regions have, in words."""
        first, *others = (region.motions.parts for region in self.regions)
        return tuple(part for part in first if all(part in parts for parts in others))

    def curve(self, kind: str) -> Curve:
        """Return the curve of a kind."""
        return next(curve for curve in self.curves if curve.kind == kind)

    def meeting(self, first: str, second: str) -> Codimension2Point:
        """Return the point at which two curves meet."""
        return next(point for point in self.curve(first).codimension2 if point.kinds == (first, second))


def damping_stiffness_plane(pair: FirstPair) -> DampingStiffnessPlane:
    """Compute figure 6b: the curves, which start on the branches of the pair, and the motions in each region."""
    fold, grazing, doubling = (pair.special(kind, "d") for kind in ("fold", "grazing", "period-doubling"))
    boundary = Bifurcation.near("boundary-equilibrium", machine_at(pair.hopf.gamma))
    rub_fold = Bifurcation.near("rub-fold", machine_at(rub_limit(machine_at(0.1))))
    curves = tuple(continue_curve(point, PLANE, STEPS) for point in (fold, boundary, grazing, doubling, rub_fold))
    regions = []
    for place, (source, point, words) in enumerate(REGIONS):
        number = sum(other[0] == source for other in REGIONS[: place + 1])
        divided = sum(other[0] == source for other in REGIONS) > 1
        part = f"{source}.{number}" if divided else source
        regions.append(NamedRegion(source, part, point, motions_at(machine_at(*point)), words))
    return DampingStiffnessPlane(PLANE, curves, tuple(regions))
