"""What a search for orbits has tried, and the random starts of its motions."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from carom.models import Rotor

FASTEST = 1.5
"""Velocities of the starts in the fixed frame, in ``c_r Ω``, are up to this."""
KIND = 3
"""Decimals to which the states of ends must agree to count as one."""


@dataclass(frozen=True)
class Searched:
    """How much a search for orbits has tried, and what share of fresh motions ended on the orbits known afterwards.

    Attributes
    ----------
    settled : int
        Number of motions that were followed until they settled; the orbits on which these end are closed.
    motions : int
        Number of further motions, whose stretches are the guesses.
    guesses : int
        Number of stretches from which Newton's method was begun; those on a known orbit are left out.
    repeats : int
        Number of those that led to a known solution.
    failures : int
        Number of those from which it converged to no orbit.
    last_new : int
        Number of the guess, from 1, that led to the last new orbit; 0 if none did.
    virtual : int
        Number of solutions that are not motions of the machine.
    fresh : int
        Number of fresh motions from random starts, which the search has not used.
    on_listed : int
        Number of those that ended on one of the orbits.
    on_others : int
        Number of those that ended on another periodic motion with no more impacts than were searched.
    unsettled : int
        Number of those that had not settled when they were given up.
    """

    settled: int
    motions: int
    guesses: int
    repeats: int
    failures: int
    last_new: int
    virtual: int
    fresh: int
    on_listed: int
    on_others: int
    unsettled: int

    @property
    def share_on_listed(self) -> float:
        """Share of the fresh motions that ended on one of the orbits."""
        return self.on_listed / self.fresh

    def and_then(self, later: Searched) -> Searched:
        """Both searches together, of which the given one came later."""
        sums = {each.name: getattr(self, each.name) + getattr(later, each.name) for each in fields(self)}
        sums["last_new"] = self.guesses + later.last_new if later.last_new else self.last_new
        return Searched(**sums)

    @property
    def words(self) -> str:
        """The same in a few sentences."""
        newest = f"guess {self.last_new} led to the last new orbit" if self.last_new else "none led to a new orbit"
        return (
            f"Orbits were found by search, so the list may be incomplete: {self.settled} motions "
            f"were followed until they settled; {self.motions} others gave {self.guesses} initial guesses for Newton's method, of "
            f"which {self.repeats} converged to known orbits and {self.failures} did not converge; {newest}. Virtual solutions: {self.virtual}. "
            f"Of {self.fresh} new motions, {self.on_listed} ended on an orbit listed here, {self.on_others} on other orbits with no more impacts than "
            f"were searched, and {self.unsettled} had not settled when they were given up."
        )


def random_starts(
    rotor: Rotor, random: np.random.Generator, count: int, *, on_wall: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """Random positions inside all walls, or on one, and velocities, complex, shape (count,) or, for n > 1 coordinates, (count, n).

    The velocities are random in the fixed frame: those of bounces that whirl backward are far from zero in the frame that turns.
    """
    system = rotor.system
    arrays, n = system.arrays, len(system.rest)
    directions = random.normal(size=(count, 2, n, 2)) @ [1.0, 1j]
    shares, speeds = np.sqrt(random.uniform(size=count)), FASTEST * np.sqrt(random.uniform(size=count))
    if on_wall:
        shares[:] = 1.0

    def reach(sizes: np.ndarray) -> np.ndarray:
        states = np.concatenate([sizes[:, None] * directions[:, 0], np.zeros((count, n))], axis=1)
        return np.abs(system.amplitudes_of(states) @ arrays.rows.T + arrays.offsets).max(axis=1)

    sizes = shares / reach(np.ones(count))
    while (far := reach(sizes) > 1.0).any():
        sizes = np.where(far, 0.5 * sizes, sizes)
    positions = sizes[:, None] * directions[:, 0]
    velocities = (speeds / np.abs(directions[:, 1]).max(axis=1))[:, None] * directions[:, 1] - 1j * positions
    return (positions, velocities) if n > 1 else (positions[:, 0], velocities[:, 0])
