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

{determinant}end module

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
