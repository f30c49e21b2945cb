"""Close a periodic motion: find the orbit that a motion approaches, and the number of impacts in its least period.

A motion that still spirals slowly towards its orbit may recur to within :data:`~carom.core.layout.RECURRENCE_RTOL` first after a
multiple of the period, when its turns about the orbit happen to close.  The motion has recurred after some number of
impacts.  For every divisor of this number, :func:`least_period` therefore tests whether that many impacts have an
attracting fixed point close by.  A rub may bring irregular bouncing back to the same numbers to the last bit.  Then the
computation repeats itself although the motion does not; no orbit closes there, and the result is 0.

Without lasting contact in the period, the fixed point is found by Newton's method with the exact derivative of the
impacts (:mod:`carom.core.variation`), and its multipliers decide on stability.  With lasting contact, it is found by
Aitken's extrapolation of the motion itself, because a difference has only one degree of freedom left after a lift-off.

A motion that has not recurred at all may still approach an orbit slowly, for example close to a period doubling.  The
same test distinguishes it from a motion that never repeats; its distance from that orbit must also decrease.
"""

from __future__ import annotations

import math

import numpy as np

from carom.base.outcome import Outcome
from carom.core.advance import advance
from carom.core.compiling.decorators import inlined, kernel, separate
from carom.core.flow import copy, displacement, squared_modulus, velocity
from carom.core.layout import RECURRENCE_RTOL
from carom.core.phases import FLIGHT, lasts
from carom.core.settling import same_state
from carom.core.variation import section_jacobian, set_amplitude_change
from carom.core.wall import unit

EVENT_LIMIT = int(Outcome.EVENT_LIMIT)
OPEN, CLOSES, ATTRACTS, REPELS = 0, 1, 2, 3
"""No orbit was found; an orbit that closes and is not known to attract or repel; one that attracts; one that repels."""
PASSES = -1
"""Returned instead of a number of impacts: the motion has recurred close to a repelling orbit and will leave it."""
REPELLING = 1e-4
"""Relative growth of a difference per period above which an orbit counts as repelling."""
LOWEST = 1e-6
"""Height, in clearances, below which elastic bounces are assumed to become ever lower: they approach no orbit."""
CANDIDATE_RTOL = 1e-3
"""Distance, relative to one plus the size of the state, within which the orbit of a recurred motion is searched for."""
CLOSED_RTOL = 1e-11
"""The same distance, within which an orbit counts as closed."""
EQUAL_IMPACT_RTOL = 1e-8
"""The same distance, within which two impacts of a closed orbit count as equal."""
STEPS = 12
"""Largest number of steps of either method; each step about squares the distance."""
SHORT, WATCHED = 64, 256
"""Impacts of the longest orbit tested for a motion that has not recurred, and the impacts it is followed for that."""
LONGEST = 1e6
"""Time within which a motion must reach its next event."""
KNOWN_ORBIT_RTOL = 10.0 * RECURRENCE_RTOL
"""The same distance, from a state at a single-impact orbit, within which another state counts as at this orbit."""
SLOW_EVENTS = 1000
"""Largest number of events up to the next impact, including lasting contact before it."""
ALIGNED = 0.1
"""Largest component of a difference across the previous one, relative to it, if both form a geometric series."""


@separate
def least_period(rotor, table, state, count, contact, log, memory, work, rub):
    """Number of impacts in the period of the orbit that a motion approaches.

    Parameters
    ----------
    rotor : record of :func:`~carom.models.from_modes.second_order_system`
    table : record of :func:`~carom.core.table.flight_table`
    state : complex array, shape (2,)
        Amplitudes just before an impact to which the motion has recurred.
    count : int
        Number of impacts after which it has recurred; zero if it has not.
    contact, log
        State of contact and log for one event, for :func:`~carom.core.advance.advance`; both are overwritten.
    memory : record of :func:`~carom.core.settling.memory`
        Its ``attracted`` caches the last state found at a single-impact orbit: many motions end at the same orbit.
    work, rub : records of :func:`~carom.core.layout.workspace` and :func:`~carom.core.layout.rub_workspace`

    Returns
    -------
    int
        If the motion has recurred: the least divisor of ``count`` for which an attracting orbit of that many impacts
        closes near the state; otherwise ``count``, if any orbit closes after that many.  If it has not recurred: the
        impacts, at most SHORT, of an attracting orbit that it approaches.  PASSES if the motion only passes by an
        orbit.  0 in all other cases, among them elastic bounces that damping makes ever lower.
    """
    plain = count == 1 and memory.rubbed == 0 and rotor.restitution[0] < 1.0
    if plain and same_state(memory.attracted, state, KNOWN_ORBIT_RTOL):
        return 1
    ahead, longest = (count, count) if count > 0 else (WATCHED, SHORT)
    states, durations = np.empty((ahead + 1, 2), np.complex128), np.empty(ahead)
    copy(state, states[0])
    followed, bounces = _follow_impacts(
        rotor, table, states[: longest + 1], durations[:longest], contact, log, memory, work, rub
    )
    if count == 0 and followed:
        # Most irregular motions do not even come near.
        if not _comes_back(states[: longest + 1]):
            return 0
        followed, _ = _follow_impacts(
            rotor, table, states[longest:], durations[longest:], contact, log, memory, work, rub
        )
    if not followed or _fades(rotor, states, durations):
        return 0
    if count == 1 and bounces and _pulls_in(rotor, states, durations):
        copy(state, memory.attracted)
        return 1
    orbit = np.empty((longest + 1, 2), np.complex128)
    closes, passes = False, False
    for impacts in range(1, longest + 1):
        if count % impacts == 0 and same_state(states[0], states[impacts], CANDIDATE_RTOL):
            copy(states[0], orbit[0])
            found = close(rotor, table, orbit[: impacts + 1], durations[:impacts], contact, log, memory, work, rub)
            if found != OPEN and _fades(rotor, orbit[: impacts + 1], durations[:impacts]):
                return 0
            if found == ATTRACTS and (count > 0 or _approaches(states, orbit[0], impacts)):
                return _distinct(orbit, impacts)
            # At a greater distance the motion would not have recurred to within RECURRENCE_RTOL.
            passes = passes or (found == REPELS and same_state(orbit[0], states[0], RECURRENCE_RTOL / REPELLING))
            closes = impacts == count and found != OPEN
    if passes and count > 0:
        return PASSES
    return count if closes else 0


