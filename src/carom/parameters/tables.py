"""Tables of a machine file as frozen values: their entries are declared once, as fields, and read where the value is made."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, ClassVar, Self

from carom.base.arguments import checked
from carom.base.outcome import InputError, Problems, shown
from carom.parameters.fields import Field, unknown_names
from carom.parameters.quantities import read_quantity


def read_entries(part: Any, fields: Mapping[str, Field]) -> None:
    """Set the attributes of a frozen part to the numbers that were given for them; all that cannot be used are reported together.

    One that is ``None`` by default may be left out.
    """
    problems, optional = Problems(), {each.name for each in dataclasses.fields(part) if each.default is None}
    for name, field in fields.items():
        given = getattr(part, name)
        if given is not None:
            object.__setattr__(part, name, problems.attempt(read_quantity, field, given))
        elif name not in optional:
            problems.errors.append(InputError(name, None, field.allowed))
    problems.raise_all()


@dataclasses.dataclass(frozen=True)
class Table:
    """Base class of a table of a machine file in SI units: a frozen dataclass whose attributes are its entries.

    Attributes
    ----------
    heading : str
        Name of the table.
    entries : mapping of str to Field
        Its numbers.
    texts : tuple of str
        Entries that are no numbers.
    means_something_empty : bool
        Whether a table without entries says something, as that of weight does.
    """

    heading: ClassVar[str]
    entries: ClassVar[Mapping[str, Field]]
    texts: ClassVar[tuple[str, ...]] = ()
    means_something_empty: ClassVar[bool] = True

    def __post_init__(self) -> None:
        read_entries(self, self.entries)

    @property
    def given(self) -> dict[str, Any]:
        """The numbers that are stated, in SI units."""
        own = {each.name: getattr(self, each.name) for each in dataclasses.fields(self) if each.name in self.entries}
        return {name: value for name, value in own.items() if value is not None}

    def unit(self, name: str) -> str:
        """SI unit of an entry."""
        return self.entries[name].unit

    def to_toml(self) -> str:
        """Return the text of a table that is read as this value; nothing if nothing is stated."""
        lines = [f'{name} = "{getattr(self, name)}"' for name in self.texts]
        lines += [f"{name} = {value!r}  # {self.unit(name)}".rstrip("# ") for name, value in self.given.items()]
        return "\n".join([f"[{self.heading}]", *lines]) + "\n" if lines else ""

    @classmethod
    @checked
    def of(cls, table: Mapping[str, Any], has_scales: bool = True) -> Self:
        """Read a table; one beside dimensionless parameters has no mass and clearance to be compared with.

        Raises
        ------
        InputError
            An unknown name, a value that is not allowed, or a table without a machine in SI units.
        """
        problems, known = Problems(), dict.fromkeys(cls.texts) | dict(cls.entries)
        problems.errors += unknown_names(table, known, f"[{cls.heading}]")
        if not has_scales and (table or cls.means_something_empty):
            problems.errors.append(cls.without_scales(shown(dict(table))))
        found = problems.attempt(cls, **{name: value for name, value in table.items() if name in known})
        problems.raise_all()
        return found or cls()

    @classmethod
    def without_scales(cls, given: object) -> InputError:
        """The error of the table beside dimensionless parameters."""
        allowed = "not allowed beside [dimensionless]: it is in SI units, which need a [machine] table with mass, clearance and speed"
        return InputError(cls.heading, shown(given), allowed)
