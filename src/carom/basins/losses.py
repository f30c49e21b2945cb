"""The smallest disturbances that are lost: kicks, shocks, steps of the unbalance, releases from contact.

This is a search, not a proof.  Its result is a bracket: the largest size up to which every start tried came back, and
the smallest size found that does not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.arguments import Count, checked
from carom.basins.families import Family, family_of
from carom.basins.shares import CONFIDENCE
from carom.disturbances import BladeLoss, Disturbance, Starts
from carom.disturbances.coordinates import TURN
from carom.disturbances.following import follow
from carom.models import Jeffcott, Model, Subject, jeffcott_of
from carom.outcome import InputError, Outcome
from carom.parameters import Scales
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result

DIRECTIONS, SIZES = 96, 96
TOLERANCE = 1e-3
TOGETHER = 768
"""About as many starts of a scan are followed at once, at a few sizes; larger ones only if none of them is lost."""
NARROWED = 4
"""Factor by which the spacing of directions is reduced from one round of refinement to the next."""
BESIDE = 8
"""Directions to each side of the best one so far, in each round."""
BELOW = 24
"""Sizes up to the best one so far, tried in each direction."""
DRAWN, ROUND = 2000, 720
"""Fresh starts below the smallest loss, and directions over a full turn at the upper end of these sizes."""
MOST_CHECKS = 8
"""Number of times that fresh starts may reduce the smallest loss."""


@dataclass(frozen=True, repr=False)
class SmallestLoss(Result):
    """Bracket of the size at which disturbances begin to be lost.

    Attributes
    ----------
    kind : str
        Kind of the disturbance: ``"kick"``, ``"shock"``, ``"unbalance-step"``, ``"blade-loss"``, ``"release"``, or that of
        another model; of a kick plane ``"kick"``.
    size : float or None
        Smallest lost size found: change of velocity in ``c_r Ω``, peak acceleration in ``c_r Ω²``, change of the
        eccentricity in ``c_r`` (for the loss of a blade: eccentricity after it), speed along the wall in ``c_r Ω`` (fixed
        frame), or first coordinate of another model.  ``None`` where none was found.
    angle : float or None
        Its direction in rad.  For a kick or shock as in :mod:`carom.disturbances`; for a step the direction from the
        eccentricity after the step to the one before it, relative to the one after; for the loss of a blade the phase of the
        unbalance after it; for a release the place on the wall.
    outcome : Outcome or None
        Outcome of the motion after it.
    backward : bool
        Whether it is a release in backward whirl.
    recovered : float
        A smaller size in this direction, within the tolerance, that comes back.
    all_back : float or None
        Largest size up to which all starts tried came back: those of the search and ``fresh`` ones.  ``None`` where the
        smallest starts are lost already.
    fresh : int
        Number of starts up to ``all_back`` that are independent of the search: 2,000 drawn uniformly over the area of the
        disc beyond the harmless size (of releases: over places and speeds), and 720 directions over a full turn at that size.
    harmless : float
        Size up to which contact is proven to be impossible in any direction; 0 where nothing is proven.
    largest : float
        Largest size searched.
    tolerance : float
        Relative width to which the smallest loss is bisected, and angle in rad between the last directions tried.
    tried : int
        Number of starts followed.
    quantity : str
        Property of the scales by which sizes are converted to SI units.
    scales : Scales or None
        Those of the machine.
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "clopper1934")

    kind: str
    size: float | None
    angle: float | None
    outcome: Outcome | None
    backward: bool
    recovered: float
    all_back: float | None
    fresh: int
    harmless: float
    largest: float
    tolerance: float
    tried: int
    quantity: str = ""
    scales: Scales | None = None

    shown: ClassVar[tuple[str, ...]] = (
        "kind",
        "size",
        "angle",
        "outcome",
        "recovered",
        "all_back",
        "fresh",
        "harmless",
        "largest",
        "tried",
    )

    @property
    def words(self) -> str:
        """The bracket in a line."""
        told = {name: self.line_of(name, getattr(self, name)) for name in ("size", "all_back", "harmless", "largest")}
        lost = f"none lost up to {told['largest']}" if self.size is None else f"smallest lost {told['size']}"
        back = "" if self.all_back is None else f", all back up to {told['all_back']}"
        return f"{lost}{back}, harmless up to {told['harmless']}"

    def kind_of(self, name: str) -> str:
        """Sizes are of one kind."""
        return (
            self.quantity if name in ("size", "recovered", "all_back", "harmless", "largest") else super().kind_of(name)
        )

    @property
    def share_below(self) -> float:
        """Share of the disturbances beyond the harmless size and up to ``all_back``, by area, that may be lost: a bound at 95 %.

        ``1 − 0.05^{1/n}`` for ``n`` starts of which none is lost (Clopper and Pearson, one-sided).
        """
        drawn = max(self.fresh - ROUND, 0)
        return -math.expm1(math.log(1.0 - CONFIDENCE) / drawn) if drawn else 1.0