@kernel
def _comes_back(states):
    """Whether one of the states is close to the first."""
    i = 1
    while i < states.shape[0] and not same_state(states[0], states[i], CANDIDATE_RTOL):
        i += 1
    return i < states.shape[0]


@kernel
def _fades(rotor, states, durations):
    """Whether elastic bounces are all low; a flight of duration ``T`` that ends at speed ``v`` has height ``vT/4``."""
    if rotor.restitution[0] < 1.0:
        return False
    for i in range(durations.shape[0]):
        end = unit(displacement(rotor, 0, states[i + 1])).conjugate() * velocity(rotor, 0, states[i + 1])
        if 0.25 * end.real * durations[i] > LOWEST:
            return False
    return True


@kernel
def _distinct(orbit, impacts):
    """Number of distinct impacts of a closed orbit: a motion far from its orbit may first close after two periods."""
    for fewer in range(1, impacts):
        if impacts % fewer == 0 and same_state(orbit[0], orbit[fewer], EQUAL_IMPACT_RTOL):
            return fewer
    return impacts


@kernel
def _approaches(states, goal, impacts):
    """Whether the states at each multiple of ``impacts`` are closer to a goal in the later half than in the first."""
    early, late = 0.0, 0.0
    last = states.shape[0] - 1
    for i in range(0, last + 1, impacts):
        apart = math.sqrt(squared_modulus(states[i, 0] - goal[0])) + math.sqrt(squared_modulus(states[i, 1] - goal[1]))
        if 2 * i <= last:
            early = max(early, apart)
        else:
            late = max(late, apart)
    return late < early


@kernel
def close(rotor, table, orbit, durations, contact, log, memory, work, rub):
    """Find the periodic orbit close to a state.

    Parameters
    ----------
    rotor, table, contact, log, memory, work, rub
        As in :func:`least_period`.
    orbit : complex array, shape (P + 1, 2)
        The first row holds the amplitudes just before an impact.  On return: the amplitudes of the orbit just before
        each of its ``P`` impacts, and the first ones again.
    durations : array, shape (P,)
        On return the times between its impacts, in ``1/Ω``.

    Returns
    -------
    int
        OPEN, CLOSES, ATTRACTS or REPELS.
    """
    start = orbit[0].copy()
    found = OPEN
    for _ in range(STEPS):
        followed, bounces = _follow_impacts(rotor, table, orbit, durations, contact, log, memory, work, rub)
        if not (followed and same_state(orbit[0], orbit[-1], 10.0 * CANDIDATE_RTOL)):
            return OPEN
        if bounces:
            found, done = _newton_step(rotor, orbit, durations)
        else:
            found, done = _aitken_step(rotor, table, orbit, durations, contact, log, memory, work, rub)
        if not same_state(orbit[0], start, CANDIDATE_RTOL):
            return OPEN
        if done:
            return found
    return OPEN


@kernel
def _follow_impacts(rotor, table, states, durations, contact, log, memory, work, rub):
    """Follow a motion from just before one impact through the next ones.

    Fills ``states`` after the first one and ``durations``.  Returns whether all impacts were reached, and whether there
    was no lasting contact in between.
    """
    patience = memory.patience
    memory.patience, memory.lifting = 0, 0
    amplitudes = states[0].copy()
    contact[0] = FLIGHT
    count = durations.shape[0]
    met, clock, bounces, quiet = -1, 0.0, True, 0
    while met < count and quiet < SLOW_EVENTS:
        departed = contact[0]
        outcome, time, events = advance(rotor, table, amplitudes, LONGEST, contact, log, memory, work, rub)
        if outcome != EVENT_LIMIT or events == 0:
            break
        clock += time
        quiet += 1
        if not lasts(departed) and not lasts(contact[0]) and _changed(log.before[0], log.after[0]):
            met += 1
            if met > 0:
                copy(log.before[0], states[met])
                durations[met - 1] = clock
            clock, quiet = 0.0, 0
        else:
            bounces = False
    memory.patience = patience
    return met == count, bounces


