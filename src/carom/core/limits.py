"""Limits of magnetic bearings: what a controller asks for beyond them acts as an excess force on the linear rotor.

A limited quantity, such as the control current of a bearing, follows from the amplitudes ``c`` of the linear rotor and is seen in
the fixed frame, at the time ``t``, as ``Q = e^{it}(row·c + offset)``; the direction of its axes is part of ``row``.  Along each of the
two axes it is cut off at ``±bound``: what lies beyond,

    X = (q − bound if q > bound, q + bound if q < −bound, else 0)  for  q = Re Q, Im Q,

acts on the amplitudes by ``ċ = Mc + … + column e^{−it}X``.  So the states of the rotor and of its controllers stay as they are, and the states
wind up by themselves.  Of several quantities the excess of one adds to those after it, as that of a commanded current to the rate
of the current of its amplifier.

The excess is continuous and linear in pieces.  While each axis stays within its bound, at the upper or at the lower one, the motion is a Taylor
series (:mod:`carom.core.contact_series`) and the distance from the bound is a margin of it.  Where ``|Q| < bound`` no axis reaches
its bound whatever their directions, and flights are exact: that ``|Q|`` reaches it is found as contact with a wall is.
"""

from __future__ import annotations

import math

from carom.core.compiling.decorators import inlined, kernel
from carom.core.flow import squared_modulus
from carom.core.layout import ORDER
from carom.core.rounding import ROUNDING
from carom.core.taylor import first_fall

FREE, WITHIN, UPPER, LOWER = range(4)
"""State of an axis: no direction of it reaches the bound, it is within its bounds though another might not be, or at one of them."""
SURELY = 1.0 - 1e-9
"""Share of the squared bound below which no axis can be at its bound, far above rounding: flights then are exact."""
TURN = 2.0 * math.pi
WHOLE = -1
"""Instead of an axis: none of them."""


@inlined
def at_limits(work):
    """Whether an axis may reach its bound, so that the motion is followed by Taylor series."""
    found = False
    for axis in range(work.limited.shape[0]):
        found = found or work.limited[axis] != FREE
    return found


@inlined
def keeps_time(rotor):
    """Whether it matters how far the fixed frame has turned: contact then is asked after each whole turn whether it has settled."""
    return rotor.limit_bounds.shape[0] > 0 or rotor.anisotropy.shape[0] > 0


@inlined
def pass_time(duration, whole, memory, work):
    """Turn the fixed frame against that of the rotor for so long, or to the end of a whole turn; kept below that, its rounding does not grow."""
    later = work.clock + duration
    work.clock = 0.0 if whole else later - TURN * math.floor(later / TURN)
    memory.clock = work.clock


@inlined
def saturate(rotor, k, work):
    """Coefficients ``k`` of what is asked for, in the fixed frame, and of its excess, in that of the rotor."""
    if k == 0:
        work.turn[0] = complex(math.cos(work.clock), math.sin(work.clock))
    else:
        work.turn[k] = complex(-work.turn[k - 1].imag / k, work.turn[k - 1].real / k)
    for each in range(rotor.limit_bounds.shape[0]):
        work.turned[each, k] = _coefficient(rotor, each, k, work)
        asked, excess = 0j, 0j
        for j in range(k + 1):
            asked += work.turn[j] * work.turned[each, k - j]
        work.asked[each, k] = asked
        bound = rotor.limit_bounds[each] if k == 0 else 0.0
        work.beyond[each, k] = complex(
            _beyond(work.limited[2 * each], asked.real, bound), _beyond(work.limited[2 * each + 1], asked.imag, bound)
        )
        for j in range(k + 1):
            excess += work.turn[j].conjugate() * work.beyond[each, k - j]
        work.excess[each, k] = excess


@inlined
def _coefficient(rotor, each, k, work):
    """Coefficient ``k`` of a quantity in the frame of the rotor."""
    total = rotor.limit_offsets[each] if k == 0 else 0j
    for m in range(work.series.shape[1]):
        total += rotor.limit_rows[each, m] * work.series[k, m]
    for other in range(each):
        total += rotor.limit_couplings[each, other] * work.excess[other, k]
    return total


@inlined
def _beyond(state, asked, bound):
    """Coefficient of the excess along an axis, from that of what is asked for."""
    if state == UPPER:
        return asked - bound
    return asked + bound if state == LOWER else 0.0


@inlined
def drive_by_excess(rotor, k, work):
    """Add what the excess does to the coefficients ``k + 1`` of the amplitudes."""
    for each in range(rotor.limit_bounds.shape[0]):
        for m in range(work.series.shape[1]):
            work.series[k + 1, m] += rotor.limit_columns[m, each] * work.excess[each, k] / (k + 1)


