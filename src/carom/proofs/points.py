"""Bifurcation points along a parameter: zeros of extended systems, enclosed and unique, with transversality.

The unknowns are the parameter ``p``, the period ``T``, the radial speed ``ṙ`` and, for grazing, the time ``t`` of the touch; the
equations are the closing conditions and those of the kind.  By Krawczyk's operator the system has exactly one zero in a box,
with a regular Jacobian.  Along the orbit's branch ``T' = −F_p/F_T``, ``ṙ' = −(B_p + B_T T')/B_ṙ`` with ``B`` = ``balance``, and a test
function that vanishes at the point changes its sign there if its derivative along the branch does not.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

from flint import arb, arb_series

from carom.proofs.balls import Ball, decided, enclosure_of, exact_ends, first, real, terms
from carom.proofs.block_orbits import inside
from carom.proofs.claims import Claim, Document, Evidence, NotShownError, claim_of
from carom.proofs.courses import OrbitCourse, Return
from carom.proofs.lines import Line, line_of
from carom.proofs.rotor import ProvenRotor
from carom.proofs.seeds import point_seeds
from carom.proofs.steady import rub_balance, rub_discriminant, wall_condition
from carom.proofs.zeros import System, box_of, derivatives, found_zero, shown_zero


class PointKind(NamedTuple):
    """A kind of point.

    Attributes
    ----------
    unknowns : tuple of str
    words : str
        What is stated to be there.
    vanishes : callable
        Function that vanishes there: of the course of an orbit, of its return if its radial speed is no unknown, or of the
        numbers if there is no orbit.  Of grazing the height between the impacts and its rate vanish.
    """

    unknowns: tuple[str, ...]
    words: str
    vanishes: Callable[..., Any]


_STEADY, _PERIOD, _ORBIT = ("value",), ("period", "value"), ("period", "radial_speed", "value")
KINDS: Mapping[str, PointKind] = {
    "fold": PointKind(_PERIOD, "two periods of orbits meet: F1 = 0 and dF1/dT = 0", lambda back: back.closing_rate),
    "speed-fold": PointKind(_PERIOD, "the two radial speeds of a period meet", lambda back: back.discriminant),
    "period-doubling": PointKind(_ORBIT, "an orbit has a multiplier -1", lambda course: course.invariants.at_minus_one),
    "neimark-sacker": PointKind(
        _ORBIT, "the product of two multipliers of an orbit is 1", lambda course: course.invariants.of_pairs
    ),
    "slip-stop": PointKind(
        _ORBIT, "friction just stops the slip in the impact of an orbit", lambda course: course.slip_after
    ),
    "grazing": PointKind(
        ("touch", *_ORBIT),
        "an orbit touches the wall between its impacts without radial speed",
        lambda course: course.height,
    ),
    "non-smooth-hopf": PointKind(
        _PERIOD, "an orbit shrinks into the equilibrium on the wall, |U*| = 1", lambda back: 1 - back.levitation
    ),
    "boundary-equilibrium": PointKind(_STEADY, "the contact-free equilibrium is on the wall, |U*| = 1", wall_condition),
    "rub-fold": PointKind(_STEADY, "the two synchronous rubs meet", rub_discriminant),
}
"""Kinds of points that can be proven."""
_LABEL, _MOST_POINTS = re.compile(r"B[0-9]{1,4},[abcd]|contact-free|rub"), 1000
"""Motions that points belong to, and how many a certificate may have."""
_ENTRIES = ({"kind", "label", "near"}, {"kind", "label", "centre", "width"})
"""Entries of a point that is open, and of one that is shown."""


def equations_of(line: Line, kind: PointKind, *unknowns: Any) -> tuple[Any, ...]:
    """Left sides of the extended system of a kind, from the unknowns in their order."""
    at = dict(zip(kind.unknowns, unknowns, strict=True))
    numbers = line.at(at["value"])
    if "period" not in at:
        return (kind.vanishes(numbers),)
    back = Return(numbers, at["period"])
    if "radial_speed" not in at:
        return back.closing, kind.vanishes(back)
    course = OrbitCourse(back, at["radial_speed"])
    found = kind.vanishes(course)
    return back.closing, course.balance, *(found(at["touch"]) if "touch" in at else (found,))


def point_claims(rotor: ProvenRotor, evidence: Evidence, options: Mapping[str, float | str]) -> list[Claim]:
    """Claims about bifurcation points along a parameter: the options ``along``, ``from`` and ``to``, as texts.

    The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    found = evidence.take("points", lambda: _all_searched(line))
    claims: list[Claim] = []
    given: set[tuple[str, str]] = set()
    shown: dict[tuple[str, str], list[ProofPoint]] = {}
    if len(found) > _MOST_POINTS:
        raise NotShownError(f"the certificate has more than {_MOST_POINTS} points")
    for entry in found:
        label, count = str(entry["label"]), 1
        if set(entry) not in _ENTRIES or not _LABEL.fullmatch(label):
            raise NotShownError(
                f"the certificate has a point of {label!r}, which names no motion or has other entries than a point"
            )
        while (entry["kind"], label) in given:
            count += 1
            label = f"{entry['label']} ({count})"
        given.add((entry["kind"], label))
        if "centre" not in entry:
            near = f"{float(entry['near'][-1]):.9g}"
            reason = f"the search in double precision found one near {near}, which could not be shown"
            unknown = ProofPoint(line, entry["kind"], label, {})
            claims.append(unknown.claim("", _statement(line, entry["kind"]), 0, reason))
            continue
        point = _shown(line, label, entry)
        others = shown.setdefault((entry["kind"], str(entry["label"])), [])
        if any(point.may_be(other) for other in others):
            raise NotShownError(f"the certificate has one {entry['kind']} of {entry['label']} twice")
        others.append(point)
        claims += _claims_of(point, entry)
    return claims


