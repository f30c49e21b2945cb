"""How a motion is recognised as settled: its memory, and the proofs about its end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.base.outcome import Outcome
from carom.closed_forms.exact_results import exact_results
from carom.closed_forms.rub_stability import rub_attracts
from carom.core.closing import PASSES, least_period
from carom.core.event_log import EventLog
from carom.core.layout import rub_workspace, workspace
from carom.core.limits import set_limits
from carom.core.planar_proofs import fades_to_rolling, planar_proofs
from carom.core.settling import discard_candidate, memory
from carom.models import Rotor, System
from carom.models.stages import NEVER, Trigger
from carom.motions.recurrence import least_recurrence
from carom.motions.resting import goes_round, lies

PATIENCE = 20_000
"""Default number of impacts without recurrence after which bouncing counts as irregular.

Irregular transients of thousands of impacts are common.
"""
LONG_FLIGHT = 3e4
"""Longest free flight, in ``1/Ω``, before the expensive proof is tried that the rotor levitates."""
TIME_CONSTANTS = 40.0
SHORTEST_LIMIT, LONGEST_LIMIT = 2e5, 2e7
"""Smallest and largest time, in ``1/Ω``, that a motion is given to settle: seconds of computing."""
FALLING_TURNS = 1_500
"""Turns of the shaft for which a rotor without levitation is followed: whirl and rest are known after 1,024 turns at the latest.

Of a rotor that bends, contact without end may neither settle nor repeat.  A shaft that loses its speed is given its time to stand.
"""
CHATTER = 15.0
"""Impacts of a chatter, times ``|ln d|``, until its bounces are too low to be distinguished from lasting contact."""
LOW, LOW_FOR = 0.5, 200
"""Bounces are low if this many take on average less than this time, in units of ``1/|λ|`` of the fastest exponent: so quickly
no rotor returns to a wall that does not keep pulling it."""
AT_REST = 1e-6
"""Largest velocity of a rub that counts as synchronous, far above the rate at which it was recognised."""
SLICE = 1_000_000
"""Blocks of flight in one compiled call, times modes and contact planes: a fraction of a second, in which Ctrl-C is not heard."""
LOOKED_AT, LEAST_PROGRESS = 32_768, 5e-7
"""Steps after which it is asked whether a motion gets on, and the time in ``1/Ω`` that these must take on average.

