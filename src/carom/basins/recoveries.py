"""Which share of drops comes back, with each recovery that a machine states and without its action."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar

import numpy as np

from carom.attractors import MotionName
from carom.base.arguments import Count, Seed, checked
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Column, Result, keys_of, record, table_of
from carom.basins.drops import MOST_STEPS, in_threads
from carom.basins.shares import Share
from carom.core.processors import available_cores
from carom.disturbances import Drop, kick
from carom.models import Rotor, Subject, rotor_of
from carom.motions.settling import PATIENCE
from carom.motions.simulation import Following, stretches
from carom.motions.starts import Until
from carom.parameters import Case, RecoveryAction, own_size, own_time
from carom.parameters.formats import format_quantity

DROPS, LONGEST = 100, 10.0
"""Number of drops by default, and seconds after which one that has not settled is given up."""
BACK, NOT_REGAINED = MotionName(Outcome.LEVITATED).words, "levitation not regained"
"""How drops end that come back, and those in which levitation is not regained in time."""


@dataclass(frozen=True)
class RecoveryShare:
    """How often one way to regain levitation succeeds.

    Attributes
    ----------
    recovery : RecoveryAction
    share : Share
        Of the drops that settle to levitation within the time that is given.
    ends : mapping of str to int
        How many drops end in each motion with levitation regained, by its name, have not settled within that time, or never regain levitation.
    with_it_alone, without_it_alone : int
        Drops that come back with the action and not without, and the other way round; 0 of one that is no action.
    """

    recovery: RecoveryAction
    share: Share
    ends: dict[str, int]
    with_it_alone: int = 0
    without_it_alone: int = 0

    @classmethod
    def of(cls, recovery: RecoveryAction, found: Sequence[str], without: Sequence[str]) -> RecoveryShare:
        """Count the ends of drops, and compare them with those of the same drops without the action."""
        back, other = (np.array([each == BACK for each in ends]) for ends in (found, without))
        return cls(
            recovery,
            Share.of(int(back.sum()), len(found), drawn=True),
            dict(Counter(found).most_common()),
            int((back & ~other).sum()),
            int((other & ~back).sum()),
        )


TABLE = (
    Column("name=recovery.name", "recovery"),
    Column("words=recovery.words acts=recovery.acts"),
    Column("", "come back", lambda row, _: f"{row.share.count}"),
    Column("", "share, 95 %", lambda row, _: f"{100.0 * row.share.low:.3g} to {100.0 * row.share.high:.3g} %"),
    Column("ends", "ends", lambda row, _: ", ".join(f"{count} {name}" for name, count in row.ends.items())),
    Column(
        "with_it_alone without_it_alone",
        "by the action",
        lambda row, _: f"+{row.with_it_alone} −{row.without_it_alone}" if row.recovery.acts else "",
    ),
)
"""Of each way what people see, and its keys in JSON."""


@dataclass(frozen=True, eq=False, repr=False)
class Recoveries(Result):
    """The share of drops that come back with each recovery, and without its action: all of the same drops.

    Attributes
    ----------
    rotor : Rotor
        It levitates.
    each : tuple of RecoveryShare
        Of each recovery; of one with an action after it the same without.
    drops, seed : int
        Size of the sample, and from what it was drawn: phases of the unbalance at the release, and kicks in the plane of their velocities, both
        spread evenly.
    kicks_up_to : float
        Largest kick at the release, in ``c_r Ω``; 0 without kicks.
    until : float
        Time after the release in which a drop has to settle, in ``1/Ω``.
    """

    rotor: Rotor
    each: tuple[RecoveryShare, ...]
    drops: int
    seed: int
    kicks_up_to: float
    until: float

    shown: ClassVar = ("rotor", "drops", "shares")

    @property
    def shares(self) -> str:
        """The shares in words."""
        return ", ".join(f"{row.recovery.name} {100.0 * row.share.fraction:.3g} %" for row in self.each)

    @property
    def words(self) -> str:
        """What was tried."""
        kicked = (
            f", kicks up to {format_quantity(self.kicks_up_to, 'velocity', self.rotor.scales)}"
            if self.kicks_up_to
            else ""
        )
        given = format_quantity(self.until, "time", self.rotor.scales)
        return f"{self.drops} drops at random instants of the turn{kicked}; a drop comes back if it settles to levitation within {given}"

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Headings, and texts of each row."""
        return table_of(TABLE, self.each, self)

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        scales, keys = self.rotor.scales, keys_of(TABLE)
        rows = [
            record(row, keys, scales) | {"share": record(row.share, "fraction count low high")} for row in self.each
        ]
        return record(self, "drops seed kicks_up_to:velocity until:time", scales) | {
            "method": "Clopper-Pearson, 95 %",
            "recoveries": rows,
        }


