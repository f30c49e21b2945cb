"""The smallest disturbances that do not come back: kicks, shocks, losses of a blade.

This is a search, not a proof.  Its result is a bracket: the largest size up to which every start tried came back, and
the smallest size found that does not.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom.base.arguments import Count, checked
from carom.base.outcome import InputError, Outcome
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.basins.brackets import BESIDE_LOST, NEIGHBOURS, SmallestUnrecovered
from carom.basins.families import contact_free_size, size_coordinate, starts_by_size
from carom.disturbances import Disturbance, KickPlane, Starts, VelocityKick
from carom.disturbances.coordinates import TURN
from carom.disturbances.following import follow
from carom.models import Rotor, Subject, rotor_of
from carom.motions.budget import NOT_FOLLOWED, BudgetSpentError

TOLERANCE = 1e-3
MOST_CHECKS = 8
"""Number of times that fresh starts may reduce the smallest unrecovered size."""


class Effort(NamedTuple):
    """How many disturbances a search tries."""

    directions: int = 96
    sizes: int = 96
    """Directions all around, and sizes in each, that are scanned."""
    beside: int = 8
    """Directions to each side of the best one so far, in each round."""
    below: int = 24
    """Sizes up to the best one so far, tried in each direction."""
    near: int = 32
    """Pairs of direction and instant about the best one so far in each round."""
    drawn: int = 2000
    """Fresh starts below the smallest unrecovered size."""
    around: int = 720
    """Directions over a full turn among the fresh starts, at the upper end of their sizes."""


FULL = Effort()
COARSE, COARSEST, MANY_MODES = Effort(24, 24, drawn=500, around=120), Effort(12, 24, drawn=500, around=120), 16
"""For rotors whose motions are followed one after another, and for those of more modes than that."""
ONE_EACH = Effort(24, 12, beside=3, below=4, near=12, drawn=300, around=96)
"""Where each disturbance leads to a machine of its own, the exact results of which take milliseconds."""
TOGETHER = 768
"""About as many starts of a scan are followed at once, at a few sizes; larger ones only if none of them fails to come back."""
NARROWED = 4
"""Factor by which the spacing of directions is reduced from one round of refinement to the next."""
GOLDEN = (5.0**0.5 - 1.0) / 2.0
"""Share of a turn between instants of neighbouring directions: pairs are then spread evenly over both."""
PAIRS, COARSER = 4, 4
"""Where the instant matters, as many times more pairs of direction and instant are scanned than directions else, at fewer sizes."""
CLOSER = 2.5
"""Factor by which the distance of pairs from the best one so far is reduced from one round to the next."""
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
    said here of directions holds of pairs of direction and instant.  All directions are scanned at increasing sizes between the proven contact-free one (zero where nothing is proven, see
    :func:`~carom.closed_forms.contact_free_kick`) and the largest, up to the first at which some
    do not come back.  In each of these directions the size is refined by bisection.  Then directions ever closer to the best one are scanned and
    bisected below the best size so far, until they are ``tolerance`` rad apart.  Finally fresh starts are drawn below
    the best size; if some do not come back, the search continues from the smallest of them.  Basins can be thinner than any
    sample, so a smaller one is possible.

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
    5.466 mm/s, ends in forward-rub
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
        return _searched(search, *chosen, Reporter.of(progress, "looking for the smallest that does not come back"))
    except BudgetSpentError:
        return search.unfinished()


def _effort(rotor: Rotor, model: Disturbance) -> Effort:
    if model.changes_machine:
        return ONE_EACH
    return FULL if rotor.system.is_planar else COARSEST if rotor.system.modes > MANY_MODES else COARSE


def _searched(search: _SizeSearch, directions: int, sizes: int, tell: Reporter) -> SmallestUnrecovered:
    """The search to its end."""
    contact_free, largest = search.contact_free, search.largest
    if contact_free >= largest:
        return search.result(largest)
    all_round = _all_round(directions, search.timed)
    if search.timed:
        sizes = max(1, sizes // COARSER)
    if contact_free == 0.0:
        search.scan(all_round, np.zeros(1))
        if search.best is not None:
            return search.result(None)
    levels = contact_free + (largest - contact_free) * np.arange(sizes + 1) / sizes
    search.scan(all_round, levels)
    search.refine(TURN / directions)
    for number in range(MOST_CHECKS):
        tell(0.5 + 0.5 * number / MOST_CHECKS)
        below = largest if search.best is None else search.share * search.best.recovered
        if below <= contact_free:
            break
        before = search.best
        fresh = search.draw(below, number)
        if search.best is before:
            tell(1.0)
            return search.result(below, *fresh)
        search.refine(TURN / directions)
    return search.result(contact_free or None)


def _all_round(directions: int, timed: bool) -> np.ndarray:
    """Evenly spaced directions over a turn, shape (1, n), or with instants, shape (2, n)."""
    count = directions * (PAIRS if timed else 1)
    angles = TURN * np.arange(count) / count
    return np.stack([angles, TURN * (GOLDEN * np.arange(count) % 1.0)]) if timed else angles[None]


class Found(NamedTuple):
    """A bracket in one direction, and at one instant where that matters."""

    recovered: float
    size: float
    angle: float
    outcome: Outcome
    instant: float | None = None


class _SizeSearch:
    """Search among the disturbances of a model by size and direction; ``best`` is the smallest unrecovered one so far."""

    def __init__(self, rotor: Rotor, model: Disturbance, tolerance: float, threads: int | None, effort: Effort) -> None:
        size = size_coordinate(model)
        if size is None:
            raise InputError("disturbance", model.kind, "one with a size from 0 and a direction")
        self.rotor, self.model, self.size, self.effort = rotor, model, size, effort
        self.tolerance, self.threads = tolerance, threads
        self.contact_free, self.largest, self.timed = (
            contact_free_size(rotor, model),
            size.high,
            rotor.depends_on_instant,
        )
        # Where trials are dear, no smaller ones are sought than by half the tolerance.
        self.share = 1.0 - 0.5 * tolerance if model.changes_machine else 1.0
        self.tried = 0
        self.best: Found | None = None
        self.back = 0.0  # up to here all directions scanned came back

    def scan(self, angles: np.ndarray, levels: np.ndarray) -> None:
        """Scan angles (k, n) at increasing sizes, the first of which is known to recover, up to that at which some do not come back.

        These are bisected below it; what does not come back farther out cannot be smaller.  A single size is only tried, not bisected.
        """
        bisect = len(levels) > 1
        # Where motions are followed one after another, or machines are many, larger sizes are dear that a smaller one makes needless.
        dear = self.model.changes_machine or not self.rotor.system.is_planar
        together = 1 if dear else max(1, TOGETHER // angles.shape[1])
        sizes, known = levels[bisect:], self.best is not None
        for begin in range(0, len(sizes), together):
            outcomes, gone = self._follow(sizes[None, begin : begin + together], angles[:, :, None])
            first = begin + (int(gone.any(axis=0).argmax()) if gone.any() else outcomes.shape[1])
            if bisect and not known:
                self.back = float(levels[first])
            if gone.any():
                break
        else:
            return
        place = first - begin
        failing = np.flatnonzero(gone[:, place])
        ends, angles = outcomes[failing, place], angles[:, failing]
        low, high = (np.full(len(failing), levels[each]) for each in (first, first + bisect))
        self._note(low, high, angles, ends)
        while ((high - low) > self.tolerance * high).any():
            middle = 0.5 * (low + high)
            found, gone = self._follow(middle, angles)
            low, high, ends = np.where(gone, low, middle), np.where(gone, middle, high), np.where(gone, found, ends)
            least = low < high.min()  # the others have brackets above the smallest
            low, high, ends, angles = low[least], high[least], ends[least], angles[:, least]
        self._note(low, high, angles, ends)

    def _note(self, low: np.ndarray, high: np.ndarray, angles: np.ndarray, ends: np.ndarray) -> None:
        """Note the smallest of several brackets, if it is the best so far."""
        place = int(high.argmin())
        if self.best is None or high[place] <= self.best.size:
            direction, *instant = angles[:, place].tolist()
            self.best = Found(float(low[place]), float(high[place]), direction, Outcome(int(ends[place])), *instant)

    def refine(self, apart: float) -> None:
        """Scan directions to both sides of the best one, or pairs all around it, ever closer."""
        if self.timed:
            self._refine_pairs(apart)
            return
        beside = self.effort.beside
        while self.best is not None and apart > self.tolerance:
            apart /= NARROWED
            angles = self.best.angle + apart * np.delete(np.arange(-beside, beside + 1), beside)
            self.scan(angles[None], np.linspace(self.contact_free, self.share * self.best.size, self.effort.below + 1))

    def _refine_pairs(self, apart: float) -> None:
        """Scan pairs spread over discs about the best one, from two distances between pairs of the first scan down to the tolerance."""
        reach, number = 2.0 * math.sqrt(apart * TURN / PAIRS), np.arange(self.effort.near) + 0.5
        spread = np.sqrt(number / self.effort.near) * np.array(
            [np.cos(TURN * GOLDEN * number), np.sin(TURN * GOLDEN * number)]
        )
        while self.best is not None and reach > self.tolerance:
            at = np.array([[self.best.angle], [self.best.instant]])
            self.scan(
                at + reach * spread,
                np.linspace(self.contact_free, self.share * self.best.size, self.effort.below // 2 + 1),
            )
            reach /= CLOSER

    def draw(self, below: float, seed: int) -> tuple[int, int]:
        """Try fresh starts up to a size, and all directions at it; bisect those that do not come back; return how many were tried, and how many of these drawn.

        Where the budget of a study does not suffice for all of them, those that were followed count.
        """
        random, drawn, around = np.random.default_rng(seed), self.effort.drawn, self.effort.around
        low, shares = self.contact_free, random.random(drawn)
        area = np.sqrt(low**2 + (below**2 - low**2) * shares)
        sizes = np.append(area if self.size.over_disc else low + (below - low) * shares, np.full(around, below))
        angles = np.append(TURN * random.random(drawn), TURN * (np.arange(around) + random.random()) / around)[None]
        if self.timed:
            angles = np.append(angles, TURN * random.random(angles.shape), axis=0)
        outcomes = self._outcomes(sizes, angles)
        followed = outcomes != NOT_FOLLOWED
        if np.count_nonzero(followed[:drawn]) < min(FEWEST, drawn):
            raise BudgetSpentError("too few fresh starts could be followed")
        gone = unrecovered(np.where(followed, outcomes, Outcome.GRAZING))
        for place in np.flatnonzero(gone)[sizes[gone].argsort()]:
            if self.best is None or sizes[place] < self.best.size:
                self.scan(
                    angles[:, place : place + 1], np.linspace(self.contact_free, sizes[place], self.effort.below + 1)
                )
        return int(np.count_nonzero(followed)), int(np.count_nonzero(followed[:drawn]))

    def unfinished(self) -> SmallestUnrecovered:
        """Result of a search that was ended."""
        below = self.back > self.contact_free and (self.best is None or self.best.size > self.back)
        return self.result(self.back if below else None, complete=False)

    def result(
        self, all_back: float | None, fresh: int = 0, drawn: int = 0, *, complete: bool = True
    ) -> SmallestUnrecovered:
        """Result of the search so far; ``all_back`` is the largest size up to which all came back.

        The neighbours are followed only where the search came to its end: otherwise nothing is left to follow them with.
        """
        recovered, size, angle, outcome, instant = self.best or (all_back or 0.0, None, None, None, None)
        return SmallestUnrecovered(
            kind=self.model.kind,
            quantity=self.size.scale,
            contact_free=self.contact_free,
            largest=self.largest,
            tolerance=self.tolerance,
            scales=self.rotor.scales,
            neighbours_lost=self._neighbours_lost() if complete else 0,
            neighbours=NEIGHBOURS if complete and self.best is not None else 0,
            size=size,
            angle=None if angle is None else math.remainder(angle, TURN),
            instant=None if instant is None else instant % TURN,
            outcome=outcome,
            recovered=recovered,
            all_back=all_back,
            fresh=fresh,
            drawn=drawn,
            tried=self.tried,
            complete=complete,
        )

    def _neighbours_lost(self) -> int:
        """How many of the neighbours of the best one, at its instant, do not come back."""
        if self.best is None:
            return 0
        away = BESIDE_LOST * np.random.default_rng(NEIGHBOURS).uniform(-1.0, 1.0, (2, NEIGHBOURS))
        at = [self.best.angle + away[1]]
        if self.best.instant is not None:
            at.append(np.full(NEIGHBOURS, self.best.instant))
        return int(np.count_nonzero(self._follow(self.best.size * (1.0 + away[0]), np.array(at))[1]))

    def _follow(self, sizes: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outcomes, and which starts do not come back; impossible and undecided starts do not count as unrecovered."""
        outcomes = self._outcomes(sizes, angles)
        return outcomes, unrecovered(outcomes)

    def _outcomes(self, sizes: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Outcomes; of impossible starts as of undecided ones."""
        sizes, *at = np.broadcast_arrays(sizes, *angles)
        starts = starts_by_size(self.rotor, self.model, sizes, *at)
        outcomes = follow(self.rotor, starts, threads=self.threads).outcomes
        outcomes[~starts.exists] = Outcome.GRAZING
        counted = starts.exists & (starts.ended == Outcome.CLEAR) & (outcomes != NOT_FOLLOWED)
        self.tried += int(np.count_nonzero(counted))
        return outcomes


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
