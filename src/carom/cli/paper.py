"""``carom paper``: the figures and numbers of the source paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.cli.options import AS_JSON, option
from carom.cli.terminal import check_output, console, hand_over, progress

if TYPE_CHECKING:
    from carom.reproductions.mora2014 import Reproduction


OUT = option("DIR", "Write figures 2 to 6, paper.json and table.md to this directory.")


def paper(out: str | None = OUT, as_json: bool = AS_JSON) -> None:
    """Reproduce the paper carom builds on: its figures and numbers.

    Mora, Budd, Glendinning and Keogh, Proc. R. Soc. A 470, 20130490 (2014). Every number printed there is compared with the
    one computed here. Misprinted formulas are evaluated beside the corrected ones. Figure 6b also shows the curves of grazing
    and period doubling, and the regions divided by a stable rub.
    """
    with progress("loading") as tell:
        check_output(out)
        from carom.reproductions.mora2014 import figures, paper_document, reproduce, write_paper

        share_of_results = 1.0 if out is None else 0.3
        found = reproduce(progress=tell.part(0.0, share_of_results))
        files = ""
        if out is not None:
            written = write_paper(found, out, progress=tell.part(share_of_results, 1.0))
            files = f"Written to {out}: {', '.join(str(path.relative_to(out)) for path in written)}"

    def document() -> dict[str, object]:
        return paper_document(found, figures(found) if files else ())

    hand_over(document, as_json, lambda: _print_reproduction(found), out, files)


def _print_reproduction(found: Reproduction) -> None:
    from carom.cli.screen import print_table
    from carom.reproductions.mora2014.document import given_words, tables

    screen = console()
    for shown in tables(found):
        styles = ["" if agrees else "yellow" for agrees in shown.agrees]
        print_table(screen, shown.title, shown.headings, shown.rows, styles=styles)
    screen.print(given_words(found))
