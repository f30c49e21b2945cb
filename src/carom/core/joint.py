"""Impacts of several planes in one instant, resolved together.

With the local velocities ``u_p = ṙ_p + iθ̇_p`` of the planes at their walls and local impulses ``π_p = −P_p + iF_p``, each per
effective mass of its plane, an impact changes the velocities by

    u⁺_p = u⁻_p + Σ_q A_pq π_q,    A_pq = ȳ_p G_pq y_q/(|y_p| |y_q|),    G = WMB.

The laws hold at every plane at once.  *Newton's restitution* for several contacts (Moreau 1988): ``ṙ⁺ ≤ −d max(ṙ⁻, 0)``, ``P ≥ 0``,
and one of the two is an equality.  Friction: ``|F| ≤ μP``; the slip ``v⁺`` vanishes, or ``F = −μP sgn v⁺``.  For a plane alone that is
the law of :func:`carom.core.impact.rebound`.

The impulses do the work ``Σ m (−P(ṙ⁻ + ṙ⁺) + F(v⁻ + v⁺))/2`` on the contact points.  Where Newton's restitution would make that
positive, *Poisson's* is used: a compression with ``ṙ ≤ 0`` and the impulses ``P_c``, then an expansion with at least ``d P_c``, and
friction as before in both.  Compression loses energy always.  Where the expansion gains more, which may be with
unequal restitutions, its ``d`` is lowered until the energy stays the same.
"""

from __future__ import annotations

import math

from carom.core.contact_series import AWAY, eliminate
from carom.core.flow import displacement, squared_modulus, velocity
from carom.core.impact import unit
from carom.core.layout import kernel, part
from carom.core.rub import meets_wall

FEW, MORE, MOST = 8, 8, 32_768
"""Sweeps before the linear equations are tried first, factor to the next try, and sweeps of the last run.

Sweeps find out which planes are pressed and where friction holds.  Then these equations give the impulses at once, while sweeps
alone would converge slowly between planes that are closely coupled.
"""
CONVERGED = 4.4e-16
"""Change of the impulses in a sweep, relative to the largest, that counts as rounding."""
EXACT = 1e-12
"""Error, relative to the largest speed and impulse, that a solution of the linear equations may leave in the inequalities."""
NO_GAIN = 1e-13
"""Work, relative to the sum of the moduli of its terms, that counts as none."""
HALVINGS = 60
ONE_INSTANT = 1e-12
"""Distance from its wall within which a plane strikes together with another: that within which a start counts as on the wall."""


@kernel
def join(rotor, contact, struck, amplitudes, rub):
    """Find the planes at their walls when one is struck, in ``rub.joined``; return whether there are others."""
    others = False
    for plane in range(rotor.rows.shape[0]):
        near = 1.0 - squared_modulus(displacement(rotor, plane, amplitudes)) <= 2.0 * ONE_INSTANT
        at_wall = plane == struck or contact[plane] != AWAY or near or meets_wall(rotor, plane, amplitudes)
        rub.joined[plane] = at_wall
        others = others or (at_wall and plane != struck)
    return others


@kernel
def strike_together(rotor, before, after, rub):
    """Impact of the planes in ``rub.joined``: the state after from the state before."""
    planes = rotor.rows.shape[0]
    _load(rotor, before, rub)
    for p in range(planes):
        rub.aims[p] = -rotor.restitution[p] * max(rub.arrivals[p].real, 0.0)
        rub.least[p] = 0.0
        rub.local[p], rub.impulses[p] = rub.arrivals[p], 0j
    _resolve(rotor, rub)
    if _gains(rotor, rub):
        _resolve_by_poisson(rotor, rub)
    for k in range(after.shape[0]):
        after[k] = before[k]
    for p in range(planes):
        if rub.joined[p]:
            change = unit(displacement(rotor, p, before)) * rub.impulses[p]
            for k in range(after.shape[0]):
                after[k] += rotor.columns[k, p] * change


@part
def _load(rotor, before, rub):
    """Local velocities ``u⁻`` and the matrix ``A``."""
    planes = rotor.rows.shape[0]
    for p in range(planes):
        normal = unit(displacement(rotor, p, before))
        rub.arrivals[p] = normal.conjugate() * velocity(rotor, p, before)
        for q in range(planes):
            other = unit(displacement(rotor, q, before))
            rub.couplings[p, q] = normal.conjugate() * rotor.mobility[p, q] * other


@kernel
def _resolve_by_poisson(rotor, rub):
    """Impulses by Poisson's restitution, lowered where it would gain energy too."""
    high, low = 1.0, 0.0
    _compress_and_expand(rotor, high, rub)
    if not _gains(rotor, rub):
        return
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        _compress_and_expand(rotor, share, rub)
        if _gains(rotor, rub):
            high = share
        else:
            low = share
    _compress_and_expand(rotor, low, rub)


@kernel
def _compress_and_expand(rotor, share, rub):
    """Impulses by Poisson's restitution with a share of the coefficients of restitution."""
    planes = rotor.rows.shape[0]
    for p in range(planes):
        rub.aims[p], rub.least[p] = 0.0, 0.0
        rub.local[p], rub.impulses[p] = rub.arrivals[p], 0j
    _resolve(rotor, rub)
    for p in range(planes):
        rub.compression[p] = rub.impulses[p]
        rub.least[p] = -share * rotor.restitution[p] * rub.impulses[p].real
        rub.impulses[p] = 0j
    _resolve(rotor, rub)
    for p in range(planes):
        rub.impulses[p] += rub.compression[p]


