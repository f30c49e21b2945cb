"""Boxes of machines: some parameters, each in an interval, the other numbers those of the hypotheses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import arb_series

from carom.base.outcome import InputError
from carom.parameters.terms import conflicts
from carom.proofs.balls import interval, rational
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.kick_cells import Part
from carom.proofs.lines import Line, Machines, line_of
from carom.proofs.series import terms
from carom.proofs.sides import Side

MOST_PARAMETERS = 3
"""Parameters of a box."""


@dataclass(frozen=True)
class Box:
    """All machines whose parameters lie in intervals, at the precision of their first use.

    Attributes
    ----------
    hypotheses : Hypotheses
        Their own values of the parameters do not matter.
    lines : tuple of Line
        One for each parameter.
    """

    hypotheses: Hypotheses
    lines: tuple[Line, ...]

    def ends(self, number: int, part: Part) -> tuple[Fraction, Fraction]:
        """Both ends of a part of the interval of a parameter, in its SI unit."""
        low, high = self.lines[number].ends
        place, halvings = part
        return tuple(low + (high - low) * Fraction(place + side, 2**halvings) for side in (0, 1))  # type: ignore[return-value]

    def values(self, parts: Sequence[Part]) -> dict[str, Any]:
        """Ball of each parameter on a part of the box."""
        return {line.name: interval(*self.ends(j, parts[j])) for j, line in enumerate(self.lines)}

    def middles(self, parts: Sequence[Part]) -> dict[str, object]:
        """Ball of the middle of each parameter on a part of the box."""
        return {line.name: rational(sum(self.ends(j, parts[j]), Fraction(0)) / 2) for j, line in enumerate(self.lines)}

    def series(self, parts: Sequence[Part]) -> list[dict[str, Any]]:
        """The parameters as power series in each of them, by half its width, on all of a part of the box."""
        balls, found = self.values(parts), []
        for j, line in enumerate(self.lines):
            low, high = self.ends(j, parts[j])
            found.append({**balls, line.name: arb_series([balls[line.name], rational((high - low) / 2)])})
        return found

    def sides(self, parts: Sequence[Part]) -> list[Side]:
        """By how much each parameter moves the numbers."""
        with terms(2):
            return [Side.of(self.machines.at(moved)) for moved in self.series(parts)]

    @cached_property
    def machines(self) -> Machines:
        """The machines as functions of the parameters."""
        return Machines(self.hypotheses)

    @property
    def words(self) -> str:
        """The intervals in words."""
        return " and ".join(line.words for line in self.lines)


def box_of(hypotheses: Hypotheses, along: Sequence[Sequence[str]]) -> Box:
    """Machines along some parameters, each as its name and both ends of its interval given as text.

    What :func:`~carom.proofs.lines.line_of` refuses is refused, and parameters two of which set the same number.
    """
    if len(along) > MOST_PARAMETERS:
        raise InputError("along", len(along), f"must be at most {MOST_PARAMETERS} parameters")
    lines = tuple(line_of(hypotheses, *entry) for entry in along)
    names = [line.name for line in lines]
    for name in names:
        if names.count(name) > 1:
            raise InputError("along", name, "names each parameter once")
    for problem in conflicts({line.name: f"{line.start} to {line.stop}" for line in lines}):
        raise problem
    return Box(hypotheses, lines)
