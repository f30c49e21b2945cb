"""The word on the other side of a border: one impact more or less, or friction that stops the slip or no longer does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.base.outcome import InputError
from carom.core.friction import friction_margin, slip_of
from carom.core.margins import highest_point
from carom.orbits.admissibility import departure
from carom.orbits.orbit import Orbit
from carom.orbits.shooting import ShootingStart
from carom.orbits.word import Kind, Word


def _with_impact(orbit: Orbit) -> tuple[Word, ShootingStart]:
    """One impact more, where the highest maximum of the radius touches the wall."""
    system, best = orbit.rotor.system, (-np.inf, 0, 0.0)
    nodes = system.nodes.amplitudes(orbit.nodes)
    left = [departure(orbit.rotor, *pair) for pair in zip(orbit.word, nodes, strict=True)]
    for i, after in enumerate(left):
        height, top = highest_point(system.arrays, 0, after, float(orbit.durations[i]))
        if height > best[0]:
            best = height, i, top
    _, i, top = best
    touching = system.fly(left[i], np.array(top))
    position, velocity = system.at_plane(touching, 0)
    slip = slip_of(complex(np.conj(position) * velocity), system.contacts[0].wall)
    added = Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD
    word = Word((*orbit.word[: i + 1], added, *orbit.word[i + 1 :]))
    states = np.insert(orbit.nodes, i + 1, system.nodes.of(touching[None])[0], axis=0)
    durations = np.insert(orbit.durations, i + 1, orbit.durations[i] - top)
    durations[i] = top
    return word, ShootingStart(states, durations)


def _without_impact(orbit: Orbit) -> tuple[Word, ShootingStart]:
    """One impact less: the slowest, which has no speed."""
    if len(orbit.word) == 1:
        raise InputError("orbit", str(orbit.word), "one with another flight than that after the impact that vanishes")
    # It comes last, so that the flight before it is the one that goes on.
    first = (int(np.argmin(orbit.impact_speeds)) + 1) % len(orbit.word)
    nodes, durations = orbit.start.turned(first)
    durations[-2] += durations[-1]
    return Word(orbit.word.turned(first)[:-1]), ShootingStart(nodes[:-1], durations[:-1])


def _with_other_slip(orbit: Orbit) -> tuple[Word, ShootingStart]:
    """The same impacts, one of which stops the slip or no longer does."""
    wall, gaps = orbit.rotor.system.contacts[0].wall, []
    for i, section in enumerate(orbit.sections):
        local = complex(section.radial_speed, section.angular_speed)
        gaps.append((abs(friction_margin(local, wall)), i, slip_of(local, wall)))
    _, i, slip = min(gaps)
    slides = Kind.IMPACT_FORWARD if slip > 0.0 else Kind.IMPACT_BACKWARD
    changed = Kind.IMPACT_STOPPED if orbit.word[i].sense else slides
    return Word((*orbit.word[:i], changed, *orbit.word[i + 1 :])), orbit.start


BORDERS: dict[str, Callable[[Orbit], tuple[Word, ShootingStart]]] = {
    "grazing": _with_impact,
    "vanishing-impact": _without_impact,
    "slip-stop": _with_other_slip,
}
"""Borders at which the word of a motion changes: from the orbit on the border the word, nodes and durations of the other side.

:class:`InputError` if no orbit is left without the impact.
"""
