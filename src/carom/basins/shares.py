"""Shares of disturbances, with confidence intervals for samples.

"The share of kicks that come back" has one meaning everywhere: the share of the area of the disc of kick velocities, up to a
stated speed, seen in the fixed frame.  Samples are drawn uniformly over this area, and cells of grids weigh by it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from carom.attractors import AttractorSet, DisturbanceSet, exact_interval
from carom.base.arguments import Truths, Whole, checked
from carom.base.results import record
from carom.disturbances import Disturbance, Plan, Sample, VelocityKick
from carom.disturbances.plans import ANY_INSTANT, ITS_INSTANT, instants_words
from carom.parameters import Scales


@dataclass(frozen=True)
class Population:
    """What a share is a share of.

    Attributes
    ----------
    of : str
        Such as ``"kicks"``.
    up_to : float or None
        Largest size, in units of the equations; speeds are those of the fixed frame.  ``None`` where they have no size.
    up_to_si : float or None
        The same in SI units, where the machine is known.
    words : str
        Such as ``"kicks up to 166 mm/s"``.
    at : str
        At which instants, where these matter, such as ``"at any instant of the turn"``.
    """

    of: str = "starts"
    up_to: float | None = None
    up_to_si: float | None = None
    words: str = "starts"
    at: str = ""

    @classmethod
    @checked
    def of_model(cls, model: Disturbance, scales: Scales | None, at: str = "") -> Population:
        """All disturbances of a model, whose sizes are given for these scales, at the instants ``at``."""
        size, when = model.size, f" {at}" if at else ""
        if size is None:
            return cls(model.noun, words=model.noun + when, at=at)
        si = size.high * size.si(scales) if scales else None
        return cls(model.noun, size.high, si, f"{model.noun} up to {size.stated(size.high, scales)}{when}", at)


STARTS = Population()


@dataclass(frozen=True, repr=False)
class Share:
    """A share of disturbances, by default of those that come back to levitation.

    Attributes
    ----------
    fraction : float
        The share itself, 0 to 1: of a random sample the share of its starts, of a grid that of the weight of its cells.
    low, high : float
        For a random sample the interval of Clopper and Pearson (1934), which contains the true share with at least 95 %
        confidence; for a grid, both equal the share.
    count, total : int
        Numbers of starts.
    drawn : bool
        Whether the starts are a random sample.
    population : Population
        Of what it is a share.
    does : str
        What those that are counted do.
    """

    fraction: float
    low: float
    high: float
    count: int
    total: int
    drawn: bool
    population: Population = STARTS
    does: str = "come back"

    @classmethod
    @checked
    def of(
        cls, count: Whole, total: Whole, *, drawn: bool, population: Population = STARTS, does: str = "come back"
    ) -> Share:
        """Share ``count`` of ``total`` starts of equal weight."""
        share = count / total if total else math.nan
        low, high = exact_interval(count, total) if drawn and total else (share, share)
        return cls(share, low, high, count, total, drawn, population, does)

    @classmethod
    @checked
    def over(
        cls,
        plan: Plan,
        chosen: Truths,
        exists: Truths,
        scales: Scales | None,
        does: str = "come back",
        at: str = "",
    ) -> Share:
        """Share of the disturbances of a plan that are chosen, among those that exist; cells of a grid weigh by their area."""
        population = Population.of_model(plan.model, scales, at)
        count, total = int((chosen & exists).sum()), int(exists.sum())
        if isinstance(plan, Sample):
            return cls.of(count, total, drawn=True, population=population, does=does)
        weights = plan.weights().reshape(exists.shape)
        whole = float(weights[exists].sum())
        # All cells are all, whatever the rounding of the sums.
        share = 1.0 if count == total else float(weights[chosen & exists].sum()) / whole
        return cls(share, share, share, count, total, False, population, does)

    def __repr__(self) -> str:
        return f"<Share: {self.words}>"

    @property
    def words(self) -> str:
        """Sentence without a full stop: the share, its confidence interval, or that the starts are a grid."""
        if self.drawn:
            interval = f"{percent(self.low).removesuffix(' %')} to {percent(self.high)} with 95 % confidence"
            how = f"{self.count:,} of {self.total:,} drawn; {interval}"
        else:
            drawn = self.population.at == ANY_INSTANT
            error = f", {ITS_INSTANT}" if drawn else ": no sampling error"
            how = f"{self.count:,} of {self.total:,} cells of a grid, weighted by area, each represented by its centre{error}"
        return f"{percent(self.fraction)} of {self.population.words} {self.does} ({how})"

    def document(self) -> dict[str, object]:
        """The share as plain data for JSON."""
        of = self.population
        si = {} if of.up_to_si is None else {"up_to_si": of.up_to_si}
        when = {"at": of.at} if of.at else {}
        return record(of, "of up_to") | si | when | record(self, "estimate=fraction low high")


@checked
def share_of_kicks(found: AttractorSet) -> Share | None:
    """Share of the kicks that come back, of attractors found by kicks of all sizes and directions up to the largest.

    Starts elsewhere in the clearance do not count.  ``None`` if the rotor cannot levitate, or was not disturbed by such kicks.
    """
    sample, scales = found.sample, found.rotor.scales
    kicks = [ending for ending in found.disturbances if ending.start.kind == "kick"]
    if sample is None or not kicks:
        return None
    back = np.array([ending.recovered for ending in kicks])
    if isinstance(sample, DisturbanceSet):
        population = Population.of_model(VelocityKick(sample.fastest), scales, instants_words(found.rotor))
        return Share.of(int(back.sum()), len(kicks), drawn=True, population=population)
    exists = sample.starts(found.rotor).exists
    chosen = np.zeros(exists.shape, bool)
    chosen[exists] = back
    return Share.over(sample, chosen, exists, scales, at=instants_words(found.rotor, sample))


def percent(share: float) -> str:
    """Write a share in per cent, with three digits, or more where they would say 100 % of what is not all."""
    digits = 3
    while float(f"{100.0 * share:.{digits}g}") >= 100.0 > 100.0 * share:
        digits += 1
    return f"{100.0 * share:.{digits}g} %"
