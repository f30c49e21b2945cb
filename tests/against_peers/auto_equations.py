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

_HEAD = """
module orbit
  implicit none
  integer, parameter :: dp = kind(1d0)
  real(dp), parameter :: rho = {rho}_dp, mu = {mu}_dp, d = {d}_dp
  complex(dp), parameter :: q = cmplx(1 + d, (1 + d)*mu, dp)
contains
  subroutine returns(gamma, omega, period, a12, a22, rate)
    real(dp), intent(in) :: gamma, omega, period
    complex(dp), intent(out) :: a12, a22, rate
    complex(dp) :: first, second, grown, more
    first = (-cmplx(gamma, 2, dp) + sqrt(cmplx(gamma**2 - 4*omega**2, 0, dp)))/2
    second = -cmplx(gamma, 2, dp) - first
    grown = exp(first*period)
    more = exp(second*period)
    a12 = (grown/(1 - grown) - more/(1 - more))/(first - second)
    a22 = (first*grown/(1 - grown) - second*more/(1 - more))/(first - second)
    rate = (first**2*grown/(1 - grown)**2 - second**2*more/(1 - more)**2)/(first - second)
  end subroutine

  real(dp) function flip(gamma, omega, period, speed)
    ! det(M + 1) of the return map over (Re U, Im U, Re V, Im V); its fourth multiplier, along the flow, is 0.
    real(dp), intent(in) :: gamma, omega, period, speed
    complex(dp) :: a12, a22, rate, first, second, rest, position, velocity, force, x, y, b1, b2, change
    real(dp) :: matrix(4, 4), late, radial
    integer :: k
    call returns(gamma, omega, period, a12, a22, rate)
    first = (-cmplx(gamma, 2, dp) + sqrt(cmplx(gamma**2 - 4*omega**2, 0, dp)))/2
    second = -cmplx(gamma, 2, dp) - first
    rest = rho/cmplx(omega**2 - 1, gamma, dp)
    position = rest/(1 + q*a12*speed)
    velocity = speed*cmplx(1, -aimag(q*a22), dp)*position
    force = -cmplx(gamma, 2, dp)*velocity - cmplx(omega**2 - 1, gamma, dp)*(position - rest)
    do k = 1, 4
      x = 0
      y = 0
      if (k == 1) x = 1
      if (k == 2) x = (0, 1)
      if (k == 3) y = 1
      if (k == 4) y = (0, 1)
      radial = real(conjg(position)*velocity, dp)
      change = (real(conjg(x)*velocity, dp) + real(conjg(position)*y, dp))*position + radial*x
      y = y - q*(change - 2*radial*position*real(conjg(position)*x, dp))
      b1 = (y - second*x)/(first - second)*exp(first*period)
      b2 = (first*x - y)/(first - second)*exp(second*period)
      x = b1 + b2
      y = first*b1 + second*b2
      late = -real(conjg(position)*x, dp)/radial
      x = x + velocity*late
      y = y + force*late
      matrix(:, k) = [real(x, dp), aimag(x), real(y, dp), aimag(y)]
      matrix(k, k) = matrix(k, k) + 1
    end do
    flip = determinant(matrix)
  end function

  real(dp) function determinant(given)
    real(dp), intent(in) :: given(4, 4)
    real(dp) :: a(4, 4), row(4)
    integer :: i, j, pivot
    a = given
    determinant = 1
    do i = 1, 4
      pivot = i - 1 + maxloc(abs(a(i:4, i)), 1)
      if (pivot /= i) then
        row = a(i, :)
        a(i, :) = a(pivot, :)
        a(pivot, :) = row
        determinant = -determinant
      end if
      determinant = determinant*a(i, i)
      do j = i + 1, 4
        a(j, :) = a(j, :) - a(i, :)*a(j, i)/a(i, i)
      end do
    end do
  end function
end module

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use orbit
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  complex(dp) :: a12, a22, rate
  call returns(u({gamma}), par(1), u(1), a12, a22, rate)
  f(1) = 1 + real(q*a22, dp)
{equations}
end subroutine

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  par(1) = {omega}d0
{start}
end subroutine

subroutine bcnd
end subroutine
subroutine icnd
end subroutine
subroutine fopt
end subroutine
subroutine pvls
end subroutine
"""

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


def why_missing() -> str:
    """Reason why AUTO-07p cannot be run here; empty if it can."""
    if not (AUTO / "lib" / "main.o").exists():
        return "AUTO-07p is not installed (Debian package auto-07p)"
    return "" if shutil.which("gfortran") else "gfortran is not installed"


def follow(kind: str, parameters, start: list[float], limits: tuple[float, float], folder: Path) -> np.ndarray:
    """Points ``(ω, unknowns…)`` of a curve that AUTO-07p follows over ``ω`` from a start, both ways."""
    unknowns, equations = EQUATIONS[kind]
    lines = "\n".join(f"  u({k}) = {value!r}d0" for k, value in enumerate(start, start=1))
    text = _HEAD.format(
        rho=repr(parameters.rho),
        mu=repr(parameters.mu),
        d=repr(parameters.d),
        omega=repr(parameters.omega),
        gamma=unknowns,
        equations=equations,
        start=lines,
    )
    (folder / "orbit.f90").write_text(text)
    objects = sorted(str(path) for path in (AUTO / "lib").glob("*.o"))
    compile_line = ["gfortran", "-O2", "-fopenmp", "orbit.f90", *objects, "-o", "orbit"]
    subprocess.run(compile_line, cwd=folder, check=True, capture_output=True, timeout=120)
    points = []
    for step in (0.01, -0.01):
        constants = _CONSTANTS.format(unknowns=unknowns, step=step, low=limits[0], high=limits[1])
        subprocess.run(
            [folder / "orbit"], input=constants, text=True, cwd=folder, check=True, capture_output=True, timeout=60
        )
        rows = [line.split() for line in (folder / "fort.7").read_text().splitlines()]
        points += [[float(row[4]), *map(float, row[6 : 6 + unknowns])] for row in rows if row[0] != "0"]
    return np.array(points)
