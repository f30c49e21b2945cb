"""The least change of a gain that leaves only recovery, as the user can set it and within what the machine can give.

The ranges of recovery (:mod:`carom.studies.recovery`) say where to look.  A value is tried a little beyond the near end of a
range, in the terms and digits in which the machine file states the gain, by fresh disturbances; if one of them is lost, the
next value farther inside is tried.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal

from carom.base.results import Result, record
from carom.basins.shares import percent
from carom.closed_forms import Runaway
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.thresholds import FOLD, ROLLING, WALL
from carom.disturbances import Sample
from carom.models import Edge, Span, rotor_of
from carom.motions.budget import BudgetSpentError
from carom.parameters import Case, InTerms, in_terms_of
from carom.studies.questions import FEWEST, Evidence
from carom.studies.recovery import Recovery, power_of
from carom.studies.trials import Check, check_recovery, in_all
from carom.studies.wording import Wording

Kind = Literal["change", "no-change-needed", "no-change-found", "not-decided"]

MARGINS = (0.05, 0.1, 0.2, 0.4)
"""Relative distances of the advised damping or stiffness from the end of a range, tried until a check passes."""
GAIN_FACTOR = 4.0
"""Greatest factor by which damping or stiffness is advised to change: noise and the current that a controller asks for grow as much, and bearings that
levitate a machine today seldom have more in reserve."""
CHECKED, CHECKED_SINGLY = 10_000, 1000
"""Number of disturbances of the check, and that of rotors whose motions are followed one after another."""
SEED = 2
"""Seed of these disturbances.  No search uses it, so the check is a fresh sample."""
CHANGE = (
    "entry=terms.entry set=terms.setting bound ratio disturbances=check.drawn.total recovered=check.drawn.count "
    "share_low=check.drawn.low share_high=check.drawn.high radius: zone"
)
_CLOSED_FORMS = (WALL, FOLD, ROLLING)


@dataclass(frozen=True)
class Margin:
    """How far a value lies from the end of a range in which every disturbance tried came back.

    Attributes
    ----------
    parameter : str
    edge : Edge
        The end of the range.
    share : float
        Distance of the value from it, relative to the damping or stiffness there.
    """

    parameter: str
    edge: Edge
    share: float

    def document(self, say: Wording) -> dict[str, object]:
        """As plain data for JSON."""
        return _end_document(say, self.parameter, self.edge) | {"share": self.share}


@dataclass(frozen=True)
class Change:
    """A change of one parameter, the others as they are, and how it was checked.

    Attributes
    ----------
    parameter : str
    present, value : float
        Present value and the new one, which is exactly that of ``terms``.
    terms : InTerms
        The new value in the terms of the machine file.
    ratio : float
        Ratio of the new damping or stiffness to the present one; infinite if there is none now.
    margin : Margin
        Distance from the near end of the range.
    far : Edge
        The other end of the range: without a kind the search ended there, and nothing was lost up to it.
    check : Check
        The fresh disturbances followed at the value.
    radius, zone : float, str
        Radius of levitation at the value, and its zone.
    whirl : Runaway or None
        Speeds from which backward whirl runs away to rolling at the value; ``None`` if rolling does not sustain itself, or no closed
        form says.
    """

    parameter: str
    present: float
    value: float
    terms: InTerms
    ratio: float
    margin: Margin
    far: Edge
    check: Check
    radius: float
    zone: str
    whirl: Runaway | None

    @property
    def bound(self) -> str:
        """Whether nothing was lost farther away from the present value, up to the end of the search."""
        return "about" if _happens(self.far) else "at least" if self.value < self.far.value else "at most"

    def document(self, say: Wording) -> dict[str, object]:
        """As plain data for JSON."""
        largest, whirl, name = self.check.largest, self.whirl, self.parameter
        return {
            **say.in_both(name, present=self.present, value=self.value),
            **record(self, CHANGE, say.scales),
            "margin": self.margin.document(say),
            "other_end": _end_document(say, name, self.far) if _happens(self.far) else None,
            "at_their_largest": sum(share.total for share in largest),
            "recovered_at_their_largest": sum(share.count for share in largest),
            **(record(whirl, "rolling_from=certain:velocity", say.scales) if whirl else {"rolling_from": None}),
        }


@dataclass(frozen=True, repr=False)
class Recommendation(Result):
    """What to change so that every disturbance that must be survived comes back.

    Attributes
    ----------
    kind : {"change", "no-change-needed", "no-change-found", "not-decided"}
    changes : tuple of Change
        Alternatives, the least change first.
    margins : tuple of Margin
        If no change is needed: how far the present values lie from where a disturbance was lost.
    """

    kind: Kind
    changes: tuple[Change, ...]
    margins: tuple[Margin, ...]

    @property
    def advised(self) -> Change | None:
        """The least change; ``None`` where none helps or is needed."""
        return self.changes[0] if self.changes else None

    def document(self, say: Wording) -> dict[str, object]:
        """As plain data for JSON."""
        return {"kind": self.kind, "changes": [change.document(say) for change in self.changes]}

    def rows(self) -> list[tuple[str, str]]:
        """Each change in the terms of the machine file, and what came back with it."""
        shown = [(one.terms.entry, f"{one.bound} {one.terms.text}: {one.check.drawn.words}") for one in self.changes]
        margins = [(f"margin of {margin.parameter}", percent(margin.share)) for margin in self.margins]
        return [("kind", self.kind), *shown, *margins]


def recommend(
    case: Case, disturbances: Sequence[Sample], recoveries: Sequence[Recovery], needed: bool | None
) -> Recommendation:
    """Recommend a value of each parameter along which recovery was searched; ``needed`` is ``None`` where that is not decided."""
    if needed is None:
        return Recommendation("not-decided", (), ())
    if not needed:
        margins = [_nearest(recovery) for recovery in recoveries]
        return Recommendation("no-change-needed", (), tuple(margin for margin in margins if margin))
    # Where the samples see no loss at the present value, they cannot say at which others there is none.
    lossy = [each for each in recoveries if each.span_at(each.along.value(each.rotor)) is None]
    advisers = [_Adviser(case, tuple(disturbances), each) for each in lossy]
    found: list[Change] = []
    with suppress(BudgetSpentError):
        found.extend(change for adviser in advisers if (change := adviser.least()))  # what is found before stays
    ordered = sorted(found, key=lambda change: abs(math.log(change.ratio)))
    return Recommendation("change" if found else "no-change-found", tuple(ordered), ())


def evidence_of(edge: Edge) -> Evidence:
    """How the end of a range is known."""
    if edge.kind == "simulated":
        return "sampled"
    return "closed form" if edge.kind in _CLOSED_FORMS else "searched"


def _end_document(say: Wording, name: str, edge: Edge) -> dict[str, object]:
    return say.in_both(name, end=edge.value) | {"at_end": edge.motion or edge.kind, "evidence": evidence_of(edge)}


def with_setting(case: Case, terms: InTerms) -> Case:
    """The case with this value set, as by ``--set``."""
    text = terms.setting.partition("=")[2]
    return case.replace(**{terms.entry: text if case.si else terms.value})


def _nearest(recovery: Recovery) -> Margin | None:
    present = recovery.along.value(recovery.rotor)
    margins = [_margin(recovery, present, edge) for edge in recovery.span_at(present) or () if _happens(edge)]
    return min(margins, key=lambda margin: margin.share, default=None)


def _margin(recovery: Recovery, value: float, edge: Edge) -> Margin:
    """Distance of a value from an edge, relative to the damping or stiffness there."""
    return Margin(recovery.along.name, edge, abs((value / edge.value) ** power_of(recovery.along) - 1.0))


def _happens(edge: Edge) -> bool:
    """Whether something is lost beyond an edge; otherwise the search ends there."""
    return bool(edge.kind) and 0.0 < edge.value < math.inf


@dataclass(frozen=True)
class _Adviser:
    """Looks for the least change along one parameter."""

    case: Case
    disturbances: tuple[Sample, ...]
    recovery: Recovery

    @property
    def name(self) -> str:
        return self.recovery.along.name

    @property
    def present(self) -> float:
        return self.recovery.along.value(self.recovery.rotor)

    def least(self) -> Change | None:
        """The nearest value in a range of recovery whose check passes."""
        for span in sorted(self.recovery.spans, key=lambda span: self._away(self._ends(span).low.value)):
            for value in self._values(span):
                # As the file would state it, rounded away from the present value.
                terms = in_terms_of(self.case, self.name, value, "up" if self.present < value else "down")
                check = self._checked(terms)
                if check.recovers:
                    return self._change(terms, check, span)
        return None

    def _away(self, value: float) -> float:
        return abs(math.log(value / self.present)) if self.present > 0.0 else value

    def _ends(self, span: Span) -> Span:
        """The near and the far end of a span, seen from the present value; of a span that holds it the low and the high one."""
        return span if self.present < span.high.value else Span(span.high, span.low)

    def _values(self, span: Span) -> Iterator[float]:
        """Values inside a span, the nearest first."""
        near, far = (edge.value for edge in self._ends(span))
        inward = math.copysign(1.0, far - near) / power_of(self.recovery.along)
        middle = math.sqrt(near * far)
        for margin in MARGINS:
            value = near * (1.0 + margin) ** inward
            if (middle - value) * inward <= 0.0:
                yield middle
                return
            yield value

    def _checked(self, terms: InTerms) -> Check:
        value = with_setting(self.case, terms).parameters.value(self.name)
        planar = self.recovery.rotor.system.is_planar
        sample = in_all(self.disturbances, CHECKED if planar else CHECKED_SINGLY)
        check = check_recovery(self.recovery.rotor, sample, along=self.name, value=value, seed=SEED)
        if min(share.total for share in check.returned) < FEWEST:
            raise BudgetSpentError("too few disturbances could be followed")
        return check

    def _change(self, terms: InTerms, check: Check, span: Span) -> Change:
        value, present, case = check.value, self.present, with_setting(self.case, terms)
        rotor = rotor_of(case)
        known, radius = exact_results(rotor), rotor.system.rest_radius
        near, far = self._ends(span)
        return Change(
            self.name,
            present,
            value,
            terms,
            (value / present) ** power_of(self.recovery.along) if present > 0.0 else math.inf,
            _margin(self.recovery, value, near),
            far,
            check,
            radius,
            case.zones.zone(min(radius, 1.0)),
            known.whirl if known.rolls and known.rolls.holds else None,
        )
