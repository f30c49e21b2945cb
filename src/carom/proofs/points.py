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
from typing import Any

from flint import arb, arb_series

from carom.proofs.balls import Enclosure, decided, enclosure_of, exact_ends, rational
from carom.proofs.block_orbits import inside
from carom.proofs.claims import Claim, claim_of
from carom.proofs.courses import Course, Return
from carom.proofs.criticality import flip_coefficient
from carom.proofs.evidence import Evidence, NotShownError, rational_of
from carom.proofs.krawczyk import System, enclosed_zero, newton
from carom.proofs.lines import Line, line_of
from carom.proofs.rotor import Rotor
from carom.proofs.seeds import point_seeds
from carom.proofs.series import first, real, terms
from carom.proofs.steady_points import boundary, rub_fold, steady_claims

Enclosures = Mapping[str, Enclosure]


@dataclass(frozen=True)
class Kind:
    """A kind of point.

    Attributes
    ----------
    unknowns : tuple of str
    equations : callable
        Takes a line, and the unknowns in their order.
    words : str
        What is stated to be there.
    test : callable or None
        Function of a course that vanishes at the point and changes its sign along the branch.
    """

    unknowns: tuple[str, ...]
    equations: Callable[..., tuple[Any, ...]]
    words: str
    test: Callable[[Course], Any] | None = None


def _fold(line: Line, period: Any, value: Any) -> tuple[Any, ...]:
    back = Return(line.at(value), period)
    return back.closing, back.closing_rate


def _speed_fold(line: Line, period: Any, value: Any) -> tuple[Any, ...]:
    back = Return(line.at(value), period)
    return back.closing, back.discriminant


def _shrinking(line: Line, period: Any, value: Any) -> tuple[Any, ...]:
    back = Return(line.at(value), period)
    return back.closing, 1 - back.levitation


def _grazing(line: Line, time: Any, period: Any, speed: Any, value: Any) -> tuple[Any, ...]:
    course = Course(Return(line.at(value), period), speed)
    return course.back.closing, course.balance, *course.height(time)


def _tested(test: Callable[[Course], Any]) -> Callable[..., tuple[Any, ...]]:
    def equations(line: Line, period: Any, speed: Any, value: Any) -> tuple[Any, ...]:
        course = Course(Return(line.at(value), period), speed)
        return course.back.closing, course.balance, test(course)

    return equations


def _of_test(words: str, test: Callable[[Course], Any]) -> Kind:
    return Kind(("period", "radial_speed", "value"), _tested(test), words, test)


KINDS: Mapping[str, Kind] = {
    "fold": Kind(("period", "value"), _fold, "two periods of orbits meet: F1 = 0 and dF1/dT = 0"),
    "speed-fold": Kind(("period", "value"), _speed_fold, "the two radial speeds of a period meet"),
    "period-doubling": _of_test("an orbit has a multiplier -1", lambda course: course.invariants.at_minus_one),
    "neimark-sacker": _of_test(
        "the product of two multipliers of an orbit is 1", lambda course: course.invariants.of_pairs
    ),
    "slip-stop": _of_test("friction just stops the slip in the impact of an orbit", lambda course: course.slip_after),
    "grazing": Kind(
        ("touch", "period", "radial_speed", "value"),
        _grazing,
        "an orbit touches the wall between its impacts without radial speed",
    ),
    "non-smooth-hopf": Kind(
        ("period", "value"), _shrinking, "an orbit shrinks into the equilibrium on the wall, |U*| = 1"
    ),
    "boundary-equilibrium": Kind(("value",), boundary, "the contact-free equilibrium is on the wall, |U*| = 1"),
    "rub-fold": Kind(("value",), rub_fold, "the two synchronous rubs meet"),
}
"""Kinds of points that can be proven."""
_LABEL, _MOST_POINTS = re.compile(r"B[0-9]{1,4},[abcd]|contact-free|rub"), 1000
"""Motions that points belong to, and how many a certificate may have."""


