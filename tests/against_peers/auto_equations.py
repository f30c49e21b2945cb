"""Bifurcations of single-impact orbits as algebraic problems for AUTO-07p, written down a second time.

Nothing is shared with the package: flights go through eigenvectors, the derivative of the return map through matrices of
four real states with the projection along the flow at the arrival.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np

AUTO = Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p"))

HERE = Path(__file__).parent


EQUATIONS = {
    "fold": (2, "  f(2) = real(q*rate, dp)"),
    "period-doubling": (
        3,
        (
            "  f(2) = abs(1 + q*a12*u(2))**2 - rho**2/((par(1)**2 - 1)**2 + u(3)**2)\n"
            "  f(3) = flip(u(3), par(1), u(1), u(2))"
        ),
    ),
}
"""Number of unknowns (period, radial speed for the second, damping) and the equations besides ``F₁ = 0``."""

_CONSTANTS = """NDIM={unknowns}, IPS=0, IRS=0, ILP=0
ICP=[1]
NTST=5, NCOL=4, IAD=3, ISP=0, ISW=1, IPLT=0, NBC=0, NINT=0
NMX=400, NPR=400, MXBF=0, IID=2, ITMX=8, ITNW=7, NWTN=3, JAC=0
EPSL=1e-11, EPSU=1e-11, EPSS=1e-9
DS={step}, DSMIN=1e-6, DSMAX=0.02, IADS=1
RL0={low}, RL1={high}
"""


def program(name: str, folder: Path, **numbers: object) -> Path:
    """Compile the Fortran of a problem with these numbers in its places, and with AUTO-07p."""
    determinant = (HERE / "auto_determinant.f90").read_text()
    text = (HERE / f"{name}.f90").read_text().format(determinant=determinant, **numbers)
    (folder / "orbit.f90").write_text(text)
    objects = sorted(str(path) for path in (AUTO / "lib").glob("*.o"))
    options = ["-O2", "-ffree-line-length-none", "-fopenmp"]
    line = ["gfortran", *options, "orbit.f90", *objects, "-o", "orbit"]
    subprocess.run(line, cwd=folder, check=True, capture_output=True, timeout=120)
    return folder / "orbit"


def solutions(orbit: Path, constants: str) -> list[list[str]]:
    """Run a compiled problem with the constants of AUTO-07p; return the rows of its solutions."""
    subprocess.run([orbit], input=constants, text=True, cwd=orbit.parent, check=True, capture_output=True, timeout=60)
    rows = [line.split() for line in (orbit.parent / "fort.7").read_text().splitlines()]
    return [row for row in rows if row[0] != "0"]


def starting(values: list[float]) -> str:
    """Fortran that sets the unknowns."""
    lines = "\n".join(f"  u({k}) = {value!r}d0" for k, value in enumerate(values, start=1))
    return lines.replace("e-", "d-").replace("d0d0", "d0")


def why_missing() -> str:
    """Reason why AUTO-07p cannot be run here; empty if it can."""
    if not (AUTO / "lib" / "main.o").exists():
        return "AUTO-07p is not installed (Debian package auto-07p)"
    return "" if shutil.which("gfortran") else "gfortran is not installed"


def follow(kind: str, parameters, start: list[float], limits: tuple[float, float], folder: Path) -> np.ndarray:
    """Points ``(ω, unknowns…)`` of a curve that AUTO-07p follows over ``ω`` from a start, both ways."""
    unknowns, equations = EQUATIONS[kind]
    names = {name: repr(getattr(parameters, name)) for name in ("rho", "mu", "d", "omega")}
    orbit = program("auto_single_impact", folder, gamma=unknowns, equations=equations, start=starting(start), **names)
    points = []
    for step in (0.01, -0.01):
        constants = _CONSTANTS.format(unknowns=unknowns, step=step, low=limits[0], high=limits[1])
        rows = solutions(orbit, constants)
        points += [[float(row[4]), *map(float, row[6 : 6 + unknowns])] for row in rows]
    return np.array(points)
