"""Multiple shooting: parameters, and a state of the rotor at the beginning of each stretch of a record, that fit it together.

Each stretch is followed from a state of its own, so chaos over the whole record does not spoil the fit; where one stretch ends and the
next begins the states may differ, by less and less from round to round.  Derivatives go through contact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from scipy.optimize import least_squares  # type: ignore[import-untyped]

from carom.base.outcome import CaromError
from carom.fitting.records import Record
from carom.fitting.stretches import Observed, StretchMotion, derivative
from carom.models import Rotor

ROUNDS = (0.1, 1.0, 30.0)
"""Weight of a jump between stretches, relative to that of a displacement of the same size, round after round."""
MOST_STEPS, CHANGE = 40, 1e-7
"""Steps of a round, and relative change of the sum of squares or of the unknowns below which it ends."""
OUTLIER = 3.0
"""Residual, in those expected, from which samples count less (Huber)."""
SMOOTH = 1e-6
"""Weight of a state that the sensors do not see, relative to what they see."""
TINY = 1e-12
"""Singular value, relative to the largest, below which a direction is as good as unknown."""


@dataclass(frozen=True, eq=False)
class Unknowns:
    """The unknowns of a fit as one vector: logarithms of parameters relative to their start, angle of the shaft, offsets of channels, states.

    Attributes
    ----------
    names : tuple of str
    start : array, shape (p,)
        Values of the parameters at the start, SI units.
    logarithmic : array of bool, shape (p,)
        Whether a parameter counts by its logarithm.
    channels, nodes, states : int
        How many channels, stretches, and numbers of a state there are.
    has_angle : bool
        Whether the angle of the shaft at time zero is unknown.
    """

    names: tuple[str, ...]
    start: np.ndarray
    logarithmic: np.ndarray
    channels: int
    nodes: int
    states: int
    has_angle: bool

    @property
    def common(self) -> int:
        """How many are common to all stretches."""
        return len(self.names) + self.has_angle + self.channels

    @property
    def size(self) -> int:
        """How many there are."""
        return self.common + self.nodes * self.states

    def values(self, vector: np.ndarray) -> np.ndarray:
        """Values of the parameters (p,), SI units."""
        moved = vector[: len(self.names)]
        with np.errstate(over="ignore"):
            return np.where(self.logarithmic, self.start * np.exp(moved), self.start + moved)

    def angle(self, vector: np.ndarray) -> float:
        """Angle of the shaft at time zero, beyond the one that the record states."""
        return float(vector[len(self.names)]) if self.has_angle else 0.0

    def offsets(self, vector: np.ndarray) -> np.ndarray:
        """Offsets of the channels, in the unit of states."""
        return vector[self.common - self.channels : self.common]

    def state(self, vector: np.ndarray, node: int) -> np.ndarray:
        """Numbers of the state at the beginning of a stretch."""
        return vector[self.common :].reshape(self.nodes, self.states)[node]


@dataclass(frozen=True, eq=False)
class Shooting:
    """A record cut into stretches, and the residuals of unknowns.

    Attributes
    ----------
    rotor : callable
        The rotor of values of the parameters.
    record : Record
    stretches : array of int, shape (K, 2)
        First sample of each stretch, and that at which it ends, where the next begins.
    unknowns : Unknowns
    unit : tuple of float
        Length in m and speed in rad/s of the numbers of states.
    noise : float
        Standard deviation of the samples that is expected, in m.
    stated_angle : float
        Angle of the shaft at time zero by a key-phasor, rad.
    """

    rotor: Callable[[Mapping[str, float]], Rotor]
    record: Record
    stretches: np.ndarray
    unknowns: Unknowns
    unit: tuple[float, float]
    noise: float
    stated_angle: float = 0.0

    @cached_property
    def measured(self) -> np.ndarray:
        """Samples of all stretches, shape (m, c)."""
        return np.concatenate([self.record.values[first:last] for first, last in self.stretches])

    def observed(self, vector: np.ndarray) -> Observed | None:
        """The rotor of unknowns as sensors see it; ``None`` if there is none."""
        unknowns = self.unknowns
        try:
            rotor = self.rotor(dict(zip(unknowns.names, unknowns.values(vector).tolist(), strict=True)))
            _ = rotor.system
        except CaromError:
            return None
        return Observed(rotor, self.record, self.stated_angle + unknowns.angle(vector), self.unit)

    def follow(self, observed: Observed, vector: np.ndarray, node: int) -> StretchMotion | None:
        """The motion of a stretch."""
        return observed.follow(self.unknowns.state(vector, node), *self.stretches[node].tolist())

    def followed(self, vector: np.ndarray) -> tuple[Observed, list[StretchMotion]] | None:
        """The rotor of unknowns and the motions of all stretches; ``None`` where one goes beyond the model."""
        observed = self.observed(vector)
        if observed is None:
            return None
        found = [self.follow(observed, vector, node) for node in range(self.unknowns.nodes)]
        known = [each for each in found if each is not None]
        return (observed, known) if len(known) == len(found) else None

    def residuals(self, vector: np.ndarray, weight: float) -> np.ndarray:
        """Residuals of samples, in the noise expected, then of the jumps between stretches; infinite where a motion goes beyond the model."""
        found = self.followed(vector)
        return np.full(self.count, np.inf) if found is None else self._compared(vector, found[1], weight)

    @property
    def count(self) -> int:
        """How many residuals there are."""
        return self.measured.size + (self.unknowns.nodes - 1) * self.unknowns.states

    def _compared(self, vector: np.ndarray, stretches: list[StretchMotion], weight: float) -> np.ndarray:
        ends = [each.end for each in stretches[:-1]]
        jumps = [end - self.unknowns.state(vector, node) for node, end in enumerate(ends, start=1)]
        closing = weight * self.unit[0] / self.noise
        left = (self._seen(vector, stretches) - self.measured) / self.noise
        return np.concatenate([_huber(left.ravel()), closing * np.ravel(jumps)])

    def _seen(self, vector: np.ndarray, stretches: list[StretchMotion]) -> np.ndarray:
        """What the sensors show, with their offsets, shape (m, c), m."""
        seen: np.ndarray = np.concatenate([each.seen for each in stretches]) + self.unit[0] * self.unknowns.offsets(
            vector
        )
        return seen

    def jacobian(self, vector: np.ndarray, weight: float) -> np.ndarray:
        """Derivative of the residuals by the unknowns, dense."""
        unknowns, observed = self.unknowns, self.observed(vector)
        p, k = unknowns.common - unknowns.channels, unknowns.states
        found, closing = np.zeros((self.count, unknowns.size)), weight * self.unit[0] / self.noise
        if observed is None:
            return found
        moved = [self._moved(vector, number) for number in range(p)]
        channels, samples = len(self.record.channels), self.measured.size
        begins = np.concatenate([[0], np.cumsum(np.diff(self.stretches).ravel())])
        for node in range(unknowns.nodes):
            start = self.follow(observed, vector, node)
            if start is None:
                continue
            first, last = self.stretches[node]
            away = start.seen + self.unit[0] * unknowns.offsets(vector) - self.record.values[first:last]
            share = _huber_slope(away.ravel() / self.noise) / self.noise
            rows = slice(channels * begins[node], channels * begins[node + 1])
            jump = slice(samples + node * k, samples + (node + 1) * k)
            ways = [partial(self._at, at, vector, node) for at in moved]
            ways += [partial(self._beside, observed, vector, node, at) for at in range(k)]
            columns = [*range(p), *range(unknowns.common + node * k, unknowns.common + (node + 1) * k)]
            for column, way in zip(columns, ways, strict=True):
                slope = derivative(way, start.events)
                if slope is None:
                    continue
                seen = rows.stop - rows.start
                found[rows, column] = slope[:seen] * share
                if node < unknowns.nodes - 1:
                    found[jump, column] = closing * slope[seen:]
            for channel in range(channels):
                found[rows, p + channel][channel::channels] = self.unit[0] * share[channel::channels]
            if node:
                before = slice(samples + (node - 1) * k, samples + node * k)
                own = slice(unknowns.common + node * k, unknowns.common + (node + 1) * k)
                found[before, own] -= closing * np.eye(k)
        return found

    def _moved(self, vector: np.ndarray, number: int) -> Callable[[float], Observed | None]:
        """The rotor, as sensors see it, after a change of one of the common unknowns; each is made once."""
        known: dict[float, Observed | None] = {}

        def at(step: float) -> Observed | None:
            if step not in known:
                beside = vector.copy()
                beside[number] += step
                known[step] = self.observed(beside)
            return known[step]

        return at

    def _at(
        self, at: Callable[[float], Observed | None], vector: np.ndarray, node: int, step: float
    ) -> StretchMotion | None:
        observed = at(step)
        return None if observed is None else self.follow(observed, vector, node)

    def _beside(
        self, observed: Observed, vector: np.ndarray, node: int, number: int, step: float
    ) -> StretchMotion | None:
        state = self.unknowns.state(vector, node).copy()
        state[number] += step
        return observed.follow(state, *self.stretches[node].tolist())

    def solved(self, vector: np.ndarray) -> Solved | None:
        """Fit the unknowns from a start, round after round; ``None`` where no motion begins there."""
        weight = ROUNDS[-1]
        for weight in ROUNDS if self.unknowns.nodes > 1 else ROUNDS[-1:]:
            if self.followed(vector) is None:
                return None
            vector = least_squares(
                self.residuals,
                vector,
                jac=self.jacobian,
                x_scale="jac",
                ftol=CHANGE,
                xtol=CHANGE,
                max_nfev=MOST_STEPS,
                args=(weight,),
            ).x
        found = self.followed(vector)
        if found is None:
            return None
        left = (self._seen(vector, found[1]) - self.measured) / self.noise
        return Solved(self, vector, *found, left, weight)


def _huber(residuals: np.ndarray) -> np.ndarray:
    """Numbers whose squares are Huber's loss of residuals in the noise: outliers count by their size, not its square."""
    size = np.abs(residuals)
    return np.sign(residuals) * np.where(
        size <= OUTLIER, size, np.sqrt(OUTLIER * np.maximum(2.0 * size - OUTLIER, 0.0))
    )


