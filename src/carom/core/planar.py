"""Single-impact orbits of the planar rotor in closed form: their equations, and test functions of their bifurcations.

All functions take a few plain numbers, since continuation evaluates them thousands of times.  The frame is turned so
that the impact is at ``U = 1``; the contact-free equilibrium is then at ``1 + q a₁₂ ṙ``.
"""

from __future__ import annotations

import cmath

import numpy as np

from carom.core.compiling.decorators import kernel
from carom.core.flow import squared_modulus
from carom.core.friction import sliding_factor
from carom.core.periods import propagator, returns

_NEWTON_STEPS = 60


@kernel
def planar_exponents(gamma, omega):
    """Exponents ``λ₋, λ₊ = (−γ − 2i ∓ √(γ² − 4ω²))/2``, that of smaller real part first, free of cancellation."""
    # (γ − 2ω)(γ + 2ω) keeps the split accurate near critical damping.
    split = cmath.sqrt(complex((gamma - 2.0 * omega) * (gamma + 2.0 * omega), 0.0))
    lower, upper = 0.5 * (-gamma - split), 0.5 * (-gamma + split)
    if split.real > 0.5 * abs(gamma):
        # Strongly overdamped: one root is a difference of nearly equal numbers; the product ω² gives it accurately.
        if gamma > 0.0:
            upper = omega * omega / lower
        else:
            lower = omega * omega / upper
    return lower - 1j, upper - 1j


@kernel
def orbit_conditions(gamma, omega, rho, mu, d, surface_speed, period, speed):
    """Equations of a single-impact orbit with forward slip, and test functions of its bifurcations.

    Parameters
    ----------
    gamma, omega, rho, mu, d : float
    surface_speed : float
        ``s + 1``.
    period, speed : float
        ``T`` and ``ṙ`` before the impact; the residuals of the equations vanish on an orbit.

    Returns
    -------
    closing, balance : float
        ``F₁(T)`` and ``|1 + q a₁₂ ṙ|² − |U*|²``: zero on an orbit (source paper (4.3), (4.4)).
    period_fold, speed_fold : float
        ``F₁'(T)`` and half of the derivative of ``balance`` by ``ṙ``: zero where two orbits meet.
    boundary : float
        ``|U*|² − 1``.
    slip_stop : float
        Slip velocity just after the impact.
    period_doubling : float
        ``det(J + 1)`` of the impact map's derivative ``J``.
    neimark_sacker, pair_sum : float
        Product of ``λⱼλₖ − 1`` over the pairs of multipliers; where it is zero, the sum of those whose product is one.
    lever, turn : complex
        ``q a₁₂`` and ``q a₂₂``.
    """
    first, second = planar_exponents(gamma, omega)
    a12, a22, rate, _ = returns(first, second, period)
    q = sliding_factor(mu, d)
    lever, turn = q * a12, q * a22
    closing = 1.0 + turn.real
    rest = rho * rho / squared_modulus(complex(omega * omega - 1.0, gamma))
    balance = squared_modulus(1.0 + lever * speed) - rest
    jacobian = _jacobian(first, second, q, lever, turn, period, speed)
    trace = jacobian[0, 0] + jacobian[1, 1] + jacobian[2, 2]
    minors, determinant = _invariants(jacobian)
    return (
        closing,
        balance,
        (q * rate).real,
        lever.real + squared_modulus(lever) * speed,
        rest - 1.0,
        surface_speed - (turn.imag + mu * (1.0 + d)) * speed,
        1.0 + trace + minors + determinant,
        determinant * determinant - determinant * trace + minors - 1.0,
        trace - determinant,
        lever,
        turn,
    )


@kernel
def impact_jacobian(gamma, omega, mu, d, period, speed):
    """Derivative of the impact map on a single-impact orbit over ``(θ, ṙ, θ̇)``, shape (3, 3)."""
    first, second = planar_exponents(gamma, omega)
    a12, a22, _, _ = returns(first, second, period)
    q = sliding_factor(mu, d)
    return _jacobian(first, second, q, q * a12, q * a22, period, speed)


