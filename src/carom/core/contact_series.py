"""Lasting contact as Taylor series: the law of sliding and rolling on the walls, for any number of modes and stations.

With ``|y| = 1`` and ``Re(ȳẏ) = 0`` a contact force ``f`` (per unit of the effective mass at the station) acts as
``ċ = Mc + Bf``.  Writing ``a`` for the free acceleration ``WM²c``, staying on the wall needs the normal force

    N = Re(ȳ a) + |ẏ|²,

and the force is ``f = −(1 + iμ sgn v) N y`` while the contact point slips with ``v = surface_speed + Im(ȳẏ)``, and
``f = −surface_speed² y − a`` while it rolls (``ẏ = −i surface_speed y``).  Products of series are all this needs, so the coefficients
follow from a recurrence and a step costs the same for any rotor.  For the planar rotor it is
``θ̈ = −γ(1 + θ̇) − ρ sin(θ − φ) − μN sgn v`` with ``N = ρ cos(θ − φ) + (1 + θ̇)² − ω²``.

In contact at several stations, a force ``f_q = (−N_q + iF_q) y_q`` at one station accelerates another by ``G_pq f_q``, with the
mobility ``G = WMB``.  Staying on all walls then needs, at each station ``p`` in contact,

    Σ_q Re(ȳ_p G_pq (N_q − iF_q) y_q) = Re(ȳ_p a_p) + |ẏ_p|²,

and the second equation of a station is ``F_p = −μ N_p sgn v_p`` where it slips and
``Im(ȳ_p a_p) + Σ_q Im(ȳ_p G_pq (−N_q + iF_q) y_q) = 0`` where it rolls: linear equations for each coefficient in turn.

A shaft whose speed changes adds to these equations (:mod:`carom.core.shaft`), and so do bearings at their limits (:mod:`carom.core.limits`) and
anisotropic ones (:mod:`carom.core.anisotropy`).

A compliant wall has a normal force of its own, and ``n = y/|y|`` takes the place of ``y`` there (:mod:`carom.core.compliance`).
"""

from __future__ import annotations

from carom.core.anisotropy import add_conjugate_forces
from carom.core.compiling.decorators import inlined, kernel
from carom.core.compliance import force_in_wall, indent, rolling_grip
from carom.core.equations import solve
from carom.core.flow import displacement
from carom.core.friction import friction_ratio, rolling_force
from carom.core.layout import ORDER
from carom.core.limits import drive_by_excess, saturate
from carom.core.phases import ROLLING, lasts, sense_of_phase, stays
from carom.core.shaft import brake_shaft, couple_by_shaft, sweep_unbalance, turn_shaft
from carom.core.surfaces import may_change, race_grip, relative_coefficient
from carom.core.wall import is_compliant, wall_of


@kernel
def rub_series(rotor, contact, amplitudes, work):
    """Fill the Taylor coefficients of a motion that starts with these amplitudes, while its contacts stay the same.

    ``work.series`` (ORDER + 1, N) receives those of the amplitudes.  Of each station, ``work.push`` receives those of the
    normal force, ``work.grip`` those of the friction force along growing angle and ``work.slip`` those of the slip
    velocity, all of shape (P, ORDER + 1).  Where there is no lasting contact, ``work.push`` is ``Re(ȳÿ) + |ẏ|²``, or without meaning
    of a station that has parted from a compliant wall.
    """
    modes, stations = rotor.columns.shape[0], rotor.columns.shape[1]
    for m in range(modes):
        work.series[0, m] = amplitudes[m]
    for k in range(ORDER + 1):
        _contact(rotor, contact, k, work)
        if k < ORDER:
            share = 1.0 / (k + 1)
            for m in range(modes):
                rate = rotor.exponents[m] * work.series[k, m] + rotor.columns[m, 0] * work.force[0, k]
                for station in range(1, stations):
                    rate += rotor.columns[m, station] * work.force[station, k]
                if rotor.driven[m]:
                    rate += work.series[k, m - 1]
                work.series[k + 1, m] = complex(share * rate.real, share * rate.imag)
            for station in range(stations):
                if rotor.race[station] >= 0:
                    work.series[k + 1, rotor.race[station]] -= (
                        rotor.race_gain[station] * work.grip[station, k] / (k + 1)
                    )
            if rotor.shaft.shape[0] > 0:
                turn_shaft(rotor, contact, k, work)
            if rotor.limit_bounds.shape[0] > 0:
                drive_by_excess(rotor, k, work)
            if rotor.anisotropy.shape[0] > 0:
                add_conjugate_forces(rotor, k, work)


