"""Lyapunov exponents of a motion through impacts, chatter, sliding and rolling."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.models import Model, Subject, model_of
from carom.motions.starts import Kick, State, check_whole
from carom.motions.trajectories import Trajectory, simulate
from carom.orbits.recognising import segments_of
from carom.orbits.shooting import Links, Start, links_of
from carom.orbits.word import Kind, Word
from carom.outcome import CaromError, InputError, Outcome, shown
from carom.results import Result

REPEATED = 1e-8
"""Largest distance, relative to one plus the size of the state, between the simulated and the repeated end of a segment."""
LEFT = 0.1
"""Largest part of the time asked for that may pass without an impact at the end."""
SAME_TIME = 1e-6
"""Difference below which two times are those of the same impact, in ``1/Ω``."""


@dataclass(frozen=True, eq=False, repr=False)
class LyapunovExponents(Result):
    """Mean rates at which small disturbances of a motion grow over a finite time.

    A positive value does not prove chaos: the motion may be a long transient, and the errors hold for batches that are
    independent of each other and as many as they need to be typical.

    Attributes
    ----------
    values : ndarray, shape (2N,)
        All exponents in ``Ω``, the largest first, for ``N`` modes.  One belongs to the disturbance along the motion itself
        (``along``).  Those of directions that a landing, a stopped slip or rolling takes away are minus infinity.
    errors : ndarray, shape (2N,)
        Standard errors from batches; 0 where the value is minus infinity.  That of ``along`` is its distance from 0.
    along : float
        The exponent along the motion.  It tends to 0 as one over the time.
    volume : float
        Sum of the exponents by the other route: the trace of the flow and the logarithm of the determinant of each impact,
        per time.  Minus infinity where directions are lost.
    impacts : int
        Impacts in the time measured, those of chatter included.
    landings : int
        Chatters that ended in lasting contact in this time.
    time : float
        Time measured, in ``1/Ω``: from an impact to an impact.
    transient : float
        Time left out before, in ``1/Ω``.
    """

    shown: ClassVar[tuple[str, ...]] = ("values", "errors", "impacts", "landings", "time", "transient")

    values: np.ndarray
    errors: np.ndarray
    along: float
    volume: float
    impacts: int
    landings: int
    time: float
    transient: float


def lyapunov_exponents(
    machine: Subject,
    start: State | Kick,
    duration: float = 1e4,
    *,
    transient: float = 1e3,
    batches: int = 20,
    max_events: int = 1_000_000,
) -> LyapunovExponents:
    """Lyapunov exponents of the motion from a start, by QR decomposition of the exact derivatives of its segments.

    The method is that of Benettin, Galgani, Giorgilli and Strelcyn (1980), with the change of the time of each event in the
    derivatives (Müller 1995).  During the transient the directions turn towards those that grow fastest.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        With one contact plane.
    start : State or Kick
    duration : float
        Time to measure, in ``1/Ω``.
    transient : float
        Time to leave out before, in ``1/Ω``.
    batches : int
        Number of stretches of the motion from which the errors are computed.
    max_events : int
        Impacts and steps of lasting contact after which to give up.

    Raises
    ------
    InputError
        The rotor has several contact planes, or a number is out of range.
    CaromError
        The motion stops hitting the wall, has too few segments, or its segments cannot be repeated to eight digits.
    """
    rotor = model_of(machine)
    if len(rotor.system.arrays.rows) > 1:
        raise InputError("machine", shown(machine), "a rotor with one contact plane")
    for name, time in (("duration", duration), ("transient", transient)):
        if not 0.0 < time < math.inf:
            raise InputError(name, time, "a finite time above 0, in 1/Omega")
    check_whole("batches", batches, 2)
    motion = simulate(rotor, start, transient + duration, max_events=max_events)
    word, begin, first = _segments(motion, duration, transient, batches)
    links = links_of(rotor, word, begin)
    _check_repeated(links)
    logarithms, along = _growth(links, first)
    section, durations = logarithms.shape[1], begin.durations[first:]
    kept, time = _directions_kept(word, first, section), float(durations.sum())
    rate = float(along[kept]) / time
    values, errors = np.full(section + 1, -np.inf), np.zeros(section + 1)
    values[:kept], errors[:kept] = _means(logarithms[:, :kept], durations, batches)
    values[-1], errors[-1] = rate, abs(rate)
    order = np.argsort(-values, kind="stable")
    ends = motion.segment_starts[1:]
    last = float(ends[motion.is_impact][-1])
    # Between the first and the last impact of the time measured, to rounding.
    inside = (ends > last - time - SAME_TIME) & (ends < last - SAME_TIME)
    impacts, landings = int((motion.is_impact & inside).sum()), int((motion.is_landing & inside).sum())
    volume = _growth_of_volume(rotor, impacts, time) if kept == section else -math.inf
    return LyapunovExponents(values[order], errors[order], rate, volume, impacts, landings, time, last - time)


def _segments(motion: Trajectory, duration: float, transient: float, batches: int) -> tuple[Word, Start, int]:
    """Segments of a motion from its first impact to its last, and the number of the first one after the transient."""
    impacts = np.flatnonzero(motion.is_impact)
    times = motion.segment_starts[1:][impacts]
    if motion.outcome is not Outcome.TIME_REACHED:
        raise CaromError(
            f"the motion was followed only to {motion.time:.6g} ({motion.outcome.label}): raise max_events"
        )
    if not len(times) or motion.time - times[-1] > LEFT * duration:
        raise CaromError("the motion stops hitting the wall: it has no exponents of impacts")
    word, begin = segments_of(motion, int(impacts[0]), int(impacts[-1]))
    begins = times[0] + np.concatenate([[0.0], np.cumsum(begin.durations)[:-1]])
    strikes = (word.kinds <= Kind.IMPACT_STOPPED) | (word.kinds == Kind.LAND)
    chosen = np.flatnonzero(strikes & (begins >= transient) & (np.arange(len(word)) > 0))
    if not len(chosen) or len(word) - chosen[0] < batches:
        raise CaromError(f"fewer than {batches} segments follow the transient: raise duration or lower batches")
    return word, begin, int(chosen[0])


def _check_repeated(links: Links) -> None:
    """Refuse segments that do not end where the simulated ones did."""
    nodes = links.start.nodes
    apart = np.abs(links.arrivals[:-1] - nodes[1:]).max(initial=0.0) / (1.0 + np.abs(nodes).max())
    if not (apart <= REPEATED and np.isfinite(links.values).all()):
        raise CaromError(f"the segments of the motion cannot be repeated: their ends are {apart:.3g} apart")


def _growth(links: Links, first: int) -> tuple[np.ndarray, np.ndarray]:
    """Logarithm of the growth of each direction in each segment from the first, and of the distance along the motion.

    The directions lie in the section at the node: disturbances that reach the event at the same time.  What a disturbance
    has along the motion is measured by the part of ``ċ`` that is orthogonal to them.

    Returns
    -------
    logarithms : ndarray, shape (m, 2N − 1)
    along : ndarray, shape (2N,)
        Over the whole time, for each number of directions kept.
    """
    passages, rates = links.passages, links.slopes[:, :-1, -1]
    size = passages.shape[1]
    directions = np.eye(size)[:, 1:]
    factors = np.empty((len(passages) - first, size - 1))
    along = np.zeros(size)
    for i, passage in enumerate(passages):
        if i == first:
            along -= _apart(rates[i - 1], directions)
        directions, triangle = np.linalg.qr(passage @ directions)
        if i >= first:
            factors[i - first] = np.abs(np.diagonal(triangle))
    along += _apart(rates[-1], directions)
    with np.errstate(divide="ignore"):
        return np.log(factors), along


def _apart(rate: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Logarithm of the part of a rate that is orthogonal to none, one, … and all of the directions, shape (2N,)."""
    shares = np.concatenate([[0.0], np.cumsum((directions.T @ rate) ** 2)])
    apart = [np.linalg.norm(rate - directions[:, :k] @ (directions[:, :k].T @ rate)) for k in range(len(shares))]
    logarithms: np.ndarray = np.log(apart)
    return logarithms


