"""Rotors and controllers by their matrices in files: ``.npz`` of NumPy, and ``.mat`` of MATLAB."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from carom.base.arguments import checked
from carom.base.files import write_whole
from carom.base.outcome import InputError, shown
from carom.rotors.matrix_rotor import MatrixRotor
from carom.rotors.shaft_parts import Damping, Disc

KEYS: Mapping[str, str] = {
    "M": "mass matrix",
    "K": "stiffness matrix, without bearings",
    "G": "gyroscopic matrix, by which the speed is multiplied",
    "nodes": "where the nodes are along the shaft, m",
    "D": "damping matrix, which may be left out",
    "coordinates": "names of the coordinates of each node, of real matrices in another order",
    "names": "a name for each node, which may be left out",
}
"""Arrays of a file, and what they are."""
NEEDED = ("M", "K", "G", "nodes")
CONTROLLER_KEYS: Mapping[str, str] = {
    **{name: name for name in ("A", "B", "C", "D", "numerator", "denominator", "sample_time")},
    "num": "numerator",
    "den": "denominator",
    "Ts": "sample_time",
}
"""Arrays of a file of a controller, and the entries of a machine file that they are."""
_SECONDS = 60
"""After which reading a file is given up; the process that reads it has its own limit, which is lower but on a busy machine."""


@checked
def read_rotor(
    path: str | os.PathLike[str], damping: Any = None, discs: Sequence[Disc] = (), internal: Damping | None = None
) -> MatrixRotor:
    """Read a rotor from a file of matrices.

    Parameters
    ----------
    path : path
        An ``.npz`` or ``.mat`` file with ``M``, ``K``, ``G`` and ``nodes``, and perhaps ``D``, ``coordinates`` and ``names``.  Matrices with two rows for each node
        are those of :class:`MatrixRotor`, others those of :meth:`MatrixRotor.of_planes`.
    damping : ProportionalDamping or ModalDamping, optional
        In place of ``D``, where the file has none.
    discs : sequence of Disc, optional
        What is put on the shaft beside what the matrices hold.
    internal : ProportionalDamping or ModalDamping, optional
        Damping that turns with the shaft.

    Raises
    ------
    InputError
        The file cannot be read, an array is missing or is not what it must be, or damping is stated twice or not at all.
    """
    name = os.fspath(path)
    arrays = _arrays(Path(name), "rotor", KEYS)
    if missing := [key for key in NEEDED if key not in arrays]:
        held = ", ".join(sorted(arrays)) or "nothing"
        raise InputError(
            f"{name}: {missing[0]}", None, f"an array of this name ({KEYS[missing[0]]}); the file holds {held}"
        )
    matrix = arrays.get("D")
    if (damping is None) == (matrix is None):
        allowed = "damping_ratio, or damping_of_mass and damping_of_stiffness; or an array D in the file of the rotor"
        raise InputError("damping", None if matrix is None else "both", f"one of: {allowed}")
    given: dict[str, Any] = {key: arrays[key] for key in NEEDED}
    given |= {"damping": matrix if damping is None else damping, "discs": discs, "internal": internal}
    if "names" in arrays:
        given["names"] = arrays["names"]
    is_complex = "coordinates" not in arrays and arrays["M"].shape == (2 * arrays["nodes"].size,) * 2
    order: dict[str, Any] = {} if is_complex else {"coordinates": arrays.get("coordinates")}
    try:
        found = (MatrixRotor if is_complex else MatrixRotor.of_planes)(**given, **order)
        object.__setattr__(found, "source", str(Path(name).absolute()))
        return found
    except InputError as problem:
        raise problem.under(f"{name}: ") from None


@checked
def write_rotor(matrices: MatrixRotor, path: str | os.PathLike[str]) -> None:
    """Write a rotor to an ``.npz`` file, which :func:`carom.rotors.read_rotor` and ``source`` of a machine file read.

    Parameters
    ----------
    matrices : MatrixRotor
    path : path

    Raises
    ------
    InputError
        The name does not end in ``.npz``.
    OSError
        The file cannot be written.
    """
    check_target(path)
    own = matrices.matrices
    arrays: dict[str, Any] = {"M": own.mass, "K": own.stiffness, "G": own.gyroscopic, "nodes": matrices.nodes}
    if matrices.own_damping is None:
        arrays["D"] = matrices.damping_matrix
    if any(matrices.names):
        arrays["names"] = np.array(matrices.names)
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)
    write_whole(Path(path), packed.getvalue())


def check_target(path: str | os.PathLike[str]) -> None:
    """Refuse the name of a file that is no ``.npz`` file."""
    if Path(path).suffix != ".npz":
        raise InputError("rotor file", shown(path), "a name that ends in .npz")


def read_controller(path: Path) -> dict[str, object]:
    """Entries of a machine file that a controller in a file is: its matrices, or its numerator and denominator, and a sample time above 0."""
    arrays = _arrays(path, "controller", CONTROLLER_KEYS)
    if not arrays:
        allowed = "arrays A, B, C and D, or num and den; in MATLAB [A, B, C, D] = ssdata(sys); save('controller.mat', 'A', 'B', 'C', 'D', '-v7')"
        raise InputError("controller file", shown(str(path)), allowed)
    found = {CONTROLLER_KEYS[name]: each if name in "ABCD" else each.ravel() for name, each in arrays.items()}
    if "sample_time" in found:
        found["sample_time"] = found["sample_time"].tolist()[0] or None
    return found


def _arrays(path: Path, what: str, keys: Iterable[str]) -> dict[str, Any]:
    """Arrays of a file with these names, and lists of texts, as a process of its own reads them (``array_reader.py``)."""
    if path.suffix.lower() not in (".npz", ".mat"):
        raise InputError(f"{what} file", shown(str(path)), "a file of matrices, .npz or .mat")
    if not path.is_file():
        why = "this is no file, but a directory or a device" if path.exists() else "there is no such file"
        raise InputError(f"{what} file", shown(str(path)), why)
    # Modules beside the reader are none of the libraries'; one thread of theirs is enough.
    command = [sys.executable, "-P", str(Path(__file__).with_name("array_reader.py")), str(path), *keys]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            command, capture_output=True, stdin=subprocess.DEVNULL, env=environment, timeout=_SECONDS, check=False
        )
        with np.load(io.BytesIO(done.stdout)) as archive:
            found: dict[str, Any] = dict(archive)
        refused = str(found.get("refused", ""))
    except subprocess.TimeoutExpired:
        refused = f"this takes more than {_SECONDS} s"
    except OSError as problem:
        refused = f"no process can be started for it: {problem.strerror}"
    except (EOFError, ValueError):  # the process has ended before it wrote anything
        refused = "it is damaged: reading it ends the program that does"
    if refused:
        allowed = "a file of numpy.savez, or of MATLAB's save -v7 with plain arrays"
        raise InputError(f"{what} file", shown(str(path)), f"{allowed}; it cannot be read: {refused}")
    return {key: tuple(each.tolist()) if each.dtype.kind == "U" else each for key, each in found.items()}
