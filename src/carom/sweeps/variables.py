"""The variables that a sweep stores for each point of its grid: names, descriptions, units and flags."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from carom.base.results import flags
from carom.parameters import UNITS


class Status:
    """State of a point of the grid."""

    WAITING, DONE, FAILED = 0, 1, 2


Kind = Literal["number", "count", "flag", "status"]
_DTYPES: dict[Kind, str] = {"number": "<f8", "count": "<i8", "flag": "|i1", "status": "|i1"}
_FILLS: dict[Kind, float | int] = {"number": np.nan, "count": -1, "flag": -1, "status": Status.WAITING}


@dataclass(frozen=True)
class Dimension:
    """A dimension of a variable besides the axes of the grid."""

    name: str
    values: tuple[int, ...]
    """Its coordinate."""
    words: str
    flags: tuple[str, ...]
    """Meaning of each value."""


@dataclass(frozen=True)
class Variable:
    """A number, a count or a flag that every point of the grid has; or its status."""

    name: str
    words: str
    kind: Kind = "number"
    """Stored as double, as 64-bit or as 8-bit integer; a missing value is stored as NaN or -1.

    One of "number", "count", "flag".
    """
    unit: str = "1"
    scale: str = ""
    """The property of :class:`~carom.parameters.Scales` that converts it to SI units; empty for a pure number."""
    si_of: str = ""
    """The variable that it is in SI units; empty for others."""
    flags: tuple[str, ...] = ()
    """Meanings of 0, 1, 2, ..."""
    along: Dimension | None = None

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the stored numbers, the same on every machine."""
        return np.dtype(_DTYPES[self.kind])

    @property
    def fill(self) -> float | int:
        """Value that is stored where there is no number."""
        return _FILLS[self.kind]

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape at one point of the grid."""
        return (len(self.along.values),) if self.along else ()

    @property
    def attributes(self) -> dict[str, Any]:
        """Attributes in the CF convention."""
        attributes: dict[str, Any] = {"long_name": self.words}
        if self.flags:
            attributes |= flags(list(range(len(self.flags))), self.flags)
        else:
            attributes["units"] = self.unit
        if self.si_of:
            attributes["si_of"] = self.si_of
        if self.fill == -1:
            attributes["_FillValue"] = self.fill
        return attributes


LEVITATES = Variable("levitates", "whether levitation exists and is stable", "flag", flags=("no", "yes"))
STATUS = Variable("status", "whether the point was computed", "status", flags=("waiting", "done", "failed"))
"""The variable that is written last: a chunk is finished as soon as its status is stored."""


def with_si(variables: Sequence[Variable], has_scales: bool) -> tuple[Variable, ...]:
    """Return variables with their units and, if scales are known, a second one ``name_si`` in SI units for each."""
    found = []
    for variable in variables:
        own, si = UNITS.get(variable.scale, (variable.unit, ""))
        found.append(replace(variable, unit=own))
        if si and has_scales:
            found.append(Variable(f"{variable.name}_si", variable.words, unit=si, si_of=variable.name))
    return tuple(found)
