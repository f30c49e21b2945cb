"""Claims about disturbances out of levitation, from cells of which it is known what is proven."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from carom.core.processors import available_cores
from carom.proofs.balls import enclosure_of_fraction, enclosures_of
from carom.proofs.claims import Claim, claim_of
from carom.proofs.evidence import Evidence, NotShownError
from carom.proofs.families import Family
from carom.proofs.kick_cells import IMPACTS, OPEN, REFUTED, Cell, Tree, leaves, read, share_of
from carom.proofs.kick_discs import Disc
from carom.proofs.kick_search import BITS, show_all
from carom.proofs.rotor import Rotor

NOT_CLAIMED = (
    "that what is open does not return, or that it does; why it is open is told by the search",
    "that the impacts stated happen: they are bounds from above",
    "anything beyond the largest size, of starts other than levitation, or of walls that give way",
)


def options_of(family: Family) -> tuple[str, str]:
    """Names of the options of the theorem about a family."""
    return family.option, "most_impacts"


def disc_from(family: Family, rotor: Rotor, options: Mapping[str, Any]) -> Disc:
    """The disc that options of a theorem describe."""
    largest, most = (options[name] for name in options_of(family))
    if not isinstance(largest, str) or type(most) is not int or not 0 <= most < len(IMPACTS):
        raise NotShownError("the certificate has no largest size, or no number of impacts")
    return Disc(family, rotor.hypotheses, largest, most)


def kick_claims(family: Family, rotor: Rotor, evidence: Evidence, options: Mapping[str, Any]) -> list[Claim]:
    """Claims of a certificate, all of whose proven cells are shown again; nothing is searched."""
    if rotor.bits != BITS:
        raise NotShownError(f"cells are shown with {BITS} bits")
    disc = disc_from(family, rotor, options)
    tree = read(evidence.take("cells", nothing_found))
    show_all(disc, tree, available_cores(), evidence.tell)
    return claims_of(disc, tree)


def nothing_found() -> str:
    """Stand for a search where cells are only read."""
    raise NotShownError("cells are found by a search of their own")


def reasons_of(known: Iterable[tuple[Cell, str]], of: str) -> str:
    """How much of all cells does not return, and how much is open, and why; nothing where all returns."""
    parts: dict[str, Fraction] = {}
    for cell, letter in known:
        parts[letter] = parts.get(letter, Fraction(0)) + cell.share
    told = [
        (letter, f"{100 * float(part):.3g} % of the {of}")
        for letter, part in sorted(parts.items(), key=lambda entry: -entry[1])
    ]
    refuted = [f"{share} does not return" for letter, share in told if letter == REFUTED]
    return "; ".join([*refuted, *(f"{share}: {OPEN[letter]}" for letter, share in told if letter in OPEN)])


def claims_of(disc: Disc, tree: Tree) -> list[Claim]:
    """Claims about a disc whose cells are known."""
    known = [(cell, letter) for cell, letter in leaves(tree)]
    proven = [(cell, IMPACTS.index(letter)) for cell, letter in known if letter in IMPACTS]
    first = min((cell.speeds[0] for cell, letter in known if letter not in IMPACTS), default=Fraction(1))
    share, left = share_of(cell for cell, _ in proven), share_of(cell for cell, letter in known if letter in OPEN)
    refuted = share_of(cell for cell, letter in known if letter == REFUTED)
    most = max((impacts for _, impacts in proven), default=0)
    family = disc.family
    numbers = enclosures_of(**{family.size: disc.size(first)})
    if disc.physical and not disc.exact[1]:
        numbers[f"{family.size}_si"] = enclosure_of_fraction(disc.exact[0] * first)
    exact = {"share_proven": share, "share_refuted": refuted, "share_open": left, "impacts": Fraction(most)}
    numbers |= {name: enclosure_of_fraction(number) for name, number in exact.items()}
    told = f"{family.told} {disc.largest}"
    recover = claim_of(
        family.about,
        "recover",
        f"Of {told}, the share share_proven of the area returns to levitation with at most so many impacts, among them every {family.smaller}.",
        1 if proven else 0,
        reason=f"no cell of {family.about} could be proven to return",
        enclosures=numbers,
        limited=False,
    )
    whole = claim_of(
        family.about,
        "all recover",
        f"All {told}, return to levitation with at most {most} impacts.",
        -1 if refuted else 0 if left else 1,
        reason=reasons_of(known, "area"),
        limited=False,
    )
    return [recover, whole, *([_refutation(family, told, refuted)] if refuted else [])]


def _refutation(family: Family, told: str, refuted: Fraction) -> Claim:
    """Claim about those that are shown not to return."""
    return claim_of(
        family.about,
        "do not recover",
        f"Of {told}, the share share_refuted of the area never returns to levitation: after bounces the rotor stays on the wall and decays to the "
        "synchronous rub of the larger normal force.",
        1,
        enclosures={"share_refuted": enclosure_of_fraction(refuted)},
        limited=False,
    )
