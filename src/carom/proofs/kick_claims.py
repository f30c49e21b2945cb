"""Claims about disturbances out of levitation, of one machine or of all machines of a box, from cells of which it is known what is proven."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import partial
from itertools import groupby

from carom.core.processors import available_cores
from carom.proofs.balls import Enclosure, enclosure_of_fraction, enclosures_of
from carom.proofs.claims import Claim, Evidence, NotShownError, claim_of
from carom.proofs.families import DisturbanceFamily, at_most
from carom.proofs.kick_cells import IMPACTS, MOST_PARAMETERS, OPEN, REFUTED, Cell, Tree, leaves, read, share_of
from carom.proofs.kick_discs import KickDisc
from carom.proofs.kick_search import BITS, show_all
from carom.proofs.lines import in_brackets, written
from carom.proofs.rotor import ProvenRotor

BOX_THEOREM = "kicks of a box of machines"
NOT_CLAIMED = (
    "whether the open cases return (the search states why they are open)",
    "that as many impacts occur as stated: these are upper bounds",
    "anything about larger sizes, starts other than levitation, or compliant walls",
)
BOX_NOT_CLAIMED = (
    *NOT_CLAIMED,
    "anything about machines with parameters outside the intervals, or with parameters that vary during the motion",
)
_STRETCHES = 16
"""Stretches of the interval of a parameter on each of which a speed is stated."""


def options_of(family: DisturbanceFamily) -> tuple[str, str]:
    """Names of the options of the theorem about a family."""
    return family.option, "most_impacts"


def _disc_from(family: DisturbanceFamily, rotor: ProvenRotor, options: Mapping[str, object]) -> KickDisc:
    """The disc that options of a theorem describe, and with an option ``box`` the box."""
    largest, most = (options[name] for name in options_of(family))
    if not isinstance(largest, str) or type(most) is not int or not 0 <= most < len(IMPACTS):
        raise NotShownError("the certificate has no largest size, or no number of impacts")
    box = options.get("box", [])
    if not isinstance(box, list) or not ("box" in options) <= len(box) <= MOST_PARAMETERS:
        raise NotShownError("the certificate has no box of machines")
    if not all(isinstance(entry, list) and [type(text) for text in entry] == [str] * 3 for entry in box):
        raise NotShownError("the certificate has no box of machines")
    return KickDisc(family, rotor.hypotheses, largest, most, tuple(tuple(entry) for entry in box))


def kick_claims(
    family: DisturbanceFamily, rotor: ProvenRotor, evidence: Evidence, options: Mapping[str, object]
) -> list[Claim]:
    """Claims of a certificate, all of whose proven cells are shown again; nothing is searched."""
    if rotor.bits != BITS:
        raise NotShownError(f"cells are shown with {BITS} bits")
    disc = _disc_from(family, rotor, options)
    tree = read(evidence.take("cells", _nothing_found), len(disc.along))
    show_all(disc, tree, available_cores(), evidence.tell)
    return claims_of(disc, tree)


def _nothing_found() -> str:
    """Stand for a search where cells are only read."""
    raise NotShownError("cells are found by a search of their own")


def _reasons_of(known: Iterable[tuple[Cell, str]], of: str) -> str:
    """How much of all cells does not return, and how much is open, and why; nothing where all returns."""
    parts: dict[str, Fraction] = {}
    for cell, letter in known:
        parts[letter] = parts.get(letter, Fraction(0)) + cell.share
    shown = [
        (letter, f"{100 * float(part):.3g} % of the {of}")
        for letter, part in sorted(parts.items(), key=lambda entry: -entry[1])
    ]
    refuted = [f"{share} does not return" for letter, share in shown if letter == REFUTED]
    return "; ".join([*refuted, *(f"{share}: {OPEN[letter]}" for letter, share in shown if letter in OPEN)])


def claims_of(disc: KickDisc, tree: Tree) -> list[Claim]:
    """Claims about a disc, and a box of machines if it has one, whose cells are known."""
    known = list(leaves(tree))
    proven = [(cell, IMPACTS.index(letter)) for cell, letter in known if letter in IMPACTS]
    rest = [cell for cell, letter in known if letter not in IMPACTS]
    refuted = share_of(cell for cell, letter in known if letter == REFUTED)
    most = max((impacts for _, impacts in proven), default=0)
    family, shown = disc.family, f"{disc.family.stated} {disc.largest}"
    of_all, where, area, always = f"All {shown}", f"Of {shown}", " of the area", " "
    if disc.along:
        of_all, area, always = f"For all {disc.box.words}, all {shown}", "", ", for all these values, "
        where += f", and of the values {disc.box.words}, area of the disc times widths of the intervals"
    numbers = _sizes(disc, min((cell.speeds[0] for cell in rest), default=Fraction(1)))
    shares = {"share_proven": share_of(cell for cell, _ in proven), "share_refuted": refuted}
    shares |= {"share_open": share_of(rest) - refuted, "impacts": Fraction(most)}
    exact = {name: enclosure_of_fraction(number) for name, number in shares.items()}
    claim = partial(claim_of, family.about, limited=False)
    claims = [
        claim(
            "recover",
            f"{where}, the share share_proven{area} returns to levitation with at most so many impacts, among them{always}every {family.smaller}.",
            1 if proven else 0,
            reason=f"no cell of {family.about} could be proven to return",
            enclosures=numbers | exact,
        ),
        claim(
            "all recover",
            f"{of_all}, return to levitation with {at_most(most)}.",
            -1 if refuted else 0 if rest else 1,
            reason=_reasons_of(known, "area times widths" if disc.along else "area"),
        ),
    ]
    if refuted:
        claims.append(
            claim(
                "do not recover",
                f"{where}, the share share_refuted{area} never returns to levitation: after bounces the rotor stays on the wall and decays to the "
                "synchronous rub of the larger normal force.",
                1,
                enclosures={"share_refuted": exact["share_refuted"]},
            )
        )
    return claims + (_stretch_claims(disc, proven, rest) if rest and len(disc.along) == 1 else [])


def _stretch_claims(disc: KickDisc, proven: list[tuple[Cell, int]], rest: list[Cell]) -> list[Claim]:
    """On stretches of a parameter the speed below which all kicks return."""
    line = disc.box.lines[0]
    start, stop = line.ends
    ends = [Fraction(j, _STRETCHES) for j in range(_STRETCHES + 1)]
    # What shares no more than an end with a stretch does not count: the stretch's own cells prove its end.
    speeds = [
        min((cell.speeds[0] for cell in rest if _meets(cell, *ends[j : j + 2])), default=Fraction(1))
        for j in range(_STRETCHES)
    ]
    claims = []
    for speed, group in groupby(range(_STRETCHES), key=speeds.__getitem__):
        numbers = list(group)
        low, high = ends[numbers[0]], ends[numbers[-1] + 1]
        if not speed:
            continue
        most = max(impacts for cell, impacts in proven if _meets(cell, low, high) and cell.speeds[0] < speed)
        inner = written(*(start + (stop - start) * share for share in (low, high)), inward=True)
        where = f"{line.name} in {in_brackets(inner)} {line.field.unit}".rstrip()
        claims.append(
            claim_of(
                f"kicks, {where}",
                "recover",
                f"For all {where}: every kick out of levitation, seen in the fixed frame, slower than the lower end of speed returns to levitation "
                f"with {at_most(most)}.",
                1,
                enclosures=_sizes(disc, speed),
                limited=False,
            )
        )
    return claims


def _meets(cell: Cell, low: Fraction, high: Fraction) -> bool:
    """Whether the interval of a cell has more than an end in common with another."""
    ((start, stop),) = cell.ends
    return start < high and low < stop


def _sizes(disc: KickDisc, share: Fraction) -> dict[str, Enclosure]:
    """A share of the largest size: in the SI unit for machines, dimensionless where its unit is the same for all of them."""
    name = disc.family.size
    found = enclosures_of(**{name: disc.size(share)}) if disc.shares_unit else {}
    if disc.physical and not disc.exact[1]:
        found[f"{name}_si"] = enclosure_of_fraction(disc.exact[0] * share)
    return found
