"""One kick, followed and sampled at each touchdown bearing: what is needed to draw it over time."""

from __future__ import annotations

import math

import numpy as np

from carom.attractors.naming import name_motions
from carom.base.outcome import Outcome
from carom.base.progress import ShowProgress
from carom.base.results import record
from carom.explorer.computing.planes import DisturbancePlane
from carom.explorer.computing.rest import rest_of
from carom.explorer.computing.walls import hardest_load, peak_loads, wall_at
from carom.models import Rotor
from carom.motions import ContactLog, LastingContact, State, Trajectory, settle, simulate
from carom.motions.settling import REPEATING
from carom.parameters.formats import shown_in
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


def follow_kick(
    rotor: Rotor, plane: DisturbancePlane, first: float, second: float, progress: ShowProgress = None
) -> dict[str, object]:
    """Follow one disturbance, by its components in units of the equations, to where it ends; refuse one that is not possible.

    ``times``, float32 of shape (n,), are in ``1/Ω``; ``planes`` hold what is drawn at each touchdown bearing.  The motion is drawn ``whole`` if up to where it
    is settled; ``outcome``, ``colour`` and ``words`` are the label of the outcome, its colour, and what is seen, as one sentence.
    """
    rotor, start, begin = plane.start(rotor, rest_of(rotor), first, second)
    motion = simulate(rotor, start, settle=True, progress=progress)
    # A motion is settled once its end is known, which may be long before it has arrived there.
    shown = simulate(rotor, start, _shown_until(rotor, motion), max_events=MOST_EVENTS)
    times = shown.sample(max(LEAST_SAMPLES, min(MOST_SAMPLES, int(PER_TURN * shown.time / math.tau))))
    times = times[:: math.ceil(len(times) / (2 * MOST_SAMPLES))]
    _, (name,) = name_motions(rotor, settle(rotor, State(np.array([start.position]), np.array([start.velocity]))))
    look = OUTCOMES["irregular" if name.irregular else name.outcome.label]
    logs = [motion.seen_at(place).contacts for place in range(len(rotor.system.planes))]
    return {
        "times": times.astype(np.float32),
        "planes": [_at_bearing(shown.seen_at(place), times, log) for place, log in enumerate(logs)],
        "whole": shown.time >= motion.time,
        "outcome": motion.outcome.label,
        "colour": look.colour,
        "words": _words(motion, begin, logs, name.words),
    }


def _at_bearing(shown: Trajectory, times: np.ndarray, every: ContactLog) -> dict[str, object]:
    """What is drawn of a motion at the touchdown bearing at which it is seen; lengths in its clearances.

    Arrays of shape (n,) are the position ``x`` and ``y`` in the co-rotating frame, the instants of impacts among them, and the normal ``force`` of a compliant
    bearing, in N or in ``m c_r Ω²``.  Those of shape (m,) are impacts that are drawn, or the beginnings of contact with a compliant bearing: time in ``1/Ω``,
    angle in rad, radial speed before in ``c_r Ω``, how hard each is, and whether the rotor whirls ``forward`` in the fixed frame just before.
    ``spans`` are the stretches of lasting contact, and ``hardest`` is the hardest of all impacts, also of those that are not drawn.
    """
    position, _ = shown.at_plane(times)
    wall, log = wall_at(shown.rotor, shown.plane), shown.contacts.some(shown.contacts.entered)
    factor, unit = shown_in("force", shown.scales)
    drawn = {
        "x": position.real,
        "y": position.imag,
        "force": factor * shown.forces(times)[0] if wall.compliant else np.zeros(len(times)),
        "impact_times": log.time,
        "impact_angles": np.angle(np.exp(1j * log.angle)),
        "impact_speeds": log.radial_speed,
        "peak_loads": peak_loads(log),
    }
    return {
        **{name: values.astype(np.float32) for name, values in drawn.items()},
        "force_unit": unit,
        "forward": (log.angular_speed > -1.0).astype(np.uint8),
        "spans": [_span(each) for each in shown.lasting_contacts],
        "hardest": hardest_load(every),
        "words": f"{counted(len(every), wall.noun)}; {wall.stated(every)}" if len(every) else f"no {wall.noun}",
    }


def _span(stretch: LastingContact) -> dict[str, object]:
    """A stretch of lasting contact as it is drawn."""
    return {**record(stretch, "start end"), **record(REGIMES[stretch.phase], "words colour")}


def _shown_until(rotor: Rotor, motion: Trajectory) -> float:
    events = motion.segment_starts[1:]
    if motion.outcome is Outcome.LEVITATED:
        end = (float(events[-1]) if len(events) else 0.0) + min(CALM / rotor.system.decay, LONGEST_CALM)
    else:
        end = motion.time + AFTERWARDS
    if len(events) > MOST_IMPACTS:
        end = min(end, float(events[MOST_IMPACTS]))
    return min(end, LONGEST_BOUNCING if motion.outcome in REPEATING else LONGEST)


def _words(motion: Trajectory, begin: str, logs: list[ContactLog], ending: str) -> str:
    """What is seen, with the load of the bearing that bears most."""
    worst = max(range(len(logs)), key=lambda place: hardest_load(logs[place]))
    wall, met = wall_at(motion.rotor, worst), [str(place) for place, log in enumerate(logs, start=1) if len(log)]
    where = f" at touchdown bearing{'s' if len(met) > 1 else ''} {listed(met)}" if len(logs) > 1 and met else ""
    load, count = wall.stated(logs[worst]), sum(map(len, logs))
    if motion.outcome in REPEATING:
        return f"{begin} ends in {ending}; {load}."
    impacts = f"without {wall.one}" if count == 0 else f"after {counted(count, wall.noun)}{where}; {load}"
    return f"{begin} {'ends in' if motion.outcome.settled else 'was given up,'} {ending} {impacts}."
