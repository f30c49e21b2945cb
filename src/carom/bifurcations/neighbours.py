"""The word on the other side of a border: one impact more or less, or friction that stops the slip or no longer does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.core.margins import highest_point
from carom.models import Model
from carom.motions.starts import State
from carom.motions.trajectories import simulate
from carom.orbits.admissibility import SLIPS, departure
from carom.orbits.orbit import Orbit
from carom.orbits.recognising import segments_of
from carom.orbits.shooting import Links, Start
from carom.orbits.word import Kind, Segment, Word
from carom.outcome import InputError


def neighbour(kind: str, orbit: Orbit) -> tuple[Word, Start]:
    """Word, nodes and durations of the orbit on a border, read as one of the neighbouring word.

    Parameters
    ----------
    kind : str
        ``"grazing"``, ``"vanishing-impact"`` or ``"slip-stop"``.
    orbit : Orbit
        The orbit on the border.

    Raises
    ------
    InputError
        Another kind, or no orbit is left without the impact.
    """
    if kind not in NEIGHBOURS:
        raise InputError("border", kind, f"one of {', '.join(NEIGHBOURS)}: no orbit is constructed beyond others")
    return NEIGHBOURS[kind](orbit)


def interrupted(rotor: Model, word: Word, links: Links) -> tuple[Word, Start] | None:
    """The impacts that a chatter becomes beyond the onset of lasting contact, read from a simulated period.

    How many they are grows with the logarithm of the distance from the onset.

    Parameters
    ----------
    rotor : Model
        Beyond the onset.
    word : Word
        A lift-off, a chatter, and lasting contact.
    links : Links
        Its segments there, with the interrupted chatter.

    Returns
    -------
    tuple or None
        ``None`` for another word, or if the simulated motion does anything but strike.
    """
    lifts = np.flatnonzero(word.kinds == Kind.LIFT)
    if len(word) != 3 or len(lifts) != 1:
        return None
    nodes, durations = links.start
    flight, period = float(durations[lifts[0]]), float(durations.sum())
    position, velocity = rotor.system.state(rotor.system.amplitudes_of(nodes[lifts])[0])
    start = State.of(position / abs(position), velocity)
    motion = simulate(rotor, start, period + 1.5 * flight)
    times = motion.segment_starts[1:]
    first = int(np.searchsorted(times, 0.5 * flight))
    last = int(np.searchsorted(times, 0.5 * flight + period))
    if last >= len(times) or not motion.is_impact[first : last + 1].all():
        return None
    return segments_of(motion, first, last)


def _with_impact(orbit: Orbit) -> tuple[Word, Start]:
    """One impact more, where the highest maximum of the radius touches the wall."""
    arrays, nodes = orbit.rotor.system.arrays, orbit.rotor.system.amplitudes_of(orbit.nodes)
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
    touching = orbit.rotor.system.fly(after, np.array(top))[None]
    position, velocity = orbit.rotor.system.at_plane(touching[0], plane)
    slip = float(arrays.drive[plane]) + float((np.conj(position) * velocity).imag)
    struck = Segment(Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD, plane)
    word = Word((*orbit.word[: i + 1], struck, *orbit.word[i + 1 :]))
    states = np.insert(orbit.nodes, i + 1, orbit.rotor.system.states_of(touching)[0], axis=0)
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
    nodes, durations = np.roll(orbit.nodes, -first, axis=0), np.roll(orbit.durations, -first)
    durations[-2] += durations[-1]
    return Word(word[:-1]), Start(nodes[:-1], durations[:-1])


def _with_other_slip(orbit: Orbit) -> tuple[Word, Start]:
    """The same impacts, one of which stops the slip or no longer does."""
    contacts = orbit.rotor.system.contacts
    gaps = []
    for i, segment in enumerate(orbit.word):
        if segment.kind.is_impact:
            contact, section = contacts[segment.plane], orbit.sections[i]
            taken = contact.friction * (1.0 + contact.restitution) * section.radial_speed
            slip = contact.drive + section.angular_speed
            gaps.append((abs(abs(slip) - taken), i, slip))
    _, i, slip = min(gaps)
    slides = Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD
    changed = Segment(Kind.IMPACT_STOPPED if SLIPS[orbit.word[i].kind] else slides, orbit.word[i].plane)
    return Word((*orbit.word[:i], changed, *orbit.word[i + 1 :])), Start(orbit.nodes, orbit.durations)


NEIGHBOURS: dict[str, Callable[[Orbit], tuple[Word, Start]]] = {
    "grazing": _with_impact,
    "vanishing-impact": _without_impact,
    "slip-stop": _with_other_slip,
}
"""Borders beyond which the orbit of the neighbouring word is known."""
