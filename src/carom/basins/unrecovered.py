"""The smallest disturbances that do not come back: kicks, shocks, losses of a blade.

This is a search, not a proof.  Its result is a bracket: the largest size up to which every start tried came back, and
the smallest size found that does not.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from carom.base.arguments import Count, checked
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.basins.sizes import BESIDE_LOST, SmallestUnrecovered, contact_free_size, size_coordinate
from carom.disturbances import BaseRecord, BladeLoss, Disturbance, KickPlane, Starts, VelocityKick
from carom.disturbances.coordinates import TURN
from carom.disturbances.following import follow
from carom.disturbances.machine_changes import starts_after
from carom.models import Rotor, Subject, rotor_of
from carom.motions.budget import NOT_FOLLOWED, BudgetSpentError

TOLERANCE = 1e-3
MOST_CHECKS = 8
"""Number of times that fresh starts may reduce the smallest unrecovered size."""


class Effort(NamedTuple):
    """How many disturbances a search tries."""

    directions: int = 96
    sizes: int = 96
    """Directions all around, and intervals of size, of the scan."""
    near: int = 96
    """Disturbances below the smallest unrecovered one in each round."""
    drawn: int = 2000
    """Fresh starts below the smallest unrecovered size."""
    around: int = 720
    """Directions over a full turn among the fresh starts, at the upper end of their sizes; as many times more pairs as in the scan."""


FULL = Effort()
COARSE, COARSEST, MANY_MODES = Effort(24, 24, 32, 500, 120), Effort(12, 24, 16, 500, 120), 16
"""For rotors whose motions are followed one after another, and for those of more modes than that."""
LOSSES, MACHINES = Effort(24, 12, 24, 300, 96), 8
"""For losses of a blade, each of which leads to a machine of its own, and number of such machines in a round."""
PAIRS = 4
"""Where the instant matters, as many times more pairs of direction and instant are tried than directions else."""
GOLDEN = (5.0**0.5 - 1.0) / 2.0
"""Share of a turn between instants of neighbouring directions: pairs are then spread evenly over both."""
KEPT, BEST = 64, 16
"""Smallest unrecovered ones that are kept for those of the next round, and those of them that are displaced."""
AGAIN, CLOSEST = 0.05, 0.5
"""Part of the smallest unrecovered size by which the search begins again below it, and share of the tolerance at which it ends."""
MARGIN = 10.0
"""Where the instant matters, all are said to come back up to so many tolerances below the smallest: basins are rough there, and no sample finds their lowest point."""
NEIGHBOURS = 32
"""Disturbances beside the smallest unrecovered one that are followed too."""
FEWEST = 60
"""Fewest fresh starts for which the budget of a study must suffice: 95 of 100 such samples show that one in twenty does not come back."""


@checked
@shows_progress
def smallest_unrecovered(
    machine: Subject,
    model: Disturbance,
    *,
    directions: Count | None = None,
    sizes: Count | None = None,
    tolerance: float = TOLERANCE,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> SmallestUnrecovered:
    """Search for the smallest disturbance of a kind that does not return to levitation, finer than any grid.

    Where the end depends on the instant of the turn at which a disturbance comes (:attr:`carom.models.Rotor.depends_on_instant`), all that is
    said here of directions holds of pairs of direction and instant.  All directions are tried at increasing sizes between the proven contact-free one (zero where nothing is proven, see
    :func:`~carom.closed_forms.contact_free_kick`) and the largest, up to the first interval of sizes in which some do not come back.  Then ever smaller intervals below the smallest
    unrecovered size are tried, in directions near those of the smallest ones so far, until they are half the tolerance wide; the gap in the direction of the smallest is halved
    to the tolerance.  Finally fresh starts are drawn below it; if some do not come back, the search continues from them.  Basins can be thinner than any
    sample, so a smaller one is possible.  All are said to come back up to the tolerance below the smallest, or ten times that where the instant matters: basins are rough there.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    model : Disturbance
        A kick, a shock, the loss of a blade, or another model whose coordinates are a size from 0 and a direction over a full
        turn.  Sizes are searched up to the largest of the model.
    directions, sizes : int, optional
        Numbers of directions and sizes in the scan; by default 96 of each for the planar rotor, fewer for rotors whose motions
        are followed one after another.

    Raises
    ------
    InputError
        The model has no size, or the rotor cannot levitate inside the wall, or its levitation is unstable.

    See Also
    --------
    carom.map_basins : the end of every disturbance
    carom.closed_forms.contact_free_kick : the size up to which contact is impossible

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> found = cm.basins.smallest_unrecovered(machine, kicks)
    >>> print(f"{found.size * machine.parameters.scales.velocity * 1e3:.3f} mm/s, ends in {found.outcome.label}")
    5.464 mm/s, ends in forward-rub
    """
    rotor = rotor_of(machine)
    if rotor.system.rest_radius >= 1.0:
        raise InputError("disturbance", f"|U*| = {rotor.system.rest_radius:.6g}", "needs levitation inside the wall")
    if rotor.system.decay < 0.0:
        grows = f"whirl that grows at a rate of {-rotor.system.decay:.6g} Ω"
        raise InputError("machine", grows, "stable levitation to come back to; this takes damping (gamma)")
    if type(model) is KickPlane:
        model = VelocityKick(model.fastest)
    search = _SizeSearch(rotor, model, tolerance, threads, _effort(rotor, model))
    chosen = directions or search.effort.directions, sizes or search.effort.sizes
    try:
        return _searched(search, *chosen, Reporter.of(progress, "searching the smallest that does not come back"))
    except BudgetSpentError:
        return search.unfinished()


def _effort(rotor: Rotor, model: Disturbance) -> Effort:
    if model.changes_machine:
        return LOSSES
    if isinstance(model, BaseRecord):  # which takes many sections
        return COARSE
    return FULL if rotor.system.is_planar else COARSEST if rotor.system.modes > MANY_MODES else COARSE


def _searched(search: _SizeSearch, directions: int, sizes: int, tell: Reporter) -> SmallestUnrecovered:
    """The search to its end."""
    contact_free, largest = search.contact_free, search.largest
    if contact_free >= largest:
        return search.result(largest)
    around = search.all_around(directions)
    if contact_free == 0.0 and search.follow(np.zeros(around.shape[1]), around):
        return search.result(None)
    search.climb(directions, contact_free + (largest - contact_free) * np.linspace(0.0, 1.0, sizes + 1) ** 2)
    apart = TURN / directions
    search.narrow(search.least - search.back, apart)
    for number in range(MOST_CHECKS):
        tell(0.5 + 0.5 * number / MOST_CHECKS)
        before = search.least
        below = min(largest, (1.0 - search.tolerance) * before)
        if below <= contact_free:
            break
        fresh = search.draw(below, number)
        search.narrow(AGAIN * search.least, apart)
        if search.least > below:
            tell(1.0)
            return search.result(min(below, search.surely * search.least), *fresh)
    return search.result(contact_free or None)


class _SizeSearch:
    """Search among the disturbances of a model by size and direction, and instant where that matters.

    ``smallest_ones`` has the smallest unrecovered ones so far by increasing size: rows are the size, the outcome, the direction and the instant.
    """

    def __init__(self, rotor: Rotor, model: Disturbance, tolerance: float, threads: int | None, effort: Effort) -> None:
        size = size_coordinate(model)
        if size is None:
            raise InputError("disturbance", model.kind, "one with a size from 0 and a direction")
        self.rotor, self.model, self.size, self.effort = rotor, model, size, effort
        self.tolerance, self.threads = tolerance, threads
        self.contact_free, self.largest = contact_free_size(rotor, model), size.high
        self.timed = rotor.depends_on_instant
        self.pairs = PAIRS if self.timed else 1
        self.surely = 1.0 - (MARGIN if self.timed else 1.0) * tolerance
        self.random = np.random.default_rng(0)
        self.tried = 0
        self.smallest_ones = np.empty((3 + self.timed, 0))
        self.recovered = self.back = self.contact_free  # in the direction of the smallest, and up to here in all tried

    @property
    def least(self) -> float:
        """Smallest unrecovered size so far."""
        return float(self.smallest_ones[0, 0]) if self.smallest_ones.size else math.inf

    def all_around(self, directions: int) -> np.ndarray:
        """Evenly spaced directions over a turn, shape (1, n), or pairs of direction and instant, shape (2, n)."""
        count = directions * self.pairs
        angles = TURN * (np.arange(count) + self.random.random()) / count
        instants = TURN * ((GOLDEN * np.arange(count) + self.random.random()) % 1.0)
        return np.stack([angles, instants][: 1 + self.timed])

    def follow(self, sizes: np.ndarray, at: np.ndarray) -> bool:
        """Follow those that are smaller than the smallest so far; keep those that do not come back, and return whether there are any."""
        inside = (sizes < self.least) & (sizes <= self.largest)
        sizes, at = sizes[inside], at[:, inside]
        outcomes = self._outcomes(sizes, at)
        gone = unrecovered(outcomes)
        self.smallest_ones = np.append(self.smallest_ones, np.stack([sizes, outcomes, *at])[:, gone], axis=1)
        self.smallest_ones = self.smallest_ones[:, self.smallest_ones[0].argsort(kind="stable")[:KEPT]]
        return bool(gone.any())

    def climb(self, directions: int, levels: np.ndarray) -> None:
        """Try all directions at increasing sizes, up to the first interval in which some do not come back."""
        for low, high in pairwise(levels.tolist()):
            at = self.all_around(directions)
            sizes = low + (high - low) * self.random.random(at.shape[1])
            if self.follow(*_on_few_machines(self.rotor, self.model, sizes, at, MACHINES)):
                return
            self.back = high

    def narrow(self, reach: float, apart: float) -> None:
        """Try disturbances below the smallest unrecovered one, first by up to ``reach``, then ever less; then halve the gap in its direction.

        Each has the direction and instant of one of those kept, displaced by a part of the difference between two others, so that long
        valleys are followed along, and at random by up to ``apart`` at first.
        """
        if not self.smallest_ones.size:
            return
        gap, count = reach, self.effort.near * self.pairs
        while gap > CLOSEST * self.tolerance * self.least:
            before, (one, other) = self.least, self.random.integers(self.smallest_ones.shape[1], size=(2, count))
            first = self.random.integers(min(BEST, self.smallest_ones.shape[1]), size=count)
            at = self.smallest_ones[2:, first] + self.random.random(count) ** 1.5 * _turned(
                self.smallest_ones[2:, one] - self.smallest_ones[2:, other]
            )
            at += apart * math.sqrt(gap / reach) * self.random.standard_normal(at.shape)
            sizes = np.maximum(before - gap * self.random.random(count), self.contact_free)
            self.follow(*_on_few_machines(self.rotor, self.model, sizes, at, MACHINES))
            gap /= 1.0 if before - self.least > 0.5 * gap else 2.0
        low = self.contact_free
        while self.least - low > self.tolerance * self.least:
            middle = 0.5 * (low + self.least)
            if not self.follow(np.array([middle]), self.smallest_ones[2:, :1]):
                low = middle
        self.recovered = low

    def draw(self, below: float, seed: int) -> tuple[int, int]:
        """Try fresh starts up to a size, and all directions at it; return how many were tried, and how many of these drawn.

        Where the budget of a study does not suffice for all of them, those that were followed count.
        """
        random, drawn, around = np.random.default_rng(seed), self.effort.drawn, self.pairs * self.effort.around
        low, shares = self.contact_free, random.random(drawn)
        area = np.sqrt(low**2 + (below**2 - low**2) * shares)
        sizes = np.append(area if self.size.over_disc else low + (below - low) * shares, np.full(around, below))
        angles = np.append(TURN * random.random(drawn), TURN * (np.arange(around) + random.random()) / around)[None]
        if self.timed:
            angles = np.append(angles, TURN * random.random(angles.shape), axis=0)
        outcomes = self._outcomes(sizes, angles)
        followed = outcomes != NOT_FOLLOWED
        if np.count_nonzero(followed[:drawn]) < min(FEWEST, drawn):
            raise BudgetSpentError("too few new disturbances could be followed")
        gone = unrecovered(np.where(followed, outcomes, Outcome.GRAZING))
        if gone.any():
            found = np.stack([sizes, outcomes, *angles])[:, gone]
            self.smallest_ones = found[:, found[0].argsort()[:KEPT]]
        return int(np.count_nonzero(followed)), int(np.count_nonzero(followed[:drawn]))

    def unfinished(self) -> SmallestUnrecovered:
        """Result of a search that was ended."""
        below = self.contact_free < self.back < self.least
        return self.result(self.back if below else None, complete=False)

    def result(
        self, all_back: float | None, fresh: int = 0, drawn: int = 0, *, complete: bool = True
    ) -> SmallestUnrecovered:
        """Result of the search so far; ``all_back`` is the largest size up to which all came back.

        The neighbours are followed only where the search came to its end: otherwise nothing is left to follow them with.
        """
        size, outcome, angle, instant = None, None, None, None
        if self.smallest_ones.size:
            size, code, angle, *instants = self.smallest_ones[:, 0].tolist()
            outcome, instant = Outcome(int(code)), instants[0] if instants else None
        return SmallestUnrecovered(
            kind=self.model.kind,
            quantity=self.size.scale,
            contact_free=self.contact_free,
            largest=self.largest,
            tolerance=self.tolerance,
            scales=self.rotor.scales,
            neighbours_lost=self._neighbours_lost() if complete else 0,
            neighbours=NEIGHBOURS if complete and self.smallest_ones.size else 0,
            size=size,
            angle=None if angle is None else math.remainder(angle, TURN),
            instant=None if instant is None else instant % TURN,
            outcome=outcome,
            recovered=(all_back or 0.0) if size is None else self.recovered,
            all_back=all_back,
            fresh=fresh,
            drawn=drawn,
            tried=self.tried,
            complete=complete,
        )

    def _neighbours_lost(self) -> int:
        """How many of the neighbours of the best one, at its instant, do not come back."""
        if not self.smallest_ones.size:
            return 0
        away = BESIDE_LOST * np.random.default_rng(NEIGHBOURS).uniform(-1.0, 1.0, (2, NEIGHBOURS))
        at = np.repeat(self.smallest_ones[2:, :1], NEIGHBOURS, axis=1)
        at[0] += away[1]
        return int(np.count_nonzero(unrecovered(self._outcomes(self.least * (1.0 + away[0]), at))))

    def _outcomes(self, sizes: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Outcomes; of impossible starts as of undecided ones."""
        sizes, *at = np.broadcast_arrays(sizes, *angles)
        starts = _starts(self.rotor, self.model, sizes, *at)
        outcomes = follow(self.rotor, starts, threads=self.threads).outcomes
        outcomes[~starts.exists] = Outcome.GRAZING
        counted = starts.exists & (starts.ended == Outcome.CLEAR) & (outcomes != NOT_FOLLOWED)
        self.tried += int(np.count_nonzero(counted))
        return outcomes


