"""The speed of the shaft as a state: what it does to the motion in contact, and flights at the speed that it has then.

The frame turns at the nominal speed, which is one.  The shaft has the speed ``σ``, which may differ, and the angle ``ϑ``.  They are
two modes that move no station: ``p = e^{i(ϑ−t)}``, the direction of the unbalance in the frame, and ``σ`` as a real amplitude.  With the
rates ``u`` of the other amplitudes by the unbalance at the nominal speed,

    ċ = Mc + u(σ² − iβ)p + Bf,      ṗ = i(σ − 1)p,      σ̇ = τ + β,      β = Σ_q h_q F_q,

where ``F_q`` is the friction along growing angle at station ``q`` per effective mass ``m`` and ``h = ms/J`` with the rotor's radius ``s``
and the inertia ``J``.  The rate ``τ`` by the torque of the drive counts in contact only: in flight the speed stays as it is.  Its share
``−iuτp`` of the unbalance's force is left out there and in contact too: otherwise what presses a station on a rigid wall would depend on
whether it is in contact.  The torque of the unbalance itself on the shaft is left out; it is to that of friction as the eccentricity is
to the radius.

*Contact.*  The surface moves by ``s(σ − 1)`` faster than in the frame, and so does the slip.  The acceleration of a station contains
``−iβep`` with ``e = Wu``.  With ``ε = n̄ep`` the normal force that keeps it on a rigid wall therefore gains ``β Im ε``, and rolling needs

    F + (s − Re ε) β + sτ = …

beside what it needs at constant speed: linear equations for the coefficients of all forces, as ``β`` is linear in ``F``.

*Flight.*  With ``ν = σ − 1`` the motion is ``c = (c₀ − Sp₀) e^{Mt} + Sp₀ e^{iνt}`` with ``S = (iν − M)⁻¹uσ²``, that is a free flight
and one more mode that moves the stations by ``WS``.  For the search of contacts a motion's own copy of the rotor is set to that
(:func:`enter_flight`) and back (:func:`leave_flight`).
"""

from __future__ import annotations

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import complex_expm1, unbalance_response
from carom.core.layout import LANE_TERMS, NODES
from carom.core.phases import lasts
from carom.core.wall import unit


@inlined
def surface_excess(rotor, station, amplitudes):
    """Speed of the rotor's surface at a station beyond that at the nominal speed."""
    return (rotor.surface_speed[station] - 1.0) * (amplitudes[rotor.shaft[0] + 1].real - 1.0)


@inlined
def excess_coefficient(rotor, station, k, work):
    """Coefficient ``k`` of :func:`surface_excess`."""
    speed = work.series[k, rotor.shaft[0] + 1].real
    return (rotor.surface_speed[station] - 1.0) * (speed - 1.0 if k == 0 else speed)


@inlined
def sweep_unbalance(rotor, k, work):
    """Coefficients ``k`` of ``σp`` (``work.sweep``) and of ``σ²p`` (``work.whirl``)."""
    place = rotor.shaft[0]
    swept, whirled = 0j, 0j
    for j in range(k + 1):
        swept += work.series[j, place + 1].real * work.series[k - j, place]
    work.sweep[k] = swept
    for j in range(k + 1):
        whirled += work.series[j, place + 1].real * work.sweep[k - j]
    work.whirl[k] = whirled


@inlined
def couple_by_shaft(rotor, contact, station, rolls, given, k, work):
    """Write what the change of the speed does into the two equations of a station; return what it adds to their right sides.

    ``given`` says whether the normal force is known; it is then no unknown of the first equation.
    """
    direction, radius = 0j, rotor.surface_speed[station] - 1.0
    for j in range(k + 1):
        direction += work.normal[station, j].conjugate() * work.series[k - j, rotor.shaft[0]]
    work.eccentricity[station, k] = rotor.unbalance_rows[station] * direction
    first = work.eccentricity[station, 0]
    torque = rotor.drive[0] if k == 0 else 0.0
    normal, along = 0.0, -radius * torque
    for j in range(1, k + 1):
        normal += work.eccentricity[station, j].imag * work.braking[k - j]
        along += work.eccentricity[station, j].real * work.braking[k - j]
    for q in range(contact.shape[0]):
        if lasts(contact[q]):
            if not given:
                work.matrix[2 * station, 2 * q + 1] -= first.imag * rotor.shaft_gain[q]
            if rolls:
                work.matrix[2 * station + 1, 2 * q + 1] += (radius - first.real) * rotor.shaft_gain[q]
    return (0.0 if given else normal), (along if rolls else 0.0)


