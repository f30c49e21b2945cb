"""One kick of a flexible machine, followed at each touchdown plane: what is needed to draw it over time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.explorer.computing.flexible_kicks import MOST_EVENTS
from carom.explorer.computing.kicked_motion import (
    LEAST_SAMPLES,
    LONGEST,
    LONGEST_BOUNCING,
    PER_TURN,
    Span,
    span_of,
)
from carom.explorer.computing.walls import YIELDING, Hits, hits_of
from carom.models import Rotor
from carom.motions import Trajectory, kick, simulate
from carom.motions.settling import REPEATING
from carom.outcome import Outcome
from carom.parameters.told import told, told_angle
from carom.plots.style import OUTCOMES
from carom.progress import ShowProgress
from carom.studies import Wording
from carom.studies.wording import counted, listed

AFTER_CONTACT = 60.0
"""Time in ``1/Ω`` that is drawn after the last contact of a motion that comes back: some ten turns."""
MOST_SAMPLES = 6000
"""Instants that are drawn at most."""


@dataclass(frozen=True, eq=False)
class AtPlane:
    """A motion at one touchdown plane; lengths in its clearances, forces in ``m c_r Ω²``.

    Attributes
    ----------
    x, y : ndarray of float32, shape (n,)
        Position in the co-rotating frame.
    force : ndarray of float32, shape (n,)
        Normal force.
    impact_times, impact_angles, impact_speeds, blows : ndarray of float32, shape (m,)
        Arrivals at the bearing, and the peak force of each contact.
    forward : ndarray of bool, shape (m,)
        Whether the rotor whirls forward in the fixed frame on arriving.
    spans : tuple of Span
        Contacts.
    hardest, deepest : float
        Of all contacts, also those that are not drawn.
    words : str
        What the bearing bears.
    """

    x: np.ndarray
    y: np.ndarray
    force: np.ndarray
    impact_times: np.ndarray
    impact_angles: np.ndarray
    impact_speeds: np.ndarray
    blows: np.ndarray
    forward: np.ndarray
    spans: tuple[Span, ...]
    hardest: float
    deepest: float
    words: str


@dataclass(frozen=True, eq=False)
class FlexibleMotion:
    """A motion after a kick.

    Attributes
    ----------
    times : ndarray of float32, shape (n,)
        In ``1/Ω``.
    planes : tuple of AtPlane
    whole : bool
        Whether the motion is drawn up to where its end is known.
    outcome, colour, words : str
        Label of the outcome, its colour, and what is seen, as one sentence.
    """

    times: np.ndarray
    planes: tuple[AtPlane, ...]
    whole: bool
    outcome: str
    colour: str
    words: str


def follow_flexible(rotor: Rotor, right: float, up: float, progress: ShowProgress = None) -> FlexibleMotion:
    """Follow a kick by its parts to the right and upward at its instant, in units of the equations; refuse one that is not possible."""
    size, angle = math.hypot(right, up), math.atan2(up, right)
    start = kick(size, angle).state(rotor)
    motion = simulate(rotor, start, settle=True, max_events=MOST_EVENTS, progress=progress)
    count = len(rotor.system.planes)
    hits = [hits_of(motion.seen_at(plane)) for plane in range(count)]
    until = _shown_until(motion)
    # That it comes back is known long before it is there; then there is no further contact.
    shown = motion if motion.time >= until else simulate(rotor, start, until, max_events=MOST_EVENTS)
    until = min(until, shown.time)
    times = shown.sample(max(LEAST_SAMPLES, min(MOST_SAMPLES, int(PER_TURN * until / math.tau))))
    times = times[times <= until]
    times = times[:: math.ceil(len(times) / MOST_SAMPLES)]
    return FlexibleMotion(
        times=times.astype(np.float32),
        planes=tuple(_at_plane(shown.seen_at(plane), times, every) for plane, every in enumerate(hits)),
        whole=until >= motion.time or motion.outcome is Outcome.LEVITATED,
        outcome=motion.outcome.label,
        colour=OUTCOMES[motion.outcome.label].colour,
        words=_words(motion, size, angle, hits),
    )


def _shown_until(motion: Trajectory) -> float:
    """Time up to which a motion is drawn."""
    if motion.outcome is not Outcome.LEVITATED:
        return min(motion.time, LONGEST_BOUNCING if motion.outcome in REPEATING else LONGEST)
    events = motion.segment_starts[1:]
    last = float(events[-1]) if len(events) else 0.0
    return min(last + AFTER_CONTACT, LONGEST)


def _at_plane(shown: Trajectory, times: np.ndarray, every: Hits) -> AtPlane:
    position, _ = shown.at_plane(times)
    force, _ = shown.forces(times)
    drawn = every.time <= times[-1]
    angles = np.angle(np.exp(1j * every.angle[drawn]))
    say = Wording(shown.scales)
    words = "no contact"
    if every.count:
        load, depth = YIELDING.load(every.hardest, shown.scales), say.length(every.deepest)
        words = f"{counted(every.count, YIELDING.noun)}, up to {load}, {depth} deep"
    return AtPlane(
        x=position.real.astype(np.float32),
        y=position.imag.astype(np.float32),
        force=force.astype(np.float32),
        impact_times=every.time[drawn].astype(np.float32),
        impact_angles=angles.astype(np.float32),
        impact_speeds=every.radial_speed[drawn].astype(np.float32),
        blows=every.blow[drawn].astype(np.float32),
        forward=every.angular_speed[drawn] > -1.0,
        spans=tuple(span_of(each) for each in shown.lasting_contacts if each.start <= times[-1]),
        hardest=every.hardest,
        deepest=every.deepest,
        words=words,
    )


def _words(motion: Trajectory, size: float, angle: float, hits: list[Hits]) -> str:
    begin = f"A kick of {told(size, 'velocity', motion.rotor.scales)} at {told_angle(angle % math.tau)}"
    met = [str(plane) for plane, every in enumerate(hits, start=1) if every.count]
    end = OUTCOMES[motion.outcome.label].words
    settled = "ends in" if motion.outcome.settled else "was given up,"
    if not met:
        return f"{begin} {settled} {end} without contact."
    where = f"touchdown bearing {met[0]}" if len(met) == 1 else f"touchdown bearings {listed(met)}"
    return f"{begin} meets {where} and {settled} {end}."
