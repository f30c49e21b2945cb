"""What a machine must survive: the table ``[survive]`` of a machine file, and options in its place."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Literal, Protocol, Self, TypeVar, runtime_checkable

from carom.base.arguments import Positive, Whole, checked
from carom.base.outcome import InputError, Problems, shown
from carom.parameters.fields import DIMENSIONLESS_FIELDS, unknown_names
from carom.parameters.formats import read_size
from carom.parameters.scaling import GRAVITY, Scales

SHOCK_DURATION = 0.011
"""Duration of a shock for which none is stated, s: that of the usual test pulse (IEC 60068-2-27)."""
_Read = TypeVar("_Read")
Source = Literal["file", "option", "default"]

SURVIVE_ENTRIES: Mapping[str, tuple[str, str]] = {
    "kick": ("velocity kick out of levitation", '"100 mm/s"'),
    "shock": ("half-sine shock of the base: peak and duration", '"5 g, 11 ms"'),
    "blade_loss": ("change of the unbalance by the loss of a blade, or of its eccentricity", '"2000 g mm"'),
    "blade_loss_node": ("node of a flexible machine at which the unbalance changes", "2"),
}
"""Entries of a ``[survive]`` table, in words and with an example; each may be left out."""


@checked
@dataclass(frozen=True)
class Shock:
    """A half-sine shock of the base.

    Parameters
    ----------
    peak : float
        Largest acceleration, m/s² (or ``c_r Ω²``).
    duration : float
        In s (or ``1/Ω``).

    Raises
    ------
    InputError
        One of them is not a finite number above 0.
    """

    peak: Positive
    duration: Positive


@runtime_checkable
class BaseMotionRequired(Protocol):
    """A recorded motion of the base that must be survived."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def largest(self) -> float:
        """Its largest peak acceleration."""

    def rescaled(self, before: Scales | None, after: Scales | None) -> Self:
        """The same for a machine with other scales."""


SI = Scales(1.0, 1.0, 1.0)
"""Scales in which times are in s and accelerations in m/s²."""


@dataclass(frozen=True)
class Required:
    """What a machine must survive, in units of the equations; speeds and accelerations are those of the fixed frame.

    Attributes
    ----------
    kick : float
        Size of a velocity kick out of levitation, in ``c_r Ω``.
    shock : Shock or None
        Peak in ``c_r Ω²``, duration in ``1/Ω``.
    blade_loss : float or None
        Size of the change of the unbalance by the loss of a blade, divided by the mass, in ``c_r``; at any phase.
    blade_loss_node : int or None
        Node of a flexible machine at which it changes.
    base_record : carom.disturbances.BaseRecord or None
        Recorded motion of the base up to its largest peak, turned to all directions.
    """

    kick: float
    shock: Shock | None
    blade_loss: float | None
    blade_loss_node: int | None = None
    base_record: BaseMotionRequired | None = None


