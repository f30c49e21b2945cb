"""Tables of columns with units: what the logs and ledgers of motions are made of."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import Field, field
from inspect import cleandoc
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from carom.base.outcome import Phase
from carom.base.results import Result, flags
from carom.parameters import UNITS

if TYPE_CHECKING:
    import xarray

    from carom.parameters import Scales

NUMBERED = "touchdown bearing, counted from 1"
"""What a table says of the column that names the bearing: people count from 1, indices of arrays (``plane``) count from 0."""


def column(quantity: str, words: str, heading: str = "") -> Any:
    """Field of a table: a property of :class:`~carom.parameters.Scales`, or a unit where it needs none; words; and what heads it in a terminal, if it is there."""
    return field(metadata={"quantity": quantity, "words": words, "heading": heading})


def in_units(
    dimension: str, values: np.ndarray, quantity: str, words: str, scales: Scales | None
) -> tuple[str, np.ndarray, dict[str, str]]:
    """Variable of a dataset with its unit and words; in SI if the machine is known."""
    unit, si = _units(quantity)
    if scales and unit != si:
        values, unit = values * getattr(scales, quantity), si
    return dimension, values, {"units": unit, "long_name": words}


class LogTable(Result):
    """Table of columns with units, all along one dimension.

    A column is a field made by :func:`column`, which docstring and dataset are made from.  Arrays are in
    the units of the equations; a table knows the scales of its machine, if these are known.
    """

    dimension: ClassVar[str]
    columns: ClassVar[dict[str, Mapping[str, str]]] = {}
    scales: Scales | None

    def __init_subclass__(cls, **keywords: object) -> None:
        super().__init_subclass__(**keywords)
        fields = {name: value.metadata for name, value in vars(cls).items() if isinstance(value, Field)}
        cls.columns = {name: metadata for name, metadata in fields.items() if metadata}
        entries = []
        for name, one in cls.columns.items():
            unit = "" if one["quantity"] == "1" else f", in ``{_units(one['quantity'])[0]}``"
            entries.append(f"{name} : ndarray\n    {one['words'][0].upper()}{one['words'][1:]}{unit}.")
        cls.__doc__ = "\n".join([cleandoc(cls.__doc__ or ""), "", "Attributes", "----------", *entries])

    def __len__(self) -> int:
        return len(getattr(self, next(iter(self.columns))))

    def kind_of(self, name: str) -> str:
        """What the metadata say."""
        quantity = self.columns[name]["quantity"] if name in self.columns else ""
        return "angle" if quantity == "rad" else quantity if quantity in UNITS else ""

    def to_dataset(self) -> xarray.Dataset:
        """Table with units and long names as attributes; in SI if the machine is known."""
        import xarray

        columns = self.columns.items()
        dataset = xarray.Dataset(
            {
                name: in_units(self.dimension, getattr(self, name), one["quantity"], one["words"], self.scales)
                for name, one in columns
            }
        )
        if "phase" in dataset:
            del dataset["phase"].attrs["units"]
            dataset["phase"].attrs |= phase_flags(Phase)
        return dataset


def _units(quantity: str) -> tuple[str, str]:
    """Unit of the equations and SI unit; the same for a column without scale."""
    return UNITS.get(quantity, (quantity, quantity))


def phase_flags(phases: Iterable[Phase]) -> dict[str, object]:
    """Attributes that give the meaning of phase numbers, by the CF conventions."""
    kinds = list(phases)
    return flags(np.array(kinds, np.int8), (phase.label for phase in kinds))