@kernel
def _jacobian(first, second, q, lever, turn, period, speed):
    """Derivative of the impact map over ``(θ, ṙ, θ̇)``, with the saltation term of the time of impact.

    The velocity before the impact is ``ṙ(1 − i Im q a₂₂)``, and the force there is a multiple of ``ṙ`` too.  So nothing
    is divided by ``ṙ``, and the derivative exists in the limit of vanishing impacts.
    """
    velocity = complex(1.0, -turn.imag)
    force = (first + second) * velocity + first * second * lever
    growth, response, decay = propagator(first, second, period)
    jacobian = np.empty((3, 3))
    for column in range(3):
        position_change, velocity_change = 0j, 1j
        if column == 0:
            position_change, velocity_change = 1j, 1j * speed * (velocity - q)
        elif column == 1:
            velocity_change = 1.0 - q
        driving = velocity_change - second * position_change
        position_change = position_change * growth + driving * response
        velocity_change = second * position_change + driving * decay
        late = -position_change.real
        turned = (position_change + velocity * late).imag
        velocity_change += force * late
        jacobian[0, column] = turned
        jacobian[1, column] = velocity_change.real + turned * speed * velocity.imag
        jacobian[2, column] = velocity_change.imag - turned * speed
    return jacobian


@kernel
def _invariants(matrix):
    """Sum of the principal minors of order two and determinant of a matrix of shape (3, 3)."""
    minors = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        minors += matrix[j, j] * matrix[k, k] - matrix[j, k] * matrix[k, j]
    determinant = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        determinant += matrix[0, i] * (matrix[1, j] * matrix[2, k] - matrix[1, k] * matrix[2, j])
    return minors, determinant


@kernel
def radial_course(gamma, omega, mu, d, period, speed, time):
    """``Re(Ū U̇)`` and ``r² − 1`` of a single-impact orbit at a time since the impact."""
    first, second, rest, driven, driving = _flight(gamma, omega, mu, d, period, speed)
    outward, _, _, excess = _radial(first, second, rest, driven, driving, time)
    return outward, excess


@kernel
def radial_rates(gamma, omega, mu, d, period, speed, times):
    """``Re(Ū U̇)`` of a single-impact orbit at times (m,) since the impact, shape (m,)."""
    first, second, rest, driven, driving = _flight(gamma, omega, mu, d, period, speed)
    rates = np.empty(times.shape[0])
    for i in range(times.shape[0]):
        rates[i], _, _, _ = _radial(first, second, rest, driven, driving, times[i])
    return rates


@kernel
def radial_profile(gamma, omega, mu, d, period, speed):
    """:func:`flight_profile` of a single-impact orbit; its parameters are those of :func:`orbit_conditions`."""
    first, second, rest, driven, driving = _flight(gamma, omega, mu, d, period, speed)
    return flight_profile(first, second, rest, driven, driving, d, period, speed)


