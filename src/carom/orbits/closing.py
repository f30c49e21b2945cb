"""Closing a stretch of a motion to a periodic one, by Newton's method on the flow that the simulator follows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.base.outcome import Phase
from carom.motions.trajectories import Trajectory
from carom.orbits.flow import BEND, Flow, FlowBudget, krylov, repeats_after
from carom.orbits.happenings import happenings
from carom.orbits.maps import Multipliers
from carom.orbits.names import CountedName
from carom.orbits.simulated import SimulatedOrbit

ITERATIONS = 12
TOLERANCE, CLOSED, ACCEPTED = 1e-15, 1e-11, 3e-9
"""Distance of the end from the start, relative to one plus the size of the state, at which Newton's method stops; that from which on it stops
as soon as a step leads no nearer, as small orbits are better known than that; and that which is accepted where rounding lets it fall no further."""
KEPT = 0.1
"""Factor by which the distance must fall for the derivative to be kept."""
LONGEST_STEP, BACKTRACKS = 0.3, 5
"""Largest change of the state in a step, relative to one plus its size; and halvings of a step that leads farther away."""
OFF_PERIOD = 0.05
"""Largest distance of a time from a whole number of turns, in these, at which it is taken for it."""
SHORTER, SHORTEST = 0.5, 1e-2
"""Least period that Newton's method may lead to, relative to that of the guess, and in ``1/Ω``: no time at all closes any path."""
DENSE, DIRECTIONS = 40, 24
"""Numbers of a state up to which its whole derivative is computed; and the directions in which it is known beyond."""
CLOSURE_RTOL = 1e-6
STILL = 1e-6
"""Rate of change of the state below which a rotor is at rest in its frame: a synchronous rub is no orbit."""
MOST_PARTS = 64
"""Most shorter periods of which a period may consist."""


def close(motion: Trajectory, begin: float, period: float, budget: FlowBudget | None = None) -> SimulatedOrbit | None:
    """Close the periodic orbit next to a stretch of a motion.

    Parameters
    ----------
    motion : Trajectory
    begin, period : float
        Where the stretch begins, in the time of the motion, and how long it is.
    budget : FlowBudget, optional
        What the motions are paid from.

    Returns
    -------
    SimulatedOrbit or None
        ``None`` if Newton's method does not converge, or to levitation.
    """
    budget = budget or FlowBudget()
    flow, vector = Flow.at(motion, begin, budget)
    whole = flow.follow(vector, period) if period > SHORTEST else None
    if whole is None:
        return None
    known = repeats_after(whole)
    if known is not None:
        count = round(period / known)
        if count < 1 or abs(period - count * known) > OFF_PERIOD * known:
            return None
        period = count * known
    flow, vector = Flow.at(whole, quietest(whole), budget)
    found = newton(flow, vector, period, free=known is None)
    return None if found is None else _orbit(flow, *found, known)


def quietest(motion: Trajectory) -> float:
    """Middle of the longest flight of a motion, or else of its longest stretch without an event."""
    events = np.unique([0.0, *(each.time for each in happenings(motion)), motion.time])
    lengths, middles = np.diff(events), 0.5 * (events[1:] + events[:-1])
    _, phases = motion.amplitudes_at(middles)
    flies = (phases == Phase.FLIGHT).all(axis=1)
    lengths = np.where(flies | ~flies.any(), lengths, 0.0)
    return float(middles[int(np.argmax(lengths))])


def newton(flow: Flow, vector: np.ndarray, period: float, *, free: bool) -> tuple[np.ndarray, float] | None:
    """Solve for a closed path of the flow next to a state; with a ``free`` period this is an unknown too."""
    motion = flow.follow(vector, period)
    if motion is None:
        return None
    apart, step, guess = flow.vector(motion.final) - vector, None, period
    miss = _size(apart, vector)
    for _ in range(ITERATIONS):
        if miss <= TOLERANCE:
            break
        if step is None:
            step = _solver(flow, vector, period, motion, free=free)
        change = step(-apart)
        if change is None:
            return None
        length = float(np.abs(change).max()) / (1.0 + float(np.abs(vector).max()))
        share, before = min(1.0, LONGEST_STEP / length if length > 0.0 else 1.0), miss
        for _ in range(BACKTRACKS if miss > CLOSED else 1):
            there = vector + share * change[: len(vector)]
            later = period + share * float(change[-1]) if free else period
            ahead = flow.follow(there, later) if later > SHORTER * guess else None
            if ahead is not None and _size(flow.vector(ahead.final) - there, there) < miss:
                break
            share *= 0.5
        else:
            break
        vector, period, motion = there, later, ahead
        apart = flow.vector(motion.final) - vector
        miss = _size(apart, vector)
        if miss > KEPT * before:
            step = None
    return (vector, period) if miss <= ACCEPTED else None


def _size(apart: np.ndarray, vector: np.ndarray) -> float:
    return float(np.abs(apart).max()) / (1.0 + float(np.abs(vector).max()))


