"""The smallest unbalance after the loss of a blade that a machine does not survive.

Each unbalance is another machine, so machines are tried one by one, each with many phases: a scan upwards from the present
unbalance to the first that is lost, bisection, and fresh unbalances and phases below it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from carom.basins.brackets import MOST_CHECKS, ROUND, TOLERANCE, Bracket, Found, SmallestLoss, lost
from carom.basins.families import UNBALANCE
from carom.closed_forms.harmless import harmless_blade_loss
from carom.disturbances import BladeLoss, Starts
from carom.disturbances.coordinates import TURN
from carom.disturbances.following import follow
from carom.models import Model
from carom.outcome import InputError, Outcome
from carom.progress import Reporter

PHASES, LEVELS = 360, 48
"""Phases tried at each unbalance, and unbalances of the scan."""
FIRST = 45
"""Every so many of the phases are followed first; the others follow only if none of these is lost."""
DRAWN = 300
"""Fresh unbalances below the smallest that is lost, each with a phase of its own."""


def smallest_blade_loss(
    rotor: Model, model: BladeLoss, *, threads: int | None = None, tell: Reporter | None = None
) -> SmallestLoss:
    """Search for the smallest unbalance, from the present one up to that of the model, that is lost at some phase.

    ``size`` is the eccentricity after the loss, ``angle`` its phase relative to the unbalance before.  A model whose
    unbalance is not larger than the present one is refused.
    """
    present, largest = rotor.value("rho"), model.eccentricity_after
    if present >= largest:
        allowed = f"more than the present one, {present:.6g}, in clearances: a search of what is survived begins there"
        raise InputError("eccentricity_after", f"{largest:.6g}", allowed)
    # Every change of the unbalance up to its harmless size is a step to at most this unbalance, at any phase.
    proven = harmless_blade_loss(rotor) - present
    search = _Search(rotor, model, max(proven, 0.0), threads)
    low = max(present, min(proven, largest))
    if proven >= largest:
        return search.result(largest, 0)
    levels = np.linspace(low, largest, LEVELS + 1)
    if proven < present and search.loses(low):
        return search.result(None, 0)
    back = low
    for place, level in enumerate(levels[1:].tolist()):
        if tell is not None:
            tell(0.7 * place / LEVELS, "looking for the smallest unbalance that is lost")
        if search.loses(level):
            back = search.bisect(back, level)
            break
        back = level
    for number in range(MOST_CHECKS):
        if tell is not None:
            tell(0.7 + 0.3 * number / MOST_CHECKS)
        if back <= proven:
            break
        found = search.draw(low, back, number)
        if found is None:
            return search.result(back, DRAWN + ROUND)
        back = search.bisect(low, found)
    return search.result(max(proven, 0.0) or None, 0)


class _Search(Bracket):
    """Unbalances tried so far, and the smallest that was lost."""

    def __init__(self, rotor: Model, model: BladeLoss, harmless: float, threads: int | None) -> None:
        sizes = {"quantity": UNBALANCE, "harmless": harmless, "largest": model.eccentricity_after}
        super().__init__(kind=model.kind, **sizes, tolerance=TOLERANCE, scales=rotor.scales)
        self.rotor, self.model, self.threads = rotor, model, threads

    def loses(self, after: float, phases: np.ndarray | None = None) -> bool:
        """Whether an unbalance is lost at some phase; note it if so."""
        tried = TURN * np.arange(PHASES) / PHASES if phases is None else phases
        at, later = replace(self.model, eccentricity_after=after), np.arange(len(tried)) % FIRST > 0
        for some in (tried[~later], tried[later]) if later.any() else (tried,):
            starts: Starts = at.starts(self.rotor, some)
            outcomes = follow(at.machine_after(self.rotor), starts, threads=self.threads).outcomes
            gone = np.flatnonzero(lost(outcomes) & starts.exists)
            self.tried += int(np.count_nonzero(starts.exists))
            if not len(gone):
                continue
            if self.best is None or after < self.best[1]:
                self.best = Found(0.0, after, float(some[gone[0]]), Outcome(int(outcomes[gone[0]])))
            return True
        return False

    def bisect(self, low: float, high: float) -> float:
        """Narrow a bracket whose upper end is lost; return its lower end."""
        while high - low > TOLERANCE * high:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.loses(middle) else (middle, high)
        if self.best is not None:
            self.best = self.best._replace(recovered=low)
        return low

    def draw(self, low: float, high: float, seed: int) -> float | None:
        """Try fresh unbalances in a range at fresh phases, and all phases at its upper end; return one that is lost."""
        random = np.random.default_rng(seed)
        if self.loses(high, TURN * (np.arange(ROUND) + random.random()) / ROUND):
            return high
        for after, phase in zip(random.uniform(low, high, DRAWN), TURN * random.random(DRAWN), strict=True):
            if self.loses(float(after), np.array([phase])):
                return float(after)
        return None