@kernel
def flight_profile(first, second, rest, driven, driving, d, period, speed):
    """Course of the radius between the impacts of an orbit with one impact a period.

    Parameters
    ----------
    first, second : complex
        Exponents ``λ₋, λ₊``.
    rest, driven, driving : complex
        Contact-free equilibrium, and amplitudes just after the impact.
    d, period, speed : float
        Restitution, period, and radial speed before the impact.

    Returns
    -------
    height, top : float
        Largest ``r² − 1`` of the local maxima inside the period, and its time; ``nan`` if there is none.
    flattest : float
        Product of ``x/(1 + |x|)`` over all inflections of ``r²``, with ``x = s(T/t)²`` from the time ``t`` and the slope ``s``
        there.  It passes through zero where a maximum and a minimum of the radius are born.  Its sign is such that it does not change where
        an inflection passes an end of the flight; without rebound it may jump where one passes the impact.
    """
    fastest = max(abs(first), abs(second))
    count = 48 + int(10.0 * fastest * period)
    step = period / count
    height, top, flattest = np.nan, np.nan, 1.0
    _, bend, _, _ = _radial(first, second, rest, driven, driving, 0.0)
    # The slope is −d ṙ at the beginning and ṙ at the end: an inflection that leaves by the end where it is negative takes a sign along.
    beginning = bend
    # Exact: without rebound (d = 0), rounding could make it positive and create a maximum at the impact itself.
    slope = -d * speed
    for i in range(1, count + 1):
        time = i * step
        next_slope, next_bend, _, _ = _radial(first, second, rest, driven, driving, time)
        if bend * next_bend < 0.0:
            turning = _zero(first, second, rest, driven, driving, time - step, time, 1)
            flat, _, _, _ = _radial(first, second, rest, driven, driving, turning)
            steepness = flat * (period / turning) ** 2
            flattest *= steepness / (1.0 + abs(steepness))
            # A maximum may hide between the inflection and the end of the step.
            if slope > 0.0 > flat or flat > 0.0 > next_slope:
                low, high = (time - step, turning) if slope > 0.0 > flat else (turning, time)
                place = _zero(first, second, rest, driven, driving, low, high, 0)
                _, _, _, tall = _radial(first, second, rest, driven, driving, place)
                if not tall <= height:
                    height, top = tall, place
        elif slope > 0.0 > next_slope:
            place = _zero(first, second, rest, driven, driving, time - step, time, 0)
            _, _, _, tall = _radial(first, second, rest, driven, driving, place)
            if not tall <= height:
                height, top = tall, place
        slope, bend = next_slope, next_bend
    if (d > 0.0 and beginning < 0.0) if speed > 0.0 else (bend > 0.0):
        flattest = -flattest
    return height, top, flattest


@kernel
def _flight(gamma, omega, mu, d, period, speed):
    """Exponents, equilibrium and amplitudes (driven, driving) of the flight that follows the impact at ``U = 1``."""
    first, second = planar_exponents(gamma, omega)
    a12, a22, _, _ = returns(first, second, period)
    q = sliding_factor(mu, d)
    rest = 1.0 + q * a12 * speed
    driven = 1.0 - rest
    driving = speed * (complex(1.0, -(q * a22).imag) - q) - second * driven
    return first, second, rest, driven, driving


@kernel
def _radial(first, second, rest, driven, driving, time):
    """``Re(Ū U̇)``, its first and second derivative, and ``r² − 1`` at a time."""
    growth, response, decay = propagator(first, second, time)
    change = driven * growth + driving * response
    late = driving * decay
    position = rest + change
    velocity = second * change + late
    acceleration = second * velocity + first * late
    jerk = second * acceleration + first * first * late
    outward = (position.conjugate() * velocity).real
    bend = squared_modulus(velocity) + (position.conjugate() * acceleration).real
    twist = 3.0 * (velocity.conjugate() * acceleration).real + (position.conjugate() * jerk).real
    return outward, bend, twist, squared_modulus(position) - 1.0


@kernel
def _zero(first, second, rest, driven, driving, low, high, order):
    """Where the derivative of this order of ``Re(Ū U̇)`` changes sign, by Newton's method kept inside the bracket."""
    values = _radial(first, second, rest, driven, driving, low)
    rising = values[0] < 0.0 if order == 0 else values[1] < 0.0
    time = 0.5 * (low + high)
    for _ in range(_NEWTON_STEPS):
        slope, bend, twist, _ = _radial(first, second, rest, driven, driving, time)
        value, rate = (slope, bend) if order == 0 else (bend, twist)
        if (value >= 0.0) == rising:
            high = time
        else:
            low = time
        guess = time - value / rate if rate != 0.0 else low
        if not low < guess < high:
            guess = 0.5 * (low + high)
        if abs(guess - time) <= 4e-16 * time:
            break
        time = guess
    return time
