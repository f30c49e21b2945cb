"""The orbit that a simulated motion repeats: its word is read from the events, and Newton's method closes it."""

from __future__ import annotations

import numpy as np

from carom.arguments import checked
from carom.models import Rotor
from carom.motions.simulation import simulate
from carom.motions.starts import amplitudes_of
from carom.motions.trajectories import Trajectory
from carom.orbits.chatter import slow_departures
from carom.orbits.happenings import arrives, first_of_period, impact_kinds
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.shooting import Start
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.simulated_search import periodic_of
from carom.orbits.word import Kind, Segment, Word
from carom.outcome import Outcome, Phase

PERIODIC = (Outcome.BOUNCING, Outcome.MIXED)
MORE = 1.1
"""Periods that are simulated to find a whole one between two lift-offs."""
SAME_TIME = 1e-3
"""Relative difference of the time between two lift-offs and the period, if they are the same lift-off."""
SAMPLES = 200
"""Times in a turn at which the normal force is compared to find where it is least."""
AROUND = 1e-3
"""Distance, relative to one plus the size of the nodes, within which the orbit of a settled motion is searched for."""


@checked
def orbit_of_motion(motion: Trajectory) -> Orbit | SimulatedOrbit | None:
    """Close the periodic orbit on which a motion has settled.

    Parameters
    ----------
    motion : Trajectory
        Settled to periodic bouncing, with or without lasting contact in the period (``settle=True``); of other machines than the planar
        rotor in a rigid bearing also to a whirl in contact.

    Returns
    -------
    Orbit, SimulatedOrbit or None
        Of the planar rotor in a rigid bearing as a word of segments.  ``None`` if the motion has not settled to such an orbit, or if
        Newton's method closes none next to it.

    See Also
    --------
    carom.find_orbits : all orbits with one impact a period
    carom.continue_orbit : follow it along a parameter

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> motion = cm.simulate(machine, cm.kick("60 mm/s"), settle=True)
    >>> print(f"{cm.orbits.orbit_of_motion(motion).period:.9f}")
    2.328416080
    """
    return orbit_of_bouncing(motion) if motion.rotor.has_closed_forms else periodic_of(motion)


def orbit_of_bouncing(motion: Trajectory) -> Orbit | None:
    """:func:`orbit_of_motion` for the planar rotor in a rigid bearing."""
    count = motion.multiplicity
    struck = arrives(motion)
    times = motion.segment_starts[1:][struck]
    if motion.outcome not in PERIODIC or count == 0 or len(times) < count:
        return None
    begun = first_of_period(motion, count)
    first = int(np.flatnonzero(struck)[begun])
    if (motion.is_landing & ~struck)[first:].any():
        # The last period may begin within a chatter: look for one from lift-off to lift-off.
        period = motion.time - float(times[begun])
        later = simulate(motion.rotor, motion.final, (1.0 + MORE) * period)
        return _between(later, lift_offs(later), period)
    return _closed(motion, first, len(motion.arrivals))


def lift_offs(motion: Trajectory) -> np.ndarray:
    """Events of a motion at which it lifts off a plane."""
    flying = motion.segment_phases == Phase.FLIGHT
    events = np.arange(len(motion.event_planes))
    return np.flatnonzero(~flying[events, motion.event_planes] & flying[events + 1, motion.event_planes])


def orbit_of_whirl(motion: Trajectory, period: float) -> Orbit | None:
    """Close the orbit of a whirl of the planar rotor that stays in contact with the wall and slides, at least for a part of each turn.

    Parameters
    ----------
    motion : Trajectory
        Settled to such a whirl.
    period : float
        Time of a turn along the wall in the co-rotating frame, in ``1/Ω``.

    Returns
    -------
    Orbit or None
        ``None`` if Newton's method closes none next to the motion.
    """
    turns = simulate(motion.rotor, motion.final, (1.0 + MORE) * period)
    # At the start it is put to rest on the wall.
    changes = np.flatnonzero(
        (np.diff(turns.segment_phases, axis=0) != 0).any(axis=1) & (turns.segment_starts[1:] > 0.0)
    )
    if len(changes):
        return _between(turns, changes, period)
    kind = Kind.of_phase(int(turns.segment_phases[-1, 0]))
    if kind is Kind.ROLL:
        return None
    least = simulate(motion.rotor, motion.final, _time_of_least_force(turns, period)).final
    node = motion.rotor.system.nodes.of(amplitudes_of(motion.rotor, least)[0][None])
    return _near(motion.rotor, Word.of(kind), Start(node, np.array([period])))