@kernel
def _gains(rotor, rub):
    """Whether the impulses do positive work on the contact points."""
    work, terms = 0.0, 0.0
    for p in range(rotor.rows.shape[0]):
        if rub.joined[p]:
            mean = 0.5 * (rub.arrivals[p] + rub.local[p])
            normal = rotor.masses[p] * rub.impulses[p].real * mean.real
            along = rotor.masses[p] * rub.impulses[p].imag * (rotor.drive[p] + mean.imag)
            work += normal + along
            terms += rotor.masses[p] * abs(rub.impulses[p].real) * (abs(rub.arrivals[p].real) + abs(rub.local[p].real))
            terms += abs(along)
    return work > NO_GAIN * terms


@kernel
def _resolve(rotor, rub):
    """Impulses from the velocities in ``rub.local``, which become those after; ``rub.aims`` and ``rub.least`` bound ``ṙ`` and ``P``."""
    sweeps = FEW
    while True:
        for _ in range(sweeps):
            change, size = _sweep(rotor, rub)
            if change <= CONVERGED * size:
                return
        if sweeps >= MOST or _solve_at_once(rotor, rub):
            return
        sweeps *= MORE


@kernel
def _sweep(rotor, rub):
    """Give each plane in turn the impulse that its own law asks for; return the largest change and impulse."""
    planes = rotor.rows.shape[0]
    largest, size = 0.0, 0.0
    for p in range(planes):
        if not rub.joined[p]:
            continue
        without = rub.local[p] - rub.impulses[p]
        push = max(without.real - rub.aims[p], rub.least[p])
        slip = rotor.drive[p] + without.imag
        grip = -math.copysign(min(rotor.friction[p] * push, abs(slip)), slip)
        change = complex(-push, grip) - rub.impulses[p]
        rub.impulses[p] += change
        for q in range(planes):
            rub.local[q] += rub.couplings[q, p] * change
        largest = max(largest, abs(change.real) + abs(change.imag))
        size = max(size, push + abs(grip))
    return largest, size


@kernel
def _solve_at_once(rotor, rub):
    """Solve the equations that the impulses obey if the inequalities hold as they do now; return whether they still do.

    If not, nothing changes.
    """
    planes = rotor.rows.shape[0]
    last = 2 * planes
    rub.matrix[:] = 0.0
    for p in range(planes):
        _equations_of(rotor, p, rub)
    eliminate(rub.matrix)
    size = 0.0
    for p in range(planes):
        size = max(size, abs(rub.matrix[2 * p, last]) + abs(rub.arrivals[p].real))
    holds = True
    for p in range(planes):
        if rub.joined[p]:
            holds = holds and _holds(rotor, p, EXACT * size, rub)
    if holds:
        for p in range(planes):
            solved = complex(-rub.matrix[2 * p, last], rub.matrix[2 * p + 1, last])
            change = solved - rub.impulses[p]
            rub.impulses[p] = solved
            for q in range(planes):
                rub.local[q] += rub.couplings[q, p] * change
    return holds


@part
def _presses(p, rub):
    """Whether the normal impulse of a plane is more than the least."""
    return -rub.impulses[p].real > rub.least[p]


@part
def _stops(rotor, p, rub):
    """Whether friction stops the slip of a plane."""
    return abs(rub.impulses[p].imag) < rotor.friction[p] * -rub.impulses[p].real


@part
def _equations_of(rotor, p, rub):
    """Write the two linear equations of a plane for the normal and friction impulses of all."""
    last = rub.matrix.shape[1] - 1
    rub.matrix[2 * p, 2 * p], rub.matrix[2 * p + 1, 2 * p + 1] = 1.0, 1.0
    if not rub.joined[p]:
        return
    presses, stops = _presses(p, rub), _stops(rotor, p, rub)
    without = rub.local[p]
    for q in range(rotor.rows.shape[0]):
        if rub.joined[q]:
            coupling = rub.couplings[p, q]
            without -= coupling * rub.impulses[q]
            if presses:
                rub.matrix[2 * p, 2 * q], rub.matrix[2 * p, 2 * q + 1] = coupling.real, coupling.imag
            if stops:
                rub.matrix[2 * p + 1, 2 * q], rub.matrix[2 * p + 1, 2 * q + 1] = -coupling.imag, coupling.real
    rub.matrix[2 * p, last] = without.real - rub.aims[p] if presses else rub.least[p]
    if stops:
        rub.matrix[2 * p + 1, last] = -(rotor.drive[p] + without.imag)
    else:
        rub.matrix[2 * p + 1, 2 * p] = -math.copysign(rotor.friction[p], rub.impulses[p].imag)


@part
def _holds(rotor, p, error, rub):
    """Whether the solution of the linear equations obeys the inequalities of a plane."""
    last = rub.matrix.shape[1] - 1
    push, grip = rub.matrix[2 * p, last], rub.matrix[2 * p + 1, last]
    after = rub.local[p]
    for q in range(rotor.rows.shape[0]):
        change = complex(-rub.matrix[2 * q, last], rub.matrix[2 * q + 1, last]) - rub.impulses[q]
        after += rub.couplings[p, q] * change
    slip = rotor.drive[p] + after.imag
    right_way = push <= error or rotor.friction[p] == 0.0 or grip * slip <= error * abs(grip)
    within = abs(grip) <= rotor.friction[p] * push + error
    return push >= rub.least[p] - error and after.real <= rub.aims[p] + error and within and right_way