def _starts(rotor: Rotor, model: Disturbance, sizes: np.ndarray, *at: np.ndarray) -> Starts:
    """Starts after disturbances of these sizes in these directions, at these instants where they matter."""
    if isinstance(model, BladeLoss):
        phases, *instants = at
        return starts_after(rotor, sizes, phases, model.node, *instants)
    return model.starts_on(rotor, sizes, *at)


def _on_few_machines(
    rotor: Rotor, model: Disturbance, sizes: np.ndarray, at: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Disturbances close to those of these sizes in these directions ``at[0]``, that lead to so many machines at most.

    The unbalances after losses of a blade, of any rotor that changes along its unbalance, are moved to circles: all of one circle lead
    to the same machine, the frame of which has turned.
    """
    before = rotor.definition.unbalance_along(model.node) if isinstance(model, BladeLoss) else None
    if before is None:
        return sizes, at
    places = before + sizes * np.exp(1j * at[0])
    for some in np.array_split(np.abs(places).argsort(), count):
        if some.size:
            places[some] *= np.abs(places[some[some.size // 2]]) / np.abs(places[some])
    return np.abs(places - before), np.vstack([np.angle(places - before), at[1:]])


def _turned(angles: np.ndarray) -> np.ndarray:
    """Angles from half a turn backward to half a turn forward."""
    return (angles + 0.5 * TURN) % TURN - 0.5 * TURN


def unrecovered(outcomes: np.ndarray) -> np.ndarray:
    """Which outcomes are not levitation; those that double precision cannot decide do not count as unrecovered.

    Raises
    ------
    BudgetSpentError
        Some were not followed.
    """
    if (outcomes == NOT_FOLLOWED).any():
        raise BudgetSpentError("the events of this question are spent")
    return (outcomes != Outcome.LEVITATED) & (outcomes != Outcome.GRAZING)


def smallest_unrecovered_kick(rotor: Rotor, kicks: Starts, outcomes: np.ndarray) -> tuple[float, float, float] | None:
    """Speed, direction and instant of the smallest unrecovered one among kicks; ``None`` if all come back."""
    chosen = kicks.some(kicks.exists & unrecovered(outcomes))
    if not chosen.exists.size:
        return None
    gone = rotor.system.translation_velocity(chosen.velocities, chosen.begins)
    place = int(np.abs(gone).argmin())
    return float(abs(gone[place])), float(np.angle(gone[place])), float(chosen.begins[place])