@inlined
def brake_shaft(rotor, contact, k, work):
    """Coefficients ``k`` of ``β`` (``work.braking``) from those of friction, and of ``−iβp`` (``work.euler``)."""
    rate, euler = 0.0, 0j
    for q in range(contact.shape[0]):
        if lasts(contact[q]):
            rate += rotor.shaft_gain[q] * work.grip[q, k]
    work.braking[k] = rate
    for j in range(k + 1):
        euler += work.braking[j] * work.series[k - j, rotor.shaft[0]]
    work.euler[k] = complex(euler.imag, -euler.real)


@inlined
def turn_shaft(rotor, contact, k, work):
    """Complete the coefficients ``k + 1`` of the amplitudes: of the modes that the unbalance drives, of its direction and the speed."""
    place, push = rotor.shaft[0], work.whirl[k] + work.euler[k]
    for m in range(work.series.shape[1]):
        work.series[k + 1, m] += rotor.unbalance[m] * push / (k + 1)
    ahead = work.sweep[k] - work.series[k, place]
    work.series[k + 1, place] = complex(-ahead.imag, ahead.real) / (k + 1)
    rate = work.braking[k]
    if k == 0:
        makes_contact = False
        for q in range(contact.shape[0]):
            makes_contact = makes_contact or lasts(contact[q])
        rate += rotor.drive[0] if makes_contact else 0.0
    work.series[k + 1, place + 1] = complex(rate, 0.0) / (k + 1)


@inlined
def has_slowed_down(rotor, amplitudes, memory):
    """Whether the shaft is so slow that this ends the stage."""
    if rotor.shaft.shape[0] > 0:
        return amplitudes[rotor.shaft[0] + 1].real <= memory.slowest
    return False


@inlined
def lever_of_shaft(rotor, station, normal, amplitudes):
    """Change of the local velocity of a station, with that of its surface, by that of the speed at one instant: ``i(s − ε)``."""
    eccentricity = normal.conjugate() * (rotor.unbalance_rows[station] * amplitudes[rotor.shaft[0]])
    return complex(eccentricity.imag, (rotor.surface_speed[station] - 1.0) - eccentricity.real)


@inlined
def change_speed(rotor, station, friction, amplitudes):
    """Change the speed by a friction impulse along growing angle, in place; the unbalance moves the rotor as it does so."""
    place, faster = rotor.shaft[0], rotor.shaft_gain[station] * friction
    amplitudes[place + 1] += complex(faster, 0.0)
    push = complex(faster * amplitudes[place].imag, -faster * amplitudes[place].real)
    for k in range(amplitudes.shape[0]):
        amplitudes[k] += rotor.unbalance[k] * push


@kernel
def enter_flight(rotor, table, amplitudes):
    """Set a motion's own rotor and table to a flight at the speed that the shaft has, and take the forced response out, in place."""
    place = rotor.shaft[0]
    unbalance_response(rotor, amplitudes, rotor.response)
    exponent = complex(0.0, amplitudes[place + 1].real - 1.0)
    rotor.exponents[place] = exponent
    for station in range(rotor.rows.shape[0]):
        row = 0j
        for k in range(amplitudes.shape[0]):
            row += rotor.rows[station, k] * rotor.response[k]
        rotor.rows[station, place] = row
        rotor.rate_rows[station, place] = exponent * row
        rotor.acceleration_rows[station, place] = exponent * exponent * row
        rotor.jerk_rows[station, place] = exponent * exponent * exponent * row
    for k in range(amplitudes.shape[0]):
        amplitudes[k] -= rotor.response[k] * amplitudes[place]
    if table.growth_series[0, place] != exponent:
        _tabulate(table, place, exponent)


@inlined
def _tabulate(table, place, exponent):
    """Entries of a free-standing mode in :mod:`carom.core.table`."""
    size, term, bound = abs(exponent.imag), 1.0 + 0j, 1.0
    for n in range(LANE_TERMS):
        term *= exponent / (n + 1.0)
        table.growth_series[n, place] = term
    for node in range(NODES + 1):
        table.growth[node, place] = complex_expm1(exponent * (node * table.spacing))
    for n in range(3):
        bound *= size
        table.bounds[n, place] = bound


@kernel
def leave_flight(rotor, amplitudes):
    """Undo :func:`enter_flight`, at whatever time."""
    place = rotor.shaft[0]
    amplitudes[place] = unit(amplitudes[place])
    for k in range(amplitudes.shape[0]):
        amplitudes[k] += rotor.response[k] * amplitudes[place]
    rotor.exponents[place] = 0j
    for station in range(rotor.rows.shape[0]):
        rotor.rows[station, place], rotor.rate_rows[station, place] = 0j, 0j
        rotor.acceleration_rows[station, place], rotor.jerk_rows[station, place] = 0j, 0j
