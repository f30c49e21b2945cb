"""Intervals of a parameter in which something holds, and what happens at their ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise


@dataclass(frozen=True)
class Edge:
    """End of an interval of a parameter.

    Attributes
    ----------
    value : float
        Value of the parameter; 0 and infinity are possible.
    kind : str
        What happens there: ``"boundary-equilibrium"``, ``"rub-fold"``, ``"rolling-limit"`` or ``"simulated"``; for
        orbits a kind of :class:`~carom.bifurcations.Bifurcation`, or ``"vanishing-period"``.  Empty if nothing happens
        there, at the end of the axis or of a search.
    period, radial_speed : float or None
        Of the orbit that appears, vanishes or changes there: its period in ``1/Ω`` and radial speed in ``c_r Ω``.
    name : str
        Name of this orbit; empty if there is none.
    motion : MotionName or None
        For the kind ``"simulated"``: the motion in which a disturbance ended beyond the edge.
    """

    value: float
    kind: str = ""
    period: float | None = None
    radial_speed: float | None = None
    name: str = ""
    motion: str | None = None


@dataclass(frozen=True)
class Span:
    """An interval of a parameter, by its ends; ``value in span`` says whether it holds a value."""

    low: Edge
    high: Edge

    def __iter__(self) -> Iterator[Edge]:
        return iter((self.low, self.high))

    def __contains__(self, value: float) -> bool:
        return self.low.value <= value <= self.high.value

    def document(self) -> list[float]:
        """Its ends, as plain data for JSON."""
        return [self.low.value, self.high.value]


def spans_where(edges: Iterable[Edge], there: Callable[[float], bool]) -> tuple[Span, ...]:
    """The spans between edges in which something holds, by whether it does in the middle between neighbours.

    Of edges with one value the first counts.
    """
    first = {edge.value: edge for edge in reversed(list(edges))}
    ordered = [first[value] for value in sorted(first)]
    sides = [False, *(there(0.5 * (one.value + other.value)) for one, other in pairwise(ordered)), False]
    return paired([edge for edge, (below, above) in zip(ordered, pairwise(sides), strict=True) if below != above])


def paired(ends: Sequence[Edge]) -> tuple[Span, ...]:
    """The spans whose ends these are, in ascending order."""
    return tuple(Span(*pair) for pair in zip(ends[::2], ends[1::2], strict=True))
