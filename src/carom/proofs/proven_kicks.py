"""What a proof of kicks shows of their disc, for figures and studies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isclose
from typing import ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.closed_forms import contact_free_kick
from carom.models import Rotor, Subject, exact_rotor_of, jeffcott
from carom.parameters.formats import number, rounded_down, shown_in
from carom.proofs.claims import Proof
from carom.proofs.families import KICKS, at_most
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.kick_cells import BY_ANGLE, BY_SPEED, DISC, IMPACTS, OPEN, REFUTED, Cell, Tree, leaves, read, share_of
from carom.proofs.kick_discs import KickDisc
from carom.proofs.seeds import doubles_of

_ROUNDING = 1e-12
"""Relative difference of numbers of the same machine, once exact and once in doubles."""
BEYOND = -1
"""Place of the part of a kick that is not in the disc."""


@dataclass(frozen=True)
class KickPart:
    """All cells of a disc of kicks of which the same is known.

    Attributes
    ----------
    letter : str
        Of these cells in the certificate.
    impacts : int or None
        Every kick is proven to return with at most so many; ``None`` where this is not so.
    reason : str
        Why they are open; empty where something is proven.
    share : float
        Share of the area of the disc.
    """

    letter: str
    impacts: int | None
    reason: str
    share: float

    @property
    def proven(self) -> bool:
        """Whether every kick is proven to return."""
        return self.impacts is not None

    @property
    def refuted(self) -> bool:
        """Whether every kick is proven to end in the stable rub."""
        return self.letter == REFUTED

    @property
    def open(self) -> bool:
        """Whether nothing is proven."""
        return not (self.proven or self.refuted)


@dataclass(frozen=True, eq=False, repr=False)
class ProvenKicks(Result):
    """What is proven of a disc of kicks out of levitation, in doubles next to the proof.

    Attributes
    ----------
    rotor : Rotor
    largest : float
        Radius of the disc, in ``c_r Ω``, fixed frame.
    all_up_to : float
        Every slower kick is proven to return by its cells.
    share, refuted_share, open_share : float
        Shares of the area of the disc that are proven to return, proven to end in the stable rub, and open.
    parts : tuple of KickPart
        The proven ones by their impacts, those that end in the rub, then the open ones, the largest first.
    proof : Proof

    Examples
    --------
    >>> from carom.proofs import ProvenKicks, prove_kicks
    >>> kicks = ProvenKicks.of(prove_kicks("examples/spindle.toml", "111 mm/s"))
    >>> kicks.whole, kicks.impacts
    (True, 1)
    """

    figure: ClassVar[str] = "proven_kicks"
    shown: ClassVar[tuple[str, ...]] = (
        "rotor",
        "largest",
        "all_up_to",
        "impacts",
        "share",
        "refuted_share",
        "open_share",
    )

    rotor: Rotor
    largest: float
    all_up_to: float
    share: float
    refuted_share: float
    open_share: float
    parts: tuple[KickPart, ...]
    proof: Proof

    @classmethod
    @checked
    def of(cls, proof: Proof, machine: Subject | None = None) -> ProvenKicks:
        """What a proof shows.

        Parameters
        ----------
        proof : Proof
        machine : Machine, Case, Parameters or model, optional
            The machine, in the units of which it is stated; by default that of the hypotheses.

        Raises
        ------
        InputError
            It is none of kicks, or of another machine.
        """
        if proof.theorem != KICKS.about:
            raise InputError("proof", proof.theorem, "a proof of kicks, as prove_kicks makes it")
        if machine is None:
            rotor = jeffcott(doubles_of(proof.hypotheses))
        else:
            rotor = exact_rotor_of(machine)
            _check_machine(proof.hypotheses, rotor)
        numbers = proof["kicks recover"].enclosures
        disc = KickDisc(KICKS, proof.hypotheses, proof.options["kicks_up_to"], proof.options["most_impacts"])
        return cls(
            rotor=rotor,
            largest=float(disc.size(DISC.speeds[1]).mid()),
            all_up_to=float(numbers["speed"].low),
            share=numbers["share_proven"].value,
            refuted_share=numbers["share_refuted"].value,
            open_share=numbers["share_open"].value,
            parts=_parts(read(proof.evidence["cells"])),
            proof=proof,
        )

    @property
    def whole(self) -> bool:
        """Whether every kick of the disc is proven to return."""
        return all(part.proven for part in self.parts)

    @property
    def impacts(self) -> int:
        """What is proven to return does so with at most so many impacts."""
        return max((part.impacts for part in self.parts if part.impacts is not None), default=0)

    @cached_property
    def contact_free(self) -> float:
        """Speed below which no kick touches (:func:`~carom.closed_forms.contact_free_kick`)."""
        return contact_free_kick(self.rotor)

    @property
    def sure_up_to(self) -> float:
        """Speed up to which every kick is proven to return, by its cells or because it never touches."""
        return max(self.all_up_to, self.contact_free)

    @property
    def shown_up_to(self) -> str:
        """The same in the unit that people see, rounded down."""
        factor, unit = shown_in("velocity", self.rotor.scales)
        return f"{number(rounded_down(factor * self.sure_up_to))} {unit}"

    @property
    def words(self) -> str:
        """What is proven, with numbers that say no more than that."""
        factor, unit = shown_in("velocity", self.rotor.scales)
        disc = f"{number(factor * self.largest)} {unit}"
        after = f"after {at_most(self.impacts)}" if self.impacts else "without an impact"
        if self.whole:
            return f"every kick up to {disc} comes back, {after}"
        lost = f"; {number(rounded_down(100.0 * self.refuted_share))} % end in the rub" if self.refuted_share else ""
        if not self.share:
            return f"every kick up to {self.shown_up_to} comes back; of those up to {disc} no more is proven{lost}"
        share = number(rounded_down(100.0 * self.share))
        return f"{share} % of the kicks up to {disc} come back, {after}, and every one up to {self.shown_up_to}{lost}"

    @cached_property
    def tree(self) -> Tree:
        """What is known of each cell (:mod:`carom.proofs.kick_cells`)."""
        return read(self.proof.evidence["cells"])

    @cached_property
    def edges(self) -> np.ndarray:
        """Edges of each cell (n, 4): slowest and fastest speed as shares of the largest, first and last angle as shares of a turn.

        Angles count from the direction in which the rotor levitates.
        """
        cells = [cell for cell, _ in leaves(self.tree)]
        return np.array([[float(end) for end in (*cell.speeds, *cell.angles)] for cell in cells])

    @cached_property
    def places(self) -> np.ndarray:
        """Place of each cell among ``parts`` (n,)."""
        place_of = self._place_of
        return np.array([place_of[letter] for _, letter in leaves(self.tree)])

    @checked
    def at(self, outward: np.ndarray, tangential: np.ndarray) -> np.ndarray:
        """Place among ``parts`` of kicks, given by both parts in ``c_r Ω`` as :class:`~carom.disturbances.KickPlane` has them.

        −1 for kicks beyond the disc.
        """
        shares = np.hypot(outward, tangential) / self.largest
        turns = np.arctan2(tangential, outward) / (2.0 * np.pi) % 1.0
        found = np.full(shares.shape, BEYOND).ravel()
        ahead = [(DISC, np.flatnonzero(shares <= 1.0))]
        while ahead:
            cell, here = ahead.pop()
            letter = self.tree[cell]
            if letter not in (BY_SPEED, BY_ANGLE):
                found[here] = self._place_of[letter]
            elif here.size:
                low, high = cell.halves(letter)
                middle = float((high.speeds if letter == BY_SPEED else high.angles)[0])
                above = (shares if letter == BY_SPEED else turns).ravel()[here] >= middle
                ahead += [(low, here[~above]), (high, here[above])]
        return found.reshape(shares.shape)

    @cached_property
    def _place_of(self) -> dict[str, int]:
        return {part.letter: place for place, part in enumerate(self.parts)}


def _parts(tree: Tree) -> tuple[KickPart, ...]:
    """What is known of cells: proven with so many impacts, that they end in the rub, then open for a reason, the largest first."""
    cells: dict[str, list[Cell]] = {}
    for cell, letter in leaves(tree):
        cells.setdefault(letter, []).append(cell)
    shares = {letter: float(share_of(alike)) for letter, alike in cells.items()}
    proven = [KickPart(letter, IMPACTS.index(letter), "", shares[letter]) for letter in IMPACTS if letter in shares]
    proven += [KickPart(REFUTED, None, "", shares[REFUTED])] if REFUTED in shares else []
    left = [KickPart(letter, None, OPEN[letter], shares[letter]) for letter in shares if letter in OPEN]
    return (*proven, *sorted(left, key=lambda part: -part.share))


def _check_machine(hypotheses: Hypotheses, rotor: Rotor) -> None:
    """Compare the numbers of the equations with those of a proof; :class:`~carom.base.outcome.InputError` if they are others."""
    values = rotor.parameters.as_dict()
    for name, proven in doubles_of(hypotheses).as_dict().items():
        if name != "phi" and not isclose(proven, values[name], rel_tol=_ROUNDING):
            words = f"of another machine: its {name} is {proven:.12g}"
            raise InputError("proof", words, f"a proof of this machine, with {name} = {values[name]:.12g}")
