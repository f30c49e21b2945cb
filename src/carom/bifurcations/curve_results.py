"""A curve of bifurcations in the plane of two parameters, and the points on it where two happen at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from carom.base.outcome import STEADY_WORDS
from carom.base.results import Result
from carom.bifurcations.conditions import RESONANCES
from carom.bifurcations.planes import Plane
from carom.bifurcations.points import STEADY
from carom.orbits.names import CountedName, OrbitName, combined
from carom.parameters.formats import format_along


@dataclass(frozen=True)
class Codimension2Point:
    """A point where two bifurcations happen at once.

    Attributes
    ----------
    kinds : tuple of str
        For example ``("fold", "boundary-equilibrium")``; ``("resonance-1:3",)`` where a multiplier on a Neimark–Sacker
        curve is a third root of one, and so on; two multipliers are 1 at ``"resonance-1:1"``, −1 at ``"resonance-1:2"``.
    value : tuple of float
        Its place in the plane.
    period, radial_speed : float
        Those of the orbit; ``nan`` for equilibria.
    admissible : bool
        Whether it happens to a motion of the machine, or to one that just stops being one.
    """

    kinds: tuple[str, ...]
    value: tuple[float, float]
    period: float
    radial_speed: float
    admissible: bool

    @property
    def kind(self) -> str:
        """Its kinds as one text, such as ``"fold + boundary-equilibrium"``."""
        return " + ".join(self.kinds)

    @property
    def resonance(self) -> str:
        """Ratio of a resonance, such as ``"1:3"``; otherwise empty."""
        return self.kinds[0].removeprefix("resonance-") if self.kinds[0] in RESONANCES else ""


@dataclass(frozen=True, eq=False, repr=False)
class Curve(Result):
    """A curve of one bifurcation.

    Attributes
    ----------
    kind : str
    plane : Plane
    points : ndarray, shape (m, 2)
    periods : ndarray, shape (m,)
        Period of the orbit; ``nan`` for equilibria.
    radial_speeds : ndarray, shape (m,)
        ``ṙ`` of the orbit; ``nan`` for equilibria.
    admissible : ndarray of bool, shape (m,)
        Where it is a bifurcation of motions of the machine.
    orbits : tuple of OrbitName or CountedName
        Names of the orbits that bifurcate, where these are motions of the machine; for a fold the orbits that meet.
        Empty for equilibria and rolling.
    codimension2 : tuple of Codimension2Point
    stops : tuple of two str
        Reason for its end at both ends: ``"edge of the plane"``, ``"closed loop"``, the codimension-2 point where the
        bifurcation ceases (``"resonance-1:1"`` or ``"resonance-1:2"`` of a Neimark–Sacker curve),
        ``"period-halving"`` (both halves of the period become equal), ``"grazing meets the impact"`` (the time of grazing
        reaches an end of the period), ``"period vanishes"``, ``"radial speed without bound"``, or why the continuation gave
        up (:class:`~carom.continuation.Branch`).
    """

    kind: str
    plane: Plane
    points: np.ndarray
    periods: np.ndarray
    radial_speeds: np.ndarray
    admissible: np.ndarray
    orbits: tuple[OrbitName | CountedName, ...]
    codimension2: tuple[Codimension2Point, ...]
    stops: tuple[str, str]

    def line_of(self, name: str, value: object) -> str:
        """Points are stated in the units of both parameters."""
        if name == "points" and len(self.points):
            ranges = zip((self.plane.first, self.plane.second), self.points.T, strict=True)
            return f"{len(self.points)}, {', '.join(format_along(axis, ends) for axis, ends in ranges)}"
        return super().line_of(name, value)

    @cached_property
    def steps(self) -> np.ndarray:
        """Distances of neighbouring points in widths of the plane, shape (m − 1,)."""
        return np.linalg.norm(np.diff(self.points, axis=0) / self.plane.widths, axis=1)

    @property
    def subject(self) -> str:
        """The motion that bifurcates, such as ``"B1,c/d"``, ``"levitation"`` or ``"synchronous rub"``."""
        single = [name for name in self.orbits if isinstance(name, OrbitName)]
        if self.orbits and not single:
            return ", ".join(self.orbits)
        return combined(single) if single else STEADY_WORDS.get(STEADY.get(self.kind, ""), "")
