"""What a proof along a parameter shows of a diagram or of a plane, for figures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import pi

import numpy as np

from carom.bifurcations import Diagram, RegionMap
from carom.models import Rotor, exact_rotor_of
from carom.outcome import InputError
from carom.proofs.claims import Claim, Proof
from carom.proofs.hypotheses import NUMBERS, Hypotheses
from carom.proofs.lines import line_of
from carom.proofs.ranges import PERIOD

_ROUNDING = 1e-12
"""Relative difference of numbers of the same machine, once exact and once in doubles."""
_NEAR = 1e-6
"""Difference of a period in doubles from its enclosure."""


@dataclass(frozen=True)
class ProvenStretch:
    """Interval on which all orbits with one impact a period are proven.

    Attributes
    ----------
    low, high : float
    periods : mapping of str to tuple of float
        Interval that holds the period of each orbit, by its name.
    motions : tuple of str
        Orbits that are motions of the machine.
    """

    low: float
    high: float
    periods: Mapping[str, tuple[float, float]]
    motions: tuple[str, ...]


@dataclass(frozen=True)
class ProvenLine:
    """What is proven along a parameter.

    Attributes
    ----------
    parameter : str
    stretches : tuple of ProvenStretch
    points : tuple of float
        Values at which a bifurcation point is proven.
    slip : bool
        Whether orbits whose impacts stop the slip are excluded too.
    """

    parameter: str
    stretches: tuple[ProvenStretch, ...]
    points: tuple[float, ...]
    slip: bool


def proven_of_diagram(proof: Proof, diagram: Diagram) -> ProvenLine:
    """What a proof shows of a diagram.

    A proof along another parameter or of another machine is refused, and a diagram with other orbits than those proven.
    """
    found = _proven(proof, (diagram.parameter,), lambda value: diagram.axis.move(diagram.model, value))
    for stretch in found.stretches:
        _compare(diagram, stretch)
    return found


def proven_of_plane(proof: Proof, regions: RegionMap) -> ProvenLine:
    """What a proof shows of the line through the machine of a plane, along one of its two parameters.

    A proof along another parameter or of another machine is refused.
    """
    names = tuple(axis.name for axis in regions.axes)
    present = {name: regions.model.value(name) for name in names}
    return _proven(proof, names, lambda value: regions.model.replace(**{**present, proof.options["along"]: value}))


def _proven(proof: Proof, allowed: tuple[str, ...], model_at: Callable[[float], Rotor]) -> ProvenLine:
    along = proof.options.get("along")
    if along not in allowed:
        raise InputError(
            "proof", f"along {along}" if along else "of one machine", f"a proof along {' or '.join(allowed)}"
        )
    line = line_of(proof.hypotheses, along, proof.options["from"], proof.options["to"])
    for end in line.ends:
        check_machine(proof.hypotheses.replace(**{along: end}), model_at(float(end)))
    points = [claim for claim in proof if claim.status == "proven" and "value" in claim.enclosures]
    return ProvenLine(
        along,
        tuple(_stretch(claim) for claim in proof if claim.kind == "orbits" and claim.status == "proven"),
        tuple(sorted({claim.enclosures["value"].value for claim in points})),
        proof["machine slip"].status == "proven",
    )


def check_machine(hypotheses: Hypotheses, model: Rotor) -> None:
    """Compare the numbers of the equations with those of a proof; :class:`~carom.outcome.InputError` if they are others."""
    parameters = exact_rotor_of(model).parameters
    for name in NUMBERS:
        number = hypotheses.numbers[name]
        scale = pi**number.turns
        low, high = float(number.low) * scale, float(number.high) * scale
        value = parameters.omega**2 if name == "omega_squared" else float(getattr(parameters, name))
        slack = _ROUNDING * abs(value)
        if not low - slack <= value <= high + slack:
            words = f"of another machine: its {name} is {low:.12g}"
            raise InputError("proof", words, f"a proof of this machine, with {name} = {value:.12g}")


def _stretch(claim: Claim) -> ProvenStretch:
    """Stretch that a claim of :mod:`carom.proofs.ranges` states."""
    low, high = (float(Fraction(end)) for end in claim.interval)
    periods = {
        name.removesuffix(PERIOD): (float(entry.low), float(entry.high))
        for name, entry in claim.enclosures.items()
        if name.endswith(PERIOD)
    }
    return ProvenStretch(low, high, periods, claim.motions)


def _compare(diagram: Diagram, stretch: ProvenStretch) -> None:
    """Refuse a diagram with an orbit on a stretch that is not proven there, or without a motion that is."""
    low, high = max(stretch.low, diagram.interval[0]), min(stretch.high, diagram.interval[1])
    if not low < high:
        return
    where = f"for {diagram.parameter} from {low:.9g} to {high:.9g}"
    there = set()
    middle = 0.5 * (low + high)
    for branch in diagram.orbits:
        values, names = branch.values, branch.names
        forward = np.array([orbit.numbers.mu >= 0.0 for orbit in branch.closed])
        for i in np.flatnonzero((low < values) & (values < high) & forward).tolist():
            shortest, longest = stretch.periods.get(names[i], (np.inf, -np.inf))
            if not shortest - _NEAR < branch.period[i] < longest + _NEAR:
                raise InputError(
                    "proof", where, f"the diagram has an orbit {names[i]} there that is proven not to exist"
                )
        for i in np.flatnonzero((values[:-1] - middle) * (values[1:] - middle) <= 0.0).tolist():
            there |= {names[i], names[i + 1]}
    missing = [name for name in stretch.motions if name not in there]
    if missing:
        raise InputError("proof", where, f"the diagram lacks orbits that are proven there: {', '.join(missing)}")
