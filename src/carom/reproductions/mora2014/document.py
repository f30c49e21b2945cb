"""The figures with captions, and the reproduction as plain data for JSON, and as tables of text, in Markdown too, written with the figures to a directory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from carom.base.files import FIGURES, staged_directory, write_json
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result, record
from carom.reproductions.mora2014.reproduction import Reproduction
from carom.reproductions.mora2014.source import CITATION, machine_at, printed_texts

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Picture(Result):
    """A figure to draw.

    Attributes
    ----------
    name : str
        File name without ending, ``"figure-2"`` to ``"figure-6"``.
    panels : str
        Letters of its panels.
    caption : str
    result : object
        The result drawn.
    draw : callable
        Returns the figure.
    """

    name: str
    panels: str
    caption: str
    result: object
    draw: Callable[[], Figure]


def figures(results: Reproduction) -> tuple[Picture, ...]:
    """List figures 2 to 6.  Nothing is drawn before :attr:`Picture.draw` is called."""
    pair, birth = results.pair, results.pair.hopf.gamma
    gammas = {
        "birth": birth,
        "fold": pair.special("fold", "d").value,
        "grazing": pair.special("grazing", "d").value,
        "doubling": pair.special("period-doubling", "d").value,
        "apart": pair.special("speed-fold", "c").value,
    }
    meeting = results.plane.meeting("fold", "boundary-equilibrium").value
    found = {name: f"{gamma:.6f}" for name, gamma in gammas.items()}
    found["meeting"] = f"{meeting[0]:.5f}, {meeting[1]:.5f}"
    # What is shown, and what is drawn: the same, or its parts.
    shown: dict[str, tuple[object, tuple[object, ...]]] = {
        "figure-2": (results.motions, (results.motions,)),
        "figure-3": (results.periods, (results.periods, birth)),
        "figure-4": (pair, (pair,)),
        "figure-5": (results.radii, (pair, results.radii)),
        "figure-6": ((pair, results.plane), (pair, results.plane)),
    }
    return tuple(
        Picture(**row, result=result, draw=partial(_drawn, row["name"], *parts))
        for row in printed_texts("figures", found)
        for result, parts in [shown[row["name"]]]
    )


def _drawn(name: str, *results: object) -> Figure:
    # Importing the drawing modules takes longer than computing.
    from carom.reproductions.mora2014 import drawing

    draw: Callable[..., Figure] = getattr(drawing, name.replace("-", "_"))
    return draw(*results)


@dataclass(frozen=True)
class TextTable:
    """A table of text."""

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    agrees: tuple[bool, ...]
    """For each row, whether the source agrees with what was computed."""


def paper_document(found: Reproduction, pictures: tuple[Picture, ...] = ()) -> dict[str, object]:
    """Return all numbers with the printed ones, the misprints, and the curves and regions of figure 6b.

    Parameters
    ----------
    pictures : tuple of Picture
        Figures that have been written.
    """
    value = ("printed_value", "value", "difference")
    return {
        "source": CITATION,
        "parameters": {name: value for name, value in machine_at(0.1).as_dict().items() if name != "gamma"},
        "numbers": [
            {"where": row.place, **record(row, f"quantity kind printed {' '.join(value)} unit agrees note")}
            for row in found.numbers
        ],
        "misprints": [
            {"where": row.place, **record(row, f"printed right quantity {' '.join(value)}")} for row in found.misprints
        ],
        "curves": [record(curve, "kind points admissible ends=stops") for curve in found.plane.curves],
        "codim2": [record(point, "kind value period") for curve in found.plane.curves for point in curve.codimension2],
        "regions": [
            {
                "name": region.source,
                "part": region.part,
                "point": list(region.point),
                "motions": region.motions.words,
                **record(region.motions, "contact_free orbits stable_orbits rub rolling"),
                "note": region.words,
            }
            for region in found.plane.regions
        ],
        "figures": [
            {"name": picture.name, "panels": list(picture.panels), "caption": picture.caption} for picture in pictures
        ],
    }


def tables(found: Reproduction) -> tuple[TextTable, ...]:
    """Return the numbers, the misprints and the regions as tables of text."""
    compared = [row for row in found.numbers if row.kind != "given"]
    return (
        TextTable(
            "Numbers printed in the source and computed here",
            ("where", "quantity", "printed", "computed", "difference", "note"),
            tuple(
                (row.place, row.quantity, row.shown, f"{row.value:.10g}", f"{row.difference:.2g}", row.note)
                for row in compared
            ),
            tuple(row.agrees for row in compared),
        ),
        TextTable(
            "Misprints of the source, evaluated",
            ("where", "printed", "right", "evaluated", "printed form", "right form"),
            tuple(
                (row.place, row.printed, row.right, row.quantity, _text(row.printed_value), _text(row.value))
                for row in found.misprints
            ),
            (True,) * len(found.misprints),
        ),
        TextTable(
            "Regions of figure 6b, with the rub that the source leaves out",
            ("part", "for example at γ, ω", "simple motions", ""),
            tuple(
                (region.part, "{:g}, {:g}".format(*region.point), region.motions.words, region.words)
                for region in found.plane.regions
            ),
            (True,) * len(found.plane.regions),
        ),
    )


def given_words(found: Reproduction) -> str:
    """Return the printed numbers that were used as they are, in a sentence."""
    given = (row for row in found.numbers if row.kind == "given")
    listed = (f"{row.quantity} = {row.shown} ({row.place})" for row in given)
    return f"Used as given: {', '.join(listed)}."


def markdown(found: Reproduction) -> str:
    """Return the tables and the numbers used as given in Markdown."""
    parts = ["# Printed and computed", f"Source: {CITATION}.", given_words(found)]
    for table in tables(found):
        cells = [[cell.replace("|", "\\|") for cell in row] for row in table.rows]
        lines = (table.headings, ["---"] * len(table.headings), *cells)
        parts += [f"## {table.title}", "\n".join(f"| {' | '.join(line)} |" for line in lines)]
    return "\n\n".join(parts) + "\n"


def _text(value: float | None) -> str:
    return "" if value is None else f"{value:.8g}"


@shows_progress
def write_paper(found: Reproduction, directory: str, *, progress: ShowProgress = None) -> list[Path]:
    """Draw the figures, and write them with the numbers; return the files written.

    Parameters
    ----------
    directory : str
        Target directory, created if it does not exist; files of the same name are replaced.

    Raises
    ------
    InputError
        The directory cannot be written.
    """
    from carom.plots import save

    tell = Reporter.of(progress, "drawing")
    pictures = figures(found)
    with staged_directory(directory, "--out") as place:
        names = []
        for done, picture in enumerate(pictures):
            tell(done / len(pictures), f"drawing {picture.name.replace('-', ' ')}")
            names += [f"{FIGURES}/{path.name}" for path in save(picture.draw(), place / FIGURES / picture.name)]
        write_json(place / "paper.json", paper_document(found, pictures))
        (place / "table.md").write_text(markdown(found), encoding="utf-8")
        tell(1.0, "writing")
    return [Path(directory) / name for name in (*names, "paper.json", "table.md")]
