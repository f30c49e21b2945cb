"""Contact with a compliant wall, as Taylor series, and how long it stays the same.

With the radius ``r = |y|``, the outward normal ``n = y/r`` and the local velocity ``u = n̄ẏ = ṙ + iw``, a station is ``δ = r − 1`` deep in
the wall.  The law of the wall gives the normal force ``N`` from ``δ`` and ``δ̇ = ṙ`` (:mod:`carom.core.laws`), and with the friction
``F`` along growing angle the contact force is ``f = (−N + iF) n``.  The contact point slips with ``v = surface_speed + δ + w``, as it is
further out by ``δ`` in a frame that turns.  Since ``u̇ = n̄ÿ − iθ̇u``, rolling, ``v̇ = 0``, needs

    F = −ṙ + θ̇ṙ − Im(n̄a)

against the acceleration ``a`` without own force.

The race of a bearing may turn too.  With its radius ``R``, its inertia ``J``, its drag and the effective mass ``m`` at the station, its surface
speed ``q`` in the fixed frame, a mode of its own, decays with the exponent ``λ = −drag/J`` and is driven by friction,
``q̇ = λq − gF`` with ``g = mR²/J``.  The contact point then slips with ``v = surface_speed + δ + w − q``, and rolling needs

    (1 + g) F = −ṙ + θ̇ṙ + λq − Im(n̄a).

A shaft whose speed changes adds to the slip and to what rolling needs (:mod:`carom.core.shaft`).

All series follow from those of ``y`` and ``ẏ`` by recurrences: of ``r`` from ``r² = |y|²``, of ``n`` from ``r n = y``.
"""

from __future__ import annotations

import math

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import displacement, squared_modulus, velocity
from carom.core.friction import friction_ratio, slip_of
from carom.core.laws.choice import edge, force_coefficient, press_coefficient, press_rounding
from carom.core.layout import ORDER
from carom.core.phases import FLIGHT, ROLLING, SEPARATED, sense_of_phase
from carom.core.rounding import position_rounding, speed_rounding
from carom.core.surfaces import race_grip, relative_coefficient, relative_excess
from carom.core.taylor import first_fall
from carom.core.wall import push_station, set_on_wall, unit, wall_of

SHARP = 1e-4
"""Error of the place where a series takes another form, relative to its depth: there both forms are the same."""


@inlined
def indent(rotor, station, k, work):
    """Coefficients ``k`` of normal, depth, slip, normal force and its share of the force, from those of position and speed up to it.

    The depth is known one order ahead, as ``ẏ`` gives ``y`` there; so its rate needs no products.  Sums of one length share a loop:
    their terms do not wait for one another.
    """
    depth, normal, speed = work.depth[station], work.normal[station], work.speed[station]
    y = work.position[station]
    if k == 0:
        radius = math.sqrt(squared_modulus(y[0]))
        depth[0] = (squared_modulus(y[0]) - 1.0) / (radius + 1.0)
    radius, ahead = 1.0 + depth[0], speed[k] / (k + 1.0)
    square, products, direction = 2.0 * (y[0].conjugate() * ahead).real, 0.0, y[k]
    for j in range(1, k + 1):
        other = y[k + 1 - j]
        square += y[j].real * other.real + y[j].imag * other.imag
        products += depth[j] * depth[k + 1 - j]
        direction -= depth[j] * normal[k - j]
    depth[k + 1] = (square - products) / (2.0 * radius)
    # Of a complex number divided by zero Numba raises: a guess of an orbit may pass through the centre.
    normal[k] = complex(direction.real / radius, direction.imag / radius)
    work.rate[station, k] = (k + 1.0) * depth[k + 1]
    work.push[station, k] = force_coefficient(
        k, depth, work.rate[station], work.power[station], wall_of(rotor, station)
    )
    along, pressed = rotor.surface_speed[station] + depth[0] if k == 0 else depth[k], 0j
    along += relative_coefficient(rotor, station, k, work)
    for j in range(k + 1):
        along += normal[j].real * speed[k - j].imag - normal[j].imag * speed[k - j].real
        pressed += work.push[station, j] * normal[k - j]
    work.slip[station, k], work.pressed[station, k] = along, pressed