@checked
@dataclass(frozen=True)
class Requirement:
    """What a machine must survive; ``None`` where nothing is stated.

    For a machine with SI units these are numbers in SI units, which stay when its speed or clearance changes; for one
    without scales they are in the units of the equations.  :meth:`of` reads text.

    Parameters
    ----------
    kick : float, optional
        Size of a velocity kick out of levitation in the fixed frame, m/s (or ``c_r Ω``).  Where none is stated
        :func:`usual_kick` stands for it, also beside a shock or the loss of a blade.
    shock : Shock, optional
        Half-sine shock of the base, in m/s² and s (or ``c_r Ω²`` and ``1/Ω``).
    blade_loss : float, optional
        Size of the change of the unbalance by the loss of a blade, kg m (or divided by the mass, in ``c_r``).
    blade_loss_node : int, optional
        Node of a flexible machine at which it changes; by default the only one that has an unbalance.
    source : {"file", "option", "default"}
        Where the numbers come from; ``"default"`` if none is given.

    Raises
    ------
    InputError
        A value is not of this kind, or not a finite number above 0.

    Examples
    --------
    >>> import carom as cm
    >>> case = cm.load("examples/keogh-cole.toml")
    >>> needed = cm.parameters.Requirement.of(case, shock="5 g, 11 ms")
    >>> f"{needed.complete(case.parameters.scales).kick:.4f} m/s"
    '0.1657 m/s'
    """

    kick: Positive | None = None
    shock: Shock | None = None
    blade_loss: Positive | None = None
    source: Source = "option"
    blade_loss_node: Whole | None = None
    base_record: BaseMotionRequired | None = None

    def __post_init__(self) -> None:
        if not any(value is not None for name, value in vars(self).items() if name != "source"):
            object.__setattr__(self, "source", "default")

    @checked
    def changed_by(self, other: Requirement) -> Requirement:
        """Return this requirement with what another one states in its place."""
        stated = {name: value for name, value in vars(other).items() if value is not None}
        return self if other.source == "default" else dataclasses.replace(self, **stated)

    @checked
    def complete(self, scales: Scales | None) -> Requirement:
        """Return this requirement with the usual kick, in its own units, where no kick is stated."""
        if self.kick is not None:
            return self
        return dataclasses.replace(self, kick=_fall_speed(scales) if scales else usual_kick(None))

    @checked
    def own(self, scales: Scales | None) -> Required:
        """Return what is required in units of the equations.

        Parameters
        ----------
        scales : Scales or None
            Those of the machine.  Without them the numbers are in units of the equations already.

        Raises
        ------
        InputError
            The change of the unbalance by the loss of a blade gives an eccentricity that is out of range.
        """
        kick = usual_kick(scales) if self.kick is None else self.kick / (scales.velocity if scales else 1.0)
        shock, change = self.shock, self.blade_loss
        if scales and shock:
            shock = Shock(shock.peak / scales.acceleration, shock.duration / scales.time)
        if change is not None:
            change /= scales.unbalance if scales else 1.0
            rho = DIMENSIONLESS_FIELDS["rho"]
            if not rho.contains(change):
                gives = f"gives a change of the eccentricity of {change:.6g} clearances, which {rho.allowed}"
                name = "[survive] blade_loss" if self.source == "file" else "blade_loss"
                raise InputError(name, self.blade_loss, gives)
        moved = self.base_record and self.base_record.rescaled(SI, scales)
        return Required(kick, shock, change, self.blade_loss_node, moved)

    def to_toml(self, has_scales: bool = True) -> str:
        """Return the text of a table that is read as this requirement; nothing if nothing is stated."""
        velocity, acceleration, time, unbalance = (" m/s", " m/s^2", " s", " kg m") if has_scales else ("",) * 4
        shock = self.shock and f'"{self.shock.peak!r}{acceleration}, {self.shock.duration!r}{time}"'
        entries = {
            "kick": self.kick and f'"{self.kick!r}{velocity}"',
            "shock": shock,
            "blade_loss": self.blade_loss and f'"{self.blade_loss!r}{unbalance}"',
            "blade_loss_node": self.blade_loss_node,
        }
        lines = [f"{name} = {text}" for name, text in entries.items() if text is not None]
        return "\n".join(["[survive]", *lines]) + "\n" if lines else ""

    @classmethod
    def of(
        cls,
        machine: object,
        *,
        kick: object = None,
        shock: object = None,
        blade_loss: object = None,
        blade_loss_node: object = None,
    ) -> Requirement:
        """Read what a machine must survive from text with units.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
            Its mass turns an eccentricity into an unbalance.  Without scales all values are numbers in units of the
            equations.
        kick : str or float, optional
            Such as ``"100 mm/s"``.
        shock : str, optional
            Peak and duration, such as ``"5 g, 11 ms"``; 11 ms if the duration is left out.
        blade_loss : str or float, optional
            Size of the change of the unbalance, such as ``"2000 g mm"``, or of its eccentricity, such as ``"0.1 mm"``.
        blade_loss_node : int, optional
            Node of a flexible machine at which it changes.

        Raises
        ------
        InputError
            A value is not of this kind or has no unit, or it has one and the machine has no scales.
        """
        numbers = getattr(machine, "parameters", machine)
        if not hasattr(numbers, "scales"):
            raise InputError("machine", shown(machine), "a Machine, a Case, Parameters or a model")
        entries = {"kick": kick, "shock": shock, "blade_loss": blade_loss, "blade_loss_node": blade_loss_node}
        return _read(entries, "", numbers.scales, "option")

    @classmethod
    @checked
    def of_table(cls, table: Mapping[str, object], scales: Scales | None) -> Requirement:
        """Read a table ``[survive]``.

        Raises
        ------
        InputError
            An unknown name, or a value that :meth:`of` would refuse.
        """
        problems = Problems()
        problems.errors += unknown_names(table, SURVIVE_ENTRIES, "[survive]")
        found = problems.attempt(_read, table, "[survive] ", scales, "file")
        problems.raise_all()
        return found or cls()


@checked
def usual_kick(scales: Scales | None) -> float:
    """Return the kick that a rotor must survive where nothing is stated, in ``c_r Ω`` of the fixed frame.

    It is the speed of a fall through the diametral clearance, ``sqrt(4 g c_r)`` in m/s whatever the running speed; 1
    where the scales are not known.

    Raises
    ------
    InputError
        They are neither scales nor None.
    """
    return _fall_speed(scales) / scales.velocity if scales else 1.0


def _fall_speed(scales: Scales) -> float:
    return math.sqrt(4.0 * GRAVITY * scales.clearance)


def _read(entries: Mapping[str, object], prefix: str, scales: Scales | None, source: Source) -> Requirement:
    """Read the entries that are given; errors call them by their names behind a prefix."""
    problems = Problems()

    def of(name: str, read: Callable[..., _Read]) -> _Read | None:
        given = entries.get(name)
        return None if given is None else problems.attempt(read, prefix + name, given, scales)

    kick, change = of("kick", partial(_size, kind="velocity")), of("blade_loss", partial(_size, kind="unbalance"))
    shock, node = of("shock", _read_shock), of("blade_loss_node", _read_node)
    problems.raise_all()
    return Requirement(kick, shock, change, source, node)


def _read_shock(name: str, given: object, scales: Scales | None) -> Shock:
    parts = [part.strip() for part in given.split(",")] if isinstance(given, str) else [given]
    if len(parts) > 2 or (len(parts) == 1 and not scales):
        example = SURVIVE_ENTRIES["shock"][1] if scales else '"0.5, 3"'
        raise InputError(name, shown(given), f"must be PEAK, DURATION, such as {example}")
    peak = _size(name, parts[0], scales, "acceleration")
    return Shock(peak, _size(name, parts[1], scales, "time") if len(parts) == 2 else SHOCK_DURATION)


def _read_node(name: str, given: object, scales: Scales | None) -> int:
    number: object = int(given) if isinstance(given, str) and given.strip().isdecimal() else given
    if not isinstance(number, int) or isinstance(number, bool) or number < 0:
        raise InputError(name, shown(given), "must be the number of a node, from 0 on")
    return number


def _size(name: str, given: object, scales: Scales | None, kind: str) -> float:
    """Read a size above 0, in SI units where the scales are known; there it needs a unit."""
    text = given if scales is None or isinstance(given, str) else shown(given)
    size = read_size(name, text, kind, scales, bare=False)
    if not size.value > 0.0:
        raise InputError(name, shown(given), "must be above 0")
    return size.value
