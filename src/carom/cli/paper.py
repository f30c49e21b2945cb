"""``carom paper``: the figures and numbers of the source paper."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from carom.cli.terminal import AsJson, console, print_document, progress

if TYPE_CHECKING:
    from pathlib import Path

    from rich.table import Table

    from carom.reproductions.mora2014 import Reproduction

__all__ = ["paper"]


def paper(
    out: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="Write figures 2 to 6, paper.json and table.md to this directory."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Reproduce the paper carom builds on: its figures and numbers.

    Mora, Budd, Glendinning and Keogh, Proc. R. Soc. A 470, 20130490 (2014). Every number it prints is compared with
    ours, and each of its propositions is tested. Misprinted formulas are evaluated beside the correct ones. Figure 6b
    also shows the curves of grazing and period doubling, and the regions divided by a stable rub.
    """
    with progress("loading") as tell:
        if out is not None:
            from carom.report import check_directory

            check_directory(out, "--out")
        from carom.reproductions.mora2014 import figures, paper_document, reproduce, write_paper

        share_of_results = 1.0 if out is None else 0.3
        found = reproduce(lambda share, words: tell(share_of_results * share, words))
        written: list[Path] = []
        if out is not None:
            written = write_paper(found, out, lambda share, words: tell(0.3 + 0.7 * share, words))
    if as_json:
        print_document(paper_document(found, figures(found) if written else ()))
    else:
        _print_reproduction(found)
    if written:
        shown = ", ".join(path.name for path in written)
        console(errors=as_json).print(f"Written to {out}: {shown}", soft_wrap=True)


def _print_reproduction(found: Reproduction) -> None:
    screen = console()
    screen.print(_numbers(found))
    given = [row for row in found.numbers if row.kind == "given"]
    screen.print(
        "Used as given: "
        + ", ".join(f"{row.quantity} = {row.printed}{' ' * bool(row.unit)}{row.unit}" for row in given)
    )
    screen.print()
    screen.print(_misprints(found))
    screen.print(_claims(found))
    screen.print(_regions(found))


def _table(title: str) -> Table:
    from rich import box
    from rich.table import Table

    return Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)


def _numbers(found: Reproduction) -> Table:
    table = _table("Numbers printed in the source and computed here")
    for heading in ("where", "quantity", "printed", "computed", "difference", "note"):
        table.add_column(heading, justify="right" if heading in ("printed", "computed", "difference") else "left")
    for row in found.numbers:
        if row.kind != "given":
            table.add_row(
                row.place,
                row.quantity,
                row.printed,
                f"{row.value:.10g}",
                f"{row.difference:.1e}" if row.difference else "0",
                row.note,
                style="" if row.agrees else "yellow",
            )
    return table


def _misprints(found: Reproduction) -> Table:
    table = _table("Misprints of the source, evaluated")
    for heading in ("where", "printed", "right", "evaluated"):
        table.add_column(heading)
    for heading in ("printed form", "right form"):
        table.add_column(heading, justify="right")
    for row in found.misprints:
        wrong = "" if row.printed_value is None else f"{row.printed_value:.6g}"
        table.add_row(row.place, row.printed, row.right, row.quantity, wrong, f"{row.value:.6g}")
    return table


def _claims(found: Reproduction) -> Table:
    table = _table("Statements of the source")
    for heading in ("where", "statement", "holds", "found"):
        table.add_column(heading)
    for claim in found.claims:
        style = "" if claim.holds else "yellow"
        table.add_row(claim.place, claim.statement, "yes" if claim.holds else "no", claim.found, style=style)
    return table


def _regions(found: Reproduction) -> Table:
    table = _table("Regions of figure 6b, with the rub that the source leaves out")
    for heading in ("part", "for example at γ, ω", "simple motions", ""):
        table.add_column(heading)
    for region in found.plane.regions:
        place = ", ".join(f"{value:g}" for value in region.point)
        table.add_row(region.part, place, region.motions.words, region.words)
    return table
