"""Claims about kicks out of levitation for all machines of a box, from cells of their velocities and of the box."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import groupby
from typing import Any

from carom.core.processors import available_cores
from carom.proofs.balls import enclosure_of, enclosure_of_fraction
from carom.proofs.boxes import MOST_PARAMETERS
from carom.proofs.claims import Claim, claim_of
from carom.proofs.evidence import Evidence, NotShownError
from carom.proofs.families import KICKS
from carom.proofs.gaps import box_told, gaps_of, outside, told
from carom.proofs.kick_cells import IMPACTS, REFUTED, Cell, Tree, leaves, read, share_of
from carom.proofs.kick_claims import NOT_CLAIMED, nothing_found, reasons_of
from carom.proofs.kick_discs import Disc
from carom.proofs.kick_search import BITS, show_all
from carom.proofs.rotor import Rotor

BOX_THEOREM = "kicks of a box of machines"
BOX_OPTIONS = ("kicks_up_to", "most_impacts", "box")
BOX_NOT_CLAIMED = (
    *NOT_CLAIMED,
    "anything of machines with parameters outside of the intervals, or whose parameters move while they are kicked",
)
_STRETCHES = 4
"""Halvings of the interval of a parameter into stretches on each of which a speed is told."""


def box_disc_from(rotor: Rotor, options: Mapping[str, Any]) -> Disc:
    """The disc and the box that options of a theorem describe."""
    largest, most, box = options["kicks_up_to"], options["most_impacts"], options["box"]
    if not isinstance(largest, str) or type(most) is not int or not 0 <= most < len(IMPACTS):
        raise NotShownError("the certificate has no largest speed, or no number of impacts")
    if not isinstance(box, list) or not 1 <= len(box) <= MOST_PARAMETERS:
        raise NotShownError("the certificate has no box of machines")
    if not all(isinstance(entry, list) and [type(text) for text in entry] == [str] * 3 for entry in box):
        raise NotShownError("the certificate has no box of machines")
    return Disc(KICKS, rotor.hypotheses, largest, most, tuple(tuple(entry) for entry in box))


def kick_box_claims(rotor: Rotor, evidence: Evidence, options: Mapping[str, Any]) -> list[Claim]:
    """Claims of a certificate, all of whose proven cells are shown again; nothing is searched."""
    if rotor.bits != BITS:
        raise NotShownError(f"cells of kicks are shown with {BITS} bits")
    disc = box_disc_from(rotor, options)
    tree = read(evidence.take("cells", nothing_found), len(disc.along))
    show_all(disc, tree, available_cores(), evidence.tell)
    return box_claims_of(disc, tree)


def box_claims_of(disc: Disc, tree: Tree) -> list[Claim]:
    """Claims about a disc and a box whose cells are known; what is refuted leaves a gap as what is open does."""
    known = list(leaves(tree))
    proven = [(cell, IMPACTS.index(letter)) for cell, letter in known if letter in IMPACTS]
    open_ = [cell for cell, letter in known if letter not in IMPACTS]
    claims = [_share_claim(disc, known, proven, open_), _all_claim(disc, known, proven, open_)]
    if open_:
        claims += _refutations(disc, known)
        claims += _claims_outside(disc, proven, open_)
        claims += _stretch_claims(disc, proven, open_) if len(disc.along) == 1 else []
    return claims


def _told(disc: Disc) -> str:
    return f"{disc.family.told} {disc.largest}"


def _share_claim(disc: Disc, known: list[tuple[Cell, str]], proven: list[tuple[Cell, int]], open_: list[Cell]) -> Claim:
    """How much of the disc, and of the box, is proven."""
    first = min((cell.speeds[0] for cell in open_), default=Fraction(1))
    refuted = share_of(cell for cell, letter in known if letter == REFUTED)
    exact = {
        "share_proven": share_of(cell for cell, _ in proven),
        "share_refuted": refuted,
        "share_open": share_of(open_) - refuted,
        "impacts": Fraction(max((impacts for _, impacts in proven), default=0)),
    }
    return claim_of(
        "kicks",
        "recover",
        f"Of {_told(disc)}, and of the values {disc.box.words}, area of the disc times widths of the intervals, the share share_proven returns to levitation "
        "with at most so many impacts, among them, for all these values, every kick slower than the lower end of speed.",
        1 if proven else 0,
        reason="no cell of kicks could be proven to return",
        enclosures=_speeds(disc, first) | {name: enclosure_of_fraction(number) for name, number in exact.items()},
        limited=False,
    )


def _all_claim(disc: Disc, known: list[tuple[Cell, str]], proven: list[tuple[Cell, int]], open_: list[Cell]) -> Claim:
    """Whether all of it is proven."""
    most = max((impacts for _, impacts in proven), default=0)
    return claim_of(
        "kicks",
        "all recover",
        f"For all {disc.box.words}, all {_told(disc)}, return to levitation with at most {most} impacts.",
        -1 if any(letter == REFUTED for _, letter in known) else 0 if open_ else 1,
        reason=reasons_of(known, "area times widths"),
        limited=False,
    )


def _refutations(disc: Disc, known: list[tuple[Cell, str]]) -> list[Claim]:
    """How much is shown not to return, if anything is."""
    refuted = share_of(cell for cell, letter in known if letter == REFUTED)
    return [
        claim_of(
            "kicks",
            "do not recover",
            f"Of {_told(disc)}, and of the values {disc.box.words}, area of the disc times widths of the intervals, the share share_refuted never returns to "
            "levitation: after bounces the rotor stays on the wall and decays to the synchronous rub of the larger normal force.",
            1,
            enclosures={"share_refuted": enclosure_of_fraction(refuted)},
            limited=False,
        )
    ] * bool(refuted)


def _claims_outside(disc: Disc, proven: list[tuple[Cell, int]], open_: list[Cell]) -> list[Claim]:
    """That all kicks return for all parameters outside of gaps, if something is left outside."""
    gaps = gaps_of(cell.parts for cell in open_)
    inside = sum((Fraction(1, 2 ** sum(n for _, n in parts)) for parts in gaps), Fraction(0))
    if inside >= 1:
        return []
    if len(disc.along) == 1:
        parts = outside(gaps)
        where = " or ".join(told(disc.box, 0, *ends, inward=True) for ends in parts)
    else:
        boxes = "; ".join(box_told(disc.box, parts) for parts in gaps)
        where = f"{disc.box.words} outside of these boxes: {boxes}"
    most = max((impacts for cell, impacts in proven if not any(_inside(cell.parts, gap) for gap in gaps)), default=0)
    return [
        claim_of(
            "kicks",
            "all recover outside of gaps",
            f"For all {where}: all {_told(disc)}, return to levitation with at most {most} impacts.",
            1,
            enclosures={"share_of_box": enclosure_of_fraction(1 - inside)},
            limited=False,
        )
    ]


def _inside(parts: tuple[tuple[int, int], ...], gap: tuple[tuple[int, int], ...]) -> bool:
    """Whether a part lies in a gap."""
    return all(n <= m and k == place >> (m - n) for (k, n), (place, m) in zip(gap, parts, strict=True))


def _stretch_claims(disc: Disc, proven: list[tuple[Cell, int]], open_: list[Cell]) -> list[Claim]:
    """On stretches of a parameter the speed below which all kicks return."""
    count = 2**_STRETCHES
    stretches = [(Fraction(j, count), Fraction(j + 1, count)) for j in range(count)]
    # What shares no more than an end with a stretch does not count: the stretch's own cells prove its end.
    speeds = [
        min((cell.speeds[0] for cell in open_ if _meets(cell, *stretch)), default=Fraction(1)) for stretch in stretches
    ]
    claims = []
    for speed, group in groupby(range(count), key=speeds.__getitem__):
        numbers = list(group)
        low, high = stretches[numbers[0]][0], stretches[numbers[-1]][1]
        if not speed:
            continue
        most = max(impacts for cell, impacts in proven if _meets(cell, low, high) and cell.speeds[0] < speed)
        where = told(disc.box, 0, low, high, inward=True)
        claims.append(
            claim_of(
                f"kicks, {where}",
                "recover",
                f"For all {where}: every kick out of levitation, seen in the fixed frame, slower than the lower end of speed returns to levitation "
                f"with at most {most} impacts.",
                1,
                enclosures=_speeds(disc, speed),
                limited=False,
            )
        )
    return claims


def _meets(cell: Cell, low: Fraction, high: Fraction) -> bool:
    """Whether the interval of a cell has more than an end in common with another."""
    ((start, stop),) = cell.ends
    return start < high and low < stop


def _speeds(disc: Disc, share: Fraction) -> dict[str, Any]:
    """A share of the largest speed: in m/s for machines, in ``c_r Ω`` where that is the same for all of them."""
    found = {"speed": enclosure_of(disc.size(share))} if disc.shares_unit else {}
    if disc.physical and not disc.exact[1]:
        found["speed_si"] = enclosure_of_fraction(disc.exact[0] * share)
    return found
