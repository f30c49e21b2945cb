"""Find the least damping above which the disturbances tried come back."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from carom.attractors import DisturbanceSet
from carom.closed_forms.whirl import Rolling, rolling, rub_limit, runaway_speed
from carom.disturbances import FASTEST
from carom.models import Jeffcott, Subject, model_of
from carom.orbits.single_impact import orbits_within_reach
from carom.outcome import InputError, Outcome
from carom.parameters import DIMENSIONLESS_FIELDS, Parameters
from carom.studies.safety.limits import MOST_CHECKS, DampingLimit, SafeDamping, within_reach
from carom.studies.safety.losses import DampingCheck, Loss, Losses

__all__ = ["FRESH", "least_safe_damping"]

FRESH = 10_000
"""Fresh disturbances at each damping that is checked."""
SCANNED = 0.1
"""Part of them that is followed at each damping on the first way down."""
GRID = 32
"""Dampings looked at on the first way down, in geometric progression."""
BELOW = 5
"""Dampings of the grid below the first with a loss at which other ways to be lost are looked for."""
LOWEST = 0.02
HIGHEST = 8.0
"""Range of ``γ`` looked at, in units of the largest of 1, ``ω`` and (the upper end only) the machine's own ``γ``."""
SEARCHED = 1e-9
"""Relative width to which the end of the single-impact orbits is bisected."""
MARGIN, WIDEST = 0.01, 0.04
"""How far above the last loss the checks begin, relative to it; the first grows by half with each that fails, up to the second."""
NEARBY = (1.0, 1.01, 1.03, 1.06, 1.1, 1.15, 1.2, 1.3, 1.4, 1.5, 1.7, 2.0)
ONWARD = 1.25
"""Dampings that are checked, relative to the first of them; beyond the last the next ones by this factor up to the highest."""
FASTER, FASTER_SHARE = 2.0, 0.25
"""Speed of faster disturbances, relative to that of the others, and how many of them are tried, relative to ``count``."""

Progress = Callable[[float], None]


def least_safe_damping(
    machine: Subject,
    *,
    seed: int = 0,
    count: int = FRESH,
    fastest: float = FASTEST,
    highest: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> SafeDamping:
    """Find the least damping above which no contact motion is met by a standard set of disturbances.

    The synchronous rub (:func:`~carom.closed_forms.whirl.rub_limit`) and rolling (:func:`~carom.closed_forms.whirl.rolling`) have closed forms.
    Single-impact orbits are complete at each damping; their uppermost limit is bisected.  What else there may be (orbits
    with several impacts, irregular bouncing, motions with rub) and what is met at all is left to simulation: from the
    highest damping down, samples of disturbances are followed until some are lost; these, of every way to be lost, are
    varied at more and more damping until no variant is lost any more; then fresh disturbances are tried just above and
    at many dampings up to the highest, and where one is lost, the search goes on upward from there.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Of the planar rotor.
    seed : int
        Of all that is random.
    count, fastest : int, float
        Fresh disturbances at each damping that is checked, and their largest speed; see
        :class:`~carom.attractors.DisturbanceSet`.
    highest : float, optional
        Largest ``γ`` to look at.
    threads : int, optional
        By default as many as there are cores; the result does not depend on it.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    SafeDamping
        The same for the same arguments.

    Raises
    ------
    InputError
        ``highest`` is not above the lowest damping looked at, or ``count`` is below 1.
    """
    parameters = model_of(machine).parameters
    tell = progress or (lambda share: None)
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
    rub = DampingLimit("synchronous rub", end, end, "closed form") if end > 0.0 and parameters.d < 1.0 else None
    orbits = _end_of_orbits(parameters, grid)
    tell(0.2)
    sample = DisturbanceSet(count, seed, fastest)
    losses = Losses(parameters, sample, rub.above if rub else 0.0, threads)
    known = max((limit.above for limit in (rub, orbits) if limit), default=0.0)
    search = _Search(losses, grid, known, lambda share: tell(0.2 + 0.7 * share))
    simulated, checks = search.run()
    limit = within_reach(rub, orbits, simulated)
    faster = losses.faster(checks[0].gamma, max(1, int(FASTER_SHARE * count)), FASTER) if checks else None
    tell(1.0)
    return SafeDamping(
        parameters,
        rub,
        orbits,
        simulated,
        _rolling_limit(rolling(rotor)),
        runaway_speed(Jeffcott(parameters.replace(gamma=limit.gamma)) if limit else rotor),
        lowest,
        highest,
        sample,
        checks,
        faster,
    )


def _rolling_limit(roll: Rolling) -> DampingLimit | None:
    if roll.least_force <= 0.0 or roll.largest_damping <= 0.0:
        return None
    return DampingLimit("rolling", roll.largest_damping, roll.damping_bound, "closed form")


def _end_of_orbits(parameters: Parameters, grid: np.ndarray) -> DampingLimit | None:
    """Go down the grid to the first damping with an admissible single-impact orbit, and bisect above it."""
    clear, found, name = math.inf, 0.0, ""
    for gamma in grid.tolist():
        name = _orbit_at(parameters, gamma)
        if name:
            found = gamma
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
    return DampingLimit(name, found, clear, "search")


def _orbit_at(parameters: Parameters, gamma: float) -> str:
    """Name of an admissible single-impact orbit, a stable one if there is; empty if there is none."""
    real = [orbit for orbit in orbits_within_reach(Jeffcott(parameters.replace(gamma=gamma))) if orbit.admissible]
    return min(real, key=lambda orbit: not orbit.stable).name if real else ""


class _Search:
    """The largest damping at which a disturbance was lost, and the dampings above at which fresh ones were not."""

    def __init__(self, losses: Losses, grid: np.ndarray, known: float, progress: Progress) -> None:
        self.losses, self.grid, self.known, self.tell = losses, grid, known, progress
        self.highest, self.count = float(grid[0]), losses.sample.count

    def run(self) -> tuple[DampingLimit | None, tuple[DampingCheck, ...]]:
        """Return the limit, if any disturbance was lost, and the checks passed above it in growing order."""
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
        """Go down the grid to the first losses, and up again from every way to be lost there and a little below."""
        count = max(1, int(SCANNED * self.count))
        ways: dict[Outcome, Loss] = {}
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
        """Climb with each way to be lost of these."""
        climbed = [self.losses.climb(way, self.highest) for way in lost.ways.values()]
        return max(climbed, key=lambda loss: loss.gamma)

    def _ladder(self, base: float, margin: float, passed: list[DampingCheck]) -> Iterator[float]:
        """Dampings to check: from just above the last loss to the highest, without those next to one that has passed."""
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
