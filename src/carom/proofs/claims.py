"""Claims, proofs and their evidence: what is proven, refuted or undecided, from which hypotheses.

Evidence is what a search has found, written down so that a check need not search.
"""

from __future__ import annotations

import json
import math
import os
import re
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from textwrap import wrap
from typing import Any, ClassVar, Literal, TypeVar, get_args

from carom.base.arguments import checked
from carom.base.files import write_whole
from carom.base.outcome import CaromError
from carom.base.progress import Reporter
from carom.base.results import WIDEST, Members
from carom.parameters.terms import set_by
from carom.proofs.balls import Enclosure

Document = Mapping[str, Any]
"""Plain data, as in JSON: what is under a name depends on it."""
_Found = TypeVar("_Found")
_RATIONAL = re.compile(r"-?[0-9]{1,2000}(?:/[0-9]{1,2000})?")


class NotShownError(CaromError):
    """The evidence does not show what it should: a certificate that was changed, or is not complete."""


class Evidence:
    """Plain data by name: found by searches and recorded, or recorded before and only read.

    A theorem asks for what it needs with :meth:`take` and then verifies it, whether it was just found or read.  So a check
    runs the same inequalities and none of the searches.

    Parameters
    ----------
    recorded : mapping, optional
        What an earlier proof has recorded; without it searches are made.
    tell : Reporter, optional
        Receives the progress of those who search.
    seconds : float
        After which searches that can end early do.
    """

    def __init__(
        self, recorded: Document | None = None, tell: Reporter | None = None, seconds: float = math.inf
    ) -> None:
        self.tell = tell or Reporter(step="proving")
        self._end = time.monotonic() + seconds
        self._recorded = None if recorded is None else dict(recorded)
        self._used: dict[str, object] = {}

    @property
    def is_late(self) -> bool:
        """Whether searches that can end early should."""
        return time.monotonic() > self._end

    def take(self, name: str, search: Callable[[], _Found]) -> _Found:
        """What is known under a name: strings, numbers, ``None``, and lists of such.

        Raises :class:`NotShownError` if evidence is read and nothing is recorded under this name.
        """
        if self._recorded is None:
            found = search()
        elif name in self._recorded:
            found = self._recorded[name]
        else:
            raise NotShownError(f"the certificate lacks its evidence: {name}")
        self._used[name] = found
        return found

    def document(self) -> dict[str, object]:
        """All that was taken, as plain data for JSON."""
        return dict(self._used)


def rational_of(text: object) -> Fraction:
    """Rational number of evidence, such as ``"3/4"``; :class:`NotShownError` for anything else."""
    if not (isinstance(text, str) and _RATIONAL.fullmatch(text)) or text.endswith("/0"):
        raise NotShownError("the certificate has a number that is no fraction of whole numbers")
    return Fraction(text)


FORMAT = "carom proof 1"
Status = Literal["proven", "refuted", "undecided"]
_MOST_NAMED = 10
"""Undecided claims that the short text form names."""


@dataclass(frozen=True)
class Claim:
    """One statement about every machine that fulfils the hypotheses.

    Attributes
    ----------
    about : str
        The motion, such as ``"B1,d"``, or the subject.
    kind : str
        What is stated of it in one or two words, such as ``"stable"``.
    statement : str
        The statement in full.
    status : {"proven", "refuted", "undecided"}
        Refuted: the contrary is proven.
    reason : str
        Why it is undecided, or what refutes it.
    enclosures : mapping of str to Enclosure
        Numbers that belong to it.
    interval : tuple of str
        Ends of the interval of a parameter on which it holds; empty for a claim about one machine.
    motions : tuple of str
        Orbits of the interval that are motions of the machine.
    limited_by_precision : bool
        Whether it is undecided only because of the number of bits computed with.
    """

    about: str
    kind: str
    statement: str
    status: Status
    reason: str = ""
    enclosures: Mapping[str, Enclosure] = field(default_factory=dict)
    interval: tuple[str, ...] = ()
    motions: tuple[str, ...] = ()
    limited_by_precision: bool = False

    @property
    def name(self) -> str:
        """The subject and what is stated: ``"B1,d stable"``."""
        return f"{self.about} {self.kind}"

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        ends = {name: [entry.low, entry.high] for name, entry in self.enclosures.items()}
        words = {"about": self.about, "kind": self.kind, "statement": self.statement, "status": self.status}
        where = {"interval": list(self.interval), "motions": list(self.motions)} if self.interval else {}
        return {**words, "reason": self.reason, "enclosures": ends, **where}


