"""Sensitivity of the loops of magnetic bearings, the zones of ISO 14839-3 for its peak, and whirls that their sensors miss."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import ClassVar

import numpy as np
from scipy.linalg import expm  # type: ignore[import-untyped]

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.rotors.controllers import Series
from carom.rotors.equations import Loops, block, off
from carom.rotors.flexible_machine import FlexibleMachine
from carom.rotors.free_motions import motions_at
from carom.rotors.shared_controller import loops_in
from carom.rotors.state_spaces import in_series, side_by_side
from carom.rotors.whirls import WhirlMode, speeds_of

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
    Where supports are anisotropic, so are the two axes of a bearing; stated is the one with the larger peak.

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
    loop = _Loop(flexible)
    listed = _usual(flexible) if frequencies is None else np.sort(speeds_of(frequencies))
    values = np.array([loop.of_axes(each) for each in listed.tolist()])
    places = [(axis, number) for number in range(len(flexible.bearings)) for axis in range(values.shape[1])]
    peaks = {place: loop.peak(listed, np.abs(values[:, *place]), place) for place in places}
    worst = [
        max((each for each in places if each[1] == number), key=lambda each: peaks[each][0])
        for number in range(values.shape[2])
    ]
    highest, at = (np.array(each) for each in zip(*(peaks[place] for place in worst), strict=True))
    sizes = np.stack([values[:, *place] for place in worst], axis=1)
    return Sensitivity(listed, sizes, highest, at, not flexible.slowest.grows)


def _usual(machine: FlexibleMachine) -> np.ndarray:
    """Frequencies, rad/s, over the range that the standard asks for, and those of the free whirls, where narrow peaks are."""
    highest = max(HIGHEST * machine.speed, LEAST_HIGHEST)
    own = np.abs(motions_at(machine.whole.equations, machine.speed).exponents.imag)
    return np.union1d(np.geomspace(LOWEST, highest, COUNT), own[(own > LOWEST) & (own < highest)])


class _Loop:
    """The loop of all bearings, opened at the sensors."""

    def __init__(self, machine: FlexibleMachine) -> None:
        whole = machine.whole
        held, has_mass = whole.equations, whole.equations.mass.any(axis=1)
        both = np.ix_(has_mass, has_mass)
        rows = Loops(*(each[:, has_mass] for each in held.rows))
        self.bearings = machine.bearings
        controls = loops_in(machine.rotor, machine.bearings, machine.shared_controllers)
        self.loops = [(np.array(each.bearings), each.both) for each in controls]
        self.pulls, self.seen = rows.bearings, rows.sensors
        softer = [
            each.magnet[0] * np.outer(pull, pull) + each.ks_tilt * np.outer(tilt, tilt)
            for each, pull, tilt in zip(self.bearings, rows.bearings, rows.tilts, strict=True)
        ]
        self.mass, self.stiffness = held.mass[both], held.unlevitated[1][both] + np.sum(softer, axis=0)
        self.spin = held.unlevitated[0][both] - 1j * machine.speed * held.gyroscopic[both]
        # Of conjugates: anisotropic supports and magnets.
        uneven = np.array([each.magnet[1] for each in self.bearings])
        self.damping_across, self.stiffness_across = (each[both] for each in held.across_unlevitated)
        self.stiffness_across = self.stiffness_across + (self.pulls.T * uneven) @ self.pulls
        self.is_anisotropic = held.is_anisotropic

    def opened(self, frequency: float) -> np.ndarray:
        """What sensors measure by forces at bearings, of displacements and of their conjugates, (2B, 2B)."""
        s = 1j * frequency
        ahead, behind = (self.stiffness + turn * self.spin + turn * turn * self.mass for turn in (s, -s))
        if not self.is_anisotropic:
            seen, opposite = (self.seen @ np.linalg.solve(each, self.pulls.T) for each in (ahead, behind))
            return block(seen, opposite.conj())
        dynamic = block(ahead, behind.conj()) + off(self.stiffness_across) + s * off(self.damping_across)
        moved = np.linalg.solve(dynamic, block(self.pulls.T, self.pulls.T))
        return np.asarray(block(self.seen, self.seen) @ moved)

    def of_axes(self, frequency: float) -> np.ndarray:
        """Sensitivity of one direction, shape (1, B); where both differ of both axes, shape (2, B)."""
        count = len(self.bearings)
        gains = np.zeros((2 * count, 2 * count), complex)
        for listed, system in self.loops:
            both = np.append(listed, count + listed)
            forces = np.array([[self.bearings[number].ki] for number in listed])
            gains[np.ix_(both, both)] = np.tile(forces, (2, 1)) * system.at(1j * frequency)
        whole = np.linalg.inv(np.eye(2 * count) + self.opened(frequency) @ gains)
        # A real signal along an axis is as much a part of the displacement as of its conjugate.
        turns = np.exp(2j * np.array([each.axis_angle for each in self.bearings]))
        straight = np.diag(whole[:count, :count]) + np.diag(whole[count:, count:])
        mixed = np.diag(whole[:count, count:]) / turns + np.diag(whole[count:, :count]) * turns
        return 0.5 * (np.stack([straight + mixed, straight - mixed]) if self.is_anisotropic else straight[None])

    def peak(self, frequencies: np.ndarray, sizes: np.ndarray, axis: tuple[int, int]) -> tuple[float, float]:
        """Largest sensitivity along an axis of a bearing beside the largest of those known, and its frequency."""
        place = int(sizes.argmax())
        best = float(sizes[place]), float(frequencies[place])
        for _ in range(ZOOMS):
            low, high = frequencies[max(place - 1, 0)], frequencies[min(place + 1, len(frequencies) - 1)]
            frequencies = np.linspace(low, high, POINTS)
            sizes = np.array([abs(self.of_axes(each)[axis]) for each in frequencies.tolist()])
            place = int(sizes.argmax())
            best = max(best, (float(sizes[place]), float(frequencies[place])))
        return best


def sampling_error(machine: FlexibleMachine) -> tuple[float, float] | None:
    """Frequency, rad/s, a quarter of the sampling rate, and the largest relative error of exponents up to that size, beside those of the motion from sample to sample.

    Between samples the currents are held, so that motion is a product of matrix exponentials, with all images.  ``None`` unless each bearing has a sampled controller of its own, all at once,
    and nothing is anisotropic.  Delays of computing are approximated in both.
    """
    bearings, listed = machine.bearings, [each.controller for each in machine.bearings if each.controller is not None]
    laws = [each if isinstance(each, Series) else Series(each, ()) for each in listed]
    times = {each.sampled.sample_time for each in laws}
    time = times.pop() if len(times) == 1 and len(laws) == len(bearings) else None
    if time is None or machine.whole.equations.is_anisotropic:
        return None
    law = side_by_side([replace(each.sampled, sample_time=None) for each in laws])
    before = side_by_side([each.stages[0] for each in bearings])
    behind = (in_series([*own.analog, *each.stages[1:]]) for own, each in zip(laws, bearings, strict=True))
    after, loop = side_by_side(list(behind)), _Loop(machine)
    n, count = len(loop.mass), len(bearings)
    forces = -np.linalg.solve(loop.mass, loop.pulls.T * np.array([each.ki for each in bearings]))
    places, rates, sensors, currents, held = (
        slice(*ends) for ends in pairwise(np.cumsum([0, n, n, before.states, after.states, count]).tolist())
    )
    matrix = np.zeros((held.stop, held.stop), complex)
    matrix[places, rates] = np.eye(n)
    matrix[rates, places], matrix[rates, rates] = -np.linalg.solve(loop.mass, np.stack([loop.stiffness, loop.spin]))
    matrix[rates, currents], matrix[rates, held] = forces @ after.C, forces @ after.D
    matrix[sensors, places], matrix[sensors, sensors] = before.B @ loop.seen, before.A
    matrix[currents, currents], matrix[currents, held] = after.A, after.B
    seen = np.zeros((count, held.start))
    seen[:, places], seen[:, sensors] = before.D @ loop.seen, before.C
    inner, pushed = np.split(expm(matrix * time)[: held.start], [held.start], axis=1)
    step = np.block([[inner + pushed @ law.D @ seen, pushed @ law.C], [law.B @ seen, law.A]])
    turns, highest = np.linalg.eigvals(step), 0.5 * math.pi / time
    exact = np.log(turns[turns != 0.0]) / time
    exact, found = exact[np.abs(exact) <= highest], machine.whole.equations.exponents(machine.speed)[0]
    return highest, max((float(np.abs(found / each - 1.0).min()) for each in exact if each), default=0.0)


HARDLY = 0.02
"""Displacement, as a share of the largest of the shaft, at its sensors or its actuator, below which a whirl has a node there."""


@dataclass(frozen=True)
class Collocation:
    """A whirl at a magnetic bearing.

    Attributes
    ----------
    bearing : int
        From 1.
    whirl : WhirlMode
    sensor, magnet : complex
        Displacement that the sensors measure, and at the magnet; the largest of the shaft is 1.
    """

    bearing: int
    whirl: WhirlMode
    sensor: complex
    magnet: complex

    @property
    def hardly(self) -> bool:
        """Whether a node of the whirl lies at the sensors or at the magnet."""
        return min(abs(self.sensor), abs(self.magnet)) < HARDLY

    @property
    def opposed(self) -> bool:
        """Whether a node lies between: sensors and magnet move against each other, so damping by the controller feeds the whirl."""
        return not self.hardly and (self.sensor * self.magnet.conjugate()).real < 0.0


def collocations(machine: FlexibleMachine, whirls: tuple[WhirlMode, ...]) -> tuple[Collocation, ...]:
    """How sensors and magnet of each bearing stand in each whirl, those of a bearing together."""
    rotor = machine.rotor

    def at(whirl: WhirlMode, node: int) -> complex:
        return complex(whirl.widest[rotor.place_of(node)])

    return tuple(
        Collocation(
            number,
            whirl,
            complex(np.mean([at(whirl, node) for node in bearing.sensor_nodes])),
            at(whirl, bearing.node),
        )
        for number, bearing in enumerate(machine.bearings, start=1)
        for whirl in whirls
    )
