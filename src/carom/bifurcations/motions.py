"""The simple motions of a machine: levitation, rub, single-impact orbits and rolling; without closed forms those on which disturbances end."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.attractors.naming import LEVITATION
from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS, Outcome
from carom.bifurcations.conditions import Solution, is_admissible, orbit_solutions, spectral_radii
from carom.bifurcations.diagrams import LONGEST_PERIOD
from carom.closed_forms.sag import BOUNDARY
from carom.closed_forms.thresholds import has_stable_rub
from carom.closed_forms.whirl import rolling
from carom.models import Rotor, Subject, exact_rotor_of, rotor_of
from carom.motions.simulation import simulate
from carom.orbits.flow import FlowBudget
from carom.orbits.names import OrbitName, combined, in_order
from carom.orbits.simulated_search import start_of

STARTS = 6
"""Motions that are followed where orbits have no closed forms, from the same random numbers everywhere."""
MOST_EVENTS, PATIENCE = 1500, 500


@dataclass(frozen=True)
class Motions:
    """The simple motions of a machine; two sets are equal if they agree in number and stability.

    Attributes
    ----------
    contact_free : bool
        Whether levitation is admissible and stable, which it is where damping is positive.
    orbits, stable_orbits : int
        Number of admissible single-impact orbits, and of the stable ones among them.
    rub : bool
        Whether a stable synchronous rub (forward whirl) is admissible.
    rolling : bool
        Whether a rotor that rolls on the bearing in backward whirl keeps rolling (:mod:`carom.closed_forms.whirl`).
    stable_names, unstable_names : tuple of OrbitName
        Names of the orbits.
    settled : tuple of str
        Of a machine without closed forms: whether it levitates, and the motions on which disturbances end, in words.
    """

    contact_free: bool
    orbits: int
    stable_orbits: int
    rub: bool
    rolling: bool
    stable_names: tuple[OrbitName, ...] = field(default=(), compare=False)
    unstable_names: tuple[OrbitName, ...] = field(default=(), compare=False)
    settled: tuple[str, ...] = ()

    @property
    def source_region(self) -> str:
        """Region of the source paper's figure 6b, which does not consider rub: R1 … R4; empty for machines without closed forms."""
        if self.settled:
            return ""
        if self.contact_free:
            return "R4" if self.orbits else "R3"
        return "R1" if self.orbits else "R2"

    @property
    def region(self) -> str:
        """Region of the source paper, refined by the stable rub and by whether any orbit is stable."""
        if self.settled:
            return self.words
        stable = "" if not self.orbits else " stable orbit" if self.stable_orbits else " unstable orbits"
        parts = [part for part in (stable.strip(), "rub" if self.rub else "no rub") if part]
        return f"{self.source_region} ({', '.join(parts)})"

    @property
    def parts(self) -> tuple[str, ...]:
        """The motions in words, one entry for each kind."""
        if self.settled:
            return self.settled
        orbits = [
            f"{combined(names)} {words}"
            for names, words in ((self.stable_names, "stable"), (self.unstable_names, "unstable"))
            if names
        ]
        return (
            f"{'' if self.contact_free else 'no stable '}{STEADY_WORDS['contact-free']}",
            f"stable {STEADY_WORDS['rub']}" if self.rub else "no stable rub",
            " and ".join(orbits) if orbits else "no impacting orbit",
            STEADY_WORDS["rolling"] if self.rolling else "no lasting rolling",
        )

    @property
    def words(self) -> str:
        """The motions in words."""
        return ", ".join(self.parts)


@checked
def motions_at(machine: Subject, budget: FlowBudget | None = None) -> Motions:
    """Count the simple motions of a machine.

    Only single-impact orbits with forward slip are counted.  Without damping, or with so little that there would be
    hundreds of pairs, only those with periods up to 60/Ω are counted.  Of machines whose orbits have no closed forms the motions are those
    on which a few disturbances end, paid from a ``budget``.
    """
    rotor = rotor_of(machine)
    if not rotor.has_closed_forms:
        return _settled_motions(rotor, budget or FlowBudget())
    orbits = [orbit for orbit in forward_orbits(rotor) if is_admissible(*orbit[1:])]
    radii = spectral_radii([orbit[1:] for orbit in orbits])
    return Motions(
        contact_free=bool(abs(rotor.equilibrium) < 1.0 - BOUNDARY) and rotor.parameters.gamma > 0.0,
        orbits=len(orbits),
        stable_orbits=sum(radius < 1.0 for radius in radii),
        rub=has_stable_rub(rotor.parameters),
        rolling=rolling(rotor).holds,
        stable_names=in_order(orbit.name for orbit, radius in zip(orbits, radii, strict=True) if radius < 1.0),
        unstable_names=in_order(orbit.name for orbit, radius in zip(orbits, radii, strict=True) if radius >= 1.0),
    )


def _settled_motions(rotor: Rotor, budget: FlowBudget) -> Motions:
    """Follow some disturbances of a machine until they settle."""
    random, found = np.random.default_rng(0), set()
    for _ in range(STARTS):
        motion = budget.pay(simulate(rotor, start_of(rotor, random), patience=PATIENCE, max_events=MOST_EVENTS))
        found.add((motion.outcome, motion.multiplicity))
    levitates = rotor.system.levitates
    settled = sorted(each for each in found if each[0] is not Outcome.LEVITATED)
    words = [f"{outcome.words} ({count} a period)" if count else outcome.words for outcome, count in settled]
    outcomes = {outcome for outcome, _ in found}
    periodic = sum(count > 0 for _, count in found)
    return Motions(
        contact_free=levitates,
        orbits=periodic,
        stable_orbits=periodic,
        rub=Outcome.FORWARD_RUB in outcomes,
        rolling=Outcome.ROLLING in outcomes,
        settled=(LEVITATION if levitates else f"no {LEVITATION}", *words),
    )


NOT_EXAMINED = Motions(
    contact_free=False, orbits=0, stable_orbits=0, rub=False, rolling=False, settled=("not examined",)
)


def forward_orbits(machine: Subject) -> list[Solution]:
    """All single-impact orbits with forward slip that :func:`motions_at` considers, including virtual ones."""
    rotor = exact_rotor_of(machine)
    return orbit_solutions(rotor, LONGEST_PERIOD if rotor.parameters.gamma < 0.05 else None)