def _solver(
    flow: Flow, vector: np.ndarray, period: float, motion: Trajectory, *, free: bool
) -> Callable[[np.ndarray], np.ndarray | None]:
    """Newton's step from a distance: of few numbers by the whole derivative, else in the space that the distance spans."""
    n = len(vector)
    begun, ended = (flow.rate(vector, 0.0), flow.rate(vector, period)) if free else (None, None)

    def bordered(change: np.ndarray, moved: np.ndarray) -> np.ndarray:
        if begun is None:
            return moved - change
        return np.append(moved - change[:n] + ended * change[n], begun @ change[:n])

    def applied(change: np.ndarray) -> np.ndarray:
        moved = flow.change(vector, change[:n], motion) if change[:n].any() else np.zeros(n)
        return bordered(change, moved)

    if n > DENSE:
        return lambda right: _krylov_step(applied, np.append(right, 0.0) if free else right)
    slopes = flow.derivative(vector, motion)
    whole = np.eye(n + int(free))
    matrix = np.array([bordered(each, slopes @ each[:n]) for each in whole]).T

    def step(right: np.ndarray) -> np.ndarray | None:
        try:
            found = np.linalg.solve(matrix, np.append(right, 0.0) if free else right)
        except np.linalg.LinAlgError:
            return None
        return found if np.isfinite(found).all() else None

    return step


def _krylov_step(applied: Callable[[np.ndarray], np.ndarray], right: np.ndarray) -> np.ndarray | None:
    basis, matrix = krylov(applied, right, DIRECTIONS)
    if not np.isfinite(matrix).all():
        return None
    goal = np.zeros(len(matrix))
    goal[0] = np.linalg.norm(right)
    return basis @ np.linalg.lstsq(matrix, goal, rcond=None)[0]


def _orbit(flow: Flow, vector: np.ndarray, period: float, repeats: float | None) -> SimulatedOrbit | None:
    """The orbit of a closed path: as short as it is, with its multipliers."""
    motion = flow.follow(vector, period)
    if motion is None or not _touches(motion) or float(np.abs(flow.rate(vector, period)).max()) < STILL:
        return None
    found = happenings(motion)
    contacts_begun = sum(each.begins_contact for each in found)
    most = contacts_begun or MOST_PARTS
    for parts in range(min(most, MOST_PARTS), 1, -1):
        part = period / parts
        whole = repeats is None or abs(part / repeats - round(part / repeats)) < CLOSURE_RTOL
        possible = part > SHORTEST and whole and len(found) % parts == 0
        if possible and _size(flow.end(vector, part) - vector, vector) < CLOSURE_RTOL:
            closed = newton(flow, vector, part, free=repeats is None)
            if closed is not None and abs(closed[1] - part) < CLOSURE_RTOL * part:
                return _orbit(flow, *closed, repeats)
    values, complete = _multipliers(flow, vector, motion, free=repeats is None)
    if values is None:
        return None
    name = CountedName(contacts_begun, 1, "" if contacts_begun else _in_contact(motion))
    state = flow.state(vector)
    return SimulatedOrbit(flow.rotor, name, state, period, Multipliers(values, BEND**2), complete, repeats, flow.rests)


def _in_contact(motion: Trajectory) -> str:
    """Kind of a name: what a plane that never leaves the wall does, if that is backward in the fixed frame all the time."""
    phases = motion.segment_phases[np.diff(motion.segment_starts, append=motion.time) > 0.0]
    plane = int(np.argmax(phases[0] != Phase.FLIGHT))
    place, moving = motion.rotor.system.at_plane(motion.segment_amplitudes, plane)
    backward = (place.conj() * moving).imag < -(np.abs(place) ** 2)
    if not (phases == phases[0]).all() or not backward.all():
        return "rubbing"
    return "rolling" if phases[0, plane] == Phase.ROLLING else "whirl"


def _touches(motion: Trajectory) -> bool:
    """Whether a motion touches a wall at all: levitation is no orbit."""
    return bool((motion.segment_phases != Phase.FLIGHT).any() or motion.is_impact.any())


def _multipliers(flow: Flow, vector: np.ndarray, motion: Trajectory, *, free: bool) -> tuple[np.ndarray | None, bool]:
    """Non-trivial multipliers, the largest first, and whether these are all."""
    complete = len(vector) <= DENSE
    if complete:
        slopes = flow.derivative(vector, motion)
    else:
        random = np.random.default_rng(0).normal(size=len(vector))
        slopes = krylov(lambda change: flow.change(vector, change, motion), random, DIRECTIONS)[1][:-1]
    return multipliers_from(slopes, free=free) if np.isfinite(slopes).all() else None, complete


def multipliers_from(slopes: np.ndarray, *, free: bool) -> np.ndarray:
    """Multipliers of the derivative of a closed path, the largest first; without that of a delay where the period is free."""
    values = np.linalg.eigvals(slopes).astype(complex).tolist()
    if free:
        values.remove(min(values, key=lambda value: abs(value - 1.0)))
    return np.array(sorted(values, key=lambda value: (-abs(value), -value.imag)))
