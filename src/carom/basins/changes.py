"""The least change of two parameters that brings back a wanted share of disturbances."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np

from carom.arguments import Count, checked
from carom.basins.gains import GainMap, measured
from carom.basins.shares import Share
from carom.disturbances import Plan
from carom.outcome import InputError
from carom.parameters import Case, in_terms_of
from carom.parameters.in_terms import EXACT
from carom.progress import Reporter, ShowProgress, shows_progress

HALVINGS = 8
STEPS = 5
"""Parts of the way, from the one found by bisection to the node, whose share is checked by another sample until one is enough."""
CANDIDATES = 8
"""Number of nodes of the map towards which the least change is searched."""
WANTED = 0.99
"""Usual share of the disturbances that must come back."""


@dataclass(frozen=True)
class GainChange:
    """The least relative change of two parameters found to bring back a wanted share.

    Attributes
    ----------
    values : tuple of float
        New values, in the units of the map.
    changes : tuple of float
        Changes relative to the present values.
    share : Share
        Share that comes back with the new values: of a sample drawn after the bisection, the first of a few along the
        rest of the way whose interval suffices.
    """

    values: tuple[float, float]
    changes: tuple[float, float]
    share: Share
    wanted: float

    @property
    def size(self) -> float:
        """Root of the sum of the squared relative changes."""
        return math.hypot(*self.changes)

    def told(self, found: GainMap, told_by: Case | None) -> tuple[float, ...]:
        """Relative changes of what a machine's file states both parameters by; without one, of the parameters themselves.

        They differ where an entry is not proportional to its parameter, as a P gain beside a negative stiffness is not.
        """
        if told_by is None:
            return self.changes
        return tuple(
            in_terms_of(told_by, varied.name, new, digits=EXACT).value
            / in_terms_of(told_by, varied.name, now, digits=EXACT).value
            - 1.0
            for varied, now, new in zip(found.axes, found.present, self.values, strict=True)
        )


@checked
@shows_progress
def least_gain_change(
    found: GainMap, wanted: float = WANTED, *, threads: Count | None = None, progress: ShowProgress = None
) -> GainChange | None:
    """Least relative change of the two parameters that brings back a wanted share of the disturbances.

    The search starts from the few nodes of the map that reach the share and are nearest (Euclidean distance of relative
    changes).  On the straight line from the present machine to each of them the change is found by bisection.  In other
    directions there may be a smaller one.  For a sample, the lower end of the confidence interval has to reach the wanted
    share, in the search and again for a sample drawn after it: where this fails, longer parts of the way are tried.  Return
    ``None`` if no node of the map reaches the share so, and a change of zero if the present machine does.

    Parameters
    ----------
    wanted : float
        Share, 0 to 1.

    Raises
    ------
    InputError
        A share out of range, or a parameter that is zero now.

    See Also
    --------
    carom.map_gains : the map in which it searches

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> kicks = cm.disturbances.VelocityKick.of(machine, "100 mm/s")
    >>> gains = cm.map_gains(machine, cm.Grid(kicks, (4, 6)), shape=(3, 3))
    >>> change = cm.basins.least_gain_change(gains, wanted=0.3)
    >>> print(change if change is None else change.share.count)
    13
    """
    if not 0.0 < wanted <= 1.0:
        raise InputError("wanted", wanted, "a share above 0 and at most 1")
    present = found.present
    if not all(present):
        raise InputError("wanted", wanted, "needs parameters other than 0 now, as changes are relative")
    if found.present_share.low >= wanted:
        return GainChange(present, (0.0, 0.0), found.present_share, wanted)
    x, y = (found.dataset[varied.name].values / now - 1.0 for varied, now in zip(found.axes, present, strict=True))
    size = np.hypot(x[:, None], y[None, :])
    good = found.dataset["recovered_low"].values >= wanted
    if not good.any():
        return None
    nearest = np.argsort(np.where(good, size, np.inf), axis=None, kind="stable")[: min(CANDIDATES, int(good.sum()))]
    found_changes, tell = [], Reporter.of(progress, "looking for the least change")
    samples = (found.plan.fresh(number) for number in count(size.size))  # the nodes of the map have the ones before
    for done, place in enumerate(zip(*np.unravel_index(nearest, size.shape), strict=True)):
        goal = float(x[place[0]]), float(y[place[1]])
        part, share = _least_part(found, goal, wanted, samples, threads)
        if part is not None:
            found_changes.append(GainChange(*_moved(present, goal, part), share, wanted))
        tell((done + 1) / len(nearest))
    return min(found_changes, key=lambda change: change.size, default=None)


def _moved(
    present: tuple[float, float], goal: tuple[float, float], part: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Values, and relative changes, a part of the way to a goal."""
    changes = part * goal[0], part * goal[1]
    return (present[0] * (1.0 + changes[0]), present[1] * (1.0 + changes[1])), changes


def _least_part(
    found: GainMap, goal: tuple[float, float], wanted: float, samples: Iterator[Plan], threads: int | None
) -> tuple[float | None, Share]:
    """Smallest sufficient part of the way to a goal, by bisection, and the share there of a sample drawn afterwards.

    ``None`` if no part of the way is sufficient for such a sample.
    """

    def share(part: float) -> Share:
        node, _ = _moved(found.present, goal, part)
        limits = {**found.limits, "threads": threads}
        (entry,) = measured(found.rotor, found.axes, [(next(samples), node)], limits)
        tried: Share = entry["share"]
        return tried

    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if share(middle).low >= wanted else (middle, high)
    for part in np.linspace(high, 1.0, STEPS).tolist():
        tried = share(part)
        if tried.low >= wanted:
            return part, tried
    return None, tried
