"""Contact that lasts: sliding and rolling on the wall, by Taylor series of the constrained motion.

With ``|y| = 1`` and ``Re(ȳẏ) = 0`` a contact force ``f`` (per unit of the mass felt at the plane) acts as
``ċ = Mc + Bf``.  Writing ``a`` for the free acceleration ``WM²c``, staying on the wall needs the normal force

    N = Re(ȳ a) + |ẏ|²,

and the force is ``f = −(1 + iμ sgn v) N y`` while the contact point slips with ``v = drive + Im(ȳẏ)``, and
``f = −drive² y − a`` while it rolls (``ẏ = −i drive y``).  Products of series are all this needs, so the coefficients
follow from a recurrence and a step costs the same for any rotor.  For the planar rotor it is
``θ̈ = −γ(1 + θ̇) − ρ sin(θ − φ) − μN sgn v`` with ``N = ρ cos(θ − φ) + (1 + θ̇)² − ω²``.

A phase lasts while its margins (normal force, slip, distance from the limit of the friction cone) stay above minus
their rounding error.  When a margin falls below, the phase ends at the last zero before that.  So a margin that is zero
at the start of a phase ends it only if it then falls.  Such a margin is the slip where rolling ends, or the normal
force where a rotor lifts off.  Two phases can therefore not pass a state back and forth.
"""

from __future__ import annotations

import math

import numpy as np

from carom.core.flow import acceleration, displacement, flight_increments, squared_modulus, velocity
from carom.core.impact import set_on_wall, unit
from carom.core.layout import ORDER, kernel, part
from carom.outcome import Phase

__all__ = [
    "first_transition",
    "fly_or_rub_all",
    "lift_off",
    "next_phase",
    "push_rounding",
    "rest_on_wall",
    "rub_series",
    "rub_step",
    "speed_rounding",
    "sum_series",
    "turn_ahead",
    "wall_push",
]


LEAVING, FORWARD_SLIP, BACKWARD_SLIP, ROLLING = (
    int(Phase.FLIGHT),
    int(Phase.FORWARD_SLIP),
    int(Phase.BACKWARD_SLIP),
    int(Phase.ROLLING),
)

STEP_FRACTION = 0.135
"""Ratio of step to radius of convergence: ``0.135^ORDER`` is below rounding."""
ROUNDING = 64 * 2.220446049250313e-16
"""Rounding error of a sum over the modes, relative to the moduli of its terms."""
NO_TURN = 1e-15
"""Distance along the wall that counts as zero."""
NEWTON_STEPS = 8
"""Far more steps than needed for a zero that is not blurred by rounding."""


@kernel
def rub_series(rotor, plane, amplitudes, phase, work):
    """Fill the Taylor coefficients of a lasting contact, or of a flight, that starts with these amplitudes.

    ``work.series`` (ORDER + 1, N) receives those of the amplitudes, ``work.push`` those of the normal force,
    ``work.grip`` those of the friction force along growing angle and ``work.slip`` those of the slip velocity.
    """
    modes = amplitudes.shape[0]
    friction = rotor.friction[plane]
    drive = rotor.drive[plane]
    slope = -friction if phase == FORWARD_SLIP else friction
    for m in range(modes):
        work.series[0, m] = amplitudes[m]
    for k in range(ORDER + 1):
        position, speed, free = 0j, 0j, 0j
        for m in range(modes):
            position += rotor.rows[plane, m] * work.series[k, m]
            speed += rotor.rate_rows[plane, m] * work.series[k, m]
            free += rotor.acceleration_rows[plane, m] * work.series[k, m]
        work.position[k] = position + rotor.offsets[plane] if k == 0 else position
        work.speed[k] = speed
        work.free[k] = free
        push, slip = 0.0, drive if k == 0 else 0.0
        for j in range(k + 1):
            y, v = work.position[j], work.speed[j]
            push += (y.conjugate() * work.free[k - j]).real + (v.conjugate() * work.speed[k - j]).real
            slip += (y.conjugate() * work.speed[k - j]).imag
        work.push[k] = push
        work.slip[k] = slip
        force = 0j
        if phase == ROLLING:
            force = -drive * drive * work.position[k] - free
        elif phase != LEAVING:
            for j in range(k + 1):
                force -= work.push[j] * work.position[k - j]
            force *= complex(1.0, -slope)
        work.force[k] = force
        grip = 0.0
        for j in range(k + 1):
            grip += (work.position[j].conjugate() * work.force[k - j]).imag
        work.grip[k] = grip
        if k < ORDER:
            for m in range(modes):
                rate = rotor.exponents[m] * work.series[k, m] + rotor.columns[m, plane] * force
                if rotor.driven[m]:
                    rate += work.series[k, m - 1]
                work.series[k + 1, m] = rate / (k + 1)


