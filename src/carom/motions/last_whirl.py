"""How a plane went round at the end of a motion."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from carom.motions.bearing_loads import GOING_ROUND, LastWhirl
from carom.motions.trajectories import Trajectory
from carom.outcome import Phase

LAST_TURNS = 8.0
"""Turns of the shaft at the end over which the whirl is averaged."""
PER_RADIAN = 2.0
"""Instants for each radian of the fastest mode at which the angle is looked at; it must not go half round in between."""


def last_whirl(last: Trajectory, turned_back: dict[int, float], held_since: float | None) -> LastWhirl | None:
    """How the plane of a motion goes round at its end; ``None`` if it does not touch in the last turns of the shaft.

    Of what was before the motion it is known when the plane last went round against each sense, and since when it has not left the wall.
    """
    begins = max(float(last.segment_starts[0]), last.time - LAST_TURNS * 2.0 * math.pi)
    touching = last.segment_phases[:, last.plane] != Phase.FLIGHT
    ends = np.append(last.segment_starts[1:], last.time)
    struck = last.event_planes[last.is_impact] == last.plane
    recent = last.segment_starts[1:][last.is_impact][struck] > begins
    if last.time == 0.0 or not (recent.any() or (ends[touching] > begins).any()):
        return None
    times, angles, rates = _angles(last, begins)
    # From one time to the next it goes less than half round.
    turned = float(np.subtract(*np.unwrap(angles)[[-1, 0]]))
    other = np.flatnonzero(rates * np.sign(turned) <= 0.0)
    since = last.begins + float(times[min(other[-1] + 1, len(times) - 1)] if len(other) else times[0])
    if not len(other) and last.outcome in GOING_ROUND and held_since is not None:
        since = min(since, max(held_since, turned_back[1 if turned > 0.0 else -1]))
    lasted = float(np.ptp(times))
    return LastWhirl(
        angular_speed=turned / lasted if lasted > 0.0 else 0.0,
        turned=turned,
        lasted=lasted,
        since=since,
        goes_on=last.outcome in GOING_ROUND,
        scales=last.rotor.scales,
    )


def _angles(last: Trajectory, begins: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times from a first one on, angles of the plane in the fixed frame and their rates, at nodes close enough to count its turns."""
    edges = np.append(last.segment_starts, last.time)
    # What fades without turning, such as the state of a filter, may be faster by far and moves nothing round.
    fastest = np.abs(last.rotor.system.arrays["exponents"].imag).max()
    pieces = []
    for first, end in pairwise(edges):
        if end > begins:
            count = max(1, math.ceil((end - first) * fastest * PER_RADIAN))
            pieces.append(np.linspace(max(first, begins), end, count, endpoint=False))
    times = np.append(np.concatenate(pieces), last.time)
    place, rate = last.at_plane(times)
    turned: np.ndarray = np.angle(place) + last.begins + times
    return times, turned, (place.conj() * rate).imag + np.abs(place) ** 2
