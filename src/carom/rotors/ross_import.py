"""Rotors of ROSS, which reads them in a process of its own (``ross_reader.py``)."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.rotors.matrix_rotor import MatrixRotor
from carom.rotors.rotor_files import read_rotor
from carom.rotors.shaft_parts import ModalDamping

USUAL = ModalDamping(0.005)
"""Damping of a rotor that brings none of its own, until the machine file says better."""
SOURCES = (".py", ".toml", ".json")


@dataclass(frozen=True, eq=False)
class ImportedRotor:
    """A rotor that another program has described, with what is known beside its matrices.

    Attributes
    ----------
    rotor : MatrixRotor
    is_damped : bool
        Whether damping is that of the source; otherwise it is a damping ratio of 0.005 of all bending modes.
    bearings : tuple of mapping
        Node, tag, kind and numbers of each bearing; they are no part of the rotor.
    remarks : tuple of str
        What has been left out.
    speed : float or None
        rad/s, if it is stated.
    """

    rotor: MatrixRotor
    is_damped: bool
    bearings: tuple[Mapping[str, Any], ...] = ()
    remarks: tuple[str, ...] = ()
    speed: float | None = None


@checked
def import_rotor(source: str | os.PathLike[str], name: str | None = None, python: str | None = None) -> ImportedRotor:
    """Read a rotor from a file of matrices, or from one of ROSS.

    Parameters
    ----------
    source : path
        ``.npz`` or ``.mat``: matrices (:func:`carom.rotors.read_rotor`).  ``.py``: a program that makes a rotor with ROSS; ``.toml`` or ``.json``: what ROSS has saved.
    name : str, optional
        Name of the rotor in a program, or of a function that returns it; needed where there are several.
    python : str, optional
        Python of an environment that has ROSS, by default the present one.

    Raises
    ------
    InputError
        The source cannot be read, ROSS is not installed, there is not one rotor, it has several shafts, or :class:`MatrixRotor` refuses it.
    """
    path = Path(source)
    if path.suffix.lower() not in SOURCES:
        return ImportedRotor(*_of_matrices(path))
    if not path.is_file():
        raise InputError("source", shown(str(path)), "there is no such file")
    with TemporaryDirectory() as folder:
        given = _read_by_ross(path, name or "", python or sys.executable, folder)
        rotor, damped = _of_matrices(Path(folder) / "rotor.npz", str(path))
    bearings, remarks = (tuple(given[key]) for key in ("bearings", "remarks"))
    return ImportedRotor(rotor, damped, bearings, remarks, given["speed"])


def _of_matrices(path: Path, called: str | None = None) -> tuple[MatrixRotor, bool]:
    """Rotor of a file of matrices, and whether it is damped."""
    try:
        return read_rotor(path), True
    except InputError as problem:
        if problem.field != "damping":
            field = problem.field.replace(str(path), called or str(path))
            raise InputError(field, problem.value, problem.allowed) from None
    return read_rotor(path, USUAL), False


def _read_by_ross(path: Path, name: str, python: str, folder: str) -> dict[str, Any]:
    """What ROSS knows of a rotor, whose matrices are in the folder then."""
    reader = Path(__file__).with_name("ross_reader.py")
    try:
        done = subprocess.run(
            [python, str(reader), str(path), name, folder], capture_output=True, text=True, check=False
        )
    except OSError as problem:
        raise InputError("python", shown(python), f"a Python that has ROSS ({problem.strerror})") from None
    given = Path(folder) / "rotor.json"
    if not given.is_file():
        last = done.stderr.strip().rpartition("\n")[2] or f"exit code {done.returncode}"
        raise InputError("source", shown(str(path)), f"a file that ROSS can read; it ended with: {shown(last)}")
    found: dict[str, Any] = json.loads(given.read_text(encoding="utf-8"))
    if "refused" in found:
        raise InputError(*found["refused"])
    return found