def claim_of(
    about: str,
    kind: str,
    statement: str,
    sign: int,
    *,
    reason: str = "",
    enclosures: Mapping[str, Enclosure] | None = None,
    limited: bool = True,
) -> Claim:
    """Claim that is proven, refuted or undecided where a sign is 1, −1 or 0.

    The reason is kept unless the claim is proven.  ``limited`` says whether more bits may decide an undecided claim.
    """
    status: Status = "proven" if sign > 0 else "refuted" if sign < 0 else "undecided"
    shown = "" if sign > 0 else reason
    return Claim(about, kind, statement, status, shown, enclosures or {}, limited_by_precision=limited and sign == 0)


@dataclass(frozen=True, eq=False, repr=False)
class Proof(Members[Claim]):
    """Claims about a machine with the evidence that decides them.

    Look a claim up by index or by name, ``proof["B1,d stable"]``.

    Attributes
    ----------
    theorem : str
        Which claims were looked at, such as ``"single-impact orbits"``.
    hypotheses : Hypotheses or StatedEquations
    options : mapping
        Limits of the theorem.
    claims : tuple of Claim
    bits : int
        Precision of the ball arithmetic.
    not_claimed : tuple of str
        What a reader may expect and is not claimed.
    evidence : mapping
        Plain data from which :func:`~carom.proofs.check` decides the claims again without any search.
    """

    called: ClassVar[str] = "claim"

    theorem: str
    # Not narrower: who reads the numbers of a planar rotor knows by the theorem that they are there.
    hypotheses: Any
    options: Document
    claims: tuple[Claim, ...]
    bits: int
    not_claimed: tuple[str, ...]
    evidence: Document

    @property
    def members(self) -> tuple[Claim, ...]:  # type: ignore[override]  # a field would be in the certificate twice
        """The claims."""
        return self.claims

    @checked
    def with_status(self, status: Status) -> tuple[Claim, ...]:
        """Claims of one status."""
        return tuple(claim for claim in self.claims if claim.status == status)

    @property
    def assumed(self) -> dict[str, str]:
        """Each number that is assumed as it was given; of parameters along which something is proven, their intervals."""
        along, box = self.options.get("along"), self.options.get("box", ())
        entries = [(along, self.options["from"], self.options["to"])] if along is not None else box
        # Their own values in the machine file are not assumed, nor what they stand for.
        moved = {name: f"{start} to {stop}" for name, start, stop in entries}
        given = {**self.hypotheses.values, **self.hypotheses.settings, **self.hypotheses.helpers}
        return {name: text for name, text in given.items() if name not in map(set_by, moved)} | moved

    def rows(self) -> list[tuple[str, str]]:
        """Each claim with its status, and the reason where it is not proven."""
        shown = [(claim.name, ": ".join(filter(None, (claim.status, claim.reason)))) for claim in self.claims]
        return [*shown, ("precision", f"{self.bits} bits")]

    def brief_rows(self) -> list[tuple[str, str]]:
        """The theorem, the machine, how many claims have each status, and which are undecided."""
        counts = [(status, len(self.with_status(status))) for status in get_args(Status)]
        first, *more = wrap(", ".join(f"{name} {text}" for name, text in self.assumed.items()), WIDEST)
        open_ = [claim.name for claim in self.with_status("undecided")]
        rest = len(open_) - _MOST_NAMED
        return [
            ("theorem", self.theorem),
            ("machine", first),
            *(("", words) for words in more),
            ("claims", ", ".join(f"{count} {status}" for status, count in counts)),
            *(("undecided", name) for name in open_[:_MOST_NAMED]),
            *([("", f"and {rest} more; rows() has all")] if rest > 0 else []),
        ]

    def document(self) -> dict[str, object]:
        """The certificate: plain data for JSON, which :func:`~carom.proofs.check` verifies."""
        return {
            "format": FORMAT,
            "theorem": self.theorem,
            "options": dict(self.options),
            "hypotheses": self.hypotheses.document(),
            "bits": self.bits,
            "claims": [claim.document() for claim in self.claims],
            "not_claimed": list(self.not_claimed),
            "evidence": dict(self.evidence),
        }

    @checked
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the certificate to a file."""
        write_whole(Path(path), json.dumps(self.document(), indent=1, ensure_ascii=False).encode())