def _time_of_least_force(turns: Trajectory, period: float) -> float:
    """Time in the second of two turns at which the normal force is least, by a parabola through three samples."""
    step = period / SAMPLES
    forces = turns.forces(period + step * np.arange(SAMPLES))[0]
    least = int(np.argmin(forces))
    before, here, after = (float(forces[(least + shift) % SAMPLES]) for shift in (-1, 0, 1))
    bend = before - 2.0 * here + after
    return period + step * (least + (0.5 * (before - after) / bend if bend > 0.0 else 0.0))


def _between(motion: Trajectory, events: np.ndarray, period: float) -> Orbit | None:
    """Orbit from the first of some events to the one a period later."""
    if not len(events):
        return None
    times = motion.segment_starts[1:][events]
    last = int(np.argmin(np.abs(times - times[0] - period)))
    if abs(times[last] - times[0] - period) > SAME_TIME * period:
        return None
    return _closed(motion, int(events[0]), int(events[last]))


def _closed(motion: Trajectory, first: int, last: int) -> Orbit | None:
    """Orbit next to a motion from one event up to another a period later."""
    return _near(motion.rotor, *segments_of(motion, first, last))


def _near(rotor: Rotor, word: Word, start: Start) -> Orbit | None:
    """Orbit next to a start, if it is the one that the motion has settled on."""
    orbit, begun = orbit_near(rotor, word, start), start.nodes[0]
    if orbit is None or np.abs(orbit.nodes - begun).max(axis=1).min() > AROUND * (1.0 + np.abs(begun).max()):
        return None
    return orbit


def segments_of(motion: Trajectory, first: int, last: int, *, brief: bool = False) -> tuple[Word, Start]:
    """Word, nodes and durations of a motion from one event up to another, which the last segment reaches.

    Impacts that lead to a landing without anything else in between become one chatter, but for those up to a slow one from
    which the rotor did not return at once; if it is to be ``brief``, only those from which on each bounce is shorter than the one before.
    """
    steps: list[tuple[Segment, np.ndarray, float]] = []
    struck_at: list[int] = []
    times = np.append(motion.segment_starts[1:], motion.time)
    kinds, places = impact_kinds(motion)[first:last].tolist(), np.arange(first, last)
    planes = motion.event_planes[first:last]
    known = {
        (kind, plane): Segment(Kind(kind), plane)
        for kind, plane in set(zip(kinds, planes.tolist(), strict=True))
        if plane >= 0
    }
    phases = zip(*(motion.segment_phases[places + later, planes].tolist() for later in (0, 1)), strict=True)
    strikes = motion.is_impact[first:last].tolist()
    for event, strike, struck, plane, (before, after) in zip(
        places.tolist(), strikes, kinds, planes.tolist(), phases, strict=True
    ):
        if strike:
            struck_at.append(event)
            steps.append((known[struck, plane], motion.arrivals[event], float(times[event])))
            continue
        if before == after:
            continue  # long contacts are logged in steps, and so is flight next to a wall beside other planes
        if before == Phase.FLIGHT:
            bounces = next((k for k, step in enumerate(reversed(steps)) if not _bounces(step[0], plane)), len(steps))
            bounces -= _not_of_chatter(motion, plane, struck_at[len(struck_at) - bounces :][:-1])
            if brief:
                bounces = _getting_shorter([step[2] for step in steps[len(steps) - bounces :]])
            chatter = steps[len(steps) - bounces :]
            del steps[len(steps) - bounces :]
            if chatter:
                steps.append((Segment(Kind.LAND, plane), chatter[0][1], chatter[0][2]))
        steps.append((Segment(Kind.of_phase(after), plane), motion.segment_amplitudes[event + 1], float(times[event])))
    segments, nodes, begins = zip(*steps, strict=True)
    states = motion.rotor.system.nodes.of(np.array(nodes))
    return Word(segments), Start(states, np.diff([*begins, float(times[last])]))


def _bounces(segment: Segment, plane: int) -> bool:
    return segment.kind.is_impact and segment.plane == plane


def _not_of_chatter(motion: Trajectory, plane: int, bounces: list[int]) -> int:
    """Number of the bounces before the last of a landing, given by their events, up to the last slow departure."""
    *_, last = -1, *slow_departures(motion.rotor, plane, motion.segment_amplitudes[1:][bounces])
    return last + 1


def _getting_shorter(times: list[float]) -> int:
    """Number of the last bounces of which each is shorter than the one before, the last one included."""
    growing = np.flatnonzero(np.diff(np.diff(times)) >= 0.0)
    return len(times) - 1 - int(growing[-1]) if len(growing) else len(times)


def with_impacts(motion: Trajectory, first: int, count: int) -> tuple[Word, Start] | None:
    """Word and start of some arrivals at walls in a row, from that of given number; ``None`` where the motion does else."""
    impacts = np.flatnonzero(arrives(motion))
    if first + count >= len(impacts):
        return None
    if impacts[first + count] - impacts[first] != count:
        return None
    return segments_of(motion, int(impacts[first]), int(impacts[first + count]))