def _huber_slope(residuals: np.ndarray) -> np.ndarray:
    """Derivative of :func:`_huber`."""
    size = np.maximum(np.abs(residuals), OUTLIER)
    found: np.ndarray = OUTLIER / np.sqrt(OUTLIER * (2.0 * size - OUTLIER))
    return found


@dataclass(frozen=True, eq=False)
class Solved:
    """Unknowns that fit a record: the rotor, the motions, and the residuals of the samples (m, c) in the noise expected."""

    shooting: Shooting
    vector: np.ndarray
    observed: Observed
    stretches: list[StretchMotion]
    residuals: np.ndarray
    weight: float

    @property
    def free(self) -> int:
        """Degrees of freedom of the residuals: states beyond the first are bound."""
        unknowns = self.shooting.unknowns
        return self.residuals.size - unknowns.common - unknowns.states

    @cached_property
    def variance(self) -> float:
        """Variance of the residuals, in that expected, of samples that are no outliers."""
        robust = np.minimum(np.abs(self.residuals), OUTLIER)
        return float((robust**2).sum()) / max(self.free, 1)

    @cached_property
    def covariance(self) -> np.ndarray:
        """Covariance of the unknowns."""
        jacobian = self.shooting.jacobian(self.vector, self.weight)
        _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
        scaled = directions / np.maximum(sizes, TINY * sizes[0])[:, None]
        return scaled.T @ scaled * self.variance
