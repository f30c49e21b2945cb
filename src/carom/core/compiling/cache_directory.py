"""The directory in which compiled kernels are cached."""

from __future__ import annotations

import hashlib
import os
import stat
import tempfile
import warnings
from functools import cache
from pathlib import Path

from platformdirs import user_cache_path

from carom.base.outcome import CaromWarning

VARIABLE = "CAROM_CACHE_DIR"
"""Environment variable that sets the cache directory."""
TRIAL = 65_536
"""Bytes written to test a directory: a full disk still accepts empty files."""


@cache
def cache_directory() -> Path | None:
    """Directory of compiled kernels: the one set in the environment, the user's cache or one for temporary files.

    Its name contains a hash of all sources in ``core/``, of which ``compiling/`` is a part.  A kernel contains the machine code of the
    kernels it calls, so an edit of any of them makes it stale.

    Anyone who can write to this directory can have their own code executed.  The system's directory for temporary files
    is shared, and the name used in it can be guessed.  An existing directory there is used only if it belongs to this
    user and nobody else has access to it.

    Returns
    -------
    Path or None
        None if no directory is writable.
    """
    digest = hashlib.sha256()
    for source in sorted(Path(__file__).parents[1].rglob("*.py")):
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
                place = root.lstat()  # lstat does not follow links
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
def warn_once() -> None:
    """Warn, once per process, that compiled kernels are not cached."""
    warnings.warn(
        "compiled kernels cannot be kept on the disk, so each run compiles them anew; "
        f"make room, or set {VARIABLE} to a directory that can be written",
        CaromWarning,
        stacklevel=2,
    )


def _user() -> str:
    return str(os.getuid()) if hasattr(os, "getuid") else os.environ.get("USERNAME", "user")
