"""Write the figures, ``paper.json`` and ``table.md`` to a directory, all of them or none."""

from __future__ import annotations

from pathlib import Path

from carom.base.files import FIGURES, staged_directory, write_json
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.reproductions.mora2014.document import markdown, paper_document
from carom.reproductions.mora2014.pictures import figures
from carom.reproductions.mora2014.reproduction import Reproduction


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