@kernel
def contact_forces(rotor, contact, amplitudes, work):
    """Fill the first coefficient of each series of :func:`rub_series` alone: the forces at these amplitudes, not their course."""
    for m in range(rotor.columns.shape[0]):
        work.series[0, m] = amplitudes[m]
    _contact(rotor, contact, 0, work)


@inlined
def _contact(rotor, contact, k, work):
    """Coefficients ``k`` of position, speed, push, slip and forces at all stations, from those of the amplitudes."""
    stations = rotor.columns.shape[1]
    if rotor.shaft.shape[0] > 0:
        sweep_unbalance(rotor, k, work)
    if rotor.limit_bounds.shape[0] > 0:
        saturate(rotor, k, work)
    for station in range(stations):
        in_wall = is_compliant(rotor, station) and stays(contact[station])
        _motion(rotor, station, k, work)
        if not in_wall or contact[station] == ROLLING:
            _free_acceleration(rotor, station, k, work)
        if in_wall:
            indent(rotor, station, k, work)
        else:
            _push_and_slip(rotor, station, k, work)
    if stations == 1 and (is_compliant(rotor, 0) or not may_change(rotor, 0)) and rotor.shaft.shape[0] == 0:
        _force(rotor, contact[0], k, work)
    else:
        _coupled_forces(rotor, contact, k, work)


@inlined
def _motion(rotor, station, k, work):
    """Coefficients ``k`` of position and speed; no force changes a position at once, so the speed gives those of the position."""
    speed = 0j
    for m in range(rotor.rows.shape[1]):
        speed += rotor.rate_rows[station, m] * work.series[k, m]
    work.speed[station, k] = speed
    if k == 0:
        work.position[station, 0] = displacement(rotor, station, work.series[0])
    else:
        before, share = work.speed[station, k - 1], 1.0 / k
        work.position[station, k] = complex(share * before.real, share * before.imag)


@inlined
def _free_acceleration(rotor, station, k, work):
    """Coefficient ``k`` of the acceleration without contact forces."""
    free = 0j
    for m in range(rotor.rows.shape[1]):
        free += rotor.acceleration_rows[station, m] * work.series[k, m]
    if rotor.shaft.shape[0] > 0:
        free += rotor.unbalance_rows[station] * work.whirl[k]
    if rotor.limit_bounds.shape[0] > 0:
        for each in range(rotor.limit_bounds.shape[0]):
            free += rotor.limit_pulls[station, each] * work.excess[each, k]
    work.free[station, k] = free


@inlined
def _push_and_slip(rotor, station, k, work):
    """Coefficients ``k`` of push without contact forces, and of slip."""
    push, slip = 0.0, rotor.surface_speed[station] if k == 0 else 0.0
    for j in range(k + 1):
        y, v = work.position[station, j], work.speed[station, j]
        push += (y.conjugate() * work.free[station, k - j]).real + (v.conjugate() * work.speed[station, k - j]).real
        slip += (y.conjugate() * work.speed[station, k - j]).imag
    slip += relative_coefficient(rotor, station, k, work)
    work.push[station, k], work.slip[station, k] = push, slip


@inlined
def _push(station, k, work):
    """Coefficient ``k`` of ``Re(ȳÿ) + |ẏ|²`` for the acceleration in ``work.free``."""
    push = 0.0
    for j in range(k + 1):
        y, v = work.position[station, j], work.speed[station, j]
        push += (y.conjugate() * work.free[station, k - j]).real + (v.conjugate() * work.speed[station, k - j]).real
    return push


@inlined
def _force(rotor, phase, k, work):
    """Coefficient ``k`` of the contact force of a rotor with one station, and of its part along growing angle."""
    force, grip = 0j, 0.0
    if is_compliant(rotor, 0):
        work.grip[0, k] = 0.0
        if lasts(phase):
            work.grip[0, k] = _compliant_grip(rotor, 0, phase, k, work)
            force = force_in_wall(rotor, phase, 0, k, work)
        work.force[0, k] = force
        return
    if phase == ROLLING:
        force = rolling_force(work.position[0, k], work.free[0, k], wall_of(rotor, 0))
    elif lasts(phase):
        for j in range(k + 1):
            force += work.push[0, j] * work.position[0, k - j]
        force *= complex(-1.0, friction_ratio(sense_of_phase(phase), wall_of(rotor, 0)))
    work.force[0, k] = force
    for j in range(k + 1):
        grip += (work.position[0, j].conjugate() * work.force[0, k - j]).imag
    work.grip[0, k] = grip


