"""Seeds of proofs, in double precision: they decide what is looked at, and no claim rests on them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from decimal import Decimal
from typing import Any

import numpy as np
from flint import arb

from carom.bifurcations import find_bifurcations
from carom.models import jeffcott
from carom.orbits import Kind, find_orbits
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, TERMS, Machine, Parameters
from carom.parameters.quantities import read_exact
from carom.proofs.balls import ball_of
from carom.proofs.courses import OrbitCourse, Return
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.lines import Line, LineNumbers

_SAMPLES = 400


def doubles_of(hypotheses: Hypotheses) -> Parameters:
    """Parameters next to the hypotheses, with scales where these are known."""
    fields = MACHINE_FIELDS if hypotheses.table == "machine" else DIMENSIONLESS_FIELDS
    values: dict[str, Any] = {
        name: float(ball_of(read_exact(fields[name], text)).mid()) for name, text in hypotheses.values.items()
    }
    numbers = Machine(**values).parameters if hypotheses.table == "machine" else Parameters(**values)
    changes = {
        name: float(ball_of(read_exact(DIMENSIONLESS_FIELDS[name], text)).mid())
        for name, text in hypotheses.settings.items()
    }
    return numbers.replace(**changes)


def doubles_at(numbers: LineNumbers[arb], phase: float) -> Parameters:
    """Parameters next to numbers of the equations."""
    values: dict[str, Any] = {name: float(ball.mid()) for name, ball in vars(numbers).items()}
    return Parameters(omega=math.sqrt(values.pop("omega_squared")), phi=phase, **values)


def point_seeds(line: Line) -> list[tuple[str, str, dict[str, float]]]:
    """Bifurcation points along a parameter: their kinds, the motions and guesses of all that may be unknown."""
    low, high = (float(end) for end in line.ends)
    if not low < high:
        # Doubles cannot tell the ends apart.
        return []
    found, term = [], TERMS.get(line.name)
    name = line.name if term is None else term.sets
    ends = [end if term is None else float(line.table(arb(end))[name].mid()) for end in (low, high)]
    for point in find_bifurcations(doubles_of(line.hypotheses), name, (ends[0], ends[1])).points:
        at = {name: float(getattr(point, name)) for name in ("period", "radial_speed", "value")}
        if term is not None:
            needs = (Decimal(float(line.table(line.ball)[need].mid())) for need in term.needs)
            at["value"] = float(term.entry(Decimal(at["value"]), *needs))
        at["touch"] = _touch(line, **at) if point.kind == "grazing" else 0.0
        if not point.name.startswith("R"):
            found.append((point.kind, str(point.name), at))
    return found


def _touch(line: Line, period: float, radial_speed: float, value: float) -> float:
    """Time of the highest point between the impacts, away from both."""
    course = OrbitCourse(Return(line.at(arb(value)), arb(period)), arb(radial_speed))
    heights = [float(course.height(arb(period * k / _SAMPLES))[0].mid()) for k in range(_SAMPLES + 1)]
    tops = [k for k in range(1, _SAMPLES) if heights[k - 1] <= heights[k] >= heights[k + 1]]
    return period * max(tops, key=lambda k: heights[k], default=_SAMPLES // 2) / _SAMPLES


def shooting_seeds(hypotheses: Hypotheses, impacts: int) -> Iterator[list[float]]:
    """Orbits with 2 up to a number of impacts a period, in forward slip, that a search finds.

    Each is a list of ``θ − arg U*``, ``ṙ``, ``θ̇`` and the time of the flight that follows, for each impact.
    """
    rotor = jeffcott(doubles_of(hypotheses))
    turned = float(np.angle(rotor.equilibrium)) if rotor.equilibrium else 0.0
    for orbit in find_orbits(rotor, impacts=impacts):
        if orbit.impacts > 1 and set(orbit.word) == {Kind.IMPACT_FORWARD}:
            steps = zip(orbit.sections, orbit.durations.tolist(), strict=True)
            yield [x for at, time in steps for x in (at.angle - turned, at.radial_speed, at.angular_speed, time)]
