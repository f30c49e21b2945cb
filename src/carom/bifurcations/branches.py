"""Branches of orbits along a parameter."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import CaromError
from carom.base.results import Result
from carom.bifurcations.conditions import Solution, is_admissible, jacobian_at, name_of, with_slip
from carom.bifurcations.points import Bifurcation, kinds_in_a_line
from carom.models import Rotor
from carom.models.axes import Axis
from carom.orbits.names import CountedName, OrbitName
from carom.orbits.orbit import Orbit
from carom.orbits.shooting import ShootingStart, closed_flights, converged, links_of, pack, unpack
from carom.orbits.word import Word
from carom.parameters import Numbers, Scales
from carom.parameters.formats import format_range
from carom.parameters.scaling import SCALING

SAME_ORBIT_RTOL = 1e-6
"""Distance of the nodes, and of the durations, below which two orbits are the same."""


@dataclass(frozen=True, eq=False, repr=False)
class OrbitBranch(Result):
    """Orbits of a word along a parameter, motions of the machine and others.

    Attributes
    ----------
    axis : Axis
        The parameter.
    name : OrbitName or CountedName
        Name of the orbit from which it was followed.
    word : Word
    rotor : Rotor
        The rotor of that orbit.
    values : ndarray, shape (m,)
        The parameter.
    unknowns : ndarray, shape (m, k)
        Nodes and durations of each orbit, in the order of :func:`carom.orbits.shooting.pack`.
    special : tuple of Bifurcation
        In the order of the branch.
    stops : tuple of two str
        Reason for its end at both ends: ``"radial speed without bound"``, ``"period-halving"``, or see
        :class:`~carom.continuation.Branch`.
    """

    shown: ClassVar[tuple[str, ...]] = (
        "parameter",
        "name",
        "segments",
        "values",
        "period",
        "radial_speed",
        "special",
        "stops",
    )

    axis: Axis
    name: OrbitName | CountedName
    word: Word
    # Not narrower: the closed form reads the parameters of a planar rotor.
    rotor: Any
    values: np.ndarray
    unknowns: np.ndarray
    special: tuple[Bifurcation, ...]
    stops: tuple[str, str]

    def __len__(self) -> int:
        return len(self.values)

    def line_of(self, name: str, value: object) -> str:
        """Values are stated in the unit of the parameter."""
        if name == "values" and len(self):
            return f"{len(self)} from {format_range(self.axis.field, self.values)}"
        if name == "special":
            return kinds_in_a_line(self.special)
        return super().line_of(name, value)

    @property
    def known_scales(self) -> Scales | None:
        """Scales of the machine, unless they vary along the branch."""
        return None if self.parameter in SCALING else self.rotor.scales

    @property
    def parameter(self) -> str:
        """Name of the parameter."""
        return self.axis.name

    @property
    def segments(self) -> str:
        """The word as text."""
        return str(self.word)

    @property
    def impacts(self) -> int:
        """Impacts per period."""
        return len(self.word)

    @cached_property
    def closed(self) -> tuple[Solution, ...]:
        """Its orbits as the closed form of orbits with one impact a period describes them.

        Raises
        ------
        CaromError
            The closed form does not know them.
        """
        if not isinstance(self.name, OrbitName):
            raise CaromError(f"the orbits of the branch of {self.name} have no closed form")
        numbers = map(self.numbers_at, self.values.tolist())
        each = zip(numbers, self.period.tolist(), self.radial_speed.tolist(), strict=True)
        return tuple(Solution(name_of(at[0], self.name.pair, *at[1:]), *at) for at in each)

    @checked
    def numbers_at(self, value: float) -> Numbers:
        """Parameters of the planar rotor at a value of the parameter; with negative ``mu`` for orbits with backward slip."""
        numbers = Numbers.of(self.rotor.parameters).moved(self.parameter, value)
        return with_slip(numbers, self.word[0].sense)

    @cached_property
    def orbits(self) -> tuple[Orbit, ...]:
        """Every orbit, with its multipliers and its admissibility certified."""
        rows = zip(self.values.tolist(), self.unknowns, self.names, strict=True)
        return tuple(orbit_at(self.axis.move(self.rotor, p), self.word, u, name) for p, u, name in rows)

    @property
    def names(self) -> tuple[OrbitName | CountedName, ...]:
        """Name of each orbit; those of the closed form change at folds, others do not."""
        if isinstance(self.name, OrbitName):
            return tuple(solution.name for solution in self.closed)
        return (self.name,) * len(self)

    @property
    def period(self) -> np.ndarray:
        """Periods in ``1/Ω``, shape (m,)."""
        return self.unknowns.reshape(len(self), len(self.word), -1)[:, :, -1].sum(axis=1)

    @cached_property
    def _at_wall(self) -> np.ndarray:
        """:func:`speeds_at` of each orbit, shape (m, segments)."""
        nodes = [unpack(unknowns, len(self.word)).nodes for unknowns in self.unknowns]
        return speeds_at(np.concatenate(nodes)).reshape(len(self), -1)

    @property
    def radial_speeds(self) -> np.ndarray:
        """``ṙ`` just before each impact in ``c_r Ω``, shape (m, n)."""
        return self._at_wall.real

    @property
    def radial_speed(self) -> np.ndarray:
        """``ṙ`` just before the first impact in ``c_r Ω``, shape (m,)."""
        return self.radial_speeds[:, 0]

    @property
    def angular_speed(self) -> np.ndarray:
        """``θ̇`` just before the first impact in ``Ω``, shape (m,)."""
        return self._at_wall.imag[:, 0]

    @cached_property
    def admissible(self) -> np.ndarray:
        """Which orbits are motions of the machine, bool, shape (m,); the closed form judges by the extrema of the radius."""
        if isinstance(self.name, OrbitName):
            return np.array([is_admissible(*solution[1:]) for solution in self.closed])
        return np.array([orbit.admissible for orbit in self.orbits])

    @cached_property
    def multipliers(self) -> np.ndarray:
        """Non-trivial Floquet multipliers, complex, shape (m, 2N − 1)."""
        if isinstance(self.name, OrbitName):
            return np.linalg.eigvals([jacobian_at(*solution[1:]) for solution in self.closed]).astype(complex)
        return np.array([orbit.multipliers.values for orbit in self.orbits])

    @property
    def stable(self) -> np.ndarray:
        """Which orbits have all multipliers inside the unit circle, bool, shape (m,)."""
        return np.abs(self.multipliers).max(axis=1) < 1.0

    @checked
    def starts_at(self, value: float, rotor: Rotor | None = None) -> list[ShootingStart]:
        """Nodes and durations of its orbits at a value of the parameter, one for each time it passes there.

        A ``rotor`` with this value need not be made again.
        """
        rotor, found = rotor or self.axis.move(self.rotor, value), []
        for i, share in passing(self.values, value):
            guess = unpack((1.0 - share) * self.unknowns[i] + share * self.unknowns[i + 1], len(self.word))
            start = closed_flights(rotor, self.word, guess)
            if start is None:
                links = converged(rotor, self.word, guess)
                start = guess if links is None else links.start
            found.append(start)
        return found

    def passes(self, orbit: Orbit, value: float) -> bool:
        """Whether the branch passes through an orbit at a value of the parameter, whichever impact either of them begins with."""
        turns = [orbit.start.turned(places) for places in orbit.word.turns_to(self.word)]
        for start in self.starts_at(value, orbit.rotor) if turns else ():
            for turned in turns:
                apart = np.abs(pack(turned) - pack(start)).max()
                if apart < SAME_ORBIT_RTOL * (1.0 + float(np.abs(turned.nodes).max())):
                    return True
        return False


def orbit_at(rotor: Rotor, word: Word, unknowns: np.ndarray, name: OrbitName | CountedName) -> Orbit:
    """Orbit with given nodes and durations, in the order of :func:`carom.orbits.shooting.pack`."""
    return Orbit.from_links(rotor, word, links_of(rotor, word, unpack(unknowns, len(word))), name)


def speeds_at(nodes: np.ndarray) -> np.ndarray:
    """``ṙ`` in ``c_r Ω`` and ``θ̇`` in ``Ω`` at nodes (m, 2), as real and imaginary part, shape (m,)."""
    position, velocity = nodes.T
    speeds: np.ndarray = velocity / position
    return speeds.real * np.abs(position) + 1j * speeds.imag


def passing(values: np.ndarray, value: float) -> Iterator[tuple[int, float]]:
    """Steps of a branch that pass a value of the parameter: index of the first point, and share of the step before the value."""
    for i in np.flatnonzero((values[:-1] - value) * (values[1:] - value) <= 0.0).tolist():
        width = values[i + 1] - values[i]
        yield i, float((value - values[i]) / width) if width else 0.0
