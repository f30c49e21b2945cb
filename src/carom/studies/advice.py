"""The least change of a gain that leaves only recovery, as the user can set it and within what the machine can give.

The ranges of recovery (:mod:`carom.studies.recovery`) say where to look.  A value is tried a little beyond the near end of a
range, in the terms and digits in which the machine file states the gain, by fresh disturbances; if one of them is lost, or the
magnetic bearings are asked for more than they can give, the next value farther inside is tried.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from carom.basins.changes import WANTED
from carom.basins.shares import percent
from carom.closed_forms.thresholds import FOLD, ROLLING, WALL, Gain
from carom.closed_forms.whirl import Runaway, rolling, runaway_speed
from carom.disturbances import Sample
from carom.models import Jeffcott
from carom.parameters import PHYSICAL_PARTNER, Case, InTerms, in_terms_of
from carom.parameters.in_terms import Side
from carom.parameters.numbers import CONVERSIONS
from carom.results import Result
from carom.studies.actuator import asked_by
from carom.studies.ranges import Edge, MotionRange, Span
from carom.studies.recovery import Check, Recovery, check_recovery, in_all

Kind = Literal["change", "no-change-needed", "nothing-buildable", "no-change-found"]
Bound = Literal["at least", "at most", "about"]
Evidence = Literal["closed form", "searched", "sampled"]

MARGINS = (0.05, 0.1, 0.2, 0.4)
"""Relative distances of the advised damping or stiffness from the end of a range, tried until a check passes."""
FARTHER = (1.0, 2.0, 4.0)
"""Still farther ones, tried for the sake of the magnetic bearings."""
CHECKED = 10_000
"""Number of disturbances of the check."""
SEED = 2
"""Seed of these disturbances.  No search uses it, so the check is a fresh sample."""

_SAME = 1e-8
"""Relative distance up to which two edges are one."""
_CLOSED_FORMS = (WALL, FOLD, ROLLING)


@dataclass(frozen=True)
class Margin:
    """How far a value lies from the end of a range in which every disturbance tried came back.

    Attributes
    ----------
    edge : Edge
        The end of the range.
    share : float
        Distance of the value from it, relative to the damping or stiffness there.
    """

    edge: Edge
    share: float


@dataclass(frozen=True)
class Change:
    """A change of one gain, the other as it is, and how it was checked.

    Attributes
    ----------
    gain : {"gamma", "omega"}
    present, value : float
        Present value and the new one, which is exactly that of ``terms``.
    terms : InTerms
        The new value in the terms of the machine file.
    ratio : float
        Ratio of the new damping or stiffness to the present one; infinite if there is none now.
    bound : {"at least", "at most", "about"}
        Whether larger or smaller values were tried too, up to the end of the search, and nothing was lost there.
    margin : Margin or None
        Distance from the near end of the range; ``None`` if the value only brings back a wanted share.
    far : Edge or None
        The other end of the range, if something is lost beyond it.
    check : Check
        The fresh disturbances followed at the value.
    forced : tuple of Check
        Nearer values at which some of the fresh disturbances were lost.
    beyond : tuple of Check
        Values beyond it, up to the end of the range, at which all disturbances of the search came back.
    radius, zone : float, str
        Radius of levitation at the value, and its zone.
    whirl : Runaway or None
        Speeds from which backward whirl runs away to rolling at the value; ``None`` if rolling does not sustain itself.
    demand : float or None
        Largest multiple of a limit of the magnetic bearings that a disturbance asked for; ``None`` if no limit is stated.
    """

    gain: Gain
    present: float
    value: float
    terms: InTerms
    ratio: float
    bound: Bound
    margin: Margin | None
    far: Edge | None
    check: Check
    forced: tuple[Check, ...]
    beyond: tuple[Check, ...]
    radius: float
    zone: str
    whirl: Runaway | None
    demand: float | None

    @property
    def buildable(self) -> bool:
        """Whether the magnetic bearings can give what it asks for, as far as limits are stated."""
        return self.demand is None or self.demand <= 1.0


@dataclass(frozen=True, repr=False)
class Recommendation(Result):
    """What to change so that every disturbance that must be survived comes back.

    Attributes
    ----------
    kind : {"change", "no-change-needed", "nothing-buildable", "no-change-found"}
    changes : tuple of Change
        Alternatives, the least change first; with ``"nothing-buildable"`` those that ask for more than the magnetic bearings can
        give.
    margins : tuple of (gain, Margin)
        If no change is needed: how far the present values lie from where a disturbance was lost.
    """

    kind: Kind
    changes: tuple[Change, ...]
    margins: tuple[tuple[Gain, Margin], ...]

    @property
    def advised(self) -> Change | None:
        """The least change; ``None`` where none helps, is needed or can be built."""
        return self.changes[0] if self.kind == "change" else None

    def rows(self) -> list[tuple[str, str]]:
        """Each change in the terms of the machine file, and what came back with it."""
        told = [(one.terms.entry, f"{one.bound} {one.terms.text}: {one.check.drawn.words}") for one in self.changes]
        margins = [(f"margin of {gain}", percent(margin.share)) for gain, margin in self.margins]
        return [("kind", self.kind), *told, *margins]


def recommend(
    case: Case,
    disturbances: Sequence[Sample],
    recoveries: Sequence[Recovery],
    ranges: Sequence[MotionRange],
    needed: bool,
) -> Recommendation:
    """Recommend a value of each gain along which recovery was searched."""
    if not needed:
        margins = [_nearest(case, recovery) for recovery in recoveries]
        return Recommendation("no-change-needed", (), tuple(margin for margin in margins if margin))
    advisers = [_Adviser(case, tuple(disturbances), recovery, tuple(ranges)) for recovery in recoveries]
    found = [change for adviser in advisers if (change := adviser.least())]
    if not found:
        found = [change for adviser in advisers if (change := adviser.least_wanted())]
    if not found:
        return Recommendation("no-change-found", (), ())
    buildable = [change for change in found if change.buildable]
    ordered = sorted(buildable or found, key=lambda change: abs(math.log(change.ratio)))
    return Recommendation("change" if buildable else "nothing-buildable", tuple(ordered), ())


def evidence_of(edge: Edge) -> Evidence:
    """How the end of a range is known."""
    if edge.kind == "simulated":
        return "sampled"
    return "closed form" if edge.kind in _CLOSED_FORMS else "searched"


def gain_of(recovery: Recovery) -> Gain:
    """The gain along which recovery was searched."""
    return "gamma" if recovery.along.name == "gamma" else "omega"


def stated(case: Case, gain: Gain, value: float, side: Side = "nearest") -> InTerms:
    """A value of a gain as the file of the machine would state it."""
    scales = case.parameters.scales
    if case.machine is None or scales is None:
        return in_terms_of(case, gain, value, side)
    return in_terms_of(case, PHYSICAL_PARTNER[gain], float(CONVERSIONS[gain].value(value, scales)), side)


def with_setting(case: Case, terms: InTerms) -> Case:
    """The case with this value set, as by ``--set``."""
    text = terms.setting.partition("=")[2]
    return case.replace(**{terms.entry: terms.value if case.machine is None else text})


def _nearest(case: Case, recovery: Recovery) -> tuple[Gain, Margin] | None:
    gain = gain_of(recovery)
    present = case.parameters.value(gain)
    span = recovery.span_at(present)
    if span is None:
        return None
    margins = [Margin(edge, _distance(gain, present, edge.value)) for edge in (span.low, span.high) if _happens(edge)]
    return (gain, min(margins, key=lambda margin: margin.share)) if margins else None


def _distance(gain: Gain, value: float, end: float) -> float:
    """Return the distance of two values relative to the damping or stiffness at the end."""
    return abs((value / end) ** CONVERSIONS[gain].power - 1.0)


def _happens(edge: Edge) -> bool:
    """Whether something is lost beyond an edge; otherwise the search ends there."""
    return bool(edge.kind) and 0.0 < edge.value < math.inf


@dataclass(frozen=True)
class _Adviser:
    """Looks for the least change along one gain."""

    case: Case
    disturbances: tuple[Sample, ...]
    recovery: Recovery
    ranges: tuple[MotionRange, ...]

    @property
    def gain(self) -> Gain:
        return gain_of(self.recovery)

    @property
    def present(self) -> float:
        return self.case.parameters.value(self.gain)

    def least(self) -> Change | None:
        """The nearest value in a range of recovery whose check passes; the first that the bearings can give, if one can."""
        forced: list[Check] = []
        best: Change | None = None
        for span in sorted(self.recovery.spans, key=self._away):
            for value, farther in self._values(span):
                if farther and best is None:
                    break
                terms = self._terms(value)
                check = self._checked(terms)
                if not check.recovers:
                    forced.append(check)
                    continue
                change = self._change(terms, check, span, tuple(forced))
                best = best or change
                if change.buildable:
                    return change
        return best

    def least_wanted(self) -> Change | None:
        """The nearest value tried at which the wanted share comes back, if none leaves only recovery."""
        tried = [check.value for check in self.recovery.checks if check.value != self.present]
        for value in sorted(
            tried, key=lambda value: abs(math.log(value / self.present)) if self.present > 0 else value
        ):
            rough = check_recovery(
                self.recovery.rotor, self.recovery.disturbances, along=self.gain, value=value, seed=SEED + 1
            )
            if min(share.fraction for share in rough.returned) < WANTED:
                continue
            terms = self._terms(value)
            check = self._checked(terms)
            if min(share.fraction for share in check.returned) >= WANTED:
                return self._change(terms, check, None, ())
        return None

    def _away(self, span: Span) -> float:
        near, _ = self._ends(span)
        return abs(math.log(near.value / self.present)) if self.present > 0.0 else near.value

    def _ends(self, span: Span) -> tuple[Edge, Edge]:
        """The near and the far end of a span, seen from the present value; of a span that holds it the low and the high one."""
        return (span.low, span.high) if self.present < span.high.value else (span.high, span.low)

    def _values(self, span: Span) -> Iterator[tuple[float, bool]]:
        """Values inside a span, the nearest first, and whether they are only for the sake of the bearings."""
        near, far = (edge.value for edge in self._ends(span))
        inward = math.copysign(1.0, far - near) / CONVERSIONS[self.gain].power
        middle = math.sqrt(near * far)
        for margin in MARGINS + FARTHER:
            value = near * (1.0 + margin) ** inward
            if (middle - value) * inward <= 0.0:
                yield middle, margin in FARTHER
                return
            yield value, margin in FARTHER

    def _terms(self, value: float) -> InTerms:
        """The new value as the file would state it, rounded away from the present one."""
        return stated(self.case, self.gain, value, "up" if self.present < value else "down")

    def _checked(self, terms: InTerms) -> Check:
        value = with_setting(self.case, terms).parameters.value(self.gain)
        sample = in_all(self.disturbances, CHECKED)
        return check_recovery(self.recovery.rotor, sample, along=self.gain, value=value, seed=SEED)

    def _change(self, terms: InTerms, check: Check, span: Span | None, forced: tuple[Check, ...]) -> Change:
        value, present = check.value, self.present
        case = with_setting(self.case, terms)
        rotor = Jeffcott(case.parameters)
        margin: Margin | None = None
        far: Edge | None = None
        beyond: tuple[Check, ...] = ()
        bound: Bound = "about"
        if span is not None:
            near, end = self._ends(span)
            margin = Margin(self._best_known(near), _distance(self.gain, value, near.value))
            far = end if _happens(end) else None
            low, high = min(value, end.value), max(value, end.value)
            beyond = tuple(each for each in self.recovery.clear if low < each.value < high)
            if far is None and beyond:
                bound = "at least" if present < value else "at most"
        radius = abs(rotor.equilibrium)
        return Change(
            self.gain,
            present,
            value,
            terms,
            (value / present) ** CONVERSIONS[self.gain].power if present > 0.0 else math.inf,
            bound,
            margin,
            far,
            check,
            forced,
            beyond,
            radius,
            case.zones.zone(min(radius, 1.0)),
            runaway_speed(rotor) if rolling(rotor).holds else None,
            asked_by(case, self.disturbances),
        )

    def _best_known(self, edge: Edge) -> Edge:
        """Return the closed form of an edge, if several motions end there and one of them has a closed form."""
        exact = [
            other
            for entry in self.ranges
            if entry.gain == self.gain
            for span in entry.spans
            for other in (span.low, span.high)
            if other.kind in _CLOSED_FORMS and math.isclose(other.value, edge.value, rel_tol=_SAME)
        ]
        return exact[0] if exact and edge.kind != "simulated" else edge
