"""Claims about kicks out of levitation, from cells of their velocities of which it is known what is proven."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from carom.core.processors import available_cores
from carom.proofs.balls import enclosure_of_fraction, enclosures_of
from carom.proofs.claims import Claim, claim_of
from carom.proofs.evidence import Evidence, NotShownError
from carom.proofs.kick_cells import IMPACTS, OPEN, Cell, Tree, leaves, read, share_of
from carom.proofs.kick_discs import Disc
from carom.proofs.kick_search import BITS, show_all
from carom.proofs.rotor import Rotor

THEOREM = "kicks"
OPTIONS = ("kicks_up_to", "most_impacts")
NOT_CLAIMED = (
    "that kicks of open cells do not return, or that they do; why they are open is told by the search",
    "that the impacts stated happen: they are bounds from above",
    "anything of kicks beyond the largest speed, of starts other than levitation, or of walls that give way",
)


def disc_from(rotor: Rotor, options: Mapping[str, Any]) -> Disc:
    """The disc that options of a theorem describe."""
    largest, most = options["kicks_up_to"], options["most_impacts"]
    if not isinstance(largest, str) or type(most) is not int or not 0 <= most < len(IMPACTS):
        raise NotShownError("the certificate has no largest speed, or no number of impacts")
    return Disc(rotor.hypotheses, largest, most)


def kick_claims(rotor: Rotor, evidence: Evidence, options: Mapping[str, Any]) -> list[Claim]:
    """Claims of a certificate, all of whose proven cells are shown again; nothing is searched."""
    if rotor.bits != BITS:
        raise NotShownError(f"cells of kicks are shown with {BITS} bits")
    disc = disc_from(rotor, options)
    tree = read(evidence.take("cells", nothing_found))
    show_all(disc, tree, available_cores(), evidence.tell)
    return claims_of(disc, tree)


def nothing_found() -> str:
    """Stand for a search where cells are only read."""
    raise NotShownError("cells are found by a search of their own")


def told_kicks(disc: Disc) -> str:
    """The kicks of a disc in words."""
    return f"kicks out of levitation, seen in the fixed frame, with velocities in the disc up to {disc.largest}"


def reasons_of(known: Iterable[tuple[Cell, str]], of: str) -> str:
    """How much of all cells is open, and why; nothing where all is proven."""
    parts: dict[str, Fraction] = {}
    for cell, letter in known:
        if letter in OPEN:
            parts[letter] = parts.get(letter, Fraction(0)) + cell.share
    ordered = sorted(parts.items(), key=lambda entry: -entry[1])
    return "; ".join(f"{100 * float(part):.3g} % of the {of}: {OPEN[letter]}" for letter, part in ordered)


def claims_of(disc: Disc, tree: Tree) -> list[Claim]:
    """Claims about a disc whose cells are known."""
    known = [(cell, letter) for cell, letter in leaves(tree)]
    proven = [(cell, IMPACTS.index(letter)) for cell, letter in known if letter in IMPACTS]
    first = min((cell.speeds[0] for cell, letter in known if letter in OPEN), default=Fraction(1))
    share, left = share_of(cell for cell, _ in proven), share_of(cell for cell, letter in known if letter in OPEN)
    most = max((impacts for _, impacts in proven), default=0)
    numbers = enclosures_of(speed=disc.speed(first))
    if disc.physical and not disc.exact[1]:
        numbers["speed_si"] = enclosure_of_fraction(disc.exact[0] * first)
    exact = {"share_proven": share, "share_refuted": Fraction(0), "share_open": left, "impacts": Fraction(most)}
    numbers |= {name: enclosure_of_fraction(number) for name, number in exact.items()}
    told = told_kicks(disc)
    recover = claim_of(
        "kicks",
        "recover",
        f"Of {told}, the share share_proven of the area returns to levitation with at most so many impacts, among them every kick slower than "
        "the lower end of speed.",
        1 if proven else 0,
        reason="no cell of kicks could be proven to return",
        enclosures=numbers,
        limited=False,
    )
    whole = claim_of(
        "kicks",
        "all recover",
        f"All {told}, return to levitation with at most {most} impacts.",
        0 if left else 1,
        reason=reasons_of(known, "area"),
        limited=False,
    )
    return [recover, whole]
