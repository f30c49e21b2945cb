"""Maps over two numbers of the machine or of what is done to it: what is measured at each node is up to a measure.

``gains`` measures where disturbances end, ``drops`` how drops end and what the touchdown bearing bears; :func:`map_over` makes the
dataset of either, and :class:`OverPlane` is what the results have in common.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

import numpy as np

from carom.base.arguments import whole
from carom.base.outcome import InputError
from carom.base.progress import Reporter
from carom.basins.dataset import Stored
from carom.disturbances.measures import Quantity
from carom.models import Axis, Rotor, axis
from carom.models.axes import Ends, read_interval, usual_range
from carom.parameters.formats import format_entry, format_range

if TYPE_CHECKING:
    import xarray

Several = Annotated[int, whole(2)]
"""A number of values of a parameter."""
Node: TypeAlias = tuple[float, float]
"""Values of the two numbers."""
Entry: TypeAlias = Mapping[str, Any]
"""What is measured at a node, by name."""


class Measure:
    """What is measured at each node of a map over parameters of a machine."""

    stated: ClassVar[Mapping[str, Quantity]]
    """Its variables; of an entry without one of them the value is NaN, and one that no entry has is left out."""

    def varied(self, rotor: Rotor, name: str) -> Axis:
        """What is varied under a name."""
        return axis(rotor, name)

    def present(self, rotor: Rotor, varied: Axis) -> float:
        """Its present value; NaN if it has none."""
        return varied.value(rotor)

    def values(self, varied: Axis, present: float, given: Ends | None, count: int) -> np.ndarray:
        """Evenly spaced values over a range, by default half to twice the present value; ends are included."""
        return np.linspace(*read_interval(varied, given or usual_range(varied, present, "ranges")), count)

    def entries(self, rotor: Rotor, axes: tuple[Axis, Axis], nodes: Sequence[Node]) -> Iterator[Entry]:
        """What is measured at each node in turn."""
        raise NotImplementedError


def map_over(
    rotor: Rotor,
    measure: Measure,
    names: tuple[str, str],
    ranges: tuple[Ends | None, Ends | None],
    shape: tuple[int, int],
    tell: Reporter,
) -> tuple[xarray.Dataset, list[Entry]]:
    """Measure at each node of a grid of two numbers; return the dataset, and the entries in the order of its nodes.

    Raises
    ------
    InputError
        A name or a range cannot be used, or both names are the same.
    """
    import xarray

    axes = measure.varied(rotor, names[0]), measure.varied(rotor, names[1])
    if axes[0].name == axes[1].name:
        raise InputError("names", ",".join(names), "two different ones")
    present = [measure.present(rotor, varied) for varied in axes]
    values = [measure.values(*each) for each in zip(axes, present, ranges, shape, strict=True)]
    nodes, entries = [(float(x), float(y)) for x in values[0] for y in values[1]], list[Entry]()
    for entry in measure.entries(rotor, axes, nodes):
        entries.append(entry)
        tell(len(entries) / len(nodes))
    known = set().union(*entries)
    dimensions, counts = (axes[0].name, axes[1].name), tuple(map(len, values))
    variables = {
        name: (
            dimensions,
            np.array([entry.get(name, np.nan) for entry in entries], float).reshape(counts),
            {"units": unit, "long_name": words},
        )
        for name, (unit, words, _) in measure.stated.items()
        if name in known
    }
    along = {
        varied.name: (varied.name, each, {"units": varied.field.unit or "1", "long_name": varied.field.words})
        for varied, each in zip(axes, values, strict=True)
    }
    return xarray.Dataset(variables, coords=along, attrs={"present": json.dumps(present)}), entries


class OverPlane(Stored):
    """Base of maps over two numbers."""

    def varied(self, name: str) -> Axis:
        """What is varied under a name."""
        return axis(self.rotor, name)

    @property
    def axes(self) -> tuple[Axis, Axis]:
        """What is varied."""
        first, second = self.dataset[self.needed[0]].dims
        return self.varied(str(first)), self.varied(str(second))

    @property
    def plane(self) -> str:
        """Both with their ranges, in words."""
        return self.ranges_of(np.ones(self.dataset[self.needed[0]].shape, bool))

    def ranges_of(self, chosen: np.ndarray) -> str:
        """Ranges of both over the chosen nodes, at least one, in words."""
        values = [self.dataset[axis.name].values[chosen.any(axis=1 - place)] for place, axis in enumerate(self.axes)]
        return _said(self.axes, [format_range(axis.field, each) for axis, each in zip(self.axes, values, strict=True)])

    @property
    def present(self) -> tuple[float, float]:
        """Values of the present machine, and of what is done to it; NaN where there is none."""
        return tuple(json.loads(self.dataset.attrs["present"]))

    def at(self, values: Sequence[float]) -> str:
        """Values of both with their names and units."""
        pairs = zip(self.axes, values, strict=True)
        return _said(self.axes, [format_entry(axis.field, value) for axis, value in pairs])

    def line_of(self, name: str, value: object) -> str:
        """Present values are stated in the units of both."""
        return self.at(self.present) if name == "present" else super().line_of(name, value)


def _said(axes: Sequence[Axis], texts: Sequence[str]) -> str:
    pairs = zip(axes, texts, strict=True)
    return ", ".join(f"{axis.name.replace('_', ' ')} {text}".replace(" °", "°") for axis, text in pairs)
