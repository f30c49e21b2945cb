"""Find the least damping above which the disturbances tried come back."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from carom.attractors import DisturbanceSet, MotionName
from carom.attractors.names import SYNCHRONOUS_RUB
from carom.closed_forms.thresholds import rub_limit
from carom.closed_forms.whirl import rolling
from carom.disturbances import FASTEST
from carom.models import Jeffcott, Subject, jeffcott_of
from carom.orbits.names import OrbitName
from carom.orbits.single_impact import orbits_within_reach
from carom.outcome import InputError, Outcome
from carom.parameters import DIMENSIONLESS_FIELDS, Parameters
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.studies.safety.limits import MOST_CHECKS, DampingLimit, SafeDamping
from carom.studies.safety.losses import DampingCheck, Loss, Losses

FRESH = 10_000
"""Number of fresh disturbances at each damping that is checked."""
SCANNED = 0.1
"""Fraction of them that is followed at each damping of the first downward search."""
GRID = 32
"""Number of dampings of the first downward search, in geometric progression."""
BELOW = 5
"""Number of grid points below the first loss at which other lost motions are searched."""
LOWEST = 0.02
HIGHEST = 8.0
"""Range of ``γ`` searched, in units of the largest of 1, ``ω`` and (for the upper end only) the machine's own ``γ``."""
SEARCHED = 1e-9
"""Relative width at which the bisection for the end of the single-impact orbits stops."""
MARGIN, WIDEST = 0.01, 0.04
"""Relative distance of the first check above the last loss: at first, and at most; it grows by half with each failure."""
NEARBY = (1.0, 1.01, 1.03, 1.06, 1.1, 1.15, 1.2, 1.3, 1.4, 1.5, 1.7, 2.0)
ONWARD = 1.25
"""Dampings checked, relative to the first; beyond the list, each is ``ONWARD`` times the previous one."""
FASTER, FASTER_SHARE = 2.0, 0.25
"""Speed of the faster disturbances relative to that of the others, and their number relative to ``count``."""


@shows_progress
def least_safe_damping(
    machine: Subject,
    *,
    seed: int = 0,
    count: int = FRESH,
    fastest: float = FASTEST,
    highest: float | None = None,
    threads: int | None = None,
    progress: ShowProgress = None,
) -> SafeDamping:
    """Find the least damping above which no disturbance of a standard set ends in a contact motion.

    The synchronous rub (:func:`~carom.closed_forms.thresholds.rub_limit`) and rolling
    (:func:`~carom.closed_forms.whirl.rolling`) have closed forms.  The list of single-impact orbits is complete at each
    damping; their upper limit is found by bisection.  Other motions (orbits with several impacts, irregular bouncing,
    motions with rub), and which motions disturbances reach, are found by simulation.  From the highest damping
    downward, samples of disturbances are followed until some are lost.  For each outcome, the lost starts are varied at
    higher and higher damping until no variant is lost; where the end of their motions is known, just above it at once.  Then fresh disturbances are tried just above and at many
    dampings up to the highest.  If one of them is lost, the search continues upward from there.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Planar rotor.
    seed : int
        Seed of all random numbers.
    count, fastest : int, float
        Number of fresh disturbances at each damping that is checked, and their largest speed; see
        :class:`~carom.attractors.DisturbanceSet`.
    highest : float, optional
        Largest ``γ`` to search.
    threads : int, optional
        By default one for each core; the result does not depend on it.

    Raises
    ------
    InputError
        ``highest`` is not above the lowest damping searched, or ``count`` is below 1.
    """
    parameters = jeffcott_of(machine).parameters
    tell = Reporter.of(progress, "disturbances at other dampings")
    unit = max(1.0, parameters.omega)
    lowest = LOWEST * unit
    if highest is None:
        highest = min(HIGHEST * max(unit, parameters.gamma), DIMENSIONLESS_FIELDS["gamma"].highest)
    if not (math.isfinite(highest) and highest > lowest):
        raise InputError("highest", highest, f"a finite damping above {lowest:g}")
    if count < 1:
        raise InputError("count", count, "a whole number of at least 1")
    grid = np.geomspace(highest, lowest, GRID)
    rotor = Jeffcott(parameters)
    end = rub_limit(rotor)
    rub = DampingLimit(SYNCHRONOUS_RUB, end, end, "closed form") if end > 0.0 and parameters.d < 1.0 else None
    orbits, rolls = _end_of_orbits(parameters, grid), rolling(rotor)
    whirl = DampingLimit(MotionName(Outcome.ROLLING), rolls.largest_damping, rolls.damping_bound, "closed form")
    tell(0.2)
    sample = DisturbanceSet(count, seed, fastest)
    losses = Losses(parameters, sample, rub.above if rub else 0.0, orbits.above if orbits else 0.0, threads)
    known = max((limit.above for limit in (rub, orbits) if limit), default=0.0)
    search = _Search(losses, grid, known, tell.part(0.2, 0.9))
    simulated, checks = search.run()
    faster = losses.faster(checks[0].gamma, max(1, int(FASTER_SHARE * count)), FASTER) if checks else None
    tell(1.0)
    return SafeDamping(
        parameters,
        rub,
        orbits,
        simulated,
        whirl if whirl.gamma > 0.0 else None,
        lowest,
        highest,
        sample,
        checks,
        faster,
    )


