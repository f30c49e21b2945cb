"""Shares of starts, with confidence intervals for samples."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Share:
    """A share of starts.

    Attributes
    ----------
    low, high : float
        For a random sample, Wilson's interval (1927) at 95 % confidence; for a grid, both equal the share.
    drawn : bool
        Whether the starts are a random sample.
    """

    count: int
    total: int
    low: float
    high: float
    drawn: bool

    @classmethod
    def of(cls, count: int, total: int, *, drawn: bool) -> Share:
        """Share ``count`` of ``total``."""
        share = count / total if total else math.nan
        low, high = wilson_interval(count, total) if drawn and total else (share, share)
        return cls(count, total, low, high, drawn)

    @property
    def fraction(self) -> float:
        """The share itself."""
        return self.count / self.total if self.total else math.nan

    @property
    def words(self) -> str:
        """Summary in words, with the confidence interval, or for a grid with a note that it has no sampling error."""
        share, count = f"{100.0 * self.fraction:.3g} %", f"{self.count} of {self.total}"
        if self.drawn:
            return f"{share} ({count}), {100.0 * self.low:.3g} to {100.0 * self.high:.3g} % with 95 % confidence"
        return f"{share} ({count} cells of a grid, each represented by its middle: no sampling error)"


def wilson_interval(count: int, total: int) -> tuple[float, float]:
    """Interval of 95 % of a probability from ``count`` successes in ``total`` trials (Wilson, J. Am. Stat. Assoc. 22, 1927).

    It contains the probabilities ``p`` with ``|count/total − p| ≤ z√(p(1 − p)/total)``.
    """
    z = NormalDist().inv_cdf(0.5 + CONFIDENCE / 2.0)
    share, weight = count / total, z * z / total
    middle = share + weight / 2.0
    half = z * math.sqrt(share * (1.0 - share) / total + weight / (4.0 * total))
    low = 0.0 if count == 0 else (middle - half) / (1.0 + weight)
    high = 1.0 if count == total else (middle + half) / (1.0 + weight)
    return low, high


def starts_enough(wanted: float) -> int | None:
    """Smallest sample which, if all its starts come back, shows that the share is at least the wanted one.

    For ``n`` of ``n`` Wilson's interval begins at ``n/(n + z²)``.  ``None`` for a share of one, which no sample can
    show.
    """
    if wanted >= 1.0:
        return None
    square = NormalDist().inv_cdf(0.5 + CONFIDENCE / 2.0) ** 2
    count = max(1, math.floor(square * wanted / (1.0 - wanted)))
    while wilson_interval(count, count)[0] < wanted:
        count += 1
    return count
