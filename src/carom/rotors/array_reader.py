"""Read arrays of a file in a process of its own: ``python array_reader.py FILE KEY …`` writes them as an archive of NumPy.

Files of other programs may be damaged, or made to do harm, and the libraries that read them end the process then, or fill the memory.  So this
program has limits; it imports nothing of carom.  Of what is refused it writes the reason, as the array ``refused``.
"""

from __future__ import annotations

import contextlib
import sys
from typing import Any

import numpy as np

SECONDS = 10
"""Of the processor; the largest matrices that are of use take one or two."""
LARGEST = 500_000_000
"""Bytes of all arrays: those of 500 nodes are 290 MB."""
ADDRESSES = 4_000_000_000
"""Bytes of memory that the process may ask for, with its libraries."""


class RefusedArraysError(Exception):
    """What is wrong with a file, in words."""


def main(source: str, keys: list[str]) -> None:
    """Write what a file holds of these arrays."""
    limit()
    try:
        found = read(source, keys)
        if (size := sum(each.nbytes for each in found.values())) > LARGEST:
            raise RefusedArraysError(f"its arrays take {size / 1e6:.0f} MB, of which {LARGEST / 1e6:.0f} MB are read")
    except RefusedArraysError as problem:
        found = {"refused": np.array(str(problem))}
    except MemoryError:
        found = {"refused": np.array("it needs more memory than a rotor does")}
    except Exception:  # noqa: BLE001  (of a damaged file libraries raise anything, with advice for those who program)
        found = {"refused": np.array("it is damaged, cut short, or another kind of file")}
    np.savez(sys.stdout.buffer, **found)


def limit() -> None:
    """Let this process end when it takes too long or too much, where the system knows limits."""
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))


def read(source: str, keys: list[str]) -> dict[str, Any]:
    """Arrays of an archive of NumPy, or of a file of MATLAB."""
    if source.lower().endswith(".npz"):
        with np.load(source) as archive:
            return {key: plain(key, archive[key]) for key in keys if key in archive}
    from scipy.io import loadmat  # type: ignore[import-untyped]

    try:
        held = loadmat(source, variable_names=keys)
    except NotImplementedError:
        raise RefusedArraysError("MATLAB has saved it with -v7.3; save it with -v7") from None
    return {key: plain(key, held[key]) for key in keys if key in held}


def plain(key: str, given: object) -> np.ndarray:
    """Numbers as doubles, with their zeros if they are sparse; of one text, or of a cell array of MATLAB, its texts."""
    array = np.asarray(given.toarray() if hasattr(given, "toarray") else given)
    if array.dtype.kind in "USO":
        listed = [str(np.asarray(each).ravel()[0]).strip() if np.size(each) else "" for each in array.ravel().tolist()]
        return np.array(listed[0].split() if len(listed) == 1 else listed, str)
    if array.dtype.kind not in "biufc":
        raise RefusedArraysError(f"{key} holds neither numbers nor texts")
    if np.iscomplexobj(array) and array.imag.any():
        raise RefusedArraysError(f"{key} holds complex numbers; a rotor has real ones")
    return np.asarray(array.real, dtype="<f8")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