def point_claims(rotor: Rotor, evidence: Evidence, options: Any) -> list[Claim]:
    """Claims about bifurcation points along a parameter: the options ``along``, ``from`` and ``to``, as texts.

    The rotor's own value of the parameter does not matter.
    """
    line = line_of(rotor.hypotheses, str(options["along"]), str(options["from"]), str(options["to"]))
    found = evidence.take("points", lambda: [_searched(line, *seed) for seed in point_seeds(line)])
    claims: list[Claim] = []
    told: set[tuple[str, str]] = set()
    if len(found) > _MOST_POINTS:
        raise NotShownError(f"the certificate has more than {_MOST_POINTS} points")
    for entry in found:
        label, count = str(entry["label"]), 1
        if set(entry) - {"kind", "label", "near", "centre", "width"} or not _LABEL.fullmatch(label):
            raise NotShownError(f"the certificate has a point of {label!r}, which names no motion")
        while (entry["kind"], label) in told:
            count += 1
            label = f"{entry['label']} ({count})"
        told.add((entry["kind"], label))
        claims += _claims_of(line, label, entry)
    return claims


def _searched(line: Line, kind: str, label: str, guess: list[float]) -> dict[str, Any]:
    """Centre and width of a box with exactly one zero; no centre if none is found."""
    system = _system(line, kind)
    centre = newton(system, guess)
    found = None if centre is None else enclosed_zero(system, centre)
    entry: dict[str, Any] = {"kind": kind, "label": label, "near": guess}
    at = None if found is None else dict(zip(KINDS[kind].unknowns, found[0], strict=True))
    if centre is not None and found is not None and at is not None and _in_range(line, at):
        entry |= {"centre": [str(exact_ends(x)[0]) for x in centre], "width": found[1]}
    return entry


def _system(line: Line, kind: str) -> System:
    equations = KINDS[kind].equations
    return lambda *unknowns: equations(line, *unknowns)


def _claims_of(line: Line, label: str, entry: Mapping[str, Any]) -> list[Claim]:
    kind = KINDS[entry["kind"]]
    statement = f"Along {line.name}, {kind.words}, at exactly one point of a box around these values."
    if "centre" not in entry:
        reason = (
            f"the search in double precision found one near {float(entry['near'][-1]):.9g}, which could not be shown"
        )
        return [_claim(entry["kind"], f"of {label}", statement, 0, reason=reason)]
    centre = [rational(rational_of(text)).mid() for text in entry["centre"]]
    found = enclosed_zero(_system(line, entry["kind"]), centre, int(entry["width"]))
    if found is None or len(centre) != len(kind.unknowns):
        raise NotShownError(f"the certificate does not show the {entry['kind']} of {label}")
    values = dict(zip(kind.unknowns, found[0], strict=True))
    if not _in_range(line, values):
        raise NotShownError(f"the {entry['kind']} of {label} is not at a value and at times that are looked at")
    enclosures = {name: enclosure_of(ball) for name, ball in values.items()}
    claims = [_claim(entry["kind"], f"of {label}", statement, 1, enclosures=enclosures)]
    try:
        return [*claims, *_nature(line, entry["kind"], label, values)]
    except (ValueError, ZeroDivisionError) as problem:
        reason = f"a formula has a pole next to it: {problem}"
        return [*claims, _claim(entry["kind"], f"of {label} transversal", "It is transversal.", 0, reason)]


def _in_range(line: Line, at: Mapping[str, Any]) -> bool:
    """Whether the value is in the interval, the period positive and a touch between the impacts."""
    low, high = exact_ends(at["value"])
    period = at.get("period", arb(1))
    touch = at.get("touch", period / 2)
    return line.ends[0] <= high and low <= line.ends[1] and bool(period > 0 and 0 < touch < period)


def _claim(
    about: str, kind: str, statement: str, sign: int, reason: str = "", enclosures: Enclosures | None = None
) -> Claim:
    """Claim that more bits do not decide, as the search for points would not find others with them."""
    return claim_of(about, kind, statement, sign, reason=reason, enclosures=enclosures, limited=False)


# ------------------------------------------------------------------------------------------------ what happens there


def _nature(line: Line, kind: str, label: str, at: Mapping[str, Any]) -> list[Claim]:
    """Claims about transversality, criticality and the motion at a point."""
    if kind in ("boundary-equilibrium", "rub-fold"):
        return steady_claims(line, kind, label, at["value"])
    course = Course(Return(line.at(at["value"]), at["period"]), _speed(line, kind, label, at))
    claims = []
    if kind in ("fold", "speed-fold"):
        claims.append(_fold_claim(line, kind, label, at))
    elif kind == "non-smooth-hopf":
        claims += _shrinking_claims(line, label, course, at)
    else:
        claims.append(_crossing_claim(line, kind, label, course, at))
    if kind == "period-doubling":
        claims += _flip_claims(label, course)
    if kind == "neimark-sacker":
        claims.append(_torus_claim(label, course))
    return [*claims, _motion_claim(kind, label, course, at)]


