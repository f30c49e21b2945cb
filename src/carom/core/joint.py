"""Impacts of several stations in one instant, resolved together.

With the local velocities ``u_p = ṙ_p + iθ̇_p`` of the stations at their walls and local impulses ``π_p = −P_p + iF_p``, each per
effective mass of its station, an impact changes the velocities by

    u⁺_p = u⁻_p + Σ_q A_pq π_q,    A_pq = ȳ_p G_pq y_q/(|y_p| |y_q|),    G = WMB.

The laws hold at every station at once.  *Newton's restitution* for several contacts (Moreau 1988): ``ṙ⁺ ≤ −d max(ṙ⁻, 0)``, ``P ≥ 0``,
and one of the two is an equality.  Friction: ``|F| ≤ μP``; the slip ``v⁺`` vanishes, or ``F = −μP sgn v⁺``.  For a station alone that is
the law of :func:`carom.core.friction.rebound`.

Friction changes the speed of a shaft that may change it too: with ``Δσ = Σ_q h_q F_q`` and ``ε = ȳep`` of :mod:`carom.core.shaft` the
velocities change by ``i(s_p − ε_p)Δσ`` more, where the imaginary part of ``u`` now counts that of the surface.  Of a race that turns it
counts that of the race too, and ``A_pp`` gains ``g_p`` for friction (:mod:`carom.core.surfaces`).

The impulses do the work ``Σ m (−P(ṙ⁻ + ṙ⁺) + F(v⁻ + v⁺))/2`` on the contact points.  Where Newton's restitution would make that
positive, *Poisson's* is used: a compression with ``ṙ ≤ 0`` and the impulses ``P_c``, then an expansion with at least ``d P_c``, and
friction as before in both.  Compression loses energy always.  Where the expansion gains more, which may be with
unequal restitutions, its ``d`` is lowered until the energy stays the same.

Every way in which the laws can hold (pressed or not, slip forward, backward or stopped) gives linear equations.  All are tried: six to
the power of the number of stations, which are few.  With strong friction several may hold; then the impulses are those that lose most.
"""

from __future__ import annotations

import math

from carom.core.compiling.decorators import inlined, kernel
from carom.core.equations import solve
from carom.core.flow import displacement, squared_modulus, velocity
from carom.core.friction import BACKWARD, FORWARD, STOPPED, friction_ratio, rebound, slip_of
from carom.core.laws.choice import impulse_by_restitution
from carom.core.phases import AWAY, ROLLING, lasts, sense_of_phase
from carom.core.rub import is_at_wall
from carom.core.shaft import change_speed, lever_of_shaft
from carom.core.surfaces import relative_excess, turn_race
from carom.core.wall import is_compliant, push_station, unit, wall_of

EXACT = 1e-11
"""Error, relative to the largest speeds and impulses, that rounding may leave in the inequalities."""
ROUNDING = 64 * 2.220446049250313e-16
NO_GAIN = 1e-11
"""Work, relative to the sum of the moduli of its terms, that counts as none."""
HALVINGS = 60
ONE_INSTANT = 1e-12
"""Distance from its wall within which a station has its impact together with another: that within which a start counts as on the wall."""
SENSES = (FORWARD, BACKWARD, STOPPED)
KINDS = 2 * len(SENSES)
"""Ways in which the laws of a station can hold: with an impulse above the least one or not, and with each sense of the slip."""


@kernel
def join(rotor, contact, impacting, amplitudes, rub):
    """Find the stations at their walls when one has an impact, in ``rub.joined``; return whether there are others."""
    others = False
    for station in range(rotor.rows.shape[0]):
        near = 1.0 - squared_modulus(displacement(rotor, station, amplitudes)) <= 2.0 * ONE_INSTANT
        at_wall = station == impacting or contact[station] != AWAY or near or is_at_wall(rotor, station, amplitudes)
        at_wall = at_wall and not is_compliant(rotor, station)
        rub.joined[station] = at_wall
        others = others or (at_wall and station != impacting)
    return others


