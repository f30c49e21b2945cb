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

{determinant}end module

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