@checked
@shows_progress
def compare_recoveries(
    machine: Subject,
    recoveries: Sequence[RecoveryAction] = (),
    drops: Count = DROPS,
    *,
    kicks_up_to: float | str = 0.0,
    until: Until | None = None,
    seed: Seed = 0,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> Recoveries:
    """Drop a machine many times, and count how often it comes back with each recovery, and without its action.

    A drop comes back if it settles to levitation, as :func:`carom.simulate` tells, within the time that is given; after 100,000 impacts and steps of
    contact it counts as not settled.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    recoveries : sequence of RecoveryAction, optional
        By default those of the machine file.  Of each that has an action the same is tried without it.
    drops : int
        The same drops for all: of evenly spread phases of the unbalance at the release, and kicks.
    kicks_up_to : float or str
        Each drop begins with a kick of up to this speed, spread evenly over the plane of velocities: in ``c_r Ω`` or text with a unit; none by default.
    until : float or str, optional
        Time after the release in which a drop has to settle, in ``1/Ω`` or text with a unit; 10 s by default.
    seed : int
    threads : int, optional
        By default the number of available cores; the result does not depend on it.

    Raises
    ------
    InputError
        There is no recovery, or the machine cannot be dropped or has not what one needs.

    See Also
    --------
    carom.basins.map_drops : how drops end over two numbers

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/dropped-rotor.toml")
    >>> soft = cm.parameters.RecoveryAction("soft", regain_after="50 ms", lasts="0.1 s", gains={"damping": 1800})
    >>> [row.share.count for row in cm.basins.compare_recoveries(machine, (soft,), 5).each]
    [5, 5]
    """
    rotor = rotor_of(machine)
    given = recoveries or (machine.recoveries if isinstance(machine, Case) else ())
    if not given:
        raise InputError(
            "recovery", None, "one or more tables [[recovery]] in the machine file, such as with regain_after"
        )
    scales = rotor.scales
    longest = LONGEST / scales.time if until is None and scales else own_time("until", until, scales)
    fastest = own_size("kicks_up_to", kicks_up_to, "velocity", scales)
    random = np.random.default_rng(seed)
    phases, angles = 2.0 * math.pi * random.random((2, drops))
    speeds = fastest * np.sqrt(random.random(drops))
    starts = [
        Drop(kick(speed, angle) if fastest else None, phase)
        for speed, angle, phase in zip(speeds.tolist(), angles.tolist(), phases.tolist(), strict=True)
    ]
    plain = {each.without_action: each.without_action for each in given}
    plain |= {each.without_action: each for each in given if not each.acts}
    ways = [*plain.values(), *(each for each in given if each.acts)]
    for way in ways:
        replace(starts[0], recovery=way).apply(rotor)  # refuses what the machine has not
    following = Following(True, False, PATIENCE, MOST_STEPS, Reporter())
    tell = Reporter.of(progress, "following drops")
    begun = [(rotor, replace(start, recovery=way)) for way in ways for start in starts]
    ends: list[str] = []
    for end in in_threads(partial(_end, longest, following), begun, threads or available_cores()):
        ends.append(end)
        tell(len(ends) / len(begun))
    of_way = {way: ends[place * drops : (place + 1) * drops] for place, way in enumerate(ways)}
    each = tuple(RecoveryShare.of(way, own, of_way[plain[way.without_action]]) for way, own in of_way.items())
    return Recoveries(rotor, each, drops, seed, fastest, longest)


def _end(longest: float, following: Following, rotor: Rotor, dropped: Drop) -> str:
    """Follow one drop, and say how it ends."""
    outcomes = [(piece.outcome, piece.multiplicity) for piece in stretches(rotor, dropped, longest, following)]
    is_regained = any(outcome is Outcome.TRIGGERED for outcome, _ in outcomes)
    return MotionName(*outcomes[-1]).words if is_regained else NOT_REGAINED