@kernel
def rub_step(work):
    """Step with a truncation error below rounding, from the last two coefficients (Jorba and Zou 2005)."""
    modes = work.series.shape[1]
    start, last, before = 0.0, 0.0, 0.0
    for m in range(modes):
        start = max(start, abs(work.series[0, m]))
        last = max(last, abs(work.series[ORDER, m]))
        before = max(before, abs(work.series[ORDER - 1, m]))
    scale = max(start, 1.0)
    radius = math.inf
    if last > 0.0:
        radius = (scale / last) ** (1.0 / ORDER)
    if before > 0.0:
        radius = min(radius, (scale / before) ** (1.0 / (ORDER - 1)))
    return min(STEP_FRACTION * radius, 1.0)


@kernel
def sum_series(work, time, amplitudes):
    """Amplitudes at a time within the step."""
    for m in range(amplitudes.shape[0]):
        total = work.series[ORDER, m]
        for k in range(ORDER - 1, -1, -1):
            total = total * time + work.series[k, m]
        amplitudes[m] = total


@kernel
def fly_or_rub_all(rotor, plane, amplitudes, phases, times, work):
    """Amplitudes (M, N) after given times (M,), each in its own phase (M,) from its own amplitudes (M, N)."""
    moved = np.empty_like(amplitudes)
    for i in range(times.shape[0]):
        if phases[i] == LEAVING:
            flight_increments(rotor, amplitudes[i : i + 1], times[i], moved[i : i + 1])
            for m in range(amplitudes.shape[1]):
                moved[i, m] += amplitudes[i, m]
        else:
            rub_series(rotor, plane, amplitudes[i], phases[i], work)
            sum_series(work, times[i], moved[i])
    return moved


@kernel
def first_transition(rotor, plane, phase, step, work):
    """First time within a step at which the kind of contact changes, and the phase that follows.

    Sliding ends where the normal force vanishes (flight follows) or the slip vanishes; rolling ends where the friction
    it needs leaves the cone.

    Returns
    -------
    time : float
        The step itself if nothing changes.
    phase : int
        The phase that follows; the same if nothing changes, or if the slip vanishes and :func:`next_phase` must decide.
    slip_stops : bool
    """
    friction = rotor.friction[plane]
    rounding = push_rounding(rotor, plane, work.series[0])
    first = _first_fall(work.push, step, rounding)
    following = LEAVING if first < step else phase
    if phase == ROLLING:
        for k in range(ORDER + 1):
            work.first_margin[k] = friction * work.push[k] - work.grip[k]
            work.second_margin[k] = friction * work.push[k] + work.grip[k]
        rounding *= 1.0 + friction
        backward = _first_fall(work.first_margin, first, rounding)
        forward = _first_fall(work.second_margin, backward, rounding)
        if forward < backward:
            return forward, FORWARD_SLIP, False
        if backward < first:
            return backward, BACKWARD_SLIP, False
        return first, following, False
    sign = -1.0 if phase == BACKWARD_SLIP else 1.0
    for k in range(ORDER + 1):
        work.first_margin[k] = sign * work.slip[k]
    stop = _first_fall(work.first_margin, first, speed_rounding(rotor, plane, work.series[0]))
    if stop < first:
        return stop, phase, True
    return first, following, False


@kernel
def lift_off(rotor, plane, amplitudes, horizon, work):
    """Follow a flight that starts at rest on the wall, in place, to its return or to the end of a Taylor step.

    There ``|y|² − 1 = 2∬N`` with ``N = Re(ȳÿ) + |ẏ|²``, so the series of ``N`` gives the distance from the wall without
    cancellation, even for a departure as slow as ``N't³/3``.

    Returns
    -------
    time : float
        Zero if it does not leave at all.
    returned : bool
        Whether it is back on the wall.
    """
    rub_series(rotor, plane, amplitudes, int(LEAVING), work)
    step = min(rub_step(work), horizon)
    for k in range(ORDER + 1):
        work.first_margin[k] = -2.0 * work.push[k] / ((k + 1) * (k + 2))
    time = _first_fall(work.first_margin, step, push_rounding(rotor, plane, amplitudes))
    sum_series(work, time, amplitudes)
    returned = time < step
    if returned:
        set_on_wall(rotor, plane, amplitudes)
    return time, returned


@kernel
def turn_ahead(reference, direction, step, work):
    """Time within a step at which the rotor next passes a reference position in the given direction, or the step."""
    for k in range(ORDER + 1):
        work.first_margin[k] = -direction * (reference.conjugate() * work.position[k]).imag
    return _first_fall(work.first_margin, step, NO_TURN)


@kernel
def rest_on_wall(rotor, plane, amplitudes, rolling):
    """Remove the rounding errors of ``|y| = 1`` and ``Re(ȳẏ) = 0``, and those of the rolling condition if it rolls."""
    set_on_wall(rotor, plane, amplitudes)
    normal = unit(displacement(rotor, plane, amplitudes))
    local = normal.conjugate() * velocity(rotor, plane, amplitudes)
    change = complex(-local.real, -(rotor.drive[plane] + local.imag) if rolling else 0.0) * normal
    for m in range(amplitudes.shape[0]):
        amplitudes[m] += rotor.columns[m, plane] * change


