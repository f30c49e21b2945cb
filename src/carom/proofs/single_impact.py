"""Orbits with one impact a period: existence, uniqueness, the course between impacts, slip and stability.

At a root ``T`` of ``F₁`` the radial speed solves ``|q a₁₂|²ṙ² + 2 Re(q a₁₂)ṙ + 1 − |U*|² = 0``.  A positive discriminant
gives two simple solutions, so by the implicit function theorem each orbit is the only one near it.

*Between the impacts* ``R(t) = |U|² − 1`` is analytic with ``R(0) = R(T) = 0``, ``Ṙ(0) = −2dṙ`` and ``Ṙ(T) = 2ṙ``.  Next to
both impacts its first term decides, in between cells on which it is negative.

*Stability.*  With trace ``τ``, sum of principal minors ``m`` and determinant ``D = d²e^{−2γT}`` of the derivative of the impact
map, all multipliers lie inside the unit circle exactly if (Schur, Cohn)

    |D| < 1,      1 − τ + m − D > 0,      1 + τ + m + D > 0,      Π_{j<k}(1 − λⱼλₖ) = 1 − m + D(τ − D) > 0.

If all lie inside or on it, none of these is violated.  So a violated one proves instability.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from math import ceil
from typing import Any

from flint import arb

from carom.proofs.balls import decided, exact_ends
from carom.proofs.cells import NEGATIVE, OPEN, Analytic, Cells, cells_of, power_of_two_below, show
from carom.proofs.claims import Claim, Status
from carom.proofs.courses import Course, Return
from carom.proofs.evidence import Evidence, NotShownError, rational_of
from carom.proofs.periods import Periods
from carom.proofs.rotor import TOO_LARGE, Rotor

MOST_CELLS = 1000
"""Cells of one flight after which the search ends."""


def candidates(rotor: Rotor, periods: Periods) -> Iterator[tuple[str, dict[str, Course] | None]]:
    """Both solutions of the closing conditions at each root, or none, or ``None`` where this is undecided, with the names they would have."""
    for root in periods.roots:
        back = Return(rotor.numbers, root.ball)
        letters = "bd" if root.longer else "ac"
        names = [f"B{root.pair},{letter}" for letter in letters]
        found, speeds = None, _radial_speeds(rotor, back)
        if speeds is not None:
            found = {name: Course(back, speed) for name, speed in zip(names, speeds, strict=False)}
        yield f"B{root.pair},{'/'.join(letters)}", found


def _radial_speeds(rotor: Rotor, back: Return) -> list[Any] | None:
    """Both radial speeds, the lower first; empty if there is none, ``None`` if that is undecided."""
    if back.discriminant < 0:
        return []
    if not back.discriminant > 0:
        return None
    if rotor.on_the_wall:
        other = -2 * back.lever.real / back.lever_squared
        return [arb(0), other] if other > 0 else [other, arb(0)]
    return list(back.speeds())


def orbit_claims(rotor: Rotor, name: str, course: Course, evidence: Evidence) -> tuple[list[Claim], Status]:
    """Claims about one orbit, and whether it is a motion of the machine."""
    solution = rotor.claim(
        name,
        "solution",
        "The closing conditions of an orbit with one impact a period and forward slip have a solution with a period and a "
        "radial speed in these intervals; it is simple, so no other is next to it.",
        1,
        period=course.back.period,
        radial_speed=course.speed,
        angular_speed=course.angular_speed,
    )
    outward = rotor.claim(
        name,
        "outward",
        "Its radial speed before the impact is positive: it meets the wall from inside.",
        decided(course.speed) or (-1 if course.speed.is_zero() else 0),
        "its radial speed is not above 0" if course.speed <= 0 else "the sign of its radial speed is open",
    )
    claims = [solution, outward]
    if outward.status == "proven":
        claims += [_inside_claim(rotor, name, course, evidence), _slip_claim(rotor, name, course)]
    kinds = {claim.status for claim in claims}
    status: Status = "refuted" if "refuted" in kinds else "undecided" if "undecided" in kinds else "proven"
    claims.append(
        Claim(
            name,
            "admissible",
            "It is a motion of the machine: it meets the wall from inside, stays inside between its impacts, and its slip "
            "stays forward.",
            status,
            "; ".join(claim.reason for claim in claims if claim.status == status and claim.reason),
            limited_by_precision=any(claim.limited_by_precision for claim in claims),
        )
    )
    return [*claims, _stability_claim(rotor, name, course)], status


def _slip_claim(rotor: Rotor, name: str, course: Course) -> Claim:
    """Claim that the slip stays forward throughout the impact."""
    after = course.slip_after
    free = rotor.hypotheses.rational("mu") == (Fraction(0),)
    words = "friction would stop its slip, or its slip is backward"
    return rotor.claim(
        name,
        "slip",
        "Its slip is forward before the impact and after it, or there is no friction.",
        1 if free else decided(after),
        words if after < 0 else "whether its slip stays forward is open",
        slip_after=after,
    )


# ------------------------------------------------------------------------------------------------ between the impacts


def _inside_claim(rotor: Rotor, name: str, course: Course, evidence: Evidence) -> Claim:
    """Claim that the orbit stays inside the wall strictly between its impacts."""
    claim = partial(rotor.claim, name, "inside", "It stays inside the wall, |U| < 1, strictly between its impacts.")
    period, radius = course.back.period, Analytic(course.heights)
    # Without rebound the rotor leaves with no radial speed, and the push decides.
    order = 2 if rotor.hypotheses.rational("d") == (Fraction(0),) else 1
    found = evidence.take(f"flight of {name}", lambda: _flight(rotor, period, radius, order))
    if found is None:
        return claim(
            0,
            "neither could be shown: it comes too close to the wall for the precision or the width of the given numbers",
        )
    if "outside" in found:
        time = rational_of(found["outside"])
        if time == 0:
            shown = order == 2 and radius.series(arb(0), 3)[2] > 0
            reason = "it would stay on the wall: it does not rebound and is pressed outward"
        else:
            shown = 0 < time < exact_ends(period)[0] and radius.sign(time) > 0
            reason = f"it would be outside the wall at t = {float(time):.6g} after the impact"
        if not shown:
            raise NotShownError(f"the certificate does not show that {name} leaves the wall at {time}")
        return claim(-1, reason)
    cells = Cells.from_document(found)
    if set(cells.kinds) - {NEGATIVE} or not _ends_inside(period, radius, cells.cuts[0], cells.cuts[-1], order):
        raise NotShownError(f"the certificate does not show that {name} stays inside the wall")
    show(radius, cells)
    return claim(1)


def _ends_inside(period: Any, radius: Analytic, first: Fraction, last: Fraction, order: int) -> bool:
    """Whether the radius is below one from the impact to ``first``, and from ``last`` to the next impact."""
    return (
        0 < first <= last < exact_ends(period)[0]
        and radius.sign_next_to(arb(0), first, order, 1) < 0
        and radius.sign_next_to(period, exact_ends(period)[1] - last, 1, -1) < 0
    )


def _flight(rotor: Rotor, period: Any, radius: Analytic, order: int) -> dict[str, Any] | None:
    """Cells on which the radius is below one, or a time at which it is not; ``None`` if neither is found."""
    if order == 2 and radius.series(arb(0), 3)[2] > 0:
        return {"outside": "0"}
    low, high = exact_ends(period)
    width = power_of_two_below(min(1 / Fraction(rotor.fastest), low / 4))
    least = width / 2 ** max(rotor.bits // 2, 20)
    # Both ends are tried from the widest interval on; a point outside ends the search.
    ends = []
    for place, side in ((arb(0), 1), (period, -1)):
        reach = width
        while not radius.sign_next_to(place, reach + (high - low), order if side > 0 else 1, side) < 0:
            near = reach if side > 0 else low - reach
            if radius.sign(near) > 0:
                return {"outside": str(near)}
            reach /= 2
            if reach < least:
                return None
        ends.append(reach)
    first, grid = ends[0], ends[1] / 256
    last = ceil((low - ends[1]) / grid) * grid
    if not _ends_inside(period, radius, first, last, order):
        return None
    found = cells_of(radius, first, last, width=width, least=least, most=MOST_CELLS, kinds=NEGATIVE)
    middle = sum(found.cuts[-2:]) / 2
    if found.kinds.endswith(OPEN) and radius.sign(middle) > 0:
        return {"outside": str(middle)}
    return found.document() if found.cuts[-1] == last and not set(found.kinds) - {NEGATIVE} else None


# ------------------------------------------------------------------------------------------------ stability


def _stability_claim(rotor: Rotor, name: str, course: Course) -> Claim:
    """Claim that all multipliers lie inside the unit circle."""
    found = course.invariants
    conserved = rotor.hypotheses.rational("d", "gamma") == (Fraction(1), Fraction(0))
    signs = {words: decided(ball) for words, ball in found.conditions.items()}
    if conserved:
        signs[TOO_LARGE] = -1
    sign = min(signs.values())
    reasons = [words for words, value in signs.items() if value == sign]
    return rotor.claim(
        name,
        "stable",
        "All three multipliers of the impact map at it lie inside the unit circle.",
        sign,
        "; ".join(reasons) if sign < 0 else f"it is open whether {', or whether '.join(reasons)}",
        **found._asdict(),
    )
