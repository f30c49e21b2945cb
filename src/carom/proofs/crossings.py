"""Bifurcations inside an open interval of a parameter: what changes there changes exactly once, and all else holds on all of it.

On a block around a period doubling, a Neimark–Sacker point or the birth of an orbit in the boundary equilibrium one quantity of an
orbit has no sign, but its slope has.  By the interval Newton operator ``m − f(m)/f'`` it has exactly one zero on the block.  The other
conditions keep their signs on all of the block; the course between the impacts is judged by ``(|U|² − 1)/ṙ``, which is
regular where the orbit shrinks to a point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

from carom.proofs.balls import decided, enclosure_of, interval
from carom.proofs.block_orbits import first_cells, inside, orbit_branches_on
from carom.proofs.blocks import Block, OpenError, OrbitBranch
from carom.proofs.claims import Claim, claim_of
from carom.proofs.courses import Course
from carom.proofs.lines import Line
from carom.proofs.series import terms

_WORDS = {
    "flip": ("period doubling", "det(1 + J)", "stable"),
    "torus": ("neimark-sacker", "the product of 1 - lambda_j lambda_k over the pairs of multipliers", "stable"),
    "speed": ("birth", "its radial speed", "a motion of the machine"),
}
"""The bifurcation, the quantity that vanishes, and what the orbit is where it is positive."""


def crossing_claims(line: Line, low: Fraction, high: Fraction, ends: str) -> list[Claim]:
    """Claims about an interval on which nothing else could be shown; none where this does not help.

    ``ends`` is the interval in words.
    """
    block = Block(line, interval(low, low), interval(high, high))
    try:
        return [
            claim
            for name, orbit, positive in orbit_branches_on(block, first_cells(block))
            for claim in _of_orbit(block, orbit, name, positive, f"{line.name} in {ends}")
        ]
    except (OpenError, ArithmeticError, ValueError):
        return []


def _of_orbit(block: Block, orbit: OrbitBranch, name: str, positive: bool, about: str) -> Iterator[Claim]:
    """Claims about what changes of one orbit; everything else of it must be decided."""
    speed = decided(orbit.speed)
    motion = speed >= 0 and inside(orbit.plain, orbit.along)
    slip = orbit.along(lambda course: course.slip_after)
    if motion is None or (motion and not (slip > 0 or block.whole.mu.is_zero())):
        raise OpenError(f"it is open whether {name} is a motion")
    found = [] if speed else [("speed", _zero(block, orbit, lambda course: course.speed))]
    settled = not positive or orbit.along(lambda course: course.invariants.slope_at_one) < 0
    signs: dict[str, Callable[[Course], Any]] = {}
    if not settled:
        signs["flip"] = lambda course: course.invariants.at_minus_one
        signs["torus"] = lambda course: course.invariants.of_pairs
    values = {kind: decided(orbit.along(function)) for kind, function in signs.items()}
    if -1 not in values.values():
        found += [(kind, _zero(block, orbit, signs[kind])) for kind, value in values.items() if not value]
    for kind, (zero, slope) in found:
        word, quantity, nature = _WORDS[kind]
        side, other = ("larger", "smaller") if slope > 0 else ("smaller", "larger")
        statement = (
            f"{name} exists for all values of this interval, and {quantity} has exactly one zero there, at this value"
        )
        if kind == "speed":
            means = nature if motion else "outward, but it crosses the wall"
            statement += f": for all {side} values of the interval {name} is {means}, and for no {other} one."
        elif len(found) == 1 and positive and orbit.branch.along(lambda back: back.determinant) < 1:
            statement += f": for all {side} values of the interval {name} is {nature}, and for no {other} one."
        else:
            statement += "."
        yield claim_of(
            about, f"{word} of {name}", statement, 1, enclosures={"value": enclosure_of(zero)}, limited=False
        )


def _zero(block: Block, orbit: OrbitBranch, function: Callable[[Course], Any]) -> tuple[Any, int]:
    """The only zero of a function of the orbit on a block, and the sign of its slope."""
    slope = orbit.over(function)[1]
    if not decided(slope):
        raise OpenError("a quantity may have several zeros")
    with terms(2):
        zero = block.middle - function(orbit.near)[0] / slope
    if not block.ball.contains_interior(zero):
        raise OpenError("a quantity may have no zero")
    return zero, decided(slope)
