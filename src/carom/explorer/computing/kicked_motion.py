"""One kick, followed and sampled at each touchdown bearing: what is needed to draw it over time."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.attractors.naming import name_motions
from carom.base.outcome import Outcome
from carom.base.progress import ShowProgress
from carom.explorer.computing.planes import DisturbancePlane
from carom.explorer.computing.rest import rest_of
from carom.explorer.computing.walls import ContactPeaks, contact_peaks, wall_at
from carom.models import Rotor
from carom.motions import LastingContact, State, Trajectory, settle, simulate
from carom.motions.settling import REPEATING
from carom.parameters.formats import shown_in
from carom.plots.cells import MotionLook
from carom.plots.style import OUTCOMES, REGIMES
from carom.studies.wording import counted, listed

LONGEST, LONGEST_BOUNCING = 260.0, 110.0
"""Times in ``1/Ω`` that are drawn at most, of motions that come to rest and of others: some forty and seventeen turns."""
MOST_IMPACTS = 600
"""Impacts that are drawn at most."""
MOST_EVENTS = 20_000
"""Events after which a motion is given up, and of the part drawn, of which chatter may have many."""
AFTERWARDS = 12.0
"""Time in ``1/Ω`` that is drawn after it is known where a motion ends."""
PER_TURN = 90
LEAST_SAMPLES, MOST_SAMPLES = 500, 6000
CALM, LONGEST_CALM = 4.0, 120.0
"""Time constants, and the longest time, that are drawn after the last contact of a motion that comes back."""


@dataclass(frozen=True)
class ContactSpan:
    """A stretch of lasting contact: its times in ``1/Ω``, words and colour."""

    start: float
    end: float
    words: str
    colour: str


@dataclass(frozen=True, eq=False)
class PathAtBearing:
    """A motion at one touchdown bearing; lengths in its clearances.

    Attributes
    ----------
    x, y : ndarray of float32, shape (n,)
        Position in the co-rotating frame; the instants of impacts are among them.
    force : ndarray of float32, shape (n,)
        Normal force of a compliant bearing, in N or in ``m c_r Ω²``; zero in a rigid one.
    force_unit : str
    impact_times, impact_angles, impact_speeds, peak_loads : ndarray of float32, shape (m,)
        Impacts that are drawn, or impacts at a compliant bearing: time in ``1/Ω``, angle in rad, radial speed before in ``c_r Ω``, and how hard
        each is: normal impulse in ``m c_r Ω``, or peak force in ``m c_r Ω²``.
    forward : ndarray of bool, shape (m,)
        Whether the rotor whirls forward in the fixed frame just before the impact.
    spans : tuple of ContactSpan
        Lasting contact.
    hardest : float
        The hardest of all impacts, also of those that are not drawn; 0 without one.
    words : str
        What the bearing bears.
    """

    x: np.ndarray
    y: np.ndarray
    force: np.ndarray
    force_unit: str
    impact_times: np.ndarray
    impact_angles: np.ndarray
    impact_speeds: np.ndarray
    peak_loads: np.ndarray
    forward: np.ndarray
    spans: tuple[ContactSpan, ...]
    hardest: float
    words: str


@dataclass(frozen=True, eq=False)
class KickedMotion:
    """A motion after a kick.

    Attributes
    ----------
    times : ndarray of float32, shape (n,)
        In ``1/Ω``.
    planes : tuple of PathAtBearing
    whole : bool
        Whether the motion is drawn up to where it is settled.
    outcome, colour, words : str
        Label of the outcome, its colour, and what is seen, as one sentence.
    """

    times: np.ndarray
    planes: tuple[PathAtBearing, ...]
    whole: bool
    outcome: str
    colour: str
    words: str


def follow_kick(
    rotor: Rotor, plane: DisturbancePlane, first: float, second: float, progress: ShowProgress = None
) -> KickedMotion:
    """Follow one disturbance, by its components in units of the equations, to where it ends; refuse one that is not possible."""
    rotor, start, begin = plane.start(rotor, rest_of(rotor), first, second)
    motion = simulate(rotor, start, settle=True, progress=progress)
    # A motion is settled once its end is known, which may be long before it has arrived there.
    shown = simulate(rotor, start, _shown_until(rotor, motion), max_events=MOST_EVENTS)
    times = shown.sample(max(LEAST_SAMPLES, min(MOST_SAMPLES, int(PER_TURN * shown.time / math.tau))))
    times = times[:: math.ceil(len(times) / (2 * MOST_SAMPLES))]
    _, (name,) = name_motions(rotor, settle(rotor, State(np.array([start.position]), np.array([start.velocity]))))
    look = OUTCOMES["irregular" if name.irregular else name.outcome.label]
    every = [contact_peaks(motion.seen_at(place)) for place in range(len(rotor.system.planes))]
    return KickedMotion(
        times=times.astype(np.float32),
        planes=tuple(_at_bearing(shown.seen_at(place), times, peaks) for place, peaks in enumerate(every)),
        whole=shown.time >= motion.time,
        outcome=motion.outcome.label,
        colour=look.colour,
        words=_words(motion, begin, every, MotionLook(0, name, look, look.colour, 1.0).words),
    )


def _at_bearing(shown: Trajectory, times: np.ndarray, every: ContactPeaks) -> PathAtBearing:
    """What is drawn of a motion at the touchdown bearing at which it is seen."""
    position, _ = shown.at_plane(times)
    wall, log = wall_at(shown.rotor, shown.plane), contact_peaks(shown)
    factor, unit = shown_in("force", shown.scales)
    force = factor * shown.forces(times)[0] if wall.compliant else np.zeros(len(times))
    return PathAtBearing(
        x=position.real.astype(np.float32),
        y=position.imag.astype(np.float32),
        force=force.astype(np.float32),
        force_unit=unit,
        impact_times=log.time.astype(np.float32),
        impact_angles=np.angle(np.exp(1j * log.angle)).astype(np.float32),
        impact_speeds=log.radial_speed.astype(np.float32),
        peak_loads=log.peak_load.astype(np.float32),
        forward=log.angular_speed > -1.0,
        spans=tuple(map(span_of, shown.lasting_contacts)),
        hardest=every.hardest,
        words=f"{counted(every.count, wall.noun)}; {wall.stated(every, shown.scales)}"
        if every.count
        else f"no {wall.noun}",
    )


def _shown_until(rotor: Rotor, motion: Trajectory) -> float:
    events = motion.segment_starts[1:]
    if motion.outcome is Outcome.LEVITATED:
        end = (float(events[-1]) if len(events) else 0.0) + min(CALM / rotor.system.decay, LONGEST_CALM)
    else:
        end = motion.time + AFTERWARDS
    if len(events) > MOST_IMPACTS:
        end = min(end, float(events[MOST_IMPACTS]))
    return min(end, LONGEST_BOUNCING if motion.outcome in REPEATING else LONGEST)


def span_of(stretch: LastingContact) -> ContactSpan:
    """A stretch of lasting contact as it is drawn."""
    look = REGIMES[stretch.phase]
    return ContactSpan(stretch.start, stretch.end, look.words, look.colour)


def _words(motion: Trajectory, begin: str, peaks: list[ContactPeaks], ending: str) -> str:
    """What is seen, with the load of the bearing that bears most."""
    worst = max(range(len(peaks)), key=lambda place: peaks[place].hardest)
    wall, seen = wall_at(motion.rotor, worst), motion.seen_at(worst)
    met = [str(place) for place, every in enumerate(peaks, start=1) if every.count]
    where = f" at touchdown bearing{'s' if len(met) > 1 else ''} {listed(met)}" if len(peaks) > 1 and met else ""
    load, count = wall.stated(peaks[worst], seen.scales), sum(every.count for every in peaks)
    if motion.outcome in REPEATING:
        return f"{begin} ends in {ending}; {load}."
    impacts = f"without {wall.one}" if count == 0 else f"after {counted(count, wall.noun)}{where}; {load}"
    return f"{begin} {'ends in' if motion.outcome.settled else 'was given up,'} {ending} {impacts}."