def _all_searched(line: Line) -> list[Document]:
    found: list[Document] = []
    shown: dict[tuple[str, str], list[ProofPoint]] = {}
    for kind, label, at in point_seeds(line):
        if kind not in KINDS:
            continue
        entry = _searched(line, kind, label, [at[name] for name in KINDS[kind].unknowns])
        if "centre" in entry:
            point, others = _shown(line, label, entry), shown.setdefault((kind, label), [])
            if any(point.may_be(other) for other in others):
                continue  # two guesses lead to one point
            others.append(point)
        found.append(entry)
    return found


def _searched(line: Line, kind: str, label: str, guess: list[float]) -> Document:
    """Centre and width of a box with exactly one zero; no centre if none is found."""
    entry, found = {"kind": kind, "label": label, "near": guess}, found_zero(_system(line, kind), guess)
    if found is None or not _in_range(line, dict(zip(KINDS[kind].unknowns, found[1], strict=True))):
        return entry
    return {name: entry[name] for name in ("kind", "label")} | found[0]


def _system(line: Line, kind: str) -> System:
    return partial(equations_of, line, KINDS[kind])


def _statement(line: Line, kind: str) -> str:
    return f"Along {line.name}, {KINDS[kind].words}, at exactly one point of the box that is given, and there at these values."


def _shown(line: Line, label: str, entry: Document) -> ProofPoint:
    """The point of an entry, if it shows one."""
    found = shown_zero(_system(line, entry["kind"]), entry)
    if found is None:
        raise NotShownError(f"the certificate does not show the {entry['kind']} of {label}")
    point = ProofPoint(line, entry["kind"], label, dict(zip(KINDS[entry["kind"]].unknowns, found, strict=True)))
    if not _in_range(line, point.at):
        raise NotShownError(f"the {entry['kind']} of {label} is not at a value and at times that are looked at")
    return point


def _claims_of(point: ProofPoint, entry: Document) -> list[Claim]:
    boxes = {f"{name} box": ball for name, ball in zip(point.at, box_of(entry), strict=True)}
    claims = [point.claim("", _statement(point.line, point.kind), 1, "", **point.at, **boxes)]
    try:
        return [*claims, *_nature(point)]
    except (ValueError, ZeroDivisionError) as problem:
        reason = f"a formula has a pole next to it: {problem}"
        return [*claims, point.claim("transversal", "It is transversal.", 0, reason)]


def _in_range(line: Line, at: Mapping[str, arb]) -> bool:
    """Whether the value is in the interval, the period positive and a touch between the impacts."""
    low, high = exact_ends(at["value"])
    period = at.get("period", arb(1))
    touch = at.get("touch", period / 2)
    return line.ends[0] <= high and low <= line.ends[1] and bool(period > 0 and 0 < touch < period)


