"""Lasting contact as broad bands: the parts of a motion during which the rotor slides or rolls along the wall."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from carom.plots.plane import Complex, Floats, Frame
from carom.plots.style import LOOKS
from carom.plots.words import clearance

if TYPE_CHECKING:
    from carom.motions.history import LastingContact
    from carom.motions.trajectories import Trajectory

_KINDS = ("slide", "roll")
_STEP = 0.03
"""Angle [rad] between points of a band: its chords deviate from the circle by less than the width of a line."""
_MOST_POINTS = 20_000
"""Largest number of points of a band: it then covers the circle many times, and more points would not be visible."""


def flying(trajectory: Trajectory, times: Floats) -> NDArray[np.bool_]:
    """Return which times belong to free flight; the end of a contact does if a flight follows."""
    free = np.ones(times.shape, bool)
    for span in trajectory.lasting_contacts:
        free &= (times < span.start) | ((times >= span.end) & (span.end < trajectory.time))
    return free


def drawing_times(trajectory: Trajectory, since: float = 0.0, until: float | None = None) -> Floats:
    """Return the times at which a motion is drawn within a stretch: dense in flight, only the two ends of a lasting contact.

    In contact the radius is 1, and :func:`bands_on_the_circle` draws the rest.
    """
    # Enough points for smooth curves, but few enough for a small file.
    end = trajectory.time if until is None else until
    even = np.linspace(since, end, int(np.clip(60.0 * (end - since), 2000, 12000)))
    events = trajectory.segment_starts[1:]
    times = np.unique(np.concatenate([even, events, np.nextafter(events, 0.0)]))
    times = times[(times >= since) & (times <= end)]
    ends = [moment for span in trajectory.lasting_contacts for moment in (span.start, span.end)]
    return times[flying(trajectory, times) | np.isin(times, ends)]


def bands_on_the_circle(axes: Axes, trajectory: Trajectory, frame: Frame, since: float = 0.0) -> None:
    """Mark where on the circle the rotor slid or rolled, from a time on."""
    for kind in _KINDS:
        arcs = [
            np.append(_arc(trajectory, span, frame, since), np.nan)
            for span in trajectory.lasting_contacts
            if span.kind == kind and span.end > since
        ]
        if arcs:
            line = clearance(trajectory.scales) * np.concatenate(arcs)
            look = LOOKS[kind].stroke | {"solid_capstyle": "butt", "dash_capstyle": "butt", "zorder": 3}
            axes.plot(line.real, line.imag, **look, label=LOOKS[kind].words, gid=kind)


def _arc(trajectory: Trajectory, span: LastingContact, frame: Frame, since: float) -> Complex:
    start = max(span.start, since)
    position, velocity = trajectory.at_plane(np.linspace(start, span.end, 16))
    # On the wall (radius 1) the angular speed equals the tangential speed; the fixed frame adds the shaft speed, 1.
    fastest = float(np.abs((position.conj() * velocity).imag + (frame == "fixed")).max())
    points = int(np.ceil((span.end - start) * fastest / _STEP)) + 2
    end = span.end
    if points > _MOST_POINTS:
        points, end = _MOST_POINTS, start + _MOST_POINTS * _STEP / fastest
    return trajectory.position(np.linspace(start, end, points), frame)
