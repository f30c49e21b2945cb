"""The smallest change of the unbalance by the loss of a blade that a machine does not survive, over all phases.

What follows depends on the machine after the loss, and on where in the turn it begins.  A rotor whose unbalance changes along that before it is, after all
changes that leave one size ``a``, the same machine in a frame that has turned.  So changes are tried in circles about a balanced rotor: few machines with many phases each.
Of any other rotor each change leads to a machine of its own; then the circles are those of the change itself.
"""

from __future__ import annotations

import cmath

import numpy as np

from carom.base.outcome import Outcome
from carom.base.progress import Reporter
from carom.basins.brackets import MOST_CHECKS, TOLERANCE, Bracket, Found, SmallestLoss, lost
from carom.basins.families import UNBALANCE
from carom.closed_forms.harmless import harmless_blade_loss
from carom.disturbances import BladeLoss
from carom.disturbances.blade_loss import levitating_before, starts_after
from carom.disturbances.coordinates import TURN
from carom.disturbances.following import follow
from carom.models import Rotor
from carom.motions.budget import BudgetSpentError

CIRCLES, PHASES, FIRST = 48, 360, 8
"""Circles of the scan on each side of the unbalance before, phases on each, and as many of them that are followed first on the first of these."""
OWN_CIRCLES, OWN_PHASES = 12, 24
"""The same where each change leads to a machine of its own, or motions are followed one after another."""
ROUNDS, BESIDE, NARROWED = 5, 4, 4
"""Rounds of refinement about the best change so far, circles and phases on each side of it, and by how much they come closer in a round."""
TOGETHER = 4
"""Circles that are followed together."""
DRAWN, AROUND = 300, 96
"""Fresh changes up to the smallest that is lost, uniform over their disc, and phases all around at that size."""


def smallest_blade_loss(
    rotor: Rotor, model: BladeLoss, *, threads: int | None = None, tell: Reporter | None = None
) -> SmallestLoss:
    """Search for the smallest change of the unbalance up to that of the model that is lost at some phase.

    ``angle`` is its phase relative to the unbalance before.
    """
    search, said = _Search(rotor, model, threads), tell or Reporter.of(None, "")
    if search.harmless >= model.change:
        return search.result(model.change)
    try:
        return _searched(search, model, said)
    except BudgetSpentError:
        return search.unfinished()


def _searched(search: _Search, model: BladeLoss, said: Reporter) -> SmallestLoss:
    """The search to its end."""
    search.scan(said.part(0.0, 0.6))
    for number in range(MOST_CHECKS):
        said(0.6 + 0.4 * number / MOST_CHECKS, "looking for smaller losses that are not survived")
        search.refine()
        below = model.change if search.best is None else search.best.recovered
        if below <= search.harmless:
            break
        best = search.best
        fresh = search.draw(below, number)
        if search.best is best:
            return search.result(below, *fresh)
    return search.result(search.harmless or None)