@inlined
def _changed(before, after):
    return before[0] != after[0] or before[1] != after[1]


@kernel
def _pulls_in(rotor, states, durations):
    """Whether differences shrink by more than REPELLING per impact; if a motion then recurs, it is at its orbit."""
    jacobian = np.empty((3, 3))
    section_jacobian(rotor, states, durations, jacobian)
    return _contracts(jacobian, 1.0 - REPELLING)


@kernel
def _newton_step(rotor, orbit, durations):
    """Newton step, in ``orbit[0]``, for an orbit without lasting contact; return what was found, whether it closes."""
    jacobian = np.empty((3, 3))
    section_jacobian(rotor, orbit, durations, jacobian)
    position, speed = displacement(rotor, 0, orbit[0]), velocity(rotor, 0, orbit[0])
    normal = unit(displacement(rotor, 0, orbit[-1]))
    before = unit(position).conjugate() * speed
    turned = (unit(position).conjugate() * normal).imag
    apart = normal.conjugate() * velocity(rotor, 0, orbit[-1]) - before
    size = 1.0 + math.sqrt(squared_modulus(before))
    done = abs(turned) + math.sqrt(squared_modulus(apart)) <= CLOSED_RTOL * size
    found = CLOSES
    if _contracts(jacobian, 1.0):
        found = ATTRACTS
    elif not _contracts(jacobian, 1.0 + REPELLING):
        found = REPELS
    for i in range(3):
        jacobian[i, i] -= 1.0
    whole = _determinant(jacobian)
    if whole == 0.0:
        return found, done
    ahead = _solved(jacobian, 0, -turned, -apart.real, -apart.imag) / whole
    faster = complex(
        _solved(jacobian, 1, -turned, -apart.real, -apart.imag) / whole,
        _solved(jacobian, 2, -turned, -apart.real, -apart.imag) / whole,
    )
    normal = unit(position) * complex(math.cos(ahead), math.sin(ahead))
    set_amplitude_change(rotor, normal - rotor.offsets[0], normal * (before + faster), orbit[0])
    return found, done


@kernel
def _contracts(matrix, radius):
    """Whether all eigenvalues of a matrix (3, 3) lie within a circle (Jury 1962)."""
    trace = (matrix[0, 0] + matrix[1, 1] + matrix[2, 2]) / radius
    minors = 0.0
    for i in range(3):
        j = (i + 1) % 3
        minors += (matrix[i, i] * matrix[j, j] - matrix[i, j] * matrix[j, i]) / radius**2
    determinant = _determinant(matrix) / radius**3
    return (
        1.0 - trace + minors - determinant > 0.0
        and 1.0 + trace + minors + determinant > 0.0
        and 1.0 - determinant * determinant > abs(minors - determinant * trace)
    )


@kernel
def _determinant(matrix):
    total = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        total += matrix[0, i] * (matrix[1, j] * matrix[2, k] - matrix[1, k] * matrix[2, j])
    return total


@kernel
def _solved(matrix, place, first, second, third):
    """Determinant of a matrix (3, 3) with one of its columns replaced: Cramer's rule without the division."""
    j, k = (place + 1) % 3, (place + 2) % 3
    return (
        first * (matrix[1, j] * matrix[2, k] - matrix[1, k] * matrix[2, j])
        + second * (matrix[2, j] * matrix[0, k] - matrix[2, k] * matrix[0, j])
        + third * (matrix[0, j] * matrix[1, k] - matrix[0, k] * matrix[1, j])
    )


@kernel
def _aitken_step(rotor, table, orbit, durations, contact, log, memory, work, rub):
    """Extrapolate an orbit with lasting contact, in ``orbit[0]``; return what was found, whether it closes."""
    count = durations.shape[0]
    ahead = np.empty((count + 1, 2), np.complex128)
    copy(orbit[count], ahead[0])
    followed, _ = _follow_impacts(rotor, table, ahead, durations, contact, log, memory, work, rub)
    if not followed:
        return OPEN, True
    size, length, later, product = 1.0, 0.0, 0.0, 0.0
    for k in range(2):
        first, second = orbit[count, k] - orbit[0, k], ahead[count, k] - ahead[0, k]
        size += math.sqrt(squared_modulus(orbit[0, k]))
        length += squared_modulus(first)
        later += squared_modulus(second)
        product += (first.conjugate() * second).real
    if math.sqrt(length) <= CLOSED_RTOL * size:
        return ATTRACTS, True
    ratio = product / length
    # Part of the later difference that is perpendicular to the first.
    rest = max(later - ratio * product, 0.0)
    if not (abs(ratio) < 1.0 and rest <= ALIGNED * ALIGNED * length):
        return OPEN, True
    # Extrapolate from the last state, so that the result stays among the states that a lift-off leads to.
    share = ratio / (1.0 - ratio)
    for k in range(2):
        orbit[0, k] = ahead[count, k] + (ahead[count, k] - ahead[0, k]) * share
    return ATTRACTS, False