@kernel
def joint_impact(rotor, before, after, rub):
    """Impact of the stations in ``rub.joined``: the state after from the state before."""
    stations = rotor.rows.shape[0]
    _load(rotor, before, rub)
    for p in range(stations):
        rub.aims[p] = -rebound(max(rub.approaches[p].real, 0.0), wall_of(rotor, p))
        rub.least[p] = 0.0
        rub.local[p] = rub.approaches[p]
    if not _resolve(rotor, rub) or _gains(rotor, rub):
        _resolve_by_poisson(rotor, rub)
    for k in range(after.shape[0]):
        after[k] = before[k]
    for p in range(stations):
        if rub.joined[p]:
            change = unit(displacement(rotor, p, before)) * rub.impulses[p]
            push_station(rotor, p, change, after, after)
            turn_race(rotor, p, rub.impulses[p].imag, after)
            if rotor.shaft.shape[0] > 0:
                change_speed(rotor, p, rub.impulses[p].imag, after)


@kernel
def land_together(rotor, contact, station, amplitudes, rub):
    """Put a station to rest on its wall, in place, while those in lasting contact stay on theirs.

    Their forces hold these, so their impulses may have either sign.  Friction is that of :func:`carom.core.advance.advance` for a
    landing: along the slip, as the impulse is outward, and no more than the slip.
    """
    _load(rotor, amplitudes, rub)
    slip = slip_of(rub.approaches[station], wall_of(rotor, station))
    for p in range(rotor.rows.shape[0]):
        rub.joined[p] = p == station or (lasts(contact[p]) and not is_compliant(rotor, p))
    share = math.copysign(rotor.friction[station], slip)
    if not _set_landing(rotor, contact, station, share, 0.0, rub):
        # stations that always move alike: one of them is enough
        for p in range(rotor.rows.shape[0]):
            rub.joined[p] = p == station
        _set_landing(rotor, contact, station, share, 0.0, rub)
    if abs(rub.matrix[2 * station + 1, -1]) > abs(slip):
        _set_landing(rotor, contact, station, 0.0, slip, rub)
    for p in range(rotor.rows.shape[0]):
        if rub.joined[p]:
            impulse = complex(-rub.matrix[2 * p, -1], rub.matrix[2 * p + 1, -1])
            change = unit(displacement(rotor, p, amplitudes)) * impulse
            push_station(rotor, p, change, amplitudes, amplitudes)
            turn_race(rotor, p, impulse.imag, amplitudes)
            if rotor.shaft.shape[0] > 0:
                change_speed(rotor, p, impulse.imag, amplitudes)


@kernel
def _set_landing(rotor, contact, station, share, grip, rub):
    """Solve for the impulses of a landing, with a friction of ``grip − share P`` at its station; return whether there are any."""
    last = rub.matrix.shape[1] - 1
    rub.matrix[:] = 0.0
    for p in range(rotor.rows.shape[0]):
        rub.matrix[2 * p, 2 * p], rub.matrix[2 * p + 1, 2 * p + 1] = 1.0, 1.0
        if not rub.joined[p]:
            continue
        rolls = p != station and contact[p] == ROLLING
        for q in range(rotor.rows.shape[0]):
            if rub.joined[q]:
                _write_coupling(rotor, p, q, True, rolls, rub)
        rub.matrix[2 * p, last] = rub.approaches[p].real
        if p == station:
            rub.matrix[2 * p + 1, 2 * p], rub.matrix[2 * p + 1, last] = share, grip
        elif rolls:
            rub.matrix[2 * p + 1, last] = -slip_of(rub.approaches[p], wall_of(rotor, p))
        else:
            rub.matrix[2 * p + 1, 2 * p] = -friction_ratio(sense_of_phase(contact[p]), wall_of(rotor, p))
    return solve(rub.matrix)