A slice of flight without an event counts as :data:`PER_SLICE` steps.  The stiffest walls of machines need steps of ``1e-5/Ω``.
"""
PER_SLICE = 4096
WHIRLING = (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
REPEATING = (Outcome.BOUNCING, Outcome.MIXED)
MODES = 2
"""Modes of the rotors whose orbits are closed here."""


def fresh_memory(
    rotor: Rotor, patience: int, stop_at_chatter: bool = False, *, absorb: bool = False, trigger: Trigger = NEVER
) -> np.record:
    """Memory of a motion at its start, for :func:`~carom.motions.simulation.follow`.

    With a ``patience`` of zero the motion never counts as settled.  With ``absorb`` it ends as soon as it is proven to
    go over to the synchronous rub or to rolling, otherwise when it has reached them.
    """
    known = exact_results(rotor)
    # What goes over to lasting contact triggers there.
    absorb = absorb and trigger.contact_time == np.inf
    decay = rotor.system.decay
    rub, around = known.rub if patience > 0 else None, known.around if patience > 0 and absorb else None
    return memory(
        rotor.system.modes,
        rub_position=rub.position if rub else 0j,
        patience=patience,
        recheck=min(1.0 / decay, LONG_FLIGHT) if decay > 0.0 else np.inf,
        stop_at_landing=stop_at_chatter,
        resting=not known.rubs,
        proofs=planar_proofs(
            # Lowered by the rounding error once more, so that the end lies inside even if V is computed another way.
            level=around.level - around.rounding if around else 0.0,
            shape=(around.friction, around.strength, around.phase) if around else (0.0, 0.0, 0.0),
            runaway=known.runaway if patience > 0 and absorb else np.inf,
            fading=known.fading if patience > 0 and absorb else 0.0,
            hastening=known.hastening if patience > 0 else np.inf,
        ),
        contact_time=trigger.contact_time,
        contact_gap=trigger.contact_gap,
        impact_speed=trigger.impact_speed,
        limits=rotor.system.limits,
        slice_time=SLICE * float(rotor.system.table.durations[0]) / rotor.system.arrays["columns"].size,
    )


@dataclass
class SettlingProgress:
    """Whether a motion gets on: the steps, and the time that they took, since it was last asked."""

    steps: int = 0
    passed: float = 0.0

    def stalls(self, steps: int, time: float) -> bool:
        """Note the steps of a call, none in a slice of flight, and the time that it has passed; return whether the motion stalls."""
        self.steps, self.passed = self.steps + (steps or PER_SLICE), self.passed + time
        if self.steps < LOOKED_AT:
            return False
        stalled = self.passed < LEAST_PROGRESS * self.steps
        self.steps, self.passed = 0, 0.0
        return stalled


def begin_limits(system: System, amplitudes: np.ndarray, time: float, recollection: np.record) -> np.ndarray:
    """Note in the memory of a motion when it begins, and the states of limits there, which are returned, shape (2L,)."""
    work = rub_workspace(system.modes, len(system.arrays["rows"]), system.limits)
    if system.limits:
        work.clock = math.fmod(time, 2.0 * math.pi)
        set_limits(system.arrays, amplitudes, work)
        recollection.clock, recollection.limited[:] = work.clock, work.limited
    return np.array(work.limited)


def settled(
    rotor: Rotor, amplitudes: np.ndarray, contact: np.ndarray, outcome: Outcome, recollection: np.record
) -> tuple[Outcome, int]:
    """Examine the end of a motion: whether it has settled there, and the impacts per period of periodic bouncing.

    Parameters
    ----------
    amplitudes : ndarray of complex, shape (N,)
        State at the end; of bouncing, just before an impact.
    contact : ndarray of int, shape (P,)
        State of contact there.
    outcome : Outcome
        What :func:`carom.core.advance.advance` has found.
    recollection : record of :func:`carom.core.settling.memory`
        Where a motion only passes by an orbit or a rub, this is noted there.

    Returns
    -------
    outcome : Outcome
        ``EVENT_LIMIT`` if it only passes by.
    multiplicity : int
        See :func:`carom.core.closing.least_period`; for rotors with other than one plane and one pair of modes
        :func:`carom.motions.recurrence.least_recurrence`.
    """
    # A rub that runs round the wall has been recognised by a full turn.
    rests = outcome is Outcome.FORWARD_RUB and np.max(np.abs(rotor.system.state(amplitudes)[1])) < AT_REST
    if rests and recollection.resting:
        if rub_attracts(rotor.system, amplitudes, contact):
            return outcome, 0
        recollection.resting = -1
        return Outcome.EVENT_LIMIT, 0
    if outcome is Outcome.EVENT_LIMIT:
        outcome = goes_round(rotor, amplitudes, contact, recollection) or outcome
    if outcome in WHIRLING and lies(rotor, amplitudes, contact, recollection):
        return Outcome.AT_REST, 0
    if outcome not in REPEATING:
        return outcome, 0
    if not recollection.period and rotor.system.is_planar and _fade(rotor, amplitudes):
        if recollection.contact_time < np.inf:  # which triggers there
            discard_candidate(recollection)
            return Outcome.EVENT_LIMIT, 0
        return Outcome.ROLLING, 0
    recurred = int(recollection.period)
    if rotor.system.is_planar:
        count = int(least_period(rotor.system.arrays, rotor.system.table, amplitudes, recurred, *_tools()))
    else:
        count = least_recurrence(rotor.system, amplitudes, contact, recurred, recollection)
    if count != PASSES:
        return outcome, count
    discard_candidate(recollection)
    return Outcome.EVENT_LIMIT, 0


def may_be_low(rotor: Rotor, patience: int) -> bool:
    """Whether bounces may stay low for so many impacts: not if a chatter would have ended."""
    restitution = rotor.system.arrays.restitution
    return patience > 0 and bool((restitution > math.exp(-2.0 * CHATTER / patience)).any())


def low_interval(rotor: Rotor) -> float:
    """Mean time between impacts, in ``1/Ω``, below which bounces are low."""
    return LOW / float(np.abs(rotor.system.arrays["exponents"]).max())


def _fade(rotor: Rotor, before_impact: np.ndarray) -> bool:
    """Whether bounces from a state just before an impact are proven to fade to rolling."""
    proofs = planar_proofs(fading=exact_results(rotor).fading)
    return bool(fades_to_rolling(proofs, rotor.system.arrays, before_impact))


def _tools() -> tuple[np.ndarray, EventLog, np.record, np.record, np.record]:
    """State of contact and log, memory and scratch arrays for the kernels that close orbits."""
    log = EventLog.empty(1, MODES)
    return np.empty(1, np.int64), log, memory(MODES), workspace(MODES), rub_workspace(MODES)


def time_limit(rotor: Rotor, trigger: Trigger) -> float:
    """Time in ``1/Ω`` after which a stage is given up: :func:`longest_time`, or that of its trigger."""
    return trigger.time if trigger.time < np.inf else longest_time(rotor)


def longest_time(rotor: Rotor) -> float:
    """Time limit in ``1/Ω`` for a motion to settle: TIME_CONSTANTS time constants of free flight, within bounds; else :data:`FALLING_TURNS`."""
    decay = rotor.system.decay
    if rotor.weight is not None and not rotor.system.levitates and rotor.system.shaft is None:
        return 2.0 * math.pi * FALLING_TURNS
    return min(max(TIME_CONSTANTS / decay, SHORTEST_LIMIT), LONGEST_LIMIT) if decay > 0.0 else SHORTEST_LIMIT
