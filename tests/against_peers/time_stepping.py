"""Peer for whole motions: Siconos, a platform for non-smooth mechanical systems, stepping through the contacts.

It knows nothing of circular walls, flights or chatter: it gets the equations of motion in the fixed frame, the gap
``1 − |z|`` and the slip velocity, and solves a contact problem with friction in every step (Acary and Brogliato 2008).
The scheme is of the first order.
"""

import json
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np

from carom.parameters import Parameters

HERE = Path(__file__).parent
PLUGIN = "WallPlugin.so"


@cache
def missing() -> str:
    """Why Siconos cannot be asked, or nothing."""
    if compiler() is None:
        return "no C compiler for the contact geometry that Siconos asks for"
    if interpreter() is None:
        return "no Python with Siconos (Debian: python3-siconos)"
    return ""


@cache
def interpreter() -> str | None:
    """A Python that has Siconos: this one, or that of the system."""
    for python in (sys.executable, "/usr/bin/python3"):
        if Path(python).exists():
            found = subprocess.run([python, "-c", "import siconos.kernel"], capture_output=True, check=False)
            if found.returncode == 0:
                return python
    return None


def compiler() -> str | None:
    """A C compiler."""
    return shutil.which("cc") or shutil.which("gcc")


def compile_wall(directory: Path) -> None:
    """Compile the geometry of the wall into a directory."""
    source = HERE / "siconos_wall.c"
    command = [compiler(), "-O2", "-shared", "-fPIC", "-o", directory / PLUGIN, source, "-lm"]
    subprocess.run(command, check=True, capture_output=True)


def follow(
    parameters: Parameters, position: complex, velocity: complex, until: float, steps: int, samples: int, wall: Path
) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities in the fixed frame at ``samples`` even times up to ``until``."""
    case = {
        **parameters.as_dict(),
        "position": [position.real, position.imag],
        "velocity": [velocity.real, velocity.imag],
        "until": until,
        "steps": steps,
        "samples": samples,
    }
    command = [interpreter(), HERE / "siconos_rotor.py", wall, json.dumps(case)]
    finished = subprocess.run(command, check=True, capture_output=True, text=True)
    path = np.array(json.loads(finished.stdout.splitlines()[-1]))
    return path[:, 0] + 1j * path[:, 1], path[:, 2] + 1j * path[:, 3]
