"""An output directory that receives all its files or none."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from carom.base.files.whole import unfinished
from carom.base.outcome import InputError

FIGURES = "figures"
MANIFEST = "study.json"


def check_directory(path: str, option: str) -> Path:
    """Refuse early a path that is not, or cannot become, a writable directory; `option` is its name in errors.

    Permissions alone do not decide this (read-only and special file systems, quotas, names too long), so writing is
    tried and undone.
    """
    allowed = "must be a directory to write to, existing or new"
    if not path.strip() or "\0" in path:
        raise InputError(option, repr(path), allowed)
    directory = Path(path)
    if directory.is_file():
        raise InputError(option, path, f"{allowed}; this is a file")
    try:
        with _staging(directory) as made:
            if not directory.exists():
                made.rename(directory)
                directory.rmdir()
    except OSError as problem:
        raise InputError(option, path, f"{allowed}; it cannot be written ({problem.strerror})") from None
    return directory


@contextmanager
def staged_directory(path: str, option: str) -> Iterator[Path]:
    """Provide an empty staging directory; when the block ends, move its files to the target directory.

    Files of the same name are replaced, each atomically.  Figures of an earlier study that this one does not have are
    removed; all other files stay as they are.  If an error occurs before the move, nothing is changed.  The staging
    directory lies inside the target, or beside it if the target does not exist yet.
    """
    target = check_directory(path, option)
    try:
        with _staging(target) as made:
            yield made
            _move(made, target)
    except OSError as problem:
        raise InputError(option, path, f"cannot be written ({problem.strerror}); give another directory") from None


@contextmanager
def _staging(target: Path) -> Iterator[Path]:
    """Create an empty directory on the file system of a target; at the end remove it, and created parents if empty."""
    there = target.exists()
    home = target if there else target.absolute().parent
    missing = [directory for directory in (home, *home.parents) if not directory.exists()]
    try:
        home.mkdir(parents=True, exist_ok=True)
        with unfinished(home, folder=True) as made:
            yield made
    finally:
        for directory in missing:
            with suppress(OSError):
                directory.rmdir()


def _move(made: Path, target: Path) -> None:
    if not target.exists():
        made.rename(target)
        return
    files = sorted(file.relative_to(made) for file in made.rglob("*") if file.is_file())
    _remove_stale_figures(target, files)
    # The page and the manifest, which refer to the figures, come last.
    for file in sorted(files, key=lambda name: len(name.parts), reverse=True):
        (target / file).parent.mkdir(parents=True, exist_ok=True)
        (made / file).replace(target / file)


def _remove_stale_figures(target: Path, files: list[Path]) -> None:
    """Remove the figures that the existing study lists as its own, except those about to be replaced."""
    try:
        names = json.loads((target / MANIFEST).read_text(encoding="utf-8"))["figures"]
        stale = [Path(name) for name in names]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):  # missing or damaged: keep the figures
        return
    for file in stale:
        if len(file.parts) == 2 and file.parts[0] == FIGURES and file.parts[1] != ".." and file not in files:
            with suppress(OSError, ValueError):  # ValueError: a name that no file can have
                (target / file).unlink(missing_ok=True)