class _Search(Bracket):
    """Changes tried so far, and the smallest that was lost.

    A change is told by the size ``a`` and the angle ``β`` of the place where it leads, seen from the centre of the circles; its own size is
    the distance from ``before``, and its phase the direction from there.
    """

    def __init__(self, rotor: Rotor, model: BladeLoss, threads: int | None) -> None:
        self.harmless, self.largest = harmless_blade_loss(rotor, model.node), model.change
        sizes = {"quantity": UNBALANCE, "harmless": self.harmless, "largest": self.largest}
        super().__init__(kind=model.kind, **sizes, tolerance=TOLERANCE, scales=rotor.scales)
        self.rotor, self.node, self.threads = rotor, model.node, threads
        self.random = np.random.default_rng(0)
        self.timed = rotor.depends_on_instant
        before = rotor.definition.unbalance_along(model.node)
        self.before, self.shared = before or 0.0, before is not None

    def follow(self, sizes: np.ndarray, angles: np.ndarray, instants: np.ndarray) -> np.ndarray:
        """Whether changes that lead to these places are lost, if they come at these instants; note the smallest."""
        places = sizes * np.exp(1j * angles)
        changes = np.abs(places - self.before)
        inside = (changes <= self.largest * (1.0 + 1e-12)) & (changes > self.harmless)
        if self.best is not None:
            inside &= changes < self.best.size
        gone = np.zeros(places.shape, bool)
        if not inside.any():
            return gone
        found = self._outcomes(sizes[inside], angles[inside], instants[inside])
        gone[inside] = lost(found)
        self.tried += len(found)
        if gone.any():
            place = int(np.where(gone, changes, np.inf).argmin())
            outcome = Outcome(int(found[np.flatnonzero(inside) == place][0]))
            phase = cmath.phase(complex(places[place] - self.before))
            self.best = Found(
                0.0, float(changes[place]), phase, outcome, float(instants[place]) if self.timed else None
            )
        return gone

    def _outcomes(self, sizes: np.ndarray, angles: np.ndarray, instants: np.ndarray) -> np.ndarray:
        if not self.shared:
            starts = starts_after(self.rotor, sizes, angles, self.node, instants)
            return follow(self.rotor, starts, threads=self.threads).outcomes
        levels, which = np.unique(sizes, return_inverse=True)
        machines = [self.rotor.with_changed_unbalance(level - self.before, self.node)[0] for level in levels.tolist()]
        starts = levitating_before(self.rotor, angles, instants)
        return follow(machines, starts, which=which, threads=self.threads).outcomes

    def lost_at(self, sizes: np.ndarray, angles: np.ndarray) -> np.ndarray:
        """Which changes of these sizes and phases, at the instant of the best one, are lost."""
        places = self.before + sizes * np.exp(1j * angles)
        instant = 0.0 if self.best is None else self.best.instant or 0.0
        return lost(self._outcomes(np.abs(places), np.angle(places), np.full(places.shape, instant)))

    def any_instants(self, count: int) -> np.ndarray:
        """Angles of the shaft, all around where it matters when a loss comes."""
        return TURN * self.random.random(count) if self.timed else np.zeros(count)

    def scan(self, tell: Reporter) -> None:
        """Try circles, those that come nearest to the unbalance before first, as long as they have changes smaller than the best."""
        many = self.shared and self.rotor.system.is_planar
        circles, phases = (CIRCLES, PHASES) if many else (OWN_CIRCLES, OWN_PHASES)
        self.spacing = self.largest / circles, TURN / phases
        steps = np.arange(1, circles + 1) * self.spacing[0]
        sizes = np.concatenate([self.before + steps, self.before - steps, [self.before]]) if self.before else steps
        sizes = sizes[sizes >= 0.0]
        sizes = sizes[np.abs(sizes - self.before).argsort(kind="stable")]
        angles = self.spacing[1] * np.arange(phases)
        for first in range(0, len(sizes), TOGETHER):
            some = sizes[first : first + TOGETHER]
            tell(first / len(sizes), "looking for the smallest loss that is not survived")
            if self.best is not None and np.abs(some - self.before).min() >= self.best.size:
                break
            self.follow(np.repeat(some, phases), np.tile(angles, len(some)), self.any_instants(phases * len(some)))
            if self.best is None:
                self.back = float(np.abs(some - self.before).max())

    def refine(self) -> None:
        """Try places ever closer to the best one, then halve the gap to changes of its phase that come back."""
        circle, turn = self.spacing
        for number in range(ROUNDS):
            if self.best is None:
                return
            circle, turn = circle / NARROWED, turn / NARROWED
            size, angle = cmath.polar(self._place(self.best.size, self.best.angle))
            sides = np.arange(-BESIDE * NARROWED, BESIDE * NARROWED + 1)
            sizes = np.abs(size + circle * np.arange(-BESIDE, BESIDE + 1))
            away = self.any_instants(len(sizes) * len(sides)) - self.any_instants(1)
            instants = (self.best.instant or 0.0) + away / NARROWED**number
            self.follow(np.repeat(sizes, len(sides)), np.tile(angle + turn * sides, len(sizes)), instants)
        if self.best is None:
            return
        low, at = self.harmless, np.array([self.best.instant or 0.0])
        while self.best.size - low > TOLERANCE * self.best.size:
            middle = 0.5 * (low + self.best.size)
            size, angle = cmath.polar(self._place(middle, self.best.angle))
            if not self.follow(np.array([size]), np.array([angle]), at).any():
                low = middle
        self.best = self.best._replace(recovered=low)

    def draw(self, below: float, seed: int) -> tuple[int, int]:
        """Try fresh changes up to a size, and at all phases at it; return how many were tried, and how many of them were drawn."""
        random = np.random.default_rng(seed)
        sizes = np.sqrt(self.harmless**2 + (below**2 - self.harmless**2) * random.random(DRAWN))
        sizes = np.append(sizes, np.full(AROUND, below))
        phases = TURN * np.append(random.random(DRAWN), (np.arange(AROUND) + random.random()) / AROUND)
        places = self.before + sizes * np.exp(1j * phases)
        self.follow(np.abs(places), np.angle(places), self.any_instants(len(places)))
        return DRAWN + AROUND, DRAWN

    def _place(self, size: float, phase: float) -> complex:
        return self.before + cmath.rect(size, phase)
