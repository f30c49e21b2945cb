"""What the last bits of a result depend on: versions of software, and kinds of processors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib.metadata import version
from pathlib import Path

from carom.outcome import InputError
from carom.sweeps.integrity import DamagedError, read_record, record

PROCESSORS = "processors.json"
"""File of a store with the kinds of processors that computed its chunks; each chunk's record has its own."""
_KIND = "kinds of processors"


def versions() -> dict[str, str]:
    """Return the versions of carom, of its compiler (Numba, llvmlite) and of its random numbers (NumPy)."""
    return {name: version(name) for name in ("carom", "numpy", "numba", "llvmlite")}


def other_version(there: Mapping[str, str], here: Mapping[str, str]) -> tuple[str, str, str] | None:
    """Return the first package whose versions differ, with both versions, or None."""
    return next(((name, there.get(name, "?"), own) for name, own in here.items() if there.get(name) != own), None)


def processors_record(kinds: Iterable[str]) -> bytes:
    """Return the content of the file, whatever the order in which the kinds computed chunks."""
    return record(_KIND, sorted(kinds))


def processors_of(path: Path) -> list[str]:
    """Return the kinds of processors of a store's chunks, as :func:`carom.compiling.target.processor` names them."""
    try:
        found: list[str] = read_record(_KIND, path / PROCESSORS)
    except (FileNotFoundError, DamagedError):
        remedy = "the carom sweep that wrote it restores it from the records of its chunks"
        raise InputError("store", path, f"its file {PROCESSORS} is damaged or missing; {remedy}") from None
    return found


def differences(here: str, there: str) -> str:
    """Describe in which features two kinds of processors differ."""
    own, other = here.split(), there.split()
    only = [word for word in own if word not in other], [word for word in other if word not in own]
    return "; ".join(
        f"{place}: {' '.join(words)}" for place, words in zip(("only here", "only there"), only, strict=True) if words
    )