@checked
@shows_progress
def smallest_loss(
    machine: Subject,
    model: Disturbance,
    *,
    directions: Count = DIRECTIONS,
    sizes: Count = SIZES,
    tolerance: float = TOLERANCE,
    threads: Count | None = None,
    progress: ShowProgress = None,
) -> SmallestLoss:
    """Search for the smallest disturbance of a kind that does not return to levitation, finer than any grid.

    All directions are scanned at increasing sizes between the proven harmless one and the largest, up to the first at which some
    are lost.  In each of these directions the size is refined by bisection.  Then directions ever closer to the best one are scanned and
    bisected below the best size so far, until they are ``tolerance`` rad apart.  Finally fresh starts are drawn below
    the best size; if some are lost, the search continues from the smallest of them.  Basins can be thinner than any
    sample, so a smaller loss is possible.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    model : Disturbance
        A kick, a shock, a step of the unbalance, the loss of a blade, a release from contact, or another model whose
        coordinates are a size from 0 and a direction over a full turn.  Sizes are searched up to the largest of the
        model (for a step up to the largest change to the eccentricity of the machine; for a release in whirl forward and
        backward, from rest up to 2 ``c_r Ω``).
    directions, sizes : int
        Numbers of directions and sizes in the scan.

    Raises
    ------
    InputError
        The model has no size, or the rotor cannot levitate inside the wall, or its levitation is unstable.

    See Also
    --------
    carom.map_basins : the end of every disturbance
    carom.closed_forms.harmless_kick : the size up to which contact is impossible

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> found = cm.basins.smallest_loss(machine, kicks)
    >>> print(f"{found.size * machine.parameters.scales.velocity * 1e3:.3f} mm/s, ends in {found.outcome.label}")
    5.466 mm/s, ends in forward-rub
    """
    rotor = jeffcott_of(machine)
    if abs(rotor.equilibrium) >= 1.0:
        raise InputError("disturbance", f"|U*| = {abs(rotor.equilibrium):.6g}", "needs levitation inside the wall")
    if rotor.parameters.gamma < 0.0:
        raise InputError("gamma", rotor.parameters.gamma, "at least 0: there is no levitation to come back to")
    if isinstance(model, BladeLoss):
        from carom.basins.blade_losses import smallest_blade_loss  # that module needs this one

        return smallest_blade_loss(rotor, model, threads=threads, tell=Reporter.of(progress, "trying unbalances"))
    family = family_of(rotor, model)
    search = _Search(rotor, family, tolerance, threads)
    if family.harmless >= family.largest:
        return search.result(family.largest, 0)
    if family.harmless == 0.0:
        search.scan(_all_round(family, directions), np.zeros(1))
        if search.best is not None:
            return search.result(None, 0)
    levels = family.harmless + (family.largest - family.harmless) * np.arange(sizes + 1) / sizes
    tell = Reporter.of(progress, "looking for the smallest that is lost")
    search.scan(_all_round(family, directions), levels)
    search.refine(TURN / directions)
    for number in range(MOST_CHECKS):
        tell(0.5 + 0.5 * number / MOST_CHECKS)
        below = family.largest if search.best is None else search.best[0]
        if below <= family.harmless:
            break
        before = search.best
        fresh = search.draw(below, number)
        if search.best is before:
            tell(1.0)
            return search.result(below, fresh)
        search.refine(TURN / directions)
    return search.result(family.harmless or None, 0)


def _all_round(family: Family, directions: int) -> np.ndarray:
    """Evenly spaced directions over all turns of a family."""
    return TURN * np.arange(family.turns * directions) / directions