@inlined
def rolling_grip(rotor, station, k, work):
    """Coefficient ``k`` of the friction that lets a station roll, times ``1 + race_gain``, against its acceleration in ``work.free``."""
    turning = work.slip[station, k] - work.depth[station, k] - relative_coefficient(rotor, station, k, work)
    grip = race_grip(rotor, station, k, work) - work.rate[station, k]
    if k == 0:
        turning -= rotor.surface_speed[station]
    for j in range(1, k + 1):
        turning -= work.depth[station, j] * work.turning[station, k - j]
    work.turning[station, k] = turning / (1.0 + work.depth[station, 0])
    for j in range(k + 1):
        grip += work.turning[station, j] * work.rate[station, k - j]
        grip -= (work.normal[station, j].conjugate() * work.free[station, k - j]).imag
    return grip


@inlined
def force_in_wall(rotor, phase, station, k, work):
    """Coefficient ``k`` of the contact force, from those of normal force and friction."""
    if phase == ROLLING:
        along = 0j
        for j in range(k + 1):
            along += work.grip[station, j] * work.normal[station, k - j]
        return complex(-along.imag, along.real) - work.pressed[station, k]
    return complex(-1.0, friction_ratio(sense_of_phase(phase), wall_of(rotor, station))) * work.pressed[station, k]


@kernel
def first_release(rotor, station, phase, step, work):
    """First time within a step at which the station leaves the wall, parts from it or reaches it again, and the phase that follows.

    Returns
    -------
    time : float
        The step itself if nothing of this happens.
    phase : int
        ``FLIGHT``, or ``SEPARATED`` where the force vanishes before the depth does.  Of a separated station that reaches the wall again
        the same, as :func:`carom.core.rub.next_phase` must decide.
    met : bool
        Whether a separated station reaches the wall again.
    """
    state, wall = work.series[0], wall_of(rotor, station)
    of_depth, of_rate = position_rounding(rotor, station, state), speed_rounding(rotor, station, state)
    left = first_fall(work.depth[station], step, of_depth)
    sign = -1.0 if phase == SEPARATED else 1.0
    for k in range(ORDER + 1):
        work.first_margin[k] = sign * press_coefficient(k, work.depth[station], work.rate[station], wall)
    parted = first_fall(work.first_margin, left, press_rounding(of_depth, of_rate, wall))
    if parted < left:
        return parted, SEPARATED, phase == SEPARATED
    return left, (FLIGHT if left < step else phase), False


@kernel
def next_form(rotor, station, step, work):
    """First time within a step at which the series of a station's force takes another form, or the step."""
    at = edge(work.depth[station, 0], work.rate[station, 0], wall_of(rotor, station))
    if at == 0.0:
        return step
    sign = -1.0 if at > 0.0 else 1.0
    for k in range(ORDER + 1):
        work.first_margin[k] = sign * work.depth[station, k]
    work.first_margin[0] += at
    return first_fall(work.first_margin, step, SHARP * abs(at))


@kernel
def stay_in_wall(rotor, station, rolls, leaves, amplitudes):
    """Remove the rounding error of the rolling condition, and of ``|y| = 1`` where a station leaves its wall."""
    if leaves:
        set_on_wall(rotor, station, amplitudes)
    elif rolls:
        normal = unit(displacement(rotor, station, amplitudes))
        change = normal * complex(0.0, -slip_in_wall(rotor, station, amplitudes))
        push_station(rotor, station, change, amplitudes, amplitudes)


@inlined
def slip_in_wall(rotor, station, amplitudes):
    """Slip velocity of a station in a compliant wall."""
    position = displacement(rotor, station, amplitudes)
    radius = math.sqrt(squared_modulus(position))
    local = unit(position).conjugate() * velocity(rotor, station, amplitudes)
    return slip_of(local, wall_of(rotor, station)) + (radius - 1.0) + relative_excess(rotor, station, amplitudes)
