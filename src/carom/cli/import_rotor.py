"""``carom import-rotor``: a rotor of another program as a file of matrices."""

from __future__ import annotations

import math
from pathlib import Path

import typer

from carom.cli.options import AS_JSON, option
from carom.cli.terminal import hand_over, progress

SOURCE = typer.Argument(
    metavar="SOURCE",
    help="A Python program that makes a rotor with ROSS (.py), a model saved by ROSS (.toml, .json), or matrices (.npz, .mat).",
)
OUT = option("ROTOR.npz", "Write the matrices to this file.", "--out", "-o", default=...)
NAME = option("NAME", "Name of the rotor in the program, or of a function that returns it.")
PYTHON = option("PYTHON", "Python of an environment with ROSS, by default the current one.")


COLUMNS = "nodes_si=nodes names mass_si=mass polar_inertia_si=polar_inertia diametral_inertia_si=diametral_inertia"


def import_rotor(
    source: str = SOURCE,
    out: str = OUT,
    name: str | None = NAME,
    python: str | None = PYTHON,
    as_json: bool = AS_JSON,
) -> None:
    """Import a ROSS rotor, or matrices, and print a machine file to start from.

    ROSS runs in a separate process, which takes seconds to start. The file of matrices holds mass, stiffness and gyroscopic matrix
    of the shaft with its discs; the printed machine file holds the bearings, and marks as ASSUMED what you have to supply:
    carom import-rotor model.py -o rotor.npz > machine.toml
    """
    from carom.base.results import record
    from carom.rotors.ross_import import import_rotor as read
    from carom.rotors.rotor_files import check_target, write_rotor
    from carom.rotors.starter import starter_text

    check_target(out)
    with progress("reading the rotor (ROSS takes seconds to start)"):
        found = read(source, name, python)
    write_rotor(found.rotor, out)
    text = starter_text(found, Path(out).name)
    rotor = found.rotor
    document = {
        "file": out,
        **record(rotor, COLUMNS),
        "free_frequencies_si": (rotor.free_modes.frequencies[2:8] / math.tau).tolist(),
        "damped": found.is_damped,
        "bearings": [dict(each) for each in found.bearings],
        "remarks": list(found.remarks),
        "machine_file": text,
    }
    hand_over(lambda: document, as_json, lambda: typer.echo(text, nl=False), None)
