"""Write the figures, ``paper.json`` and ``table.md`` to a directory, all of them or none."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from carom.reproductions.mora2014.document import markdown, paper_document
from carom.reproductions.mora2014.pictures import figures
from carom.reproductions.mora2014.reproduction import Reproduction

__all__ = ["write_paper"]


def write_paper(
    found: Reproduction, directory: str, progress: Callable[[float, str], None] | None = None
) -> list[Path]:
    """Draw the figures, and write them with the numbers.

    Parameters
    ----------
    found : Reproduction
    directory : str
        Target directory, created if it does not exist; files of the same name are replaced.
    progress : callable, optional
        Called with the share done, 0 to 1, and a description of the next step.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    InputError
        The directory cannot be written.
    """
    from carom.plots import save
    from carom.report.directory import filled_at_once
    from carom.studies import as_json

    tell = progress or (lambda share, words: None)
    pictures = figures(found)
    with filled_at_once(directory, "--out") as place:
        names = []
        for done, picture in enumerate(pictures):
            tell(done / len(pictures), f"drawing {picture.name.replace('-', ' ')}")
            names += [path.name for path in save(picture.draw(), place / picture.name)]
        (place / "paper.json").write_text(as_json(paper_document(found, pictures)) + "\n", encoding="utf-8")
        (place / "table.md").write_text(markdown(found), encoding="utf-8")
        tell(1.0, "writing")
    return [Path(directory) / name for name in (*names, "paper.json", "table.md")]