# ------------------------------------------------------------------------------------------------ what happens there


@dataclass(frozen=True)
class ProofPoint:
    """A point that is shown.

    Attributes
    ----------
    line : Line
    kind : str
    label : str
        The motion that it belongs to.
    at : mapping of str to arb
        Enclosures of the unknowns.
    """

    line: Line
    kind: str
    label: str
    at: Mapping[str, arb]

    def claim(self, what: str, statement: str, sign: int, reason: str = "", **balls: arb) -> Claim:
        """Claim that more bits do not decide, as the search for points would not find others with them."""
        values = {name: enclosure_of(ball) for name, ball in balls.items()}
        about = f"of {self.label} {what}".rstrip()
        return claim_of(self.kind, about, statement, sign, reason=reason, enclosures=values, limited=False)

    def may_be(self, other: ProofPoint) -> bool:
        """Whether both may be one zero: nothing tells them apart."""
        return all(ball.overlaps(other.at[name]) for name, ball in self.at.items())

    def moved(self, period_rate: arb | int = 0, by: int = 1) -> Return[arb_series]:
        """The return of the orbit as a power series of the parameter; with ``by`` zero of its period alone."""
        value = arb_series([self.at["value"], by])
        return Return(self.line.at(value), arb_series([self.at["period"], period_rate]))

    @cached_property
    def course(self) -> OrbitCourse[arb]:
        """The orbit there."""
        back = Return(self.line.at(self.at["value"]), self.at["period"])
        if self.kind == "non-smooth-hopf":
            return OrbitCourse(back, arb(0))
        if self.kind == "speed-fold":
            return OrbitCourse(back, -real(back.lever) / back.lever_squared)
        faster = self.label.split()[0][-1] in "cd"
        return OrbitCourse(back, self.at["radial_speed"] if "radial_speed" in self.at else back.speeds()[faster])

    @cached_property
    def rates(self) -> tuple[arb, arb]:
        """``T'`` and ``ṙ'`` along the branch; not finite at a fold."""

        def closing(period: Any, speed: Any, value: Any) -> tuple[Ball, Ball]:
            moved = OrbitCourse(Return(self.line.at(value), period), speed)
            return moved.back.closing, moved.balance

        _, slopes = derivatives(closing, (self.course.back.period, self.course.speed, self.at["value"]))
        period_rate = -slopes[0, 2] / slopes[0, 0]
        return period_rate, -(slopes[1, 2] + slopes[1, 0] * period_rate) / slopes[1, 1]


def _nature(point: ProofPoint) -> list[Claim]:
    """Claims about transversality and the motion at a point."""
    if "period" not in point.at:
        return _steady_claims(point)
    claims = {"fold": _fold_claims, "speed-fold": _speed_fold_claims, "non-smooth-hopf": _shrinking_claims}.get(
        point.kind, _crossing_claims
    )(point)
    if point.kind == "neimark-sacker":
        claims.append(_torus_claim(point))
    return [*claims, _motion_claim(point)]


_BALANCES = {
    1: (
        "non-smooth fold",
        "It is a non-smooth fold: a synchronous rub, a saddle along the wall, exists on the side where the rotor levitates.",
    ),
    -1: (
        "persistence",
        "It is persistence: a synchronous rub pressed on the wall exists where the contact-free equilibrium is outside.",
    ),
    0: ("kind", "It is a non-smooth fold or persistence."),
}


def _steady_claims(point: ProofPoint) -> list[Claim]:
    """Claims about transversality and about the motions on both sides of a point of levitation or rubs."""
    with terms(2):
        slope = KINDS[point.kind].vanishes(point.line.at(arb_series([point.at["value"], 1])))[1]
    words = f"The condition vanishes with this slope by {point.line.name}, which is not zero."
    claims = [point.claim("transversal", words, abs(decided(slope)), "the sign of the slope is open", slope=slope)]
    if point.kind == "boundary-equilibrium":
        balance = rub_balance(point.line.at(point.at["value"]))
        sign = decided(balance)
        claims.append(point.claim(*_BALANCES[sign], abs(sign), "this is open", balance=balance))
    return claims