@kernel
def first_limit(rotor, step, work):
    """First time within a step at which an axis comes to a bound or leaves it, the axis, and its state from then on.

    ``work.reached`` receives of each quantity whether ``|Q|`` comes to its bound in that time.  Without a change the axis is WHOLE.
    """
    time, axis, following = step, WHOLE, FREE
    for each in range(rotor.limit_bounds.shape[0]):
        bound, rounding = rotor.limit_bounds[each], _rounding(rotor, each, work)
        work.reached[each] = 1
        if work.limited[2 * each] <= WITHIN and work.limited[2 * each + 1] <= WITHIN:
            for k in range(ORDER + 1):
                square = bound * bound if k == 0 else 0.0
                for j in range(k + 1):
                    square -= (work.asked[each, j].conjugate() * work.asked[each, k - j]).real
                work.first_margin[k] = square
            if first_fall(work.first_margin, time, 2.0 * bound * rounding) >= time:
                work.reached[each] = 0
                continue
        for part in range(2):
            found, after = _leaves(2 * each + part, part == 0, each, bound, time, rounding, work)
            if found < time:
                time, axis, following = found, 2 * each + part, after
    return time, axis, following


@inlined
def _leaves(axis, real, each, bound, step, rounding, work):
    """First time within a step at which an axis leaves its state, and the next one."""
    state = work.limited[axis]
    sign = -1.0 if state == LOWER else 1.0
    if state <= WITHIN:
        sign = -1.0
    for k in range(ORDER + 1):
        asked = work.asked[each, k].real if real else work.asked[each, k].imag
        work.first_margin[k] = sign * asked
    if state > WITHIN:
        work.first_margin[0] -= bound
        return first_fall(work.first_margin, step, rounding), WITHIN
    for k in range(ORDER + 1):
        work.second_margin[k] = -work.first_margin[k]
    work.first_margin[0] += bound
    work.second_margin[0] += bound
    high = first_fall(work.first_margin, step, rounding)
    low = first_fall(work.second_margin, high, rounding)
    return low, (LOWER if low < high else UPPER)


@inlined
def _rounding(rotor, each, work):
    """Rounding error of a quantity at the start of a step."""
    total = math.sqrt(squared_modulus(rotor.limit_offsets[each])) + rotor.limit_bounds[each]
    for m in range(work.series.shape[1]):
        total += math.sqrt(squared_modulus(rotor.limit_rows[each, m] * work.series[0, m]))
    for other in range(each):
        total += math.sqrt(squared_modulus(rotor.limit_couplings[each, other] * work.excess[other, 0]))
    return ROUNDING * total


@inlined
def change_limits(rotor, axis, following, amplitudes, memory, work):
    """Set the states of all axes at the end of a step at which one changes, or none, and note whether a bound was in reach."""
    if axis != WHOLE:
        work.limited[axis] = following
    for each in range(rotor.limit_bounds.shape[0]):
        memory.limited_steps += work.reached[each]
        if work.limited[2 * each] > WITHIN or work.limited[2 * each + 1] > WITHIN:
            continue
        state = FREE
        if work.reached[each] and not _surely_within(rotor, each, amplitudes, work):
            state = WITHIN
        work.limited[2 * each], work.limited[2 * each + 1] = state, state


@inlined
def _surely_within(rotor, each, amplitudes, work):
    """Whether a quantity, without the excess of others, is so small that no axis is at its bound."""
    total = rotor.limit_offsets[each]
    for m in range(amplitudes.shape[0]):
        total += rotor.limit_rows[each, m] * amplitudes[m]
    bound = rotor.limit_bounds[each]
    return squared_modulus(total) < SURELY * (bound * bound)


@kernel
def set_limits(rotor, amplitudes, work):
    """Set the states of all axes in a state of the motion, as after an impact, in which what is asked for may jump."""
    turn = complex(math.cos(work.clock), math.sin(work.clock))
    for each in range(rotor.limit_bounds.shape[0]):
        total, bound = rotor.limit_offsets[each], rotor.limit_bounds[each]
        for m in range(amplitudes.shape[0]):
            total += rotor.limit_rows[each, m] * amplitudes[m]
        for other in range(each):
            total += rotor.limit_couplings[each, other] * work.excess[other, 0]
        asked = turn * total
        real, imaginary = _state(asked.real, bound), _state(asked.imag, bound)
        if squared_modulus(asked) < SURELY * bound * bound:
            real, imaginary = FREE, FREE
        work.limited[2 * each], work.limited[2 * each + 1] = real, imaginary
        beyond = complex(_beyond(real, asked.real, bound), _beyond(imaginary, asked.imag, bound))
        work.excess[each, 0] = turn.conjugate() * beyond


@inlined
def _state(asked, bound):
    """State of an axis that is not sure to be within its bounds."""
    if asked > bound:
        return UPPER
    return LOWER if asked < -bound else WITHIN
