"""Motions that never return to levitation, by the speed in the fixed frame of their slowest state that is known: rubs, whirl, orbits with one impact a period."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from flint import arb

from carom.proofs.evidence import Evidence
from carom.proofs.periods import all_periods
from carom.proofs.rotor import ProvenRotor
from carom.proofs.single_impact import candidates, orbit_claims
from carom.proofs.steady import steady_claims
from carom.proofs.whirl import attracting_speed, whirl_claims

MOST_CELLS = 2000
"""Cells of the periods after which the search for orbits ends."""


class Lost(NamedTuple):
    """A motion that does not return.

    Attributes
    ----------
    words : str
        What it is.
    speed : arb
        Of one of its states, or of states that lead to it, in ``c_r Ω``; for whirl, the speed above which all do.
    """

    words: str
    speed: arb


def steadily_lost(rotor: ProvenRotor) -> Iterator[Lost]:
    """Synchronous rubs and whirl in lasting contact that are proven."""
    n = rotor.numbers
    proven = {claim.name for claim in (*steady_claims(rotor), *whirl_claims(rotor)) if claim.status == "proven"}
    for name in ("rub 1", "rub 2"):
        if f"{name} pressed" in proven:
            yield Lost(f"the synchronous {name} is a motion", arb(1))
    if "whirl attracts sliding" in proven:
        # What is claimed there holds above the upper end, so that the speed itself is not reached.
        speed = attracting_speed(n).upper()
        yield Lost("backward whirl on the wall that is faster than this runs away to rolling", speed)
    elif "whirl rolls" in proven:
        yield Lost("the rotor can roll on the wall for ever", n.radius_ratio)


def lost_on_orbits(rotor: ProvenRotor, evidence: Evidence) -> Iterator[Lost]:
    """Orbits with one impact a period that are proven, each by the slower of its states before and after the impact."""
    n = rotor.numbers
    for _, found in candidates(rotor, all_periods(rotor, evidence, None, MOST_CELLS)):
        for name, course in (found or {}).items():
            if orbit_claims(rotor, name, course)[1] != "proven":
                continue
            radial, along = course.speed, 1 + course.angular_speed
            after = along - n.mu * (1 + n.d) * radial
            speeds = ((radial * radial + along * along).sqrt(), (n.d * n.d * radial * radial + after * after).sqrt())
            yield Lost(f"the orbit {name} is a motion", min(speeds, key=lambda speed: float(speed.upper())))
