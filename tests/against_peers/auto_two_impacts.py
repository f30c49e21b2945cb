"""A branch of orbits with two impacts as an algebraic problem for AUTO-07p, written down a second time.

Nothing is shared with the package.  The unknowns are both states just before the impacts and both flight times.  Flights go through
eigenvectors; the return map's derivative is a product of matrices of four real states.
"""

from __future__ import annotations

from pathlib import Path

from .auto_equations import program, solutions, starting

_CONSTANTS = """NDIM=10, IPS=0, IRS=0, ILP=1
ICP=[1, 2]
NTST=5, NCOL=4, IAD=3, ISP=0, ISW=1, IPLT=0, NBC=0, NINT=0
NMX=4000, NPR=4000, MXBF=0, IID=2, ITMX=12, ITNW=9, NWTN=3, JAC=0
EPSL=1e-12, EPSU=1e-12, EPSS=1e-11
DS={step}, DSMIN=1e-8, DSMAX=0.002, IADS=1
RL0={low}, RL1={high}
UZR={{2: 0.0}}
"""
FOLD, USER = 2, 4
"""Types of special points in its output: a limit point of algebraic equations, a zero that the user asks for."""


def special_points(
    parameters, unknowns: list[float], limits: tuple[float, float], folder: Path
) -> dict[str, list[float]]:
    """Dampings of the folds and period doublings on the branch through a start, both ways."""
    names = {name: repr(getattr(parameters, name)) for name in ("rho", "phi", "mu", "d", "omega", "gamma")}
    orbit = program("auto_two_impacts", folder, start=starting(unknowns), **names)
    found: dict[str, list[float]] = {"fold": [], "period-doubling": []}
    for step in (0.0005, -0.0005):
        for row in solutions(orbit, _CONSTANTS.format(step=step, low=limits[0], high=limits[1])):
            kind = {FOLD: "fold", USER: "period-doubling"}.get(abs(int(row[2])) % 10)
            if kind:
                found[kind].append(float(row[4]))
    return found
