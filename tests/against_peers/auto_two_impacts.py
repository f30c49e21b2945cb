"""A branch of orbits with two impacts as an algebraic problem for AUTO-07p, written down a second time.

Nothing is shared with the package.  The unknowns are both states just before the impacts and both flight times.  Flights go through
eigenvectors; the return map's derivative is a product of matrices of four real states.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

from .auto_equations import AUTO

_SOURCE = """
module orbit
  implicit none
  integer, parameter :: dp = kind(1d0)
  real(dp), parameter :: rho = {rho}_dp, phi = {phi}_dp, mu = {mu}_dp, d = {d}_dp, omega = {omega}_dp
  complex(dp), parameter :: q = cmplx(1 + d, (1 + d)*mu, dp)
contains
  subroutine passage(gamma, before, time, after, matrix)
    ! Impact and flight from (Re U, Im U, Re V, Im V), and the derivative with the projection along the flow at the arrival.
    real(dp), intent(in) :: gamma, before(4), time
    real(dp), intent(out) :: after(4), matrix(4, 4)
    complex(dp) :: first, second, rest, position, velocity, force, x, y, b1, b2, change, normal
    real(dp) :: late, radial, size, turn
    integer :: k
    first = (-cmplx(gamma, 2, dp) + sqrt(cmplx(gamma**2 - 4*omega**2, 0, dp)))/2
    second = -cmplx(gamma, 2, dp) - first
    rest = rho*exp(cmplx(0, phi, dp))/cmplx(omega**2 - 1, gamma, dp)
    position = cmplx(before(1), before(2), dp)
    velocity = cmplx(before(3), before(4), dp)
    size = abs(position)
    normal = position/size
    radial = real(conjg(normal)*velocity, dp)
    x = position - rest
    y = velocity - q*radial*normal
    b1 = (y - second*x)/(first - second)*exp(first*time)
    b2 = (first*x - y)/(first - second)*exp(second*time)
    x = b1 + b2
    y = first*b1 + second*b2
    after = [real(rest + x, dp), aimag(rest + x), real(y, dp), aimag(y)]
    force = -cmplx(gamma, 2, dp)*y - cmplx(omega**2 - 1, gamma, dp)*x
    do k = 1, 4
      x = 0
      y = 0
      if (k == 1) x = 1
      if (k == 2) x = (0, 1)
      if (k == 3) y = 1
      if (k == 4) y = (0, 1)
      turn = aimag(conjg(normal)*x)/size
      change = (real(conjg(normal)*y, dp) + turn*real(conjg((0, 1)*normal)*velocity, dp))*normal + radial*(0, 1)*normal*turn
      y = y - q*change
      b1 = (y - second*x)/(first - second)*exp(first*time)
      b2 = (first*x - y)/(first - second)*exp(second*time)
      x = b1 + b2
      y = first*b1 + second*b2
      late = -(after(1)*real(x, dp) + after(2)*aimag(x))/(after(1)*after(3) + after(2)*after(4))
      x = x + cmplx(after(3), after(4), dp)*late
      y = y + force*late
      matrix(:, k) = [real(x, dp), aimag(x), real(y, dp), aimag(y)]
    end do
  end subroutine

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
  double precision :: after(4), matrix(4, 4)
  call passage(par(1), u(1:4), u(5), after, matrix)
  f(1:4) = after - u(6:9)
  f(5) = after(1)**2 + after(2)**2 - 1
  call passage(par(1), u(6:9), u(10), after, matrix)
  f(6:9) = after - u(1:4)
  f(10) = after(1)**2 + after(2)**2 - 1
end subroutine

subroutine stpnt(ndim, u, par, t)
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  par(1) = {gamma}d0
  par(2) = 1
{start}
end subroutine

subroutine pvls(ndim, u, par)
  ! Determinant of the return map's derivative plus one: zero where the period doubles.
  use orbit
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim)
  double precision, intent(inout) :: par(*)
  double precision :: after(4), first(4, 4), second(4, 4)
  integer :: k
  call passage(par(1), u(1:4), u(5), after, first)
  call passage(par(1), u(6:9), u(10), after, second)
  first = matmul(second, first)
  do k = 1, 4
    first(k, k) = first(k, k) + 1
  end do
  par(2) = determinant(first)
end subroutine

subroutine bcnd
end subroutine
subroutine icnd
end subroutine
subroutine fopt
end subroutine
"""

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
    lines = "\n".join(f"  u({k}) = {value!r}d0" for k, value in enumerate(unknowns, start=1))
    (folder / "orbit.f90").write_text(_SOURCE.format(**names, start=lines.replace("e-", "d-").replace("d0d0", "d0")))
    objects = sorted(str(path) for path in (AUTO / "lib").glob("*.o"))
    compile_line = ["gfortran", "-O2", "-ffree-line-length-none", "-fopenmp", "orbit.f90", *objects, "-o", "orbit"]
    subprocess.run(compile_line, cwd=folder, check=True, capture_output=True, timeout=120)
    found: dict[str, list[float]] = {"fold": [], "period-doubling": []}
    for step in (0.0005, -0.0005):
        constants = _CONSTANTS.format(step=step, low=limits[0], high=limits[1])
        subprocess.run(
            [folder / "orbit"], input=constants, text=True, cwd=folder, check=True, capture_output=True, timeout=60
        )
        for line in (folder / "fort.7").read_text().splitlines():
            row = line.split()
            kind = {FOLD: "fold", USER: "period-doubling"}.get(abs(int(row[2])) % 10 if row[0] != "0" else 0)
            if kind:
                found[kind].append(float(row[4]))
    return found
