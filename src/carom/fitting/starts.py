"""Where a fit starts: what free flights say of the parameters, how noisy a record is, where it is cut, and the state at the beginning of each stretch.

In the fixed frame a flight is linear and the same whenever it begins, up to what the unbalance adds, which turns with the shaft.  So all
windows of a record are compared with flights at once, by one projection, and a robust loss leaves out those with a contact in them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares  # type: ignore[import-untyped]

from carom.fitting.shooting import Shooting
from carom.fitting.stretches import Observed

SHORTEST = 6
"""Samples of the shortest windows, at least."""
PER_STATE = 2.0
"""Numbers measured in a window per number of a state, at least."""
LONGER = (1, 2, 4, 8)
"""Lengths of windows, in the shortest ones."""
MOSTLY_FREE = 0.5
"""Share of the windows that must be flights for longer ones to be tried."""
STRETCHES = 16
"""Stretches into which a record is cut, at most about."""
MIDDLE = (0.25, 0.75)
"""Part of a flight in which a stretch may begin, away from contacts at its ends."""
TIGHT = 2.0
"""Residual of a flight, in the noise, up to which it is free of contact."""
QUIET = 0.25
"""Share of the windows that are taken for flights when the noise is estimated."""
SMALL, INSENSITIVE = 1e-3, 1e-9
"""Change of an unknown, and change of the residuals, relative, from which flights depend on it."""
MOST_STEPS, CHANGE = 30, 1e-6
"""Steps of the fit of flights, and relative change of the loss at which it ends."""
UNSEEN = 1e-2
"""Noise, in clearances, with which states of about one are estimated where the sensors hardly see them."""


@dataclass(frozen=True, eq=False)
class Windows:
    """All windows of a length of a record, compared with flights.

    Attributes
    ----------
    firsts : array of int, shape (w,)
        Samples at which they begin.
    states : array, shape (w, k)
        State at each by which a flight is nearest to the record.
    residuals : array, shape (w, l c)
        Differences that remain, m, scaled so that their squares have the mean of the noise.
    """

    firsts: np.ndarray
    states: np.ndarray
    residuals: np.ndarray

    @classmethod
    def of(cls, observed: Observed, width: int, offsets: np.ndarray) -> Windows | None:
        """Compare all windows of a width, without offsets (c,) in m, with the flights of a rotor; ``None`` if these grow beyond all numbers."""
        record = observed.record
        matrix, constants = observed.flights(width)
        firsts = np.arange(len(record.times) - width)
        clocks = np.asarray(observed.clock(record.times[firsts]))
        turning = np.stack([np.ones_like(clocks), np.cos(clocks), np.sin(clocks)], axis=1) @ constants
        shape = (len(firsts), width * len(record.channels))
        slid = np.lib.stride_tricks.sliding_window_view(record.values - offsets, width, axis=0)[: len(firsts)]
        wanted = slid.transpose(0, 2, 1).reshape(shape) - turning
        if not np.isfinite(matrix).all() or not np.isfinite(constants).all():
            return None
        found, sizes, directions = np.linalg.svd(matrix, full_matrices=False)
        parts, ridge = wanted @ found, UNSEEN * observed.unit[0]
        shares = sizes**2 / (sizes**2 + ridge**2)
        left = wanted - (parts * shares) @ found.T
        free = max(shape[1] - float(shares.sum()), 1.0)
        return cls(firsts, (parts * sizes / (sizes**2 + ridge**2)) @ directions, left * np.sqrt(shape[1] / free))

    @property
    def deviations(self) -> np.ndarray:
        """Standard deviation of the record from a flight, of each window, m."""
        found: np.ndarray = np.sqrt((self.residuals**2).mean(axis=1))
        return found

    @property
    def noise(self) -> float:
        """Noise of the record by the windows that are nearest to flights, m."""
        return float(np.quantile(self.deviations, QUIET))


def shortest(observed: Observed) -> int:
    """Samples of the shortest windows that determine a state."""
    channels = len(observed.record.channels)
    return max(SHORTEST, int(np.ceil(PER_STATE * observed.states / channels)))


@dataclass(frozen=True, eq=False)
class FlightFit:
    """The fit of what flights determine: levitation and unbalance, but nothing of contacts.

    Attributes
    ----------
    shooting : Shooting
        Of a record that is not cut yet.
    """

    shooting: Shooting

    def windows(self, vector: np.ndarray, width: int) -> Windows | None:
        """All windows of a width, compared with flights of the unknowns; ``None`` if there is no such rotor."""
        observed = self.shooting.observed(vector)
        offsets = self.shooting.unit[0] * self.shooting.unknowns.offsets(vector)
        return None if observed is None else Windows.of(observed, width, offsets)

    def solved(self, vector: np.ndarray) -> tuple[np.ndarray, int] | None:
        """Common unknowns that fit the flights, over longer and longer windows while these are mostly free of contact, and their last width."""
        observed = self.shooting.observed(vector)
        if observed is None:
            return None
        least = width = shortest(observed)
        start = self.windows(vector, least)
        if start is None:
            return None
        free = self._determined(vector, least, start)
        for factor in LONGER:
            tried = factor * least
            if 2 * tried > len(self.shooting.record.times):
                break
            moved = self._fitted(self._fitted(vector, free, tried, np.inf), free, tried, TIGHT)
            now = self.windows(moved, tried)
            if now is None or (now.deviations <= TIGHT * now.noise).mean() < MOSTLY_FREE:
                break
            vector, width = moved, tried
        return vector, width

    def _determined(self, vector: np.ndarray, width: int, start: Windows) -> list[int]:
        """Which of the common unknowns flights depend on."""
        found = []
        for number in range(len(vector)):
            beside = vector.copy()
            beside[number] += SMALL
            moved = self.windows(beside, width)
            if moved and np.abs(moved.residuals - start.residuals).max() > INSENSITIVE * np.abs(start.residuals).max():
                found.append(number)
        return found

    def _fitted(self, vector: np.ndarray, free: list[int], width: int, limit: float) -> np.ndarray:
        """Unknowns that fit those windows whose deviation is below a limit, in the noise; robust against contacts in them."""
        present = self.windows(vector, width)
        if present is None or not free:
            return vector
        chosen, noise = present.deviations <= limit * present.noise, present.noise
        size, moved = present.residuals[chosen].size, vector.copy()

        def residuals(numbers: np.ndarray) -> np.ndarray:
            moved[free] = numbers
            found = self.windows(moved, width)
            return np.full(size, np.inf) if found is None else found.residuals[chosen].ravel() / noise

        fitted = least_squares(
            residuals, vector[free], jac="2-point", loss="cauchy", x_scale="jac", max_nfev=MOST_STEPS, ftol=CHANGE
        )
        moved[free] = fitted.x
        return moved


def cut(observed: Observed, width: int, offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Cut a record in its flights, long ones first: stretches as first sample and one past the last, (K, 2), states at their beginnings, and noise in m."""
    last, least = len(observed.record.times) - 1, shortest(observed)
    covered = np.zeros(last + 1, bool)
    apart, noise = max(width, last // STRETCHES), 0.0
    chosen: dict[int, np.ndarray] = {}
    taken: list[tuple[int, int]] = []
    while width >= least:
        windows = Windows.of(observed, width, offsets)
        if windows is None:
            break
        deviations, noise = windows.deviations, noise or windows.noise
        tight = deviations <= TIGHT * noise
        fresh = np.flatnonzero(tight & ~covered[windows.firsts + width // 2])
        for number in fresh[np.argsort(deviations[fresh])].tolist():
            free = all(number + width <= begin or end <= number for begin, end in taken)
            sample, state = deepest(observed, windows.states[number], number, width)
            if free and all(abs(sample - other) >= apart for other in chosen) and sample < last - least:
                taken.append((number, number + width))
                chosen[sample] = state
        for number in np.flatnonzero(tight).tolist():
            covered[number : number + width] = True
        width //= 2
        apart = width
    begins = sorted(chosen)
    return np.column_stack([begins, [*begins[1:], last]]), np.array([chosen[each] for each in begins]), noise


def deepest(observed: Observed, state: np.ndarray, first: int, width: int) -> tuple[int, np.ndarray]:
    """Sample in the middle part of a flight over some samples at which the rotor is farthest from the walls, and its state there."""
    samples = range(first + int(MIDDLE[0] * width), first + max(int(MIDDLE[1] * width), 1))
    flown = observed.flown(state, first, samples)
    radii = [observed.radius(each, sample) for each, sample in zip(flown, samples, strict=True)]
    best = int(np.argmin(radii))
    return samples[best], flown[best]