def _speed(line: Line, kind: str, label: str, at: Mapping[str, Any]) -> Any:
    if "radial_speed" in at:
        return at["radial_speed"]
    if kind == "non-smooth-hopf":
        return arb(0)
    back = Return(line.at(at["value"]), at["period"])
    if kind == "speed-fold":
        return -real(back.lever) / back.lever_squared
    return back.speeds()[label.split()[0][-1] in "cd"]


def _rates(line: Line, course: Course, value: Any) -> tuple[Any, Any]:
    """``T'`` and ``ṙ'`` along the branch; not finite at a fold."""
    period, speed = course.back.period, course.speed

    def equations(*unknowns: Any) -> tuple[Any, Any]:
        moved = Course(Return(line.at(unknowns[2]), unknowns[0]), unknowns[1])
        return moved.back.closing, moved.balance

    columns = []
    with terms(2):
        for place in range(3):
            balls = (period, speed, value)
            found = equations(*(arb_series([x, 1]) if k == place else x for k, x in enumerate(balls)))
            columns.append([x[1] if isinstance(x, arb_series) else arb(0) for x in found])
    (along, balance), (_, tilt), (push, lift) = columns
    slope = -push / along
    return slope, -(lift + balance * slope) / tilt


def _slope(line: Line, course: Course, value: Any, test: Callable[[Course], Any]) -> Any:
    """Derivative of a function of the orbit along its branch."""
    period_rate, speed_rate = _rates(line, course, value)
    with terms(2):
        back = Return(line.at(arb_series([value, 1])), arb_series([course.back.period, period_rate]))
        return test(Course(back, arb_series([course.speed, speed_rate])))[1]


def _crossing_claim(line: Line, kind: str, label: str, course: Course, at: Mapping[str, Any]) -> Claim:
    test = KINDS[kind].test or (lambda moved: moved.height(arb_series([at["touch"]]))[0])
    slope = _slope(line, course, at["value"], test)
    sign, reason = decided(slope), "the sign of the slope is open"
    words = (
        f"Along the branch of the orbit, the test function vanishes with this slope by {line.name}, which is not zero."
    )
    if kind == "grazing":
        with terms(3):
            curve = course.height(arb_series([at["touch"], 1]))[0][2]
        sign = sign if curve < 0 else 0
        words = f"The touch is a maximum of the radius, whose height (|U|^2 - 1)/radial speed grows by {line.name} with this slope, not zero."
        reason = "whether the touch is a maximum is open"
    return _claim(
        kind, f"of {label} transversal", words, abs(sign), reason=reason, enclosures={"slope": enclosure_of(slope)}
    )


def _fold_claim(line: Line, kind: str, label: str, at: Mapping[str, Any]) -> Claim:
    with terms(3):
        back = Return(line.at(at["value"]), arb_series([at["period"], 1]))
        curve = back.closing[2] * 2
    with terms(2):
        moved = Return(line.at(arb_series([at["value"], 1])), arb_series([at["period"]]))
        push = moved.closing[1]
    if kind == "speed-fold":
        rate = Return(line.at(at["value"]), at["period"]).closing_rate
        with terms(2):
            slope = -push / rate
            shift = Return(line.at(arb_series([at["value"], 1])), arb_series([at["period"], slope])).discriminant[1]
        words = "The discriminant of the radial speeds passes through zero with this slope, not zero, and the period is simple."
        return _claim(
            kind, f"of {label} transversal", words, abs(decided(shift)), enclosures={"slope": enclosure_of(shift)}
        )
    side = -decided(curve) * decided(push)
    words = f"It is a quadratic fold: d2F1/dT2 and the derivative of F1 by {line.name} are not zero. Both periods exist for "
    words += f"{'larger' if side > 0 else 'smaller'} values of {line.name} next to it, and none for {'smaller' if side > 0 else 'larger'} ones."
    values = {"curvature": enclosure_of(curve), "slope": enclosure_of(push)}
    return _claim(
        kind, f"of {label} transversal", words, abs(side), reason="a derivative may vanish", enclosures=values
    )


