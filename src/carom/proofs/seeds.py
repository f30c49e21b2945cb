"""Seeds of proofs, in double precision: they decide what is looked at, and no claim rests on them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from flint import arb

from carom.bifurcations import find_bifurcations
from carom.core.planar import impact_jacobian
from carom.models import Jeffcott
from carom.motions import State, simulate
from carom.orbits import Section, impact_map, orbits_within_reach
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Machine, Parameters
from carom.parameters.exact import read_exact
from carom.proofs.balls import ball_of
from carom.proofs.courses import Course, Return
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.lines import Line

_SAMPLES = 400
STARTS, FOLLOWED = 24, 400.0
"""Simulated motions, and the time for which each is followed, in ``1/Ω``."""
FLIPPING, SIZES = -0.8, (0.02, 0.05, 0.1, 0.2, 0.4)
"""Multipliers below which the neighbourhood of an orbit is searched, and distances from it."""
NEAREST, MOST_SEEDS, FARTHEST = 4, 40, 0.5
"""Near returns that are taken of a motion and of all, and the largest distance of a return."""


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


def point_seeds(line: Line) -> list[tuple[str, str, list[float]]]:
    """Bifurcation points along a parameter: their kinds, the motions and guesses of the unknowns."""
    low, high = (float(end) for end in line.ends)
    found: list[tuple[str, str, list[float]]] = []
    if not low < high:
        # Doubles cannot tell the ends apart.
        return found
    for point in find_bifurcations(doubles_of(line.hypotheses), line.name, (low, high)).points:
        period, speed, value = point.period, point.radial_speed, point.value
        guess = {
            "fold": [period, value],
            "speed-fold": [period, value],
            "non-smooth-hopf": [period, value],
            "boundary-equilibrium": [value],
            "rub-fold": [value],
            "grazing": [_touch(line, period, speed, value), period, speed, value],
        }.get(point.kind, [period, speed, value])
        if point.kind in KNOWN and not point.name.startswith("R"):
            found.append((point.kind, str(point.name), [float(x) for x in guess]))
    return found


KNOWN = (
    "fold",
    "speed-fold",
    "period-doubling",
    "neimark-sacker",
    "slip-stop",
    "grazing",
    "non-smooth-hopf",
    "boundary-equilibrium",
    "rub-fold",
)
"""Kinds of points with an extended system."""


def _touch(line: Line, period: float, speed: float, value: float) -> float:
    """Time of the highest point between the impacts, away from both."""
    if not (np.isfinite(period) and np.isfinite(speed)):
        return 0.0
    course = Course(Return(line.at(arb(value)), arb(period)), arb(speed))
    heights = [float(course.height(arb(period * k / _SAMPLES))[0].mid()) for k in range(_SAMPLES + 1)]
    tops = [k for k in range(1, _SAMPLES) if heights[k - 1] <= heights[k] >= heights[k + 1]]
    return period * max(tops, key=lambda k: heights[k], default=_SAMPLES // 2) / _SAMPLES


def _flipped(rotor: Jeffcott, turned: float, count: int) -> Iterator[list[float]]:
    """Motions that start from an orbit with a multiplier near or below −1, in its direction."""
    for orbit in orbits_within_reach(rotor):
        multipliers, directions = np.linalg.eig(_jacobian(rotor, orbit.period, orbit.radial_speed))
        for multiplier, direction in zip(multipliers, directions.T, strict=True):
            if count % 2 or not orbit.admissible or multiplier.imag or multiplier.real > FLIPPING:
                continue
            for size in SIZES:
                place = orbit.section.angle, orbit.radial_speed, orbit.angular_speed
                guess = _followed(rotor, Section(*(np.array(place) + size * direction.real)), turned, count)
                if guess:
                    yield guess


def _jacobian(rotor: Jeffcott, period: float, speed: float) -> np.ndarray:
    at = rotor.parameters
    return impact_jacobian(at.gamma, at.omega, at.mu, at.d, period, speed)


def _followed(rotor: Jeffcott, section: Section, turned: float, count: int) -> list[float]:
    """Unknowns of a motion through some impacts; empty if it does not make so many."""
    guess: list[float] = []
    for _ in range(count):
        step = impact_map(rotor, section) if section.radial_speed > 0.0 else None
        if step is None or step.image is None:
            return []
        guess += [section.angle - turned, section.radial_speed, section.angular_speed, step.duration]
        section = step.image
    return guess


def shooting_seeds(hypotheses: Hypotheses, impacts: int) -> Iterator[list[float]]:
    """Near returns of simulated motions after 2 and up to ``impacts`` impacts, the nearest of each number first.

    Each is a list of ``θ − arg U*``, ``ṙ``, ``θ̇`` and the time of the flight that follows, for each impact.
    """
    rotor = Jeffcott(doubles_of(hypotheses))
    turned = float(np.angle(rotor.equilibrium)) if rotor.equilibrium else 0.0
    random = np.random.default_rng(0)
    logs = []
    for _ in range(STARTS):
        place = 0.95 * np.sqrt(random.uniform()) * np.exp(2j * np.pi * random.uniform())
        speed = random.normal(scale=0.7) + 1j * random.normal(scale=0.7)
        motion = simulate(rotor, State(complex(place), complex(speed)), FOLLOWED, stop_at_chatter=True, max_events=2000)
        met = motion.contacts
        logs.append(np.array([met.time, met.angle - turned, met.radial_speed, met.angular_speed]).T)
    for count in range(2, impacts + 1):
        yield from _flipped(rotor, turned, count)
        returns = []
        for log in logs:
            moved = log[count:] - log[:-count] if len(log) > count else np.empty((0, 4))
            gaps = np.hypot(2 * np.sin(0.5 * moved[:, 1]), np.hypot(moved[:, 2], moved[:, 3]))
            nearest = np.argsort(gaps)[:NEAREST]
            returns += [(gaps[k], log[k : k + count + 1]) for k in nearest if gaps[k] < FARTHEST]
        for _, piece in sorted(returns, key=lambda entry: entry[0])[:MOST_SEEDS]:
            durations = np.diff(piece[:, 0])
            yield [float(x) for row, time in zip(piece, durations, strict=False) for x in (*row[1:], time)]
