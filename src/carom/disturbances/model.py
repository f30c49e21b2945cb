"""Base class of the models of disturbances."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from inspect import signature
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from carom.base.arguments import checked, is_number
from carom.base.outcome import InputError, Outcome, shown
from carom.disturbances.coordinates import INSTANT, Coordinate, Starts
from carom.disturbances.single import Echo, Part, Single, in_both_units, read_single
from carom.parameters import Scales, own_size, usual_kick
from carom.parameters.formats import format_angle, format_quantity

if TYPE_CHECKING:
    from carom.models import Rotor, Subject
    from carom.motions.starts import State

FASTEST = usual_kick(None)
"""Largest speed in ``c_r Ω`` of a disturbance that is made without a machine."""
_SIZES = ("fastest", "peak", "duration", "largest", "change")


@dataclass(frozen=True)
class Disturbance:
    """Base class of disturbances; see :mod:`carom.disturbances` for the models.

    A subclass of your own is a frozen dataclass with :attr:`coordinates` and :meth:`starts`.  It can be used wherever a
    model of carom can; results that were saved with it are read where its module has been imported.

    Attributes
    ----------
    kind : str
        Its name in files and results; by default that of the class in lower case.
    noun : str
        What many of them are called, in sentences.
    measured_in : dict of str to str
        Property of :class:`~carom.parameters.Scales` that is the unit of each field with a unit, so that a disturbance
        keeps its size in SI units where a sweep or a gain map changes the scales.
    changes_machine : bool
        Whether the machine after it is another one; then its starts say which.
    parts : tuple of Part
        The text of a single one: the fields and coordinates that it states, in turn.
    example : str
        Such a text in quotes.
    bare : bool
        Whether its sizes may be numbers without a unit where the machine is in SI units.
    many : bool
        Whether grids and samples of it are taken, in sweep files too.
    """

    kind: ClassVar[str] = ""
    noun: ClassVar[str] = "disturbances"
    measured_in: ClassVar[dict[str, str]] = {}
    changes_machine: ClassVar[bool] = False
    parts: ClassVar[tuple[Part, ...]] = ()
    example: ClassVar[str] = ""
    bare: ClassVar[bool] = False
    many: ClassVar[bool] = True

    def __init_subclass__(cls, **keywords: object) -> None:
        super().__init_subclass__(**keywords)
        if cls.__dict__.get("kind") == "":  # the base of several kinds
            return
        if "kind" not in cls.__dict__:
            cls.kind = cls.__name__.lower()
        known = _KNOWN.get(cls.kind, cls)
        if known.__qualname__ != cls.__qualname__:
            raise InputError("kind", cls.kind, f"another name: {known.__qualname__} has this one")
        _KNOWN[cls.kind] = cls
        if cls.many:
            MODELS[cls.kind] = cls

    def __post_init__(self) -> None:
        for name, scale in self.measured_in.items():
            value = getattr(self, name)
            if isinstance(value, str):
                raise InputError(name, value, f"a number; text with a unit is for {type(self).__name__}.of(machine, …)")
            if not is_number(value):
                raise InputError(name, value, f"a finite number, in the unit of {scale} of the equations")
            if name in _SIZES and (isinstance(value, complex) or value <= 0.0):
                raise InputError(name, value, "a size, above 0")

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Coordinates by which the disturbance varies."""
        raise NotImplementedError

    @property
    def size(self) -> Coordinate | None:
        """Their size, up to the largest; by default the first of two coordinates that are a size from 0 and a direction."""
        axes = self.coordinates
        return axes[0] if len(axes) == 2 and axes[0].low == 0.0 and axes[1].periodic else None

    def drawn(self, shares: np.ndarray) -> tuple[np.ndarray, ...]:
        """Values of the coordinates drawn by numbers uniform from 0 to 1, shape (number, coordinates)."""
        return tuple(coordinate.at(share) for coordinate, share in zip(self.coordinates, shares.T, strict=True))

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """Starts of free motion.

        Parameters
        ----------
        *values : ndarray
            One array for each coordinate, broadcast against each other.
        instant : ndarray
            Angle by which the shaft has turned when the disturbance comes; asked for only of machines on which that matters
            (:attr:`carom.models.Rotor.depends_on_instant`).
        """
        raise NotImplementedError

    @staticmethod
    def of_kind(kind: object) -> type[Disturbance]:
        """The class of this kind; refuse one that is not known."""
        if kind not in _KNOWN:
            known = f"one of: {', '.join(_KNOWN)}; one of your own must be imported before its results are read"
            raise InputError("disturbance", kind, known)
        return _KNOWN[str(kind)]

    @classmethod
    def read(cls, text: str, machine: Subject, name: str = "") -> Single:
        """Read a single disturbance, such as ``VelocityKick.read("60 mm/s, 30 deg", machine)``, for :func:`carom.simulate`.

        Parameters
        ----------
        text : str
            Its :attr:`parts` with commas between them; those at the end may be left out.
        machine : Machine, Case, Parameters or model
        name : str
            What errors call it, by default its kind.

        Raises
        ------
        InputError
            The text is none of this kind.
        """
        from carom.models import rotor_of

        return cls.single_of(text, rotor_of(machine).scales, name or cls.kind)

    @classmethod
    def single_of(cls, text: str, scales: Scales | None, option: str) -> Single:
        """The same for scales, as of an option of the command line, which errors name."""
        if not cls.parts:
            raise InputError(option, shown(text), "a kind of disturbance that has a text")
        return read_single(cls, text, scales, option)

    def apply(self, machine: Subject, *values: float | str, instant: float | str = 0.0) -> tuple[Rotor, State]:
        """Return the machine that moves after one disturbance, perhaps in stages or another one than before, and its start.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
        *values : float or str
            Values of the coordinates in turn, in units of the equations or text with a unit; a size that comes first may be left out for the
            largest, and angles that come last for 0.
        instant : float or str
            Angle by which the shaft has turned when it comes, rad, since the co-rotating frame coincided with the fixed one.

        Raises
        ------
        InputError
            The rotor cannot levitate inside the wall before it, or its motion ends during it.
        """
        from carom.models import rotor_of
        from carom.motions.starts import State

        rotor = rotor_of(machine)
        *own, begun = self.whole(values, instant, rotor.scales)
        given = [np.array([each]) for each in own]
        starts = self.starts_on(rotor, *given, *([np.array([begun])] if rotor.depends_on_instant else []))
        if not starts.exists[0]:
            radius = f"|U*| = {rotor.system.rest_radius:.6g}"
            raise InputError(
                "disturbance", radius, f"needs levitation inside the wall before a disturbance ({self.kind})"
            )
        if starts.ended[0]:
            words = f"another size or direction: with this one the motion ends during it ({Outcome(int(starts.ended[0])).words})"
            raise InputError("disturbance", self.kind, words)
        state = State.of(starts.positions[0], starts.velocities[0], time=float(starts.begins[0]))
        return rotor if starts.after is None else starts.after[0], state

    def whole(
        self, values: Sequence[float | str], instant: float | str = 0.0, scales: Scales | None = None
    ) -> tuple[float, ...]:
        """Values of all coordinates and the instant, checked, from those that are given."""
        axes = self.coordinates
        if len(values) < len(axes) and self.size == axes[0]:
            values = (axes[0].high, *values)
        values = (*values, *(0.0 for each in axes[len(values) :] if each.periodic))
        if len(values) != len(axes):
            raise InputError("values", shown(values), f"one for each of {', '.join(each.name for each in axes)}")
        return tuple(
            own_size(f"{self.kind} {each.name}", value, each.scale if each.scale else "angle", scales)
            for each, value in zip((*axes, INSTANT), (*values, instant), strict=True)
        )

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """What was done to a rotor by one disturbance with these values of the coordinates, in a sentence."""
        sizes = {each.name: (value, each.scale) for each, value in zip(self.coordinates, values, strict=True)}
        words = (
            f"{each.words} {format_quantity(value, each.scale, rotor.scales) if each.scale else format_angle(value)}"
            for each, value in zip(self.coordinates, values, strict=True)
        )
        return Echo(self.kind, f"Disturbance, {self.kind}: {', '.join(words)}", sizes)

    def up_to_words(self, before: float | None, scales: Scales | None) -> str:
        """How large those of a plan are, on a machine with an eccentricity ``before`` them, in clearances, if there is one."""
        size = self.size
        return "" if size is None else f"{size.words} up to {in_both_units(size.high, size.scale, scales)}"

    def coordinates_on(self, rotor: Rotor) -> tuple[Coordinate, ...]:
        """Coordinates by which the disturbance varies on a machine: those of the model, and the instant where that matters."""
        return (*self.coordinates, INSTANT) if rotor.depends_on_instant else self.coordinates

    def starts_on(self, rotor: Rotor, *values: np.ndarray) -> Starts:
        """Starts of free motion by the coordinates on a machine."""
        if not rotor.depends_on_instant:
            return self.starts(rotor, *values)
        if "instant" not in signature(self.starts).parameters:
            allowed = "one whose starts take the instant, on a machine on which that matters (weight, limits, axes of bearings)"
            raise InputError("disturbance", self.kind, allowed)
        *own, instant = values
        return self.starts(rotor, *own, instant=instant)

    @classmethod
    def of(cls, machine: Subject, *sizes: float | str, **others: Any) -> Self:
        """Disturbance with sizes for a machine, such as ``VelocityKick.of(machine, "50 mm/s")``.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
        *sizes : float or str
            Sizes of the fields with a unit, in the order of ``measured_in``: text with a unit, or numbers in the units of
            the equations; an unbalance may be stated by its eccentricity.  Without a largest speed it is :func:`~carom.parameters.usual_kick`.
        **others
            Fields without a unit.

        Raises
        ------
        InputError
            A size is not allowed, or has a unit and the machine has no scales.
        """
        if len(sizes) > len(cls.measured_in):
            raise InputError("sizes", shown(sizes), f"at most {len(cls.measured_in)}: {', '.join(cls.measured_in)}")
        from carom.models import rotor_of

        scales = rotor_of(machine).scales
        pairs = zip(cls.measured_in.items(), sizes, strict=False)
        given: dict[str, Any] = {name: own_size(name, size, kind, scales) for (name, kind), size in pairs}
        if "fastest" in cls.measured_in:
            given.setdefault("fastest", usual_kick(scales))
        return cls(**given, **others)

    @checked
    def rescaled(self, before: Scales | None, after: Scales | None, names: Collection[str] | None = None) -> Self:
        """Return the disturbance that is the same in SI units for a machine with other scales.

        Parameters
        ----------
        before, after : Scales or None
            Without scales nothing changes.
        names : collection of str, optional
            Fields that are to be the same in SI units, by default all that have a unit.
        """
        if before is None or after is None or before == after:
            return self
        changes = {
            name: getattr(self, name) * (getattr(before, scale) / getattr(after, scale))
            for name, scale in self.measured_in.items()
            if names is None or name in names
        }
        return dataclasses.replace(self, **changes)

    def describe(self) -> dict[str, object]:
        """Kind and numbers of the disturbance, as plain data for JSON.

        Raises
        ------
        InputError
            A field of an own subclass that is no number, text, or tuple of these.
        """
        numbers = {one.name: _plain(one.name, getattr(self, one.name)) for one in dataclasses.fields(self)}
        return {"kind": self.kind, **numbers}

    @staticmethod
    @checked
    def from_description(description: Mapping[str, object]) -> Disturbance:
        """Disturbance from its description.

        Raises
        ------
        InputError
            A kind of disturbance that is not known.
        """
        model = Disturbance.of_kind(description["kind"])
        fields = [one for one in dataclasses.fields(model) if one.name in description]
        return model(**{one.name: _from_plain(one, description[one.name]) for one in fields})


_KNOWN: dict[str, type[Disturbance]] = {}
MODELS: dict[str, type[Disturbance]] = {}
"""All models by their kind, those of carom and those that users have defined; and those of which grids and samples are taken."""


def _plain(name: str, value: object) -> object:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, tuple):
        return [_plain(name, part) for part in value]
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise InputError(name, shown(value), "a number, a text, or a tuple of these, so that results can record it")


def _from_plain(field: dataclasses.Field[object], value: Any) -> object:
    """Value of a field from plain data, in which complex numbers and tuples are lists."""
    if field.type in (complex, "complex"):
        return complex(*value) if isinstance(value, list) else complex(value)
    return tuple(value) if isinstance(value, list) else value