def _flip_claims(label: str, course: Course) -> list[Claim]:
    trace, _, determinant = course.invariants
    # The other two multipliers have the sum τ + 1 and the product −D.
    total, product = trace + 1, -determinant
    signs = [decided(x) for x in (1 - total + product, 1 + total + product, 1 - product, 1 + product)]
    others = min(signs)
    coefficient = flip_coefficient(course)
    # The normal form needs that no other multiplier is on the unit circle.
    sign = decided(coefficient) if 0 not in signs else 0
    words = "super" if sign > 0 else "sub"
    born = "born stable" if sign > 0 and others > 0 else "unstable"
    return [
        _claim(
            "period-doubling",
            f"of {label} simple",
            "The other two multipliers lie inside the unit circle.",
            others,
            reason="one of them is outside" if others < 0 else "whether they lie inside is open",
        ),
        _claim(
            "period-doubling",
            f"of {label} {words}critical" if sign else f"of {label} critical",
            f"It is {words}critical: on the centre manifold the impact map is x -> -x + b x^3 with this b, not zero. Orbits of "
            f"twice the period next to it are {born}, as far as they stay inside the wall.",
            abs(sign),
            reason="the sign of b is open, or another multiplier may be on the unit circle",
            enclosures={"b": enclosure_of(coefficient)},
        ),
    ]


def _torus_claim(label: str, course: Course) -> Claim:
    trace, _, determinant = course.invariants
    total = trace - determinant
    strong = [decided(total - k) for k in (-2, -1, 0, 1, 2)]
    sign = 1 if abs(total) < 2 and 0 not in strong[1:3] else -1 if abs(total) > 2 else 0
    return _claim(
        "neimark-sacker",
        f"of {label} complex",
        "A conjugate pair of multipliers lies on the unit circle, with this sum; it is at no resonance 1:1, 1:2, 1:3 or 1:4.",
        sign,
        reason="the two multipliers are real: this is no Neimark-Sacker bifurcation"
        if sign < 0
        else "it may be at a strong resonance",
        enclosures={"pair_sum": enclosure_of(total)},
    )


def _shrinking_claims(line: Line, label: str, course: Course, at: Mapping[str, Any]) -> list[Claim]:
    slope, reach = _rates(line, course, at["value"])[1], real(course.back.lever)
    side = decided(reach)
    words = "subcritical" if side < 0 else "supercritical"
    where = "inside" if side < 0 else "outside"
    values = {"speed_slope": enclosure_of(slope), "reach": enclosure_of(reach)}
    return [
        _claim(
            "non-smooth-hopf",
            f"of {label} transversal",
            f"Its radial speed grows from zero by {line.name} with this slope, not zero.",
            abs(decided(slope)),
            reason="the sign of the slope is open",
            enclosures=values,
        ),
        _claim(
            "non-smooth-hopf",
            f"of {label} {words}" if side else f"of {label} critical",
            f"It is {words}: next to it the small cycle has a positive radial speed where the contact-free equilibrium is {where} "
            "the wall, as Re(q a12) has this sign.",
            abs(side),
            reason="the sign of Re(q a12) is open",
        ),
    ]


def _motion_claim(kind: str, label: str, course: Course, at: Mapping[str, Any]) -> Claim:
    """Claim that the orbit there is a motion of the machine, but for what the point itself is about."""
    small = kind == "non-smooth-hopf"
    outward = 1 if small else decided(course.speed)
    free = course.back.numbers.mu.is_zero()
    slip = 1 if kind == "slip-stop" or free else decided(course.slip_after)
    stays = inside(course, lambda function: first(function(course)), at.get("touch")) if outward > 0 else None
    sign = min(outward, slip, {True: 1, False: -1, None: 0}[stays]) if outward > 0 else outward
    what = "The small cycles next to it are motions" if small else "The orbit there is a motion"
    statement = f"{what} of the machine: inside the wall between the impacts{', but for the touch' if kind == 'grazing' else ''}."
    return _claim(kind, f"of {label} motion", statement, sign, reason="it is virtual" if sign < 0 else "this is open")
