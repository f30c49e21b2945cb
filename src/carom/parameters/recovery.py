"""How levitation is regained, and with which actions: the tables ``[[recovery]]`` of a machine file."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

from carom.base.outcome import InputError, Problems, shown
from carom.parameters.fields import RPM
from carom.parameters.formats import format_entry
from carom.parameters.tables import Table, entries_of, entry

REGAINED = ("regain_after", "regain_speed", "regain_quiet")
"""What makes levitation come back, one of them."""
OF_ACTION = ("gains", "force", "current", "set_point", "slow_to")
"""What an action may be, one or several of them."""
_MS, _RPM, _DEGREES = ("ms", 1e-3), ("rpm", RPM), ("°", math.radians(1.0))


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
    regain_quiet, quiet_speed : float or str, optional
        Time, s, for which the rotor has not been faster than a speed, m/s, since the release: at any touchdown bearing, in the fixed frame.  It is
        looked at where a contact begins, changes or ends, and when the time is over.
    lasts : float or str, optional
        Time for which the action lasts from the regain on, s.
    gains : mapping of str, optional
        Other values of parameters of the levitation: such as ``{"damping": "1800 N s/m"}``.
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
    >>> cm.parameters.RecoveryAction("soft", regain_after="50 ms", lasts="0.2 s", gains={"damping": 1800}).regain_after
    0.05
    """

    name: str = ""
    regain_after: float | None = entry("", "regained after", "s", 1e-9, 1e6, '"50 ms"', usual=_MS)
    regain_speed: float | None = entry("", "regained at the shaft speed", "rad/s", 1e-6, 1e6, '"3000 rpm"', usual=_RPM)
    regain_quiet: float | None = entry("", "regained when quiet for", "s", 1e-9, 1e6, '"20 ms"', usual=_MS)
    quiet_speed: float | None = entry("", "quiet up to", "m/s", 1e-9, 1e6, '"30 mm/s"', usual=("mm/s", 1e-3))
    lasts: float | None = entry("", "then for", "s", 1e-9, 1e6, '"0.2 s"', usual=_MS)
    gains: Mapping[str, float | str] = dataclasses.field(default_factory=dict, hash=False)
    force: float | None = entry("", "synchronous force", "N", 1e-12, 1e12, '"50 N"')
    current: float | None = entry("", "synchronous current", "A", 1e-12, 1e9, '"1.5 A"')
    phase: float | None = entry("", "angle from the unbalance", "rad", -1e6, 1e6, '"180 deg"', True, usual=_DEGREES)
    set_point: float | None = entry("", "set point", "m", 1e-12, 1.0, '"50 um"', usual=("µm", 1e-6))
    set_point_angle: float | None = entry(
        "", "angle of the set point", "rad", -1e6, 1e6, '"90 deg"', True, usual=_DEGREES
    )
    slow_to: float | None = entry("", "shaft slowed down to", "rad/s", 1e-6, 1e6, '"3000 rpm"', usual=_RPM)

    heading: ClassVar = "[recovery]"
    texts: ClassVar = ("name", "gains")

    def __post_init__(self) -> None:
        super().__post_init__()
        of_texts = (
            ("name", str, 'a text by which results call it, such as "soft gains"'),
            ("gains", Mapping, "a table of parameters, such as { damping = 1800 }"),
        )
        for name, kind, allowed in of_texts:
            if not isinstance(given := getattr(self, name), kind) or given == "":
                raise InputError(name, shown(given), allowed)
        ways = [name for name in REGAINED if getattr(self, name) is not None]
        if len(ways) != 1:
            raise InputError("regain", " with ".join(ways) or None, f"one of {', '.join(REGAINED)}")
        if (self.regain_quiet is None) != (self.quiet_speed is None):
            raise InputError("quiet_speed", self.quiet_speed, "beside regain_quiet, which needs it")
        if self.acts != any(getattr(self, name) for name in OF_ACTION):
            raise InputError("lasts", self.lasts, f"beside an action, which needs it: one of {', '.join(OF_ACTION)}")
        if self.force and self.current:
            raise InputError("force", self.force, "must be left out beside current")

    @property
    def acts(self) -> bool:
        """Whether more is done than regaining levitation."""
        return self.lasts is not None

    @property
    def without_action(self) -> RecoveryAction:
        """Levitation regained in the same way, and nothing else done."""
        name, value = next(iter(self.given.items()))
        words = f"no action, {format_entry(self.entries[name], value)}"
        return RecoveryAction(words, self.regain_after, self.regain_speed, self.regain_quiet, self.quiet_speed)

    @property
    def words(self) -> str:
        """When levitation is regained and what is done, in the units of people."""
        parts = [
            f"{self.entries[name].words} {format_entry(self.entries[name], value)}"
            for name, value in self.given.items()
        ]
        return ", ".join(parts + [f"{name} {shown(value)}" for name, value in self.gains.items()])


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
            problems.errors += problem.under(f"[[recovery]] {number}: ").errors
    return tuple(found.values())
