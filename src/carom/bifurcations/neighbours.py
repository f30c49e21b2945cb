"""The word on the other side of a border: one impact more or less, or friction that stops the slip or no longer does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.bifurcations.points import OF_CONTACT
from carom.core.friction import slip_of, spare_friction
from carom.core.margins import highest_point
from carom.core.wall import set_on_wall
from carom.models import Rotor
from carom.motions.simulation import simulate
from carom.motions.starts import State
from carom.orbits.admissibility import INSTANT, departure
from carom.orbits.orbit import Orbit, orbit_near
from carom.orbits.recognising import orbit_of_whirl, segments_of
from carom.orbits.shooting import Start
from carom.orbits.word import Kind, Segment, Word
from carom.outcome import InputError, Phase

SIMULATED = 3.3
"""Periods that are simulated to read two."""
SAME_TIME = 0.02
"""Relative difference of the period read from that on the border."""
MOST_EVENTS = 20_000
"""Events of a motion from which a period is read."""


def setting_out(orbit: Orbit) -> State:
    """State on an orbit from which motions beside it are simulated.

    After the first impact if it only bounces; otherwise in the middle of its longest flight after a lift-off, or on the
    wall if it never leaves it.
    """
    if orbit.word.flies:
        return orbit.departure
    system, amplitudes = orbit.rotor.system, orbit.rotor.system.nodes.amplitudes(orbit.nodes)
    flights = np.flatnonzero(orbit.word.kinds == Kind.LIFT).tolist()
    if flights:
        longest = max(flights, key=lambda i: orbit.durations[i])
        begun = departure(orbit.rotor, orbit.word[longest], amplitudes[longest])
        return State.of(*system.state(system.fly(begun, np.array(0.5 * orbit.durations[longest]))))
    set_on_wall(system.arrays, orbit.word[0].plane, amplitudes[0])
    return State.of(*system.state(amplitudes[0]))


def read_beside(orbit: Orbit, rotor: Rotor) -> list[tuple[Word, Start]]:
    """Read the next two periods of a motion, of a rotor beside a border, that starts on the orbit on it.

    Each gives a word, nodes and durations.  Where lasting contact begins, the word holds the impacts that a chatter
    becomes: the closer to the border, the more.

    Returns
    -------
    list of (Word, Start)
        Fewer if nothing recurs after about a period.
    """
    # The orbit of the same word there is no motion, but nearer to the one that is sought than that on the border.
    beside = orbit_near(rotor, orbit.word, orbit.start) or orbit
    motion = simulate(rotor, setting_out(beside), SIMULATED * orbit.period, max_events=MOST_EVENTS)
    times, places = motion.segment_starts[1:], np.arange(len(motion.event_planes))
    before, after = (motion.segment_phases[places + later, motion.event_planes] for later in (0, 1))
    signs = np.stack([motion.event_planes, before, after], axis=1)
    changes = motion.is_impact | (before != after)
    begins = np.flatnonzero(changes & (times > INSTANT) & (times < orbit.period))
    if not changes[times > INSTANT].any():
        whirl = orbit_of_whirl(motion, orbit.period)
        return [] if whirl is None else [(whirl.word, whirl.start)]
    if not len(begins):
        return []
    # From the first change on: whether a later period is like it is what is asked.  A chatter must not be cut.
    lifts = begins[(before[begins] != Phase.FLIGHT) & (after[begins] == Phase.FLIGHT)]
    cut = not motion.is_impact[begins[0]] or not any(segment.kind.flies for segment in beside.word)
    first = lifts[int(np.argmax(np.diff(times)[lifts]))] if cut and len(lifts) else begins[0]
    alike = np.flatnonzero((signs == signs[first]).all(axis=1))
    read = []
    # The first period may still be that of the orbit, the second no longer that from which the other word is seen.
    for _ in range(2):
        last = alike[int(np.argmin(np.abs(times[alike] - times[first] - orbit.period)))]
        if abs(times[last] - times[first] - orbit.period) > SAME_TIME * orbit.period:
            break
        read.append(segments_of(motion, int(first), int(last)))
        first = last
    return read


def is_other(word: Word, known: Word) -> bool:
    """Whether two words differ, whichever segment they begin with."""
    return not word.turns_to(known)


def _highest(orbit: Orbit) -> tuple[int, int, float, np.ndarray]:
    """Segment, plane and time from its beginning of the highest maximum of the radius in flight, and the amplitudes there (1, N)."""
    arrays, nodes = orbit.rotor.system.arrays, orbit.rotor.system.nodes.amplitudes(orbit.nodes)
    best, found = -np.inf, (0, 0, 0.0)
    for i, segment in enumerate(orbit.word):
        if segment.kind.flies:
            after = departure(orbit.rotor, segment, nodes[i])
            for plane in range(len(arrays.rows)):
                height, top = highest_point(arrays, plane, after, float(orbit.durations[i]))
                if height > best:
                    best, found = height, (i, plane, top)
    i, plane, top = found
    after = departure(orbit.rotor, orbit.word[i], nodes[i])
    return i, plane, top, orbit.rotor.system.fly(after, np.array(top))[None]


def _with_impact(orbit: Orbit) -> tuple[Word, Start]:
    """One impact more, where the highest maximum of the radius touches the wall."""
    i, plane, top, touching = _highest(orbit)
    position, velocity = orbit.rotor.system.at_plane(touching[0], plane)
    slip = slip_of(complex(np.conj(position) * velocity), orbit.rotor.system.contacts[plane].wall)
    struck = Segment(Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD, plane)
    word = Word((*orbit.word[: i + 1], struck, *orbit.word[i + 1 :]))
    states = np.insert(orbit.nodes, i + 1, orbit.rotor.system.nodes.of(touching)[0], axis=0)
    durations = np.insert(orbit.durations, i + 1, orbit.durations[i] - top)
    durations[i] = top
    return word, Start(states, durations)


def _without_impact(orbit: Orbit) -> tuple[Word, Start]:
    """One impact less: the slowest, which has no speed."""
    impacts = [i for i, segment in enumerate(orbit.word) if segment.kind.is_impact]
    slowest = min(impacts, key=lambda i: orbit.sections[i].radial_speed)
    # It comes last, so that the flight before it is the one that goes on.
    first = (slowest + 1) % len(orbit.word)
    word = orbit.word.turned(first)
    if len(word) == 1 or not word[-2].kind.flies:
        raise InputError("orbit", str(orbit.word), "one with another flight than that after the impact that vanishes")
    nodes, durations = orbit.start.turned(first)
    durations[-2] += durations[-1]
    return Word(word[:-1]), Start(nodes[:-1], durations[:-1])


def _with_other_slip(orbit: Orbit) -> tuple[Word, Start]:
    """The same impacts, one of which stops the slip or no longer does."""
    contacts = orbit.rotor.system.contacts
    gaps = []
    for i, segment in enumerate(orbit.word):
        if segment.kind.is_impact:
            wall, section = contacts[segment.plane].wall, orbit.sections[i]
            local = complex(section.radial_speed, section.angular_speed)
            gaps.append((abs(spare_friction(local, wall)), i, slip_of(local, wall)))
    _, i, slip = min(gaps)
    slides = Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD
    changed = Segment(Kind.IMPACT_STOPPED if orbit.word[i].kind.sense else slides, orbit.word[i].plane)
    return Word((*orbit.word[:i], changed, *orbit.word[i + 1 :])), orbit.start


NEIGHBOURS: dict[str, Callable[[Orbit], tuple[Word, Start]]] = {
    "grazing": _with_impact,
    "vanishing-impact": _without_impact,
    "slip-stop": _with_other_slip,
}
"""Borders beyond which the orbit of the neighbouring word is known: from the orbit on the border its word, nodes and durations.

Beyond other borders a period is simulated (:func:`read_beside`).  :class:`InputError` if no orbit is left without the impact.
"""
BORDERS = (*NEIGHBOURS, *OF_CONTACT)
"""Special points at which the word of a motion changes."""