def _end_of_orbits(parameters: Parameters, grid: np.ndarray) -> DampingLimit | None:
    """Search the grid downward for the first damping with an admissible single-impact orbit, and bisect above it."""
    clear = math.inf
    for gamma in grid.tolist():
        found, name = gamma, _orbit_at(parameters, gamma)
        if name:
            break
        clear = gamma
    else:
        return None
    while math.isfinite(clear) and clear - found > SEARCHED * found:
        middle = math.sqrt(found * clear)
        if not found < middle < clear:
            break
        again = _orbit_at(parameters, middle)
        if again:
            found, name = middle, again
        else:
            clear = middle
    return DampingLimit(MotionName(Outcome.BOUNCING, 1, orbit=name), found, clear, "search")


def _orbit_at(parameters: Parameters, gamma: float) -> OrbitName | None:
    """Return the name of an admissible single-impact orbit, a stable one if possible."""
    real = [orbit for orbit in orbits_within_reach(Jeffcott(parameters.replace(gamma=gamma))) if orbit.admissible]
    return min(real, key=lambda orbit: not orbit.stable).name if real else None


class _Search:
    """Search for the largest damping at which a disturbance is lost, with checks by fresh disturbances above it."""

    def __init__(self, losses: Losses, grid: np.ndarray, known: float, tell: Reporter) -> None:
        self.losses, self.grid, self.known, self.tell = losses, grid, known, tell
        self.highest, self.count = float(grid[0]), losses.sample.count

    def run(self) -> tuple[DampingLimit | None, tuple[DampingCheck, ...]]:
        """Return the limit, if any disturbance was lost, and the checks passed above it in ascending order."""
        last = self._first_loss()
        self.tell(0.3)
        checks: list[DampingCheck] = []
        tried, margin = 0, MARGIN
        while True:
            base = max(last.gamma if last else 0.0, self.known)
            checks = [check for check in checks if check.gamma > base]
            lost = None
            for gamma in self._ladder(base, margin, checks):
                if tried == MOST_CHECKS:
                    return self._limit(last, math.inf), ()
                tried += 1
                result = self.losses.fresh(gamma, self.count)
                if isinstance(result, Loss):
                    lost = result
                    break
                checks.append(result)
                self.tell(0.3 + 0.7 * tried / MOST_CHECKS)
            if lost is None:
                checks.sort(key=lambda check: check.gamma)
                return self._limit(last, checks[0].gamma if checks else math.inf), tuple(checks)
            last, margin = self._climbed(lost), min(1.5 * margin, WIDEST)

    def _limit(self, last: Loss | None, above: float) -> DampingLimit | None:
        return DampingLimit(last.motion, last.gamma, above, "simulation") if last else None

    def _first_loss(self) -> Loss | None:
        """Search the grid downward for the first losses, then upward from each outcome found there or just below."""
        count = max(1, int(SCANNED * self.count))
        ways: dict[tuple[Outcome, bool], Loss] = {}
        left = BELOW
        for gamma in self.grid.tolist():
            found = self.losses.fresh(gamma, count)
            if isinstance(found, Loss):
                ways = found.ways | ways
            left -= bool(ways)
            if left < 0:
                break
        climbed = [self._climbed(way) for way in ways.values()]
        return max(climbed, key=lambda loss: loss.gamma, default=None)

    def _climbed(self, lost: Loss) -> Loss:
        """Search upward from each outcome of these lost starts; return the highest loss."""
        climbed = [self.losses.climb(way, self.highest) for way in lost.ways.values()]
        return max(climbed, key=lambda loss: loss.gamma)

    def _ladder(self, base: float, margin: float, passed: list[DampingCheck]) -> Iterator[float]:
        """Yield the dampings to check, from just above the last loss to the highest, except near a passed check."""
        lowest = float(self.grid[-1])
        first = max(base * (1.0 + margin), lowest)
        if base >= self.highest:
            return
        rungs = [first * ratio for ratio in NEARBY]
        while rungs[-1] * ONWARD < self.highest:
            rungs.append(rungs[-1] * ONWARD)
        for gamma in [*(rung for rung in rungs if rung < self.highest), self.highest]:
            if gamma < first * 1.0001 or not any(abs(check.gamma / gamma - 1.0) < margin for check in passed):
                yield gamma