@inlined
def _write_coupling(rotor, p, q, radially, along, rub):
    """Write what the impulses at station ``q`` change at station ``p``: of ``ṙ`` into the first of its equations, of the slip into the second."""
    matrix, coupling = rub.matrix, rub.couplings[p, q]
    if radially:
        matrix[2 * p, 2 * q], matrix[2 * p, 2 * q + 1] = coupling.real, coupling.imag
    if along:
        matrix[2 * p + 1, 2 * q], matrix[2 * p + 1, 2 * q + 1] = -coupling.imag, coupling.real
        if p == q:
            matrix[2 * p + 1, 2 * p + 1] += rotor.race_gain[p]
    if rotor.shaft.shape[0] > 0:
        by_friction = rub.levers[p] * rotor.shaft_gain[q]
        matrix[2 * p, 2 * q + 1] -= by_friction.real if radially else 0.0
        matrix[2 * p + 1, 2 * q + 1] += by_friction.imag if along else 0.0


@inlined
def _change(rotor, p, q, impulse, rub):
    """Change of the local velocity of station ``p`` by an impulse at station ``q``, with those of the speeds of shaft and race."""
    change = rub.couplings[p, q] * impulse
    if p == q:
        change += complex(0.0, rotor.race_gain[p] * impulse.imag)
    if rotor.shaft.shape[0] > 0:
        change += rub.levers[p] * (rotor.shaft_gain[q] * impulse.imag)
    return change


@inlined
def _load(rotor, before, rub):
    """Local velocities ``u⁻`` and the matrix ``A``."""
    for p in range(rotor.rows.shape[0]):
        normal = unit(displacement(rotor, p, before))
        rub.approaches[p] = normal.conjugate() * velocity(rotor, p, before)
        rub.approaches[p] += complex(0.0, relative_excess(rotor, p, before))
        if rotor.shaft.shape[0] > 0:
            rub.levers[p] = lever_of_shaft(rotor, p, normal, before)
        for q in range(rotor.rows.shape[0]):
            other = unit(displacement(rotor, q, before))
            rub.couplings[p, q] = normal.conjugate() * rotor.mobility[p, q] * other


@kernel
def _resolve_by_poisson(rotor, rub):
    """Impulses by Poisson's restitution, lowered where it would gain energy too."""
    high, low = 1.0, 0.0
    if _compress_and_expand(rotor, high, rub) and not _gains(rotor, rub):
        return
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        if _compress_and_expand(rotor, share, rub) and not _gains(rotor, rub):
            low = share
        else:
            high = share
    _compress_and_expand(rotor, low, rub)


@kernel
def _compress_and_expand(rotor, share, rub):
    """Impulses by Poisson's restitution with a share of the coefficients of restitution; return whether they obey the laws."""
    stations = rotor.rows.shape[0]
    for p in range(stations):
        rub.aims[p], rub.least[p] = 0.0, 0.0
        rub.local[p] = rub.approaches[p]
    compressed = _resolve(rotor, rub)
    for p in range(stations):
        rub.compression[p] = rub.impulses[p]
        rub.least[p] = -share * _restitution(rub.approaches[p].real, wall_of(rotor, p)) * rub.impulses[p].real
    expanded = _resolve(rotor, rub)
    for p in range(stations):
        rub.impulses[p] += rub.compression[p]
    return compressed and expanded


@inlined
def _restitution(speed, wall):
    """Coefficient of restitution of an impact with this speed."""
    return wall.restitution * (impulse_by_restitution(speed, wall) / speed) if speed > 0.0 else wall.restitution


@kernel
def _gains(rotor, rub):
    """Whether the impulses do positive work on the contact points."""
    work, terms = _work(rotor, rub.approaches, rub.local, rub.impulses, rub)
    return work > NO_GAIN * terms


@inlined
def _work(rotor, before, after, impulses, rub):
    """Work of impulses on the contact points, and the sum of the moduli of its terms."""
    work, terms = 0.0, 0.0
    for p in range(rotor.rows.shape[0]):
        if rub.joined[p]:
            normal = 0.5 * rotor.masses[p] * impulses[p].real
            along = (
                0.5
                * rotor.masses[p]
                * impulses[p].imag
                * (2.0 * rotor.surface_speed[p] + before[p].imag + after[p].imag)
            )
            work += normal * (before[p].real + after[p].real) + along
            terms += abs(normal) * (abs(before[p].real) + abs(after[p].real)) + abs(along)
    return work, terms