@inlined
def _compliant_grip(rotor, station, phase, k, work):
    """Coefficient ``k`` of the friction of a station alone in a compliant wall."""
    if phase == ROLLING:
        return rolling_grip(rotor, station, k, work) / (1.0 + rotor.race_gain[station])
    return friction_ratio(sense_of_phase(phase), wall_of(rotor, station)) * work.push[station, k]


@kernel
def _coupled_forces(rotor, contact, k, work):
    """Coefficient ``k`` of the contact forces at all stations; those without lasting contact get their push as well."""
    stations = rotor.rows.shape[0]
    work.matrix[:] = 0.0
    for p in range(stations):
        if not is_compliant(rotor, p):
            work.normal[p, k] = work.position[p, k]
    for p in range(stations):
        work.matrix[2 * p, 2 * p], work.matrix[2 * p + 1, 2 * p + 1] = 1.0, 1.0
        if lasts(contact[p]):
            _balance(rotor, contact, p, k, work)
    solve(work.matrix)  # forces without bound where there are none (Painlevé)
    for p in range(stations):
        work.force[p, k], work.grip[p, k] = 0j, 0.0
        if lasts(contact[p]):
            work.push[p, k], work.grip[p, k] = work.matrix[2 * p, 2 * stations], work.matrix[2 * p + 1, 2 * stations]
            for j in range(k + 1):
                work.force[p, k] += complex(-work.push[p, j], work.grip[p, j]) * work.normal[p, k - j]
    if rotor.shaft.shape[0] > 0:
        brake_shaft(rotor, contact, k, work)
    for p in range(stations):
        if not stays(contact[p]):
            for q in range(stations):
                work.free[p, k] += rotor.mobility[p, q] * work.force[q, k]
            if rotor.shaft.shape[0] > 0:
                work.free[p, k] += rotor.unbalance_rows[p] * work.euler[k]
            work.push[p, k] = _push(p, k, work)


@inlined
def _balance(rotor, contact, p, k, work):
    """The two equations of a station in contact for its coefficients ``k`` of normal and friction force.

    Of a compliant wall the normal force is known.
    """
    last = work.matrix.shape[1] - 1
    normal, along = work.push[p, k], 0.0
    rolls = contact[p] == ROLLING
    given = is_compliant(rotor, p)
    if rolls:
        work.matrix[2 * p + 1, 2 * p + 1] += rotor.race_gain[p]
    if rolls and given:
        along = rolling_grip(rotor, p, k, work)
    elif rolls:
        along = race_grip(rotor, p, k, work)
        for j in range(k + 1):
            along -= (work.position[p, j].conjugate() * work.free[p, k - j]).imag
    else:
        work.matrix[2 * p + 1, 2 * p] = -friction_ratio(sense_of_phase(contact[p]), wall_of(rotor, p))
    for q in range(contact.shape[0]):
        if q == p or not lasts(contact[q]):
            continue
        link = 0j
        for j in range(k + 1):
            link += work.normal[p, j].conjugate() * work.normal[q, k - j]
        work.links[p, q, k] = rotor.mobility[p, q] * link
        first = work.links[p, q, 0]
        if not given:
            work.matrix[2 * p, 2 * q], work.matrix[2 * p, 2 * q + 1] = first.real, first.imag
        if rolls:
            work.matrix[2 * p + 1, 2 * q], work.matrix[2 * p + 1, 2 * q + 1] = -first.imag, first.real
        for j in range(1, k + 1):
            share = work.links[p, q, j] * complex(work.push[q, k - j], -work.grip[q, k - j])
            normal -= 0.0 if given else share.real
            along += share.imag if rolls else 0.0
    if rotor.shaft.shape[0] > 0:
        more_normal, more_along = couple_by_shaft(rotor, contact, p, rolls, given, k, work)
        normal, along = normal + more_normal, along + more_along
    work.matrix[2 * p, last], work.matrix[2 * p + 1, last] = normal, along
