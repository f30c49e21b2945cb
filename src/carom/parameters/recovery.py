"""How levitation is regained, and with which actions: the tables ``[[recovery]]`` of a machine file."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

from carom.base.outcome import InputError, Problems, shown
from carom.parameters.formats import format_angle, format_entry
from carom.parameters.tables import Table, entries_of, entry, toml_line

REGAINED = ("regain_after", "regain_speed", "regain_quiet")
"""What makes levitation come back, one of them."""
OF_ACTION = ("gains", "gain_factors", "force", "current", "set_point", "slow_to")
"""What an action may be, one or several of them."""
UP = 0.5 * math.pi
"""Up the y axis, as an angle from the x axis."""
_MS, _RPM = ("ms", 1e-3), ("rpm", math.pi / 30.0)


@dataclasses.dataclass(frozen=True)
class RecoveryAction(Table):
    """When levitation is regained after a drop, and what the controller does then for a while; after that the machine is as its file says.

    Parameters
    ----------
    name : str
        By which results call it.
    regain_after : float or str, optional
        Time from the release, s.
    regain_speed : float or str, optional
        Speed of the shaft, which friction in contact slows down, rad/s.
    regain_quiet : float or str, optional
        Time for which it has been quiet since the release, s: without contact, or with ``quiet_speed`` without a faster rotor.
    quiet_speed : float or str, optional
        Speed of the rotor at any touchdown bearing, in the fixed frame, up to which contact counts as quiet, m/s.  It is looked at where a contact begins,
        changes or ends, and when the time is over.
    lasts : float or str, optional
        Time for which the action lasts from the regain on, s.
    gains, gain_factors : mapping of str, optional
        Other values, or factors, of parameters of the levitation: such as ``{"damping": "1800 N s/m"}`` or ``{"derivative": 2}``.
    force, current : float or str, optional
        Amplitude, 0 to peak, of a force on the centre of mass, N, or of the current of every magnetic bearing, A, that turns with the shaft.
    phase : float or str, optional
        Angle of this force or current from the unbalance, in the sense of rotation, rad.
    slow_to : float or str, optional
        Speed to which the drive slows the shaft down at a constant rate while the action lasts, rad/s.
    set_point, set_point_angle : float or str, optional
        Distance from the centre at which the rotor levitates, m, and where, from the fixed x axis in the sense of rotation, rad: up by default.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, there is not one way to regain levitation, or an action without ``lasts`` or the other way round.

    Examples
    --------
    >>> import carom as cm
    >>> cm.parameters.RecoveryAction("soft", regain_after="50 ms", lasts="0.2 s", gain_factors={"damping": 2}).regain_after
    0.05
    """

    name: str = ""
    regain_after: float | None = entry("", "time until levitation is regained", "s", 1e-9, 1e6, '"50 ms"', usual=_MS)
    regain_speed: float | None = entry(
        "", "shaft speed at which levitation is regained", "rad/s", 1e-6, 1e6, '"3000 rpm"', usual=_RPM
    )
    regain_quiet: float | None = entry(
        "", "quiet time until levitation is regained", "s", 1e-9, 1e6, '"20 ms"', usual=_MS
    )
    quiet_speed: float | None = entry(
        "", "speed of the rotor that is quiet", "m/s", 1e-9, 1e6, '"30 mm/s"', usual=("mm/s", 1e-3)
    )
    lasts: float | None = entry("", "time for which the action lasts", "s", 1e-9, 1e6, '"0.2 s"', usual=_MS)
    gains: Mapping[str, float | str] = dataclasses.field(default_factory=dict, hash=False)
    gain_factors: Mapping[str, float] = dataclasses.field(default_factory=dict, hash=False)
    force: float | None = entry("", "amplitude of the synchronous force", "N", 1e-12, 1e12, '"50 N"')
    current: float | None = entry("", "amplitude of the synchronous current", "A", 1e-12, 1e9, '"1.5 A"')
    phase: float = entry("", "angle from the unbalance", "rad", -1e6, 1e6, '"180 deg"', True, 0.0)
    set_point: float | None = entry(
        "", "distance at which it levitates", "m", 1e-12, 1.0, '"50 um"', usual=("µm", 1e-6)
    )
    slow_to: float | None = entry(
        "", "speed to which the drive slows the shaft down", "rad/s", 1e-6, 1e6, '"3000 rpm"', usual=_RPM
    )
    set_point_angle: float = entry("", "angle of the set point", "rad", -1e6, 1e6, '"90 deg"', True, UP)

    heading: ClassVar = "recovery"
    texts: ClassVar = ("name", "gains", "gain_factors")

    def __post_init__(self) -> None:
        super().__post_init__()
        given: object = self.name
        if not isinstance(given, str) or not given:
            raise InputError("name", shown(given), 'a text by which results call it, such as "soft gains"')
        for table in ("gains", "gain_factors"):
            if not isinstance(getattr(self, table), Mapping):
                raise InputError(table, shown(getattr(self, table)), "a table of parameters, such as { damping = 2 }")
        factors: Mapping[str, object] = self.gain_factors
        for name, factor in factors.items():
            if not isinstance(factor, int | float) or not 0.0 < factor < 1e6:
                raise InputError(f"gain_factors.{name}", shown(factor), "a number above 0, such as 2")
        ways = [name for name in REGAINED if getattr(self, name) is not None]
        if len(ways) != 1:
            raise InputError("regain", " with ".join(ways) or None, f"one of {', '.join(REGAINED)}")
        acts = [name for name in OF_ACTION if getattr(self, name)]
        needed = {
            "quiet_speed": (self.quiet_speed, self.regain_quiet, "regain_quiet"),
            "lasts": (self.lasts, acts, f"an action: one of {', '.join(OF_ACTION)}"),
            acts[0] if acts else "action": (acts, self.lasts, 'the time for which it lasts, such as lasts = "0.2 s"'),
        }
        for name, (stated, other, allowed) in needed.items():
            if stated and not other:
                raise InputError(name, shown(getattr(self, name)), f"needs {allowed}")
        if self.force and self.current:
            raise InputError("force", self.force, "must be left out beside current")

    @property
    def acts(self) -> bool:
        """Whether more is done than regaining levitation."""
        return self.lasts is not None

    @property
    def without_action(self) -> RecoveryAction:
        """Levitation regained in the same way, and nothing else done."""
        kept = {name: getattr(self, name) for name in (*REGAINED, "quiet_speed")}
        when = next(format_entry(self.entries[name], value) for name, value in kept.items() if value is not None)
        return RecoveryAction(f"no action, {when}", **kept)

    @property
    def words(self) -> str:
        """When levitation is regained and what is done, in the units of people."""
        said = {name: format_entry(self.entries[name], value) for name, value in self.given.items()}
        if self.regain_after is not None:
            text = f"regained {said['regain_after']} after the release"
        elif self.regain_speed is not None:
            text = f"regained at {said['regain_speed']}"
        else:
            limit = f"with the rotor up to {said['quiet_speed']}" if self.quiet_speed else "without contact"
            text = f"regained after {said['regain_quiet']} {limit}"
        parts = [f"{name} {shown(value)}" for name, value in self.gains.items()]
        parts += [f"{name} times {factor:g}" for name, factor in self.gain_factors.items()]
        for name in ("force", "current"):
            if name in said:
                parts.append(f"synchronous {name} {said[name]} at {format_angle(self.phase)} from the unbalance")
        if self.set_point:
            parts.append(f"set point {said['set_point']} at {format_angle(self.set_point_angle)}")
        if self.slow_to:
            parts.append(f"slowed down to {said['slow_to']}")
        return f"{text}; for {said['lasts']}: {', '.join(parts)}" if self.acts else text

    def to_toml(self) -> str:
        """Return the text of a table that is read as this value."""
        lines = [toml_line("name", self.name)]
        for table in ("gains", "gain_factors"):
            if stated := getattr(self, table):
                each = (f"{json.dumps(name)} = {json.dumps(value)}" for name, value in stated.items())
                lines.append(f"{table} = {{ {', '.join(each)} }}")
        usual = {each.name: each.default for each in dataclasses.fields(self)}
        stated = {name: value for name, value in self.given.items() if value != usual[name]}
        lines += [toml_line(name, value, self.unit(name)) for name, value in stated.items()]
        return "\n".join([f"[[{self.heading}]]", *lines]) + "\n"


RECOVERY_FIELDS = entries_of(RecoveryAction)


def read_recoveries(
    tables: Sequence[Mapping[str, object]], has_scales: bool, problems: Problems
) -> tuple[RecoveryAction, ...]:
    """All tables of a file, each of a name of its own; errors, which say in which table, are added to those before."""
    found: dict[str, RecoveryAction] = {}
    for number, table in enumerate(tables, start=1):
        try:
            one = RecoveryAction.of(table, has_scales)
            if one.name in found:
                raise InputError("name", one.name, "a name of its own for each")
            found[one.name] = one
        except InputError as problem:
            where = f"[[recovery]] {number}: "
            problems.errors += [InputError(where + each.field, each.value, each.allowed) for each in problem.errors]
    return tuple(found.values())