@kernel
def _resolve(rotor, rub):
    """Find the impulses that obey the laws at every station, from the velocities in ``rub.local``, which become those after.

    ``rub.aims`` and ``rub.least`` bound ``ṙ`` from above and ``P`` from below.  Returns whether any obey them; otherwise those are
    taken that come nearest.
    """
    stations = rotor.rows.shape[0]
    found, best, nearest = False, 0.0, math.inf
    for p in range(stations):
        rub.impulses[p] = 0j
    for way in range(KINDS**stations):
        if not (_set_equations(rotor, way, rub) and solve(rub.matrix)):
            continue
        error = _violation(rotor, rub)
        work, _ = _work(rotor, rub.local, rub.tried_after, rub.tried, rub)
        valid = error <= EXACT
        if (valid and (not found or work < best)) or (not found and error < nearest):
            found, best, nearest = valid, work, error
            for p in range(stations):
                rub.impulses[p] = rub.tried[p]
    for p in range(stations):
        for q in range(stations):
            rub.local[p] += _change(rotor, p, q, rub.impulses[q], rub)
    return found


@inlined
def _set_equations(rotor, way, rub):
    """Write two linear equations of each station for the impulses if the laws hold in a given way; return whether that can be.

    A station without impulse has one way only, and so has one that is not at its wall.
    """
    stations = rotor.rows.shape[0]
    last = 2 * stations
    rub.matrix[:] = 0.0
    for p in range(stations):
        kind = way % KINDS
        pressed, sense = kind >= len(SENSES), SENSES[kind % len(SENSES)]
        way //= KINDS
        if not pressed and sense != SENSES[0] and rub.least[p] == 0.0:
            return False
        if not rub.joined[p] and kind != 0:
            return False
        rub.matrix[2 * p, 2 * p], rub.matrix[2 * p + 1, 2 * p + 1] = 1.0, 1.0
        rub.matrix[2 * p, last] = rub.least[p]
        for q in range(stations):
            if rub.joined[q]:
                _write_coupling(rotor, p, q, pressed, sense == STOPPED, rub)
        if pressed:
            rub.matrix[2 * p, last] = rub.local[p].real - rub.aims[p]
        if sense == STOPPED:
            rub.matrix[2 * p + 1, last] = -slip_of(rub.local[p], wall_of(rotor, p))
        else:
            rub.matrix[2 * p + 1, 2 * p] = -friction_ratio(sense, wall_of(rotor, p))
    return True


@inlined
def _violation(rotor, rub):
    """Largest violation of the inequalities by the solution in ``rub.matrix``, relative; infinite if there was none.

    Fills ``rub.tried`` and ``rub.tried_after``, the impulses and the velocities that they lead to.
    """
    stations = rotor.rows.shape[0]
    last = 2 * stations
    wrong, size = 0.0, 0.0
    for p in range(stations):
        rub.tried[p] = complex(-rub.matrix[2 * p, last], rub.matrix[2 * p + 1, last])
    for p in range(stations):
        if not rub.joined[p]:
            continue
        after = rub.local[p]
        for q in range(stations):
            after += _change(rotor, p, q, rub.tried[q], rub)
        rub.tried_after[p] = after
        push, grip, slip = -rub.tried[p].real, rub.tried[p].imag, slip_of(after, wall_of(rotor, p))
        size = max(size, abs(rub.local[p].real) + abs(push) + abs(grip))
        wrong = max(wrong, rub.least[p] - push, after.real - rub.aims[p], abs(grip) - rotor.friction[p] * push)
        # Friction must not push along the slip; a slip that is stopped is zero to the rounding of its terms.
        slipping = abs(slip) - ROUNDING * (abs(rotor.surface_speed[p]) + abs(after.imag))
        wrong = max(wrong, min(slipping, grip if slip > 0.0 else -grip))
    return wrong / size if 0.0 < size < math.inf else math.inf