@kernel
def _first_fall(margin, step, rounding):
    """Time within a step at which a polynomial margin falls through zero, or the step; certified for the polynomial.

    That is the last zero before it first falls below minus its rounding error; zero if it is negative up to there.
    """
    reach, curvature = 0.0, 0.0
    power = 1.0
    for k in range(1, ORDER + 1):
        power *= step
        reach += abs(margin[k]) * power
        curvature += k * (k - 1) * abs(margin[k]) * power
    if margin[0] + rounding > reach:
        return step
    curvature /= step * step
    time, value, slope = 0.0, margin[0], margin[1]
    while value > -rounding:
        height = value + rounding
        root = math.sqrt(slope * slope + 2.0 * curvature * height)
        if slope <= 0.0:
            advance = 2.0 * height / (root - slope) if root > slope else step
        else:
            advance = (root + slope) / curvature if curvature > 0.0 else step
        if time + advance >= step:
            return step
        if time + advance <= time * (1.0 + 4e-16):
            break
        time += advance
        value, slope = _value_and_slope(margin, time)
    return _zero_before(margin, time)


@kernel
def _zero_before(margin, time):
    """Last zero of a margin before a time at which it is below minus its rounding error, or 0."""
    latest = time
    for _ in range(NEWTON_STEPS):
        value, slope = _value_and_slope(margin, time)
        if slope >= 0.0:
            return time
        before = time
        time = min(max(time - value / slope, 0.0), latest)
        if abs(time - before) <= 2e-16 * time:
            break
    return time


@kernel
def _value_and_slope(margin, time):
    value, slope = margin[ORDER], 0.0
    for k in range(ORDER - 1, -1, -1):
        slope = slope * time + value
        value = value * time + margin[k]
    return value, slope


@part
def speed_rounding(rotor, plane, amplitudes):
    """Rounding error of the radial speed and the speed along the wall."""
    speed = 1.0
    for m in range(amplitudes.shape[0]):
        speed += _size(rotor.rate_rows[plane, m] * amplitudes[m])
    return ROUNDING * _spread(rotor, plane, amplitudes) * speed


@kernel
def push_rounding(rotor, plane, amplitudes):
    """Rounding error of the normal force, including that of the position, which dominates near the equilibrium."""
    force = squared_modulus(velocity(rotor, plane, amplitudes))
    for m in range(amplitudes.shape[0]):
        row = rotor.acceleration_rows[plane, m]
        force += _size(row * amplitudes[m]) + _size(row * rotor.rows[plane, m]) / rotor.weights[plane]
    return ROUNDING * _spread(rotor, plane, amplitudes) * force


@part
def _spread(rotor, plane, amplitudes):
    """Sum of the sizes of the terms of a displacement of modulus one, on the wall: a measure of their cancellation."""
    spread = _size(rotor.offsets[plane])
    for m in range(amplitudes.shape[0]):
        spread += _size(rotor.rows[plane, m] * amplitudes[m])
    return spread


@part
def _size(z):
    """Bound of ``|z|``."""
    return abs(z.real) + abs(z.imag)


@kernel
def wall_push(rotor, plane, amplitudes):
    """Normal force that keeps a rotor at rest against the wall, and its rate at zero force."""
    position = unit(displacement(rotor, plane, amplitudes))
    speed = velocity(rotor, plane, amplitudes)
    free, jerk = 0j, 0j
    for m in range(amplitudes.shape[0]):
        rate = rotor.exponents[m] * amplitudes[m]
        if rotor.driven[m]:
            rate += amplitudes[m - 1]
        free += rotor.acceleration_rows[plane, m] * amplitudes[m]
        jerk += rotor.acceleration_rows[plane, m] * rate
    inward = (position.conjugate() * free).real
    turning = (position.conjugate() * speed).imag
    change = (position.conjugate() * jerk).real + 3.0 * (speed.conjugate() * free).real
    return inward + turning * turning, change


@kernel
def next_phase(rotor, plane, amplitudes, phase):
    """Phase that follows from rest against the wall (``|y| = 1``, no radial speed, pressed outward).

    If the slip is zero, the rotor rolls if the friction needed for that lies within the cone.  Otherwise it slips in
    the direction of the tangential acceleration that friction cannot balance.  With ``μ = 0`` and no such acceleration,
    it continues to slip, in the direction opposite to that of the phase before.
    """
    position = unit(displacement(rotor, plane, amplitudes))
    speed = velocity(rotor, plane, amplitudes)
    slip = rotor.drive[plane] + (position.conjugate() * speed).imag
    if abs(slip) > speed_rounding(rotor, plane, amplitudes):
        return FORWARD_SLIP if slip > 0.0 else BACKWARD_SLIP
    push, _ = wall_push(rotor, plane, amplitudes)
    pull = (position.conjugate() * acceleration(rotor, plane, amplitudes)).imag
    missing = abs(pull) - rotor.friction[plane] * max(push, 0.0)
    if missing > push_rounding(rotor, plane, amplitudes):
        return FORWARD_SLIP if pull > 0.0 else BACKWARD_SLIP
    if rotor.friction[plane] > 0.0:
        return ROLLING
    return BACKWARD_SLIP if phase == FORWARD_SLIP else FORWARD_SLIP
