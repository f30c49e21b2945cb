"""What decides the bits of a result: versions of software, and kinds of processors."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

from carom.outcome import InputError
from carom.sweeps.integrity import DamagedError, read_record

__all__ = ["PROCESSORS", "differences", "other_version", "processors_of", "versions"]

PROCESSORS = "processors.json"
"""File of a store with the kinds of processors that computed its chunks, the first one first."""


def versions() -> dict[str, str]:
    """Of carom, and of what its kernels are compiled by and its numbers are drawn by."""
    return {name: version(name) for name in ("carom", "numpy", "numba", "llvmlite")}


def other_version(there: Mapping[str, str], here: Mapping[str, str]) -> tuple[str, str, str] | None:
    """The first name under which the versions differ, and both of them."""
    return next(((name, there.get(name, "?"), own) for name, own in here.items() if there.get(name) != own), None)


def processors_of(path: Path, option: str) -> list[str]:
    """Kinds of processors that computed the chunks of a store, as :func:`carom.core.target.processor` names them.

    Raises
    ------
    InputError
        The record is damaged.
    """
    try:
        found: list[str] = read_record(path / PROCESSORS)
    except FileNotFoundError:
        return []
    except DamagedError:
        remedy = "delete it: it tells on which kinds of processors chunks were computed, and nothing else"
        raise InputError(option, path, f"its file {PROCESSORS} is damaged; {remedy}") from None
    return found


def differences(here: str, there: str) -> str:
    """Words for what one kind of processor has and another has not."""
    own, other = here.split(), there.split()
    only = [word for word in own if word not in other], [word for word in other if word not in own]
    return "; ".join(
        f"{place}: {' '.join(words)}" for place, words in zip(("only here", "only there"), only, strict=True) if words
    )
