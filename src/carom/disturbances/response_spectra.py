"""Shock response spectra: the largest absolute acceleration of an oscillator whose base moves as the base of a machine, or as its rotor.

An oscillator of natural frequency ``ω`` and quality ``Q`` on a base with the acceleration ``a`` has the displacement ``z`` against it,

    z̈ + (ω/Q) ż + ω² z = −a,        z̈ + a = −(ω/Q) ż − ω² z,

and the spectrum is the maximax of the second: its largest size at any time, during the motion of the base and after it.  On a piece of a course
``ä = −ν² a``: a half-sine, or with ``ν = 0`` a straight line.  So oscillator and base are one linear system, whose matrix exponential is exact, also in resonance;
it is summed as a power series over steps of 1/32 of the shortest period.  The largest value is sought on all steps and refined on that series.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from carom.base.arguments import Positive, checked
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Result, record
from carom.parameters import Scales
from carom.parameters.formats import format_quantity, number

if TYPE_CHECKING:
    from carom.motions import Trajectory

STEPS, ORDER, REFINED = 32, 17, 8
"""Steps in the shortest period of a piece, terms of the power series of one, and corrections of the time of the largest value."""
COUNT = 60
"""Frequencies of a spectrum."""


class BaseCourse(NamedTuple):
    """An acceleration in pieces, complex for two axes: duration, value and slope at the beginning, and ``ν`` of each, all (n,)."""

    durations: np.ndarray
    values: np.ndarray
    slopes: np.ndarray
    frequencies: np.ndarray

    def at(self, times: np.ndarray) -> np.ndarray:
        """Acceleration (m,) at times (m,); zero after the end."""
        begins = np.append(0.0, np.cumsum(self.durations))
        place = np.clip(np.searchsorted(begins, times, side="right") - 1, 0, len(self.values) - 1)
        elapsed, nu = times - begins[place], self.frequencies[place]
        found = self.values[place] * np.cos(nu * elapsed) + self.slopes[place] * elapsed * np.sinc(nu * elapsed / np.pi)
        return np.where(times <= begins[-1], found, 0.0)


@dataclass(frozen=True, eq=False, repr=False)
class ShockResponse(Result):
    """Shock response spectra along both axes of the fixed frame.

    Attributes
    ----------
    frequencies : ndarray, shape (F,)
        Natural frequencies of the oscillators, in ``Ω``.
    quality : float
        ``Q`` of the oscillators, ``1/2ζ``.
    base : ndarray, shape (2, F)
        Largest absolute acceleration, 0-to-peak, in ``c_r Ω²``, of oscillators on the base.
    bearings : ndarray, shape (P, 2, F)
        The same of oscillators on the rotor at each touchdown bearing.
    scales : Scales or None
    """

    figure: ClassVar[str] = "shock_response"
    shown: ClassVar = ("quality", "frequencies", "base", "bearings")

    frequencies: np.ndarray
    quality: float
    base: np.ndarray
    bearings: np.ndarray
    scales: Scales | None = None

    @property
    def curves(self) -> list[tuple[str, np.ndarray]]:
        """What shakes the oscillators, and the accelerations (2, F) of these."""
        return [
            ("base", self.base),
            *((f"rotor at touchdown bearing {place}", each) for place, each in enumerate(self.bearings, 1)),
        ]

    @property
    def words(self) -> str:
        """The largest of each in a sentence."""
        parts = []
        for name, curve in self.curves:
            _, place = np.unravel_index(curve.argmax(), curve.shape)
            at = self.frequencies[place]
            shown = f"{number(at * self.scales.speed / (2.0 * np.pi), 3)} Hz" if self.scales else f"{number(at, 3)} Ω"
            parts.append(f"{name} up to {format_quantity(float(curve.max()), 'acceleration', self.scales)} at {shown}")
        return f"Shock response spectra (Q = {number(self.quality)}): {'; '.join(parts)}."

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return record(self, "quality frequencies:speed base:acceleration bearings:acceleration", self.scales)


@checked
@shows_progress
def shock_response(
    motion: Trajectory, base: BaseCourse, quality: Positive = 10.0, *, progress: ShowProgress = None
) -> ShockResponse:
    """Shock response spectra of the motion of a base, and of what it makes of the rotor at each touchdown bearing.

    Parameters
    ----------
    motion : Trajectory
        That of :func:`carom.simulate` during the motion of the base and after it.
    base : BaseCourse
        The acceleration of the base: ``course`` of :class:`carom.BaseShock` or :class:`carom.disturbances.BaseRecord`, of its peak and angle.
    quality : float
        Quality ``Q`` of the oscillators, 10 as usual: a damping ratio of 5 %.

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/spindle.toml")
    >>> shock = cm.BaseShock.of(machine, "5 g", "11 ms")
    >>> motion = cm.simulate(*shock.apply(machine))
    >>> cm.disturbances.shock_response(motion, shock.course(shock.peak)).words
    'Shock response spectra (Q = 10): base up to 8.26 g at 73.1 Hz; rotor at touchdown bearing 1 up to 45.1 g at 455 Hz.'
    """
    tell, ends = Reporter.of(progress, "shock response spectra"), float(base.durations.sum())
    highest = 10.0 * np.pi / base.durations.min() if base.frequencies.any() else np.pi / base.durations.min()
    frequencies = np.geomspace(0.5 * np.pi / ends, highest, COUNT)
    courses = [base, *(_of_rotor(motion, plane, base, highest) for plane in range(len(motion.at_each)))]
    found = np.empty((len(courses), 2, COUNT))
    for each in range(COUNT):
        for place, course in enumerate(courses):
            found[place, :, each] = maximax(course, float(frequencies[each]), 0.5 / quality)
        tell((each + 1) / COUNT)
    return ShockResponse(frequencies, quality, found[0], found[1:], motion.rotor.scales)


def _of_rotor(motion: Trajectory, plane: int, base: BaseCourse, highest: float) -> BaseCourse:
    """Absolute acceleration of the rotor at a plane: between samples that of the base and the mean of that against it; impacts change the velocity at once."""
    begun, width, pieces = motion.parts[0].begins, float(motion.rotor.system.widths[plane]), list[BaseCourse]()
    for part in motion.parts:
        even = np.linspace(0.0, part.time, 2 + int(part.time * highest * STEPS / (2.0 * np.pi)))
        starts = part.segment_starts
        times = np.unique(np.concatenate([even, starts, np.nextafter(starts[1:], 0.0)]))
        place, rate = part.seen_at(plane).at_plane(times)
        speed = width * (rate + 1j * place) * np.exp(1j * (part.begins + times))
        durations, shaken = np.diff(times), base.at(part.begins - begun + times)
        means = np.diff(speed) / durations + shaken[:-1]
        pieces.append(BaseCourse(durations, means, np.diff(shaken) / durations, np.zeros(len(durations))))
    return BaseCourse(*map(np.concatenate, zip(*pieces, strict=True)))


def maximax(course: BaseCourse, frequency: float, damping: float) -> tuple[float, float]:
    """Largest absolute acceleration along both axes of an oscillator of this natural frequency and damping ratio, at rest before."""
    inputs = np.stack([course.values, course.slopes], axis=1)
    matrices, rows, scaled = _system(frequency, damping, course.frequencies, inputs)
    fastest = max(frequency, float(course.frequencies.max()))
    count = max(1, int(np.ceil(course.durations.max() * fastest * STEPS / (2.0 * np.pi))))
    steps = _step(matrices * (course.durations / count)[:, None, None])
    whole = np.linalg.matrix_power(steps, count)
    pushed = np.einsum("nij,nj->ni", whole[:, :2, 2:], scaled)
    states, state = list[tuple[complex, complex]](), (0j, 0j)
    for (a, b), (c, d), (p, q) in zip(*whole[:, :2, :2].transpose(1, 0, 2).tolist(), pushed.tolist(), strict=True):
        states.append(state)
        state = a * state[0] + b * state[1] + p, c * state[0] + d * state[1] + q
    given, ends = np.concatenate([np.array(states), scaled], axis=1), np.array([[*state, 0j, 0j]])
    free, row, _ = _system(frequency, damping, np.zeros(1), np.zeros((1, 2)))
    step = np.array([2.0 * np.pi / (frequency * STEPS)])

    def along(during: np.ndarray, after: np.ndarray) -> float:
        shaken = _largest(during, matrices, rows, steps, course.durations / count, count)
        return max(shaken, _largest(after, free, row, _step(free * step), step, STEPS))

    return along(given.real, ends.real), along(given.imag, ends.imag)


def _system(
    frequency: float, damping: float, turns: np.ndarray, inputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Matrices (n, 4, 4) of states ``ωz, ż, a/s, ȧ/s²``, what reads the absolute acceleration (4,), and inputs (n, 2) in this scale ``s``."""
    size = np.maximum(frequency, turns)
    matrices = np.zeros((len(turns), 4, 4))
    matrices[:, 0, 1], matrices[:, 1, 0], matrices[:, 1, 1] = frequency, -frequency, -2.0 * damping * frequency
    matrices[:, 1, 2], matrices[:, 2, 3], matrices[:, 3, 2] = -size, size, -(turns**2) / size
    row = np.array([-frequency, -2.0 * damping * frequency, 0.0, 0.0])
    return matrices, row, inputs / np.stack([size, size**2], axis=1)


