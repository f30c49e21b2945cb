"""Which share of drops comes back, with each recovery that a machine states and without its action."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, NamedTuple

import numpy as np

from carom.attractors import MotionName
from carom.base.arguments import Count, Seed, checked
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Column, Result, record, table_of
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
BACK, ELSEWHERE, UNSETTLED, NEVER = range(4)
"""Where a drop ends: levitated, settled in another motion, neither in time, or before levitation is regained."""


class DropEnding(NamedTuple):
    """Where one drop ends, by one recovery; times in ``1/Ω``."""

    how: int
    motion: MotionName
    regained_at: float
    time: float


@dataclass(frozen=True)
class RecoveryShare:
    """How often one way to regain levitation succeeds.

    Attributes
    ----------
    recovery : RecoveryAction
    share : Share
        Of the drops that settle to levitation within the time that is given.
    elsewhere : int
        Drops that settle in another motion with levitation regained.
    not_settled : int
        Drops that have not settled within that time.
    not_regained : int
        Drops in which levitation was not regained within that time.
    regained_at : float or None
        Median time of the regain in ``1/Ω``; ``None`` without any.
    settled_after : float or None
        Median time from the regain to where levitation was certain, in ``1/Ω``; ``None`` without any.
    motions : mapping of str to int
        How many drops end in each motion, by its name.
    with_it_alone, without_it_alone : int
        Drops that come back with the action and not without, and the other way round; 0 of one that is no action.
    """

    recovery: RecoveryAction
    share: Share
    elsewhere: int
    not_settled: int
    not_regained: int
    regained_at: float | None
    settled_after: float | None
    motions: dict[str, int]
    with_it_alone: int = 0
    without_it_alone: int = 0

    @classmethod
    def of(cls, recovery: RecoveryAction, found: Sequence[DropEnding], without: Sequence[DropEnding]) -> RecoveryShare:
        """Count the ends of drops, and compare them with those of the same drops without the action."""
        count = Counter(each.how for each in found)
        back, other = (np.array([each.how == BACK for each in ends]) for ends in (found, without))
        after = [each.time - each.regained_at for each in found if each.how == BACK]
        regained = [each.regained_at for each in found if each.how != NEVER]
        return cls(
            recovery,
            Share.of(count[BACK], len(found), drawn=True),
            count[ELSEWHERE],
            count[UNSETTLED],
            count[NEVER],
            float(np.median(regained)) if regained else None,
            float(np.median(after)) if after else None,
            dict(Counter(each.motion.words for each in found).most_common()),
            int((back & ~other).sum()),
            int((other & ~back).sum()),
        )


def _interval(row: RecoveryShare, _: object) -> str:
    return f"{100.0 * row.share.low:.3g} to {100.0 * row.share.high:.3g} %"


TABLE = (
    Column("", "recovery", lambda row, _: row.recovery.name),
    Column("", "come back", lambda row, _: f"{row.share.count}"),
    Column("", "share, 95 %", _interval),
    Column("", "in contact", lambda row, _: str(row.elsewhere)),
    Column("", "not settled", lambda row, _: str(row.not_settled)),
    Column("", "not regained", lambda row, _: str(row.not_regained)),
    Column(
        "", "by the action", lambda row, _: f"+{row.with_it_alone} −{row.without_it_alone}" if row.recovery.acts else ""
    ),
)
"""Of each way what people see."""
_ENTRY = "name=recovery.name words=recovery.words acts=recovery.acts elsewhere not_settled not_regained regained_at:time settled_after:time motions with_it_alone without_it_alone"


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
        scales = self.rotor.scales
        shares = [record(row.share, "fraction count low high") for row in self.each]
        rows = [record(row, _ENTRY, scales) | {"share": share} for row, share in zip(self.each, shares, strict=True)]
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
    >>> soft = cm.parameters.RecoveryAction("soft", regain_after="50 ms", lasts="0.1 s", gain_factors={"damping": 2})
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
    ways = _with_plain(given)
    for way, _ in ways:
        replace(starts[0], recovery=way).apply(rotor)  # refuses what the machine has not
    following = Following(True, False, PATIENCE, MOST_STEPS, Reporter())
    tell = Reporter.of(progress, "following drops")
    begun = [(rotor, replace(start, recovery=way)) for way, _ in ways for start in starts]
    ends: list[DropEnding] = []
    for end in in_threads(partial(_end, longest, following), begun, threads or available_cores()):
        ends.append(end)
        tell(len(ends) / len(begun))
    found = [ends[place * drops : (place + 1) * drops] for place in range(len(ways))]
    each = [RecoveryShare.of(way, own, found[plain]) for (way, plain), own in zip(ways, found, strict=True)]
    return Recoveries(rotor, tuple(each), drops, seed, fastest, longest)


def _with_plain(recoveries: Sequence[RecoveryAction]) -> list[tuple[RecoveryAction, int]]:
    """Each recovery, before them those without action for which some stands; beside each the place of the one without."""
    plain: dict[RecoveryAction, RecoveryAction] = {}
    for each in sorted(recoveries, key=lambda one: one.acts):
        plain.setdefault(each.without_action, each.without_action if each.acts else each)
    places = list(plain)
    acting = [(each, places.index(each.without_action)) for each in recoveries if each.acts]
    return [(each, place) for place, each in enumerate(plain.values())] + acting


def _end(longest: float, following: Following, rotor: Rotor, dropped: Drop) -> DropEnding:
    """Follow one drop."""
    regained, passed = math.nan, 0.0
    for piece in stretches(rotor, dropped, longest, following):
        if piece.outcome is Outcome.TRIGGERED:
            passed += piece.time
            regained = passed if math.isnan(regained) else regained
    if piece.outcome is Outcome.LEVITATED:
        how = BACK
    elif math.isnan(regained):
        how = NEVER
    else:
        how = ELSEWHERE if piece.outcome.settled else UNSETTLED
    return DropEnding(how, MotionName(piece.outcome, piece.multiplicity), regained, passed + piece.time)