def _directions_kept(word: Word, first: int, section: int) -> int:
    """Number of directions of the section that no segment takes away.

    Each event lies on a section of the state space, or of the states in lasting contact (two dimensions fewer; in rolling
    three).  A stopped slip takes away one direction, a landing one of the section besides the event itself.
    """
    lost = {Kind.IMPACT_STOPPED: 1, Kind.LAND: 1, Kind.SLIDE_FORWARD: 2, Kind.SLIDE_BACKWARD: 2, Kind.ROLL: 3}
    return section - max(lost.get(Kind(kind), 0) for kind in np.unique(word.kinds[first:]))


def _means(logarithms: np.ndarray, durations: np.ndarray, batches: int) -> tuple[np.ndarray, np.ndarray]:
    """Exponents, and their standard errors from batches of equally many segments."""
    values = logarithms.sum(axis=0) / durations.sum()
    edges = np.linspace(0, len(durations), batches + 1).astype(int)[:-1]
    apart = np.add.reduceat(logarithms - values * durations[:, None], edges)
    return values, np.sqrt(batches / (batches - 1) * (apart**2).sum(axis=0)) / durations.sum()


def _growth_of_volume(rotor: Model, impacts: int, time: float) -> float:
    """Rate at which volumes of the state space grow: ``2 Re Σλ`` in flight, and a factor ``d²`` at each impact.

    An impact with slip multiplies the normal velocity by ``−d``; the other velocities change by what depends on it and on
    the position alone.  The change of the time of impact gives the same factor once more.
    """
    restitution = float(rotor.system.arrays.restitution[0])
    return float(2.0 * rotor.system.exponents.real.sum()) + 2.0 * impacts * math.log(restitution) / time