def _step(matrices: np.ndarray) -> np.ndarray:
    """Exponentials of small matrices (n, 4, 4)."""
    unit = np.eye(4)
    found = unit + matrices / ORDER
    for order in range(ORDER - 1, 0, -1):
        found = unit + matrices @ found / order
    return found


def _largest(
    states: np.ndarray, matrices: np.ndarray, row: np.ndarray, steps: np.ndarray, lasts: np.ndarray, count: int
) -> float:
    """Largest size over pieces from states (n, 4), each of so many steps that last (n,): found on all steps, and refined beside the step that has it."""
    first = row @ matrices
    second = np.einsum("nj,nji->ni", first, matrices)
    largest, place, state, low, high = -1.0, 0, states[0], 0.0, 0.0
    for step in range(count + 1):
        value, rate, bend = states @ row, np.einsum("nj,nj->n", first, states), np.einsum("nj,nj->n", second, states)
        before, beyond = 0.5 * (step > 0), 0.5 * (step < count)
        time = -rate / np.where(bend == 0.0, np.inf, bend)
        near = (time >= -before * lasts) & (time <= beyond * lasts)
        sizes = np.abs(value + 0.5 * np.where(near, rate * time, 0.0))
        if (most := float(sizes.max())) > largest:
            largest, place = most, int(sizes.argmax())
            state, low, high = states[place], -before * lasts[place], beyond * lasts[place]
        states = np.einsum("nij,nj->ni", steps, states)
    terms = list[float]()
    for order in range(ORDER):
        terms.append(float(row @ state) / math.factorial(order))
        state = matrices[place] @ state
    course, at = Polynomial(terms), 0.0
    slope, curvature = course.deriv(), course.deriv(2)
    for _ in range(REFINED):
        at = float(np.clip(at - slope(at) / (curvature(at) or np.inf), low, high))
    return float(max(abs(course(at)), abs(terms[0])))
