"""Many motions of one rotor, one after another, each for the same time: for any number of modes and contact stations."""

from __future__ import annotations

from carom.base.outcome import Outcome
from carom.core.advance import advance
from carom.core.compiling.decorators import kernel
from carom.core.limits import set_limits
from carom.core.settling import reset

EVENT_LIMIT = int(Outcome.EVENT_LIMIT)


@kernel
def advance_in_turn(
    rotor, table, motions, clocks, duration, most_events, contacts, log, memory, work, rub, outcomes, events
):
    """Advance motions in place; one does not depend on the others, to the last bit.

    Parameters
    ----------
    rotor, table, log, memory, work, rub
        See :func:`~carom.core.advance.advance`.
    motions : complex array, shape (M, N)
        Amplitudes at the start; overwritten by those at the end.
    clocks : float array, shape (M,)
        Times at the start, less whole turns: where the axes of limits are.
    duration : float
    most_events : int
        Events after which a motion is given up.
    contacts : int array, shape (M, P)
        State of contact at the start; overwritten by that at the end.
    outcomes, events : int arrays, shape (M,)
        Overwritten.
    """
    for i in range(motions.shape[0]):
        reset(memory)
        if rotor.limit_bounds.shape[0] > 0:
            memory.clock, rub.clock = clocks[i], clocks[i]
            set_limits(rotor, motions[i], rub)
            memory.limited[:] = rub.limited
        outcomes[i], events[i], time = EVENT_LIMIT, 0, 0.0
        while outcomes[i] == EVENT_LIMIT and events[i] < most_events:
            outcome, passed, count = advance(
                rotor, table, motions[i], duration - time, contacts[i], log, memory, work, rub
            )
            outcomes[i] = outcome
            events[i] += count
            time += passed
