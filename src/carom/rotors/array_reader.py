"""Read arrays of a file in a process of its own: ``python array_reader.py FILE KEY …``.

Files of other programs may be damaged, or made to do harm, and the libraries that read them end the process then, or fill the memory.  So this
program has limits; it imports nothing of carom.  It writes a line of JSON, texts and shapes by key or what is refused, and then all numbers.
"""

from __future__ import annotations

import contextlib
import json
import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

SECONDS = 10
"""Of the processor; the largest matrices that are of use take one or two."""
LARGEST = 500_000_000
"""Bytes of all arrays, unpacked: those of 500 nodes are 290 MB."""
ADDRESSES = 4_000_000_000
"""Bytes of memory that the process may ask for, with its libraries."""


class RefusedError(Exception):
    """What is wrong with a file, in words."""


def main(source: str, keys: list[str]) -> None:
    """Write what a file holds of these arrays."""
    limit()
    told: dict[str, Any]
    numbers: dict[str, np.ndarray] = {}
    try:
        readers = {".npz": of_numpy, ".mat": of_matlab}
        found = {key: plain(key, each) for key, each in readers[Path(source).suffix.lower()](source, keys).items()}
        numbers = {key: each for key, each in found.items() if isinstance(each, np.ndarray)}
        check_size(sum(each.nbytes for each in numbers.values()))
        told = {"texts": [(key, each) for key, each in found.items() if isinstance(each, list)]}
        told["numbers"] = [(key, each.shape) for key, each in numbers.items()]
    except RefusedError as problem:
        told, numbers = {"refused": str(problem)}, {}
    except MemoryError:
        told, numbers = {"refused": "it needs more memory than a rotor does"}, {}
    except Exception:  # noqa: BLE001  (of a damaged file libraries raise anything, with advice for those who program)
        told, numbers = {"refused": "it is damaged, cut short, or another kind of file"}, {}
    out = sys.stdout.buffer
    out.write(json.dumps(told).encode() + b"\n")
    for each in numbers.values():
        out.write(each.tobytes())
    out.flush()


def limit() -> None:
    """Let this process end when it takes too long or too much, where the system knows limits."""
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))


def of_numpy(source: str, keys: list[str]) -> dict[str, Any]:
    """Arrays of an archive of NumPy."""
    with zipfile.ZipFile(source) as archive:
        members = {key: f"{key}.npy" for key in keys if f"{key}.npy" in archive.namelist()}
        check_size(sum(archive.getinfo(member).file_size for member in members.values()))
        found = {}
        for key, member in members.items():
            with archive.open(member) as stream:
                found[key] = array_of(key, stream)
        return found


def array_of(key: str, stream: Any) -> np.ndarray:
    """An array of numbers or texts; one of objects would run what the file says."""
    version = np.lib.format.read_magic(stream)
    headers = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    shape, by_columns, kind = headers[version](stream)
    if kind.hasobject:
        raise RefusedError(f"{key} holds objects of Python; write it as an array of numbers, or of texts of one length")
    size = int(np.prod(shape, dtype=object)) * kind.itemsize
    check_size(size)
    content = stream.read(size)
    return np.frombuffer(content, kind).reshape(shape, order="F" if by_columns else "C")


def of_matlab(source: str, keys: list[str]) -> dict[str, Any]:
    """Arrays of a file of MATLAB."""
    from scipy.io import loadmat  # type: ignore[import-untyped]

    try:
        return {key: each for key, each in loadmat(source, variable_names=keys).items() if key in keys}
    except NotImplementedError:
        raise RefusedError("MATLAB has saved it with -v7.3; save it with -v7") from None


def plain(key: str, given: Any) -> np.ndarray | list[str]:
    """Numbers as doubles, with their zeros if they are sparse; of texts a list."""
    if hasattr(given, "toarray"):
        check_size(8 * int(np.prod(given.shape, dtype=object)))
        given = given.toarray()
    array = np.asarray(given)
    if array.dtype.kind in "USO":
        return texts_of(array)
    if array.dtype.kind not in "biufc":
        raise RefusedError(f"{key} holds neither numbers nor texts")
    if np.iscomplexobj(array):
        if array.imag.any():
            raise RefusedError(f"{key} holds complex numbers; a rotor has real ones")
        array = array.real
    return np.asarray(array, dtype="<f8")


def texts_of(given: np.ndarray) -> list[str]:
    """Texts of an array, or of a cell array of MATLAB; one text alone holds words with spaces between them."""
    listed = [str(np.asarray(each).ravel()[0]) if np.size(each) else "" for each in np.ravel(given).tolist()]
    texts = [each.strip() for each in listed]
    return texts[0].split() if len(texts) == 1 else texts


def check_size(size: int) -> None:
    """Refuse what no rotor needs."""
    if size > LARGEST:
        raise RefusedError(f"its arrays take {size / 1e6:.0f} MB, of which {LARGEST / 1e6:.0f} MB are read")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
