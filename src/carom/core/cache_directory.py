"""Where compiled kernels are kept."""

from __future__ import annotations

import hashlib
import os
import stat
import tempfile
import warnings
from functools import cache
from pathlib import Path

from platformdirs import user_cache_path

from carom.outcome import CaromWarning

__all__ = ["VARIABLE", "cache_directory", "tell_once"]

VARIABLE = "CAROM_CACHE_DIR"
"""Environment variable that names a directory for compiled kernels."""
TRIAL = 65_536
"""Bytes that a directory must take to be used: a full disk still takes empty files."""


@cache
def cache_directory() -> Path | None:
    """Directory of compiled kernels: the one chosen, the user's, or one in the directory of temporary files.

    It is named by a hash of all of ``core/``: a kernel holds the machine code of those that it calls, so an edit of any of
    them makes it stale.

    Whoever can write there can have their own code run.  The directory of temporary files is shared, and the name in it
    can be guessed: what is there already is taken only if it belongs to this user and nobody else may enter.

    Returns
    -------
    Path or None
        None where no directory can be written.
    """
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parent.rglob("*.py")):
        digest.update(source.read_bytes())
    shared = Path(tempfile.gettempdir()) / f"carom-{_user()}"
    roots = [user_cache_path("carom"), shared]
    if chosen := os.environ.get(VARIABLE) or os.environ.get("NUMBA_CACHE_DIR"):
        roots.insert(0, Path(chosen))
    for root in roots:
        directory = root / "kernels" / digest.hexdigest()[:16]
        try:
            if root == shared:
                root.mkdir(exist_ok=True, mode=0o700)
                place = root.lstat()  # not of what a link leads to
                foreign = os.name == "posix" and (place.st_uid != os.getuid() or place.st_mode & 0o077)
                if foreign or not stat.S_ISDIR(place.st_mode):
                    continue
            directory.mkdir(parents=True, exist_ok=True, mode=0o700)
            with tempfile.TemporaryFile(dir=directory, buffering=0) as trial:
                if trial.write(bytes(TRIAL)) == TRIAL:
                    return directory
        except OSError:
            continue
    return None


@cache
def tell_once() -> None:
    """Warn, the first time in this process, that compiled kernels are not kept."""
    warnings.warn(
        "compiled kernels cannot be kept on the disk, so each run compiles them anew; "
        f"make room, or set {VARIABLE} to a directory that can be written",
        CaromWarning,
        stacklevel=2,
    )


def _user() -> str:
    return str(os.getuid()) if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
