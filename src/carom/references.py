"""The literature that methods rest on, as text and as BibTeX."""

from __future__ import annotations

from dataclasses import dataclass, fields
from html import escape
from urllib.parse import quote


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

    def _repr_html_(self) -> str:
        """For notebooks: the references with their links, and the BibTeX entries folded away."""
        entries = "".join(f"<li>{_linked(reference)}</li>" for reference in self.references)
        bibtex = f"<details><summary>BibTeX</summary><pre>{escape(self.bibtex)}</pre></details>"
        return f"<ol>{entries}</ol>{bibtex}"


def _linked(reference: Reference) -> str:
    """The line of a reference as HTML, with its DOI as a link."""
    before, found, after = escape(reference.text).partition(f"doi:{escape(reference.doi)}")
    if not reference.doi:
        return escape(reference.text)
    return f'{before}<a href="https://doi.org/{quote(reference.doi)}">{found}</a>{after}'


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


_ALL = (
    Reference(
        key="mora2014",
        kind="article",
        author="Mora, Karin and Budd, Chris and Glendinning, Paul and Keogh, Patrick",
        title="Non-smooth {Hopf}-type bifurcations arising from impact-friction contact events in rotating machinery",
        journal="Proceedings of the Royal Society A",
        volume="470",
        pages="20130490",
        year="2014",
        doi="10.1098/rspa.2013.0490",
    ),
    Reference(
        key="api617",
        kind="techreport",
        author="{American Petroleum Institute}",
        title="{API} Standard 617: Axial and centrifugal compressors and expander-compressors",
    ),
    Reference(
        key="benettin1980",
        kind="article",
        author="Benettin, Giancarlo and Galgani, Luigi and Giorgilli, Antonio and Strelcyn, Jean-Marie",
        title=(
            "{Lyapunov} characteristic exponents for smooth dynamical systems and for {Hamiltonian} systems; a method for "
            "computing all of them"
        ),
        journal="Meccanica",
        volume="15",
        pages="9--30",
        year="1980",
        doi="10.1007/BF02128236",
    ),
    Reference(
        key="brent1980",
        kind="article",
        author="Brent, Richard P.",
        title="An improved {Monte Carlo} factorization algorithm",
        journal="BIT Numerical Mathematics",
        volume="20",
        number="2",
        pages="176--184",
        year="1980",
        doi="10.1007/BF01933190",
    ),
    Reference(
        key="clopper1934",
        kind="article",
        author="Clopper, C. J. and Pearson, E. S.",
        title="The use of confidence or fiducial limits illustrated in the case of the binomial",
        journal="Biometrika",
        volume="26",
        number="4",
        pages="404--413",
        year="1934",
        doi="10.1093/biomet/26.4.404",
    ),
    Reference(
        key="das2017",
        kind="article",
        author="Das, Suddhasattwa and Saiki, Yoshitaka and Sander, Evelyn and Yorke, James A.",
        title="Quantitative quasiperiodicity",
        journal="Nonlinearity",
        volume="30",
        pages="4111--4140",
        year="2017",
        doi="10.1088/1361-6544/aa84c2",
    ),
    Reference(
        key="daza2016",
        kind="article",
        author="Daza, Alvar and Wagemakers, Alexandre and Georgeot, Bertrand and Guéry-Odelin, David and Sanjuán, Miguel A. F.",
        title="Basin entropy: a new tool to analyze uncertainty in dynamical systems",
        journal="Scientific Reports",
        volume="6",
        pages="31416",
        year="2016",
        doi="10.1038/srep31416",
    ),
    Reference(
        key="iso14839",
        kind="techreport",
        author="{International Organization for Standardization}",
        title=(
            "{ISO} 14839-2:2004, Mechanical vibration – Vibration of rotating machinery equipped with active magnetic "
            "bearings – Part 2: Evaluation of vibration"
        ),
        year="2004",
    ),
    Reference(
        key="johansson2017",
        kind="article",
        author="Johansson, Fredrik",
        title="{Arb}: efficient arbitrary-precision midpoint-radius interval arithmetic",
        journal="IEEE Transactions on Computers",
        volume="66",
        number="8",
        pages="1281--1292",
        year="2017",
        doi="10.1109/TC.2017.2690633",
    ),
    Reference(
        key="keller1977",
        kind="incollection",
        author="Keller, Herbert B.",
        title="Numerical solution of bifurcation and nonlinear eigenvalue problems",
        booktitle="Applications of Bifurcation Theory",
        publisher="Academic Press",
        year="1977",
    ),
    Reference(
        key="krawczyk1969",
        kind="article",
        author="Krawczyk, R.",
        title="{Newton-Algorithmen} zur {Bestimmung} von {Nullstellen} mit {Fehlerschranken}",
        journal="Computing",
        volume="4",
        pages="187--201",
        year="1969",
        doi="10.1007/BF02234767",
    ),
    Reference(
        key="lenci2003",
        kind="article",
        author="Lenci, Stefano and Rega, Giuseppe",
        title="Optimal control of nonregular dynamics in a {Duffing} oscillator",
        journal="Nonlinear Dynamics",
        volume="33",
        pages="71--86",
        year="2003",
    ),
    Reference(
        key="mueller1995",
        kind="article",
        author="Müller, Peter C.",
        title="Calculation of {Lyapunov} exponents for dynamic systems with discontinuities",
        journal="Chaos, Solitons \\& Fractals",
        volume="5",
        pages="1671--1681",
        year="1995",
    ),
    Reference(
        key="squire1998",
        kind="article",
        author="Squire, William and Trapp, George",
        title="Using complex variables to estimate derivatives of real functions",
        journal="SIAM Review",
        volume="40",
        number="1",
        pages="110--112",
        year="1998",
        doi="10.1137/S003614459631241X",
    ),
    Reference(
        key="thompson1989",
        kind="article",
        author="Thompson, J. M. T.",
        title="Chaotic phenomena triggering the escape from a potential well",
        journal="Proceedings of the Royal Society A",
        volume="421",
        pages="195--225",
        year="1989",
    ),
)

REFERENCES = {reference.key: reference for reference in _ALL}
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