class _Search:
    """State of a search: the number of starts tried, and the best bracket.

    The bracket holds a recovered size, the smallest lost size, its direction and its outcome.
    """

    def __init__(self, rotor: Jeffcott, family: Family, tolerance: float, threads: int | None) -> None:
        self.rotor, self.family, self.tolerance, self.threads = rotor, family, tolerance, threads
        self.tried = 0
        self.best: tuple[float, float, float, Outcome] | None = None

    def result(self, all_back: float | None, fresh: int) -> SmallestLoss:
        """Result of the search so far."""
        family = self.family
        recovered, size, angle, outcome = self.best or (all_back or 0.0, None, None, None)
        backward = angle is not None and family.turns > 1 and angle % (2.0 * TURN) >= TURN
        if angle is not None:
            angle = math.remainder(angle, TURN)
        return SmallestLoss(
            kind=family.kind,
            size=size,
            angle=angle,
            outcome=outcome,
            backward=backward,
            recovered=recovered,
            all_back=all_back,
            fresh=fresh,
            harmless=family.harmless,
            largest=family.largest,
            tolerance=self.tolerance,
            tried=self.tried,
            quantity=family.quantity,
            scales=self.rotor.scales,
        )

    def scan(self, angles: np.ndarray, levels: np.ndarray) -> None:
        """Scan directions at increasing sizes, the first of which is known to recover, up to that at which some are lost.

        These are bisected below it; what is lost farther out cannot be smaller.  A single size is only tried, not bisected.
        """
        bisect = len(levels) > 1
        sizes, together = levels[bisect:], max(1, TOGETHER // len(angles))
        for begin in range(0, len(sizes), together):
            outcomes, gone = self._follow(sizes[None, begin : begin + together], angles[:, None])
            if gone.any():
                break
        else:
            return
        place = int(gone.any(axis=0).argmax())
        hit, first = np.flatnonzero(gone[:, place]), begin + place
        ends, angles = outcomes[hit, place], angles[hit]
        low, high = (np.full(len(hit), levels[each]) for each in (first, first + bisect))
        while ((high - low) > self.tolerance * high).any():
            middle = 0.5 * (low + high)
            found, gone = self._follow(middle, angles)
            low, high = np.where(gone, low, middle), np.where(gone, middle, high)
            ends = np.where(gone, found, ends)
        place = int(high.argmin())
        if self.best is None or high[place] < self.best[1]:
            self.best = float(low[place]), float(high[place]), float(angles[place]), Outcome(int(ends[place]))

    def refine(self, apart: float) -> None:
        """Scan directions to both sides of the best one, with ever smaller spacing."""
        while self.best is not None and apart > self.tolerance:
            apart /= NARROWED
            _, size, angle, _ = self.best
            beside = angle + apart * np.delete(np.arange(-BESIDE, BESIDE + 1), BESIDE)
            self.scan(beside, np.linspace(self.family.harmless, size, BELOW + 1))

    def draw(self, below: float, seed: int) -> int:
        """Try fresh starts up to a size, and all directions at it; bisect the lost ones; return how many were tried."""
        family = self.family
        random = np.random.default_rng(seed)
        sizes = np.append(family.drawn(random.random(DRAWN), below), np.full(ROUND, below))
        span = TURN * family.turns
        angles = np.append(span * random.random(DRAWN), span * (np.arange(ROUND) + random.random()) / ROUND)
        _, gone = self._follow(sizes, angles)
        for place in np.flatnonzero(gone)[sizes[gone].argsort()]:
            if self.best is None or sizes[place] < self.best[1]:
                self.scan(angles[place : place + 1], np.linspace(family.harmless, sizes[place], BELOW + 1))
        return len(sizes)

    def _follow(self, sizes: np.ndarray, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outcomes, and which starts are lost; impossible and undecided starts do not count as lost."""
        sizes, angles = np.broadcast_arrays(sizes, angles)
        starts = self.family.starts(sizes, angles)
        outcomes = follow(self.rotor, starts, threads=self.threads).outcomes
        outcomes[~starts.exists] = Outcome.GRAZING
        self.tried += int(np.count_nonzero(starts.exists & ~starts.undecided))
        return outcomes, lost(outcomes)


def lost(outcomes: np.ndarray) -> np.ndarray:
    """Which outcomes are not levitation; those that double precision cannot decide do not count as lost."""
    return (outcomes != Outcome.LEVITATED) & (outcomes != Outcome.GRAZING)


def smallest_lost(rotor: Model, kicks: Starts, outcomes: np.ndarray) -> tuple[float, float] | None:
    """Speed and direction of the smallest lost one among kicks; ``None`` if none is lost."""
    gone = rotor.system.translation_velocity(kicks.velocities[kicks.exists & lost(outcomes)])
    if not gone.size:
        return None
    smallest = gone[np.abs(gone).argmin()]
    return float(abs(smallest)), float(np.angle(smallest))
