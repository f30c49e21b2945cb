"""Sensitivity of the loops of magnetic bearings, and the zones of ISO 14839-3 for its peak."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.arguments import checked
from carom.outcome import InputError
from carom.results import Result
from carom.rotors.equations import Equations, block, loops_of
from carom.rotors.flexible_machine import FlexibleMachine
from carom.rotors.free_motions import motions_at
from carom.rotors.whirls import speeds_of

LIMITS = {"A": 3.0, "B": 4.0, "C": 5.0}
"""Largest peak of the sensitivity in each zone of ISO 14839-3:2006; above lies zone D."""
HIGHEST = 3.0
"""Times the speed of the shaft up to which frequencies are looked at by default, or 2 kHz if that is more, as ISO 14839-3 asks."""
LEAST_HIGHEST = 2e3 * 2.0 * math.pi
LOWEST = 2.0 * math.pi
COUNT = 1000
ZOOMS, POINTS = 8, 9
"""A peak is enclosed so many times, each time between neighbours of so many points."""


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(Result):
    """Sensitivity of one direction of each magnetic bearing, with all other loops closed: what the controller sees of a signal added to its input.

    Attributes
    ----------
    frequencies : ndarray, shape (m,)
        rad/s.
    values : ndarray of complex, shape (m, B)
    peaks : ndarray, shape (B,)
        Largest size of each.
    peak_frequencies : ndarray, shape (B,)
        Where it is, rad/s.
    stable : bool
        Whether no free motion of the machine grows; of an unstable loop the sensitivity measures no margin.
    """

    frequencies: np.ndarray
    values: np.ndarray
    peaks: np.ndarray
    peak_frequencies: np.ndarray
    stable: bool

    figure: ClassVar[str] = "sensitivity"
    shown: ClassVar = ("peaks", "peak_frequencies", "zones")
    rests_on: ClassVar = ()

    @property
    def zones(self) -> tuple[str, ...] | None:
        """Zone of ISO 14839-3 of each bearing; ``None`` of an unstable loop, which has none."""
        if not self.stable:
            return None
        return tuple(map(zone_of, self.peaks.tolist()))


def zone_of(peak: float) -> str:
    """Zone of ISO 14839-3 of a peak of the sensitivity."""
    return next((zone for zone, limit in LIMITS.items() if peak <= limit), "D")


@checked
def sensitivity(flexible: FlexibleMachine, frequencies: Sequence[float] | None = None) -> Sensitivity:
    """Compute the sensitivity of the loops of a flexible machine, from all its modes.

    With gyroscopic moments a direction, such as x, sees both whirls: ``S(iω)`` of the complex loop and the conjugate of ``S(−iω)``, half of each.
    Where supports act differently in two directions, so are the two axes of a bearing; told is the one with the larger peak.

    Parameters
    ----------
    flexible : FlexibleMachine
    frequencies : sequence of float, optional
        rad/s, above 0; by default from 1 Hz to three times the speed, or to 2 kHz if that is more, with those of the free whirls.  Peaks are enclosed between those given.

    Raises
    ------
    InputError
        There is no magnetic bearing, or a frequency is not above 0.
    """
    if not flexible.bearings:
        raise InputError("bearings", None, "one or more carom.rotors.MagneticBearing")
    of_axes = _sensitivities(flexible)
    listed = _usual(flexible) if frequencies is None else np.sort(speeds_of(frequencies))
    values = np.array([of_axes(each) for each in listed.tolist()])
    axes = np.abs(values).max(axis=0).argmax(axis=0)
    of_worst = np.take_along_axis(values, axes[None, None], axis=1)[:, 0]
    peaks = [_peak(of_axes, listed, (axis, number)) for number, axis in enumerate(axes.tolist())]
    highest, at = np.array(peaks).T
    return Sensitivity(listed, of_worst, highest, at, not flexible.slowest.grows)


def _usual(machine: FlexibleMachine) -> np.ndarray:
    """Frequencies, rad/s, over the range that the standard asks for, and those of the free whirls, where narrow peaks are."""
    highest = max(HIGHEST * machine.speed, LEAST_HIGHEST)
    own = np.abs(motions_at(machine.whole.equations, machine.speed).exponents.imag)
    return np.union1d(np.geomspace(LOWEST, highest, COUNT), own[(own > LOWEST) & (own < highest)])


def _sensitivities(machine: FlexibleMachine) -> Callable[[float], np.ndarray]:
    """Function of a frequency, rad/s: sensitivities along the axes of each bearing, one where all are alike, shape (axes, B)."""
    whole, loops = machine.whole, loops_of(machine.rotor, machine.bearings, machine.touchdowns)
    equations, count, vectors = whole.equations, len(machine.bearings), slice(0, whole.vectors)
    # What the sensors see, and what signals added to it do to the coordinates.
    seen, pushed = np.zeros((2, count, len(equations.mass)))
    seen[:, vectors] = loops.sensors @ whole.basis.shapes
    first = len(equations.mass) - sum(each.loop.states for each in machine.bearings)
    for number, bearing in enumerate(machine.bearings):
        pushed[number, vectors] = -bearing.ki * bearing.loop.D * (loops.bearings[number] @ whole.basis.shapes)
        pushed[number, first : first + bearing.loop.states] = bearing.loop.B
        first += bearing.loop.states
    turns = np.exp(2j * np.array([each.axis_angle for each in machine.bearings]))

    def closed(of: Equations, seen: np.ndarray, pushed: np.ndarray, frequency: float) -> np.ndarray:
        s = 1j * frequency
        dynamic = of.stiffness + s * (of.damping - 1j * machine.speed * of.gyroscopic) + s * s * of.mass
        found: np.ndarray = np.eye(len(seen)) + seen @ np.linalg.solve(dynamic, pushed.T)
        return found

    def of_axes(frequency: float) -> np.ndarray:
        if not equations.is_anisotropic:
            forward, backward = (closed(equations, seen, pushed, each) for each in (frequency, -frequency))
            return 0.5 * (np.diag(forward) + np.diag(backward).conj())[None]
        found = closed(equations.both, block(seen, seen), block(pushed, pushed), frequency)
        straight = np.diag(found[:count, :count]) + np.diag(found[count:, count:])
        mixed = np.diag(found[:count, count:]) / turns + np.diag(found[count:, :count]) * turns
        return 0.5 * np.stack([straight + mixed, straight - mixed])

    return of_axes


def _peak(
    of_axes: Callable[[float], np.ndarray], frequencies: np.ndarray, axis: tuple[int, int]
) -> tuple[float, float]:
    """Largest sensitivity of an axis of a bearing and its frequency, enclosed ever more closely between those given."""
    best = (0.0, 0.0)
    for _ in range(ZOOMS + 1):
        sizes = [abs(of_axes(each)[axis]) for each in frequencies.tolist()]
        place = int(np.argmax(sizes))
        best = max(best, (float(sizes[place]), float(frequencies[place])))
        frequencies = np.linspace(*frequencies[[max(place - 1, 0), min(place + 1, len(frequencies) - 1)]], POINTS)
    return best
