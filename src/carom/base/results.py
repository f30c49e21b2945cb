"""What results show: a few lines for interpreters and notebooks, however large they are, and plain data and tables by columns declared once."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set, Sized
from enum import Enum
from importlib import import_module
from numbers import Complex
from types import MappingProxyType
from typing import Any, ClassVar, Literal, NamedTuple, TypeVar, overload

import numpy as np

from carom.base.outcome import InputError
from carom.base.tabular import Tabular

Member = TypeVar("Member")
WIDEST = 120
"""Largest number of characters of a line, without the name before it."""
FEW = 4
"""Largest size of an array whose numbers are shown one by one."""
DIGITS = 6
_KINDS = {
    "time": "time times period periods duration contact_time",
    "length": "position places radius radii gap amplitudes depth",
    "velocity": "velocity radial_speed radial_speeds",
    "speed": "angular_speed",
    "force": "force normal_force normal_forces largest_force",
    "impulse": "impulse largest_impulse",
    "energy": "heat restitution_loss",
    "power": "power lasting_power",
    "angle": "angle",
}
KINDS = MappingProxyType({name: kind for kind, names in _KINDS.items() for name in names.split()})
"""Attributes in units of the equations, each with its property of the scales of a rotor: in SI units, people see more."""
BOXES = {"figures": "carom.plots", "proofs": "carom.proofs"}
"""Packages that stand above those that ask for them: the layers forbid imports from above, so they are named as data."""
_OF_THE_MACHINE = ("rotor", "model", "parameters", "numbers")
"""Attributes that know the scales of the machine, where a result does not itself."""


def box(name: Literal["figures", "proofs"]) -> Any:
    """The package that draws results, or the one that proves; the second needs the extra ``carom[proof]``."""
    return import_module(BOXES[name])


class Result(Tabular):
    """Result of a function: a frozen dataclass that is shown by its attributes, large ones by their size only.

    ``shown`` names the attributes to show, which may be properties; if it is empty, all fields are shown.  ``figure``
    names the function of :mod:`carom.plots` that draws such a result; it is empty if there is none.
    """

    shown: ClassVar[tuple[str, ...]] = ()
    figure: ClassVar[str] = ""

    def plot(self, *args: object, **options: object) -> Any:
        """Draw this result: ``result.plot(...)`` is ``carom.plots.<figure>(result, ...)``.

        Raises
        ------
        InputError
            There is no figure of such a result.
        """
        if not self.figure:
            raise InputError("plot", type(self).__name__, "a result with a figure; draw its arrays with matplotlib")
        return getattr(box("figures"), self.figure)(self, *args, **options)

    def rows(self) -> list[tuple[str, str]]:
        """By default the names of the attributes and their values."""
        names = self.shown or tuple(field.name for field in dataclasses.fields(self))  # type: ignore[arg-type]
        values = [(name, getattr(self, name)) for name in names if name != "scales"]
        return [(name, self.line_of(name, value)) for name, value in values if not callable(value)]

    def line_of(self, name: str, value: object) -> str:
        """An attribute in a line: in units of the equations, behind it in SI units if the machine is known."""
        return format_value(self.kind_of(name), value, self.known_scales)

    def kind_of(self, name: str) -> str:
        """Property of the scales by which an attribute is converted, ``"angle"``, or nothing."""
        return KINDS.get(name, "")

    @property
    def known_scales(self) -> Any:
        """Scales that convert all attributes to SI units; ``None`` where they are not known."""
        if (own := getattr(self, "scales", None)) is not None:
            return own
        holders = (_held(self, name) for name in _OF_THE_MACHINE)
        return next((found for holder in holders if (found := getattr(holder, "scales", None)) is not None), None)


def _held(result: object, name: str) -> object:
    """An attribute of a result; ``None`` if there is none, or none for this model: only the planar rotor has ``parameters``."""
    try:
        return getattr(result, name, None)
    except InputError:
        return None


class Members(Result, Sequence[Member]):
    """Result that holds others, to look up by index or, where they have names, by name.

    ``called`` is what an error calls one of them.
    """

    called: ClassVar[str]
    members: tuple[Member, ...]

    def __len__(self) -> int:
        return len(self.members)

    def __iter__(self) -> Iterator[Member]:
        return iter(self.members)

    def __contains__(self, key: object) -> bool:
        return key in self.members or key in self._names

    @overload
    def __getitem__(self, key: int | str) -> Member: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Member, ...]: ...
    def __getitem__(self, key: int | str | slice) -> Member | tuple[Member, ...]:
        if not isinstance(key, str):
            return self.members[key]
        if key not in self._names:
            raise InputError(self.called, key, f"one of: {', '.join(self._names) or 'none'}")
        return self.members[self._names.index(key)]

    @property
    def _names(self) -> list[str]:
        return [getattr(member, "name", "") for member in self.members]


def format_value(kind: str, value: object, scales: object) -> str:
    """A value of a kind in a line, behind it in SI units if the scales are known."""
    # The layers forbid imports from above.
    beside = import_module("carom.parameters.formats").format_beside(value, kind, scales) if kind and scales else ""
    return f"{in_a_line(value, scales)}{beside}"


def attribute_of(entry: object, path: str) -> object:
    """An attribute, perhaps of an attribute: ``None`` of one that is ``None``."""
    for name in path.split("."):
        entry = None if entry is None else getattr(entry, name)
    return entry


def _plain(value: object) -> object:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if type(value) is tuple:
        return [_plain(each) for each in value]
    return value.document() if hasattr(value, "document") else value


def record(entry: object, columns: str, scales: object = None) -> dict[str, Any]:
    """Attributes as plain data for JSON, by the declaration of their columns: ``"name kind=edge.kind period: lost=size:velocity"``.

    A column is a key, behind ``=`` the attribute where it has another name, and behind ``:`` what kind of number it is, by default that of :data:`KINDS`.
    With scales such a number is there once more, in SI units under a key that ends in ``_si``.  What has a method ``document`` is
    given by that; of ``None`` every attribute is ``None``.
    """
    found, kinds = dict[str, object](), dict[str, str]()
    for column in columns.split():
        named, is_number, kind = column.partition(":")
        key, _, name = named.partition("=")
        found[key] = _plain(attribute_of(entry, name or key))
        if is_number:
            kinds[key] = kind or KINDS[key]
    return found | in_si(found, scales, **kinds)


class Column(NamedTuple):
    """A value of each entry of a result.

    Attributes
    ----------
    key : str
        Its key in JSON as :func:`record` reads it: ``"branch=name"``, ``"period:"``; empty if it is not there.
    heading : str
        What heads it in tables; empty if it is in none.  Braces stand for attributes of the result: ``"{0.parameter}"``.
    text : callable, optional
        What stands in its cells, from the entry and the result; by default the attribute.
    """

    key: str
    heading: str = ""
    text: Callable[..., str] | None = None

    def cell(self, entry: object, result: object) -> str:
        """What stands in the cell of an entry of a result."""
        if self.text is not None:
            return self.text(entry, result)
        return str(attribute_of(entry, self.key.partition(":")[0].rpartition("=")[2]))


def keys_of(columns: Iterable[Column]) -> str:
    """The declaration of the keys in JSON, for :func:`record`."""
    return " ".join(column.key for column in columns if column.key)


def table_of(columns: Iterable[Column], entries: Iterable[object], result: object) -> tuple[list[str], list[list[str]]]:
    """Headings, and a row of texts for each entry of a result."""
    shown = [column for column in columns if column.heading]
    headings = [column.heading.format(result) for column in shown]
    return headings, [[column.cell(entry, result) for column in shown] for entry in entries]


def flags(values: object, meanings: Iterable[str]) -> dict[str, Any]:
    """Attributes that give the meaning of whole numbers, by the CF conventions."""
    words = " ".join(meaning.replace("-", "_").replace(" ", "_") for meaning in meanings)
    return {"flag_values": values, "flag_meanings": words}


def in_si(values: Mapping[str, object], scales: object, **kinds: str) -> dict[str, object]:
    """Some numbers of a document once more, in SI units under keys that end in ``_si``; nothing without scales.

    What a number is says the name of a property of the scales: ``lost="velocity"``.
    """
    if scales is None:
        return {}
    return {f"{name}_si": _times(values[name], getattr(scales, kind)) for name, kind in kinds.items()}


def _times(value: Any, scale: float) -> object:
    """A number, or each of a list, in other units; ``None`` where there is none."""
    if isinstance(value, list):
        return [_times(entry, scale) for entry in value]
    return None if value is None else value * scale


def in_a_line(value: object, scales: object = None) -> str:
    """A value in one line: numbers to six digits, arrays by size and range, collections by number and names.

    With scales the parts of a state and the like are stated in SI units too.
    """
    if value is None:
        return "none"
    if isinstance(value, Enum):
        return value.name.lower().replace("_", " ")
    if isinstance(value, str):
        return _cut(value)
    if isinstance(value, bool | np.bool_):
        return "yes" if value else "no"
    if isinstance(value, Complex):
        return _number(value)
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, Result):
        name = f"of {len(value)}" if isinstance(value, Sized) else _text(value, "name")
        return (f"{type(value).__name__} {name}" if name else _cut(_text(value, "words"))) or type(value).__name__
    if isinstance(value, Mapping):
        return _cut(", ".join(f"{key} {in_a_line(entry)}" for key, entry in value.items()) or "none")
    if isinstance(value, Sequence | Set):
        return _counted(list(value))
    if dataclasses.is_dataclass(value):
        return _cut(_text(value, "words")) or _parts(value, scales)
    return _cut(repr(value))


def _text(value: object, name: str) -> str:
    """What something says itself that it is; empty if it does not."""
    text = getattr(value, name, "")
    return text if isinstance(text, str) else ""


def _parts(value: Any, scales: object) -> str:
    fields = [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
    stated = [
        f"{name}={format_value(KINDS.get(name, ''), entry, scales)}"
        for name, entry in fields
        if entry is not None and not callable(entry)
    ]
    return _cut(f"{type(value).__name__}({', '.join(stated)})")


def _number(value: Complex) -> str:
    if isinstance(value, int | np.integer):
        return str(value)
    number = complex(value)
    if isinstance(value, float | np.floating):
        return f"{number.real:.{DIGITS}g}"
    return f"{number.real:.{DIGITS}g}{number.imag:+.{DIGITS}g}i"


def _array(values: np.ndarray) -> str:
    if values.dtype.names is not None or values.dtype == object:
        return f"{values.size} entries"
    if values.size <= FEW:
        return ", ".join(in_a_line(value) for value in values.ravel()) or "empty"
    size = " x ".join(str(length) for length in values.shape)
    if np.iscomplexobj(values) or values.dtype.kind not in "fiu":
        return f"{size} {'complex numbers' if np.iscomplexobj(values) else 'values'}"
    known = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    if not known.size:
        return f"{size} numbers, none finite"
    return f"{size} numbers from {_number(known.min())} to {_number(known.max())}"


def _counted(entries: list[object]) -> str:
    """A collection by what identifies its entries, their names or themselves if they are text or numbers, otherwise by its size."""
    if not entries:
        return "none"
    stated = [in_a_line(each) if isinstance(each, str | Complex) else _text(each, "name") for each in entries]
    if all(stated):
        return _cut(f"{len(entries)}: {', '.join(stated)}" if len(entries) > FEW else ", ".join(stated))
    kinds = dict.fromkeys(type(entry).__name__ for entry in entries)
    return f"{len(entries)} of {', '.join(kinds)}"


def _cut(text: str) -> str:
    flat = " ".join(text.split())
    return flat if len(flat) <= WIDEST else f"{flat[: WIDEST - 1]}…"