def _crossing_claims(point: ProofPoint) -> list[Claim]:
    """Claim that the test function of a point changes its sign along the branch."""
    period_rate, speed_rate = point.rates
    with terms(2):
        moved = OrbitCourse(point.moved(period_rate), arb_series([point.course.speed, speed_rate]))
        found = KINDS[point.kind].vanishes(moved)
        slope = (found(arb_series([point.at["touch"]]))[0] if point.kind == "grazing" else found)[1]
    sign, reason = decided(slope), "the sign of the slope is open"
    words = f"Along the branch of the orbit, the test function vanishes with this slope by {point.line.name}, which is not zero."
    if point.kind == "grazing":
        with terms(3):
            curve = point.course.height(arb_series([point.at["touch"], 1]))[0][2]
        sign, reason = (sign if curve < 0 else 0), "whether the touch is a maximum is open"
        words = f"The touch is a maximum of the radius, whose height (|U|^2 - 1)/radial speed grows by {point.line.name} with this slope, not zero."
    return [point.claim("transversal", words, abs(sign), reason, slope=slope)]


def _speed_fold_claims(point: ProofPoint) -> list[Claim]:
    with terms(2):
        slope = -point.moved().closing[1] / point.course.back.closing_rate
        shift = point.moved(slope).discriminant[1]
    words = (
        "The discriminant of the radial speeds passes through zero with this slope, not zero, and the period is simple."
    )
    return [point.claim("transversal", words, abs(decided(shift)), slope=shift)]


def _fold_claims(point: ProofPoint) -> list[Claim]:
    with terms(3):
        curve = point.moved(1, by=0).closing[2] * 2
    with terms(2):
        push = point.moved().closing[1]
    side, name = -decided(curve) * decided(push), point.line.name
    both, none = ("larger", "smaller") if side > 0 else ("smaller", "larger")
    words = f"It is a quadratic fold: d2F1/dT2 and the derivative of F1 by {name} are not zero. Both periods exist for "
    words += f"{both} values of {name} next to it, and none for {none} ones."
    return [point.claim("transversal", words, abs(side), "a derivative may vanish", curvature=curve, slope=push)]


def _torus_claim(point: ProofPoint) -> Claim:
    trace, _, determinant = point.course.invariants
    total = trace - determinant
    strong = [decided(total - k) for k in (-2, -1, 0, 1, 2)]
    sign = 1 if abs(total) < 2 and 0 not in strong[1:3] else -1 if abs(total) > 2 else 0
    return point.claim(
        "complex",
        "A conjugate pair of multipliers lies on the unit circle, with this sum; it is at no resonance 1:1, 1:2, 1:3 or 1:4.",
        sign,
        "the two multipliers are real: this is no Neimark-Sacker bifurcation"
        if sign < 0
        else "it may be at a strong resonance",
        pair_sum=total,
    )


def _shrinking_claims(point: ProofPoint) -> list[Claim]:
    slope, reach = point.rates[1], real(point.course.back.lever)
    side = decided(reach)
    words, where = ("subcritical", "inside") if side < 0 else ("supercritical", "outside")
    grows = f"Its radial speed grows from zero by {point.line.name} with this slope, not zero."
    means = (
        f"It is {words}: next to it the small cycle has a positive radial speed where the contact-free equilibrium is {where} "
        "the wall, as Re(q a12) has this sign."
    )
    open_ = "the sign of the slope is open"
    return [
        point.claim("transversal", grows, abs(decided(slope)), open_, speed_slope=slope, reach=reach),
        point.claim(words if side else "critical", means, abs(side), "the sign of Re(q a12) is open"),
    ]


def _motion_claim(point: ProofPoint) -> Claim:
    """Claim that the orbit there is a motion of the machine, but for what the point itself is about."""
    kind, course = point.kind, point.course
    small = kind == "non-smooth-hopf"
    outward = 1 if small else decided(course.speed)
    free = course.back.numbers.mu.is_zero()
    slip = 1 if kind == "slip-stop" or free else decided(course.slip_after)
    touch = point.at.get("touch")
    stays = inside(course, lambda function: first(function(course)), touch) if outward > 0 else None
    sign = min(outward, slip, {True: 1, False: -1, None: 0}[stays]) if outward > 0 else outward
    what = "The small cycles next to it are motions" if small else "The orbit there is a motion"
    statement = f"{what} of the machine: inside the wall between the impacts{', but for the touch' if kind == 'grazing' else ''}."
    return point.claim("motion", statement, sign, "it is virtual" if sign < 0 else "this is open")
