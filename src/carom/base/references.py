"""The literature that methods rest on, as text and as BibTeX."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from pathlib import Path


@dataclass(frozen=True)
class Reference:
    """A publication.

    Attributes
    ----------
    key : str
        Its key in BibTeX files.
    kind : str
        Kind of the BibTeX entry.
    author : str
        Names as in BibTeX, ``"Family, Given and Family, Given"``.
    title : str
    year, journal, booktitle, volume, number, pages, publisher, doi : str
        Empty where there is none.
    """

    key: str
    kind: str
    author: str
    title: str
    year: str = ""
    journal: str = ""
    booktitle: str = ""
    volume: str = ""
    number: str = ""
    pages: str = ""
    publisher: str = ""
    doi: str = ""

    @property
    def text(self) -> str:
        """The reference on one line."""
        author, title = (text.replace("{", "").replace("}", "") for text in (self.author, self.title))
        names = [" ".join(reversed(name.split(", "))) for name in author.split(" and ")]
        home = " ".join(filter(None, (self.journal.replace("\\&", "&") or self.booktitle, self.volume)))
        where = ", ".join(filter(None, (home, self.pages.replace("--", "–"), self.publisher)))
        link = f", doi:{self.doi}" if self.doi else ""
        when = f"({self.year})" if self.year else ""
        return ", ".join(filter(None, (_listed(names), f"“{title}”", f"{where} {when}".strip()))) + f"{link}."

    @property
    def bibtex(self) -> str:
        """The reference as a BibTeX entry."""
        shown = [one.name for one in fields(self) if one.name not in ("key", "kind") and getattr(self, one.name)]
        rows = [f"  {name} = {{{getattr(self, name)}}}," for name in shown]
        return "\n".join([f"@{self.kind}{{{self.key},", *rows, "}"])


@dataclass(frozen=True, repr=False)
class Citations:
    """What to cite for a result: ``text`` for people, ``bibtex`` for a file.

    Attributes
    ----------
    references : tuple of Reference
        carom first.
    """

    references: tuple[Reference, ...]

    @property
    def text(self) -> str:
        """One line for each reference."""
        return "\n".join(reference.text for reference in self.references)

    @property
    def bibtex(self) -> str:
        """All entries, ready for a ``.bib`` file."""
        return "\n\n".join(reference.bibtex for reference in self.references)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _read(text: str) -> dict[str, Reference]:
    """References by their keys, from BibTeX entries with one field a line."""
    entries = re.findall(r"^@(\w+)\{(\w+),\n(.*?)^\}", text, re.DOTALL | re.MULTILINE)
    return {
        key: Reference(key, kind, **dict(re.findall(r"^  (\w+) = \{(.*)\},$", rows, re.MULTILINE)))
        for kind, key, rows in entries
    }


REFERENCES = _read(Path(__file__).with_name("references.bib").read_text(encoding="utf-8"))
"""All publications by their keys."""


def carom_itself() -> Reference:
    """Reference to this version of carom."""
    from importlib.metadata import version

    return Reference(
        key="carom",
        kind="software",
        author="{The carom developers}",
        title=f"carom {version('carom')}: does a rotor that touches its touchdown bearing come back?",
        year="2026",
    )
