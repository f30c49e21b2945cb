"""The misprints of the source paper: the values of the printed formulas compared with the correct ones.

Each is evaluated on motions of the machine; the correct value comes from the general code of the package, which does
not use the printed formulas.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carom.closed_forms.periods import PeriodCondition
from carom.models import jeffcott
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import find_orbits, period_condition
from carom.parameters import Parameters
from carom.reproductions.mora2014.branches import FirstPair
from carom.reproductions.mora2014.plane import DampingStiffnessPlane
from carom.reproductions.mora2014.propositions import fixed_points
from carom.reproductions.mora2014.source import SCALES, machine_at, printed_texts

LONG = 200.0
"""Period, in ``1/Ω``, at which the leading term of ``F₁`` is accurate to four digits at ``γ = 0.1``."""
SMALL = 1e-6
"""Distance in damping from ``γ*`` at which the symbols of section 5 are evaluated."""


@dataclass(frozen=True)
class Misprint:
    """A formula or statement of the source paper that does not hold.

    Attributes
    ----------
    place : str
    printed, right : str
        Both forms, in words or formulas.
    quantity : str
        What is evaluated, and at which parameters or motion.
    printed_value : float or None
        Value of the printed form; ``None`` if it is not a number.
    value : float
        Correct value.
    """

    place: str
    printed: str
    right: str
    quantity: str
    printed_value: float | None
    value: float

    @property
    def difference(self) -> float | None:
        """Correct value minus printed value."""
        return None if self.printed_value is None else self.value - self.printed_value


class _Values(NamedTuple):
    """Values of a printed formula and of the right one, and what the words of the misprint need besides."""

    printed: float | None
    right: float
    found: Mapping[str, str] = {}


def misprints(pair: FirstPair, plane: DampingStiffnessPlane) -> tuple[Misprint, ...]:
    """List the misprints in the order of the text."""
    orbit = find_orbits(jeffcott(machine_at(0.1)))["B1,d"]
    values = {
        **_impact_law(orbit),
        **_closed_forms(orbit),
        **_second_form(orbit),
        "fixed_points": _Values(2.0, float(fixed_points(machine_at(0.1)).total)),
        "admissible": _Values(2.0, float(fixed_points(machine_at(0.06)).admissible)),
        "doubling": _stability(pair),
        **_local_theory(pair),
        **_letters_of_section_5(pair),
        "grazing": _grazing_regions(plane),
    }
    found = {name: text for each in values.values() for name, text in each.found.items()}
    return tuple(
        Misprint(printed_value=each.printed, value=each.right, **row)
        for row in printed_texts("misprints", found)
        for each in [values[row.pop("name")]]
    )


def _impact_law(orbit: Orbit) -> dict[str, _Values]:
    """Evaluate the misprints of section 2 on ``B1,d`` at ``γ = 0.1``."""
    log, parameters = orbit.trajectory(1.5).contacts, orbit.rotor.parameters
    speed = (1.0 + parameters.d) * orbit.radial_speed * SCALES.velocity
    return {
        "impulse": _Values(speed, SCALES.impulse * float(log.normal_impulse[0])),
        "slip": _Values(parameters.radius_ratio + orbit.angular_speed, float(log.slip_before[0])),
    }


def _closed_forms(orbit: Orbit) -> dict[str, _Values]:
    """Evaluate the misprints of section 4 on the same orbit."""
    parameters, period, before = orbit.rotor.parameters, orbit.period, orbit.section.state
    factor = (1.0 + parameters.d) * complex(1.0, parameters.mu)
    closing = float(period_condition(orbit.rotor, np.array([period]))[0])
    velocity = orbit.radial_speed + 1j * orbit.angular_speed * before.position
    return {
        "matrix": _Values(1.0 + (factor * printed_matrix(parameters, period)[1, 1]).real, closing),
        "velocity": _Values(abs(velocity), abs(before.velocity)),
    }


def _second_form(orbit: Orbit) -> dict[str, _Values]:
    """Evaluate the misprints of the second form of (4.6), and of the conclusions of the text from it."""
    parameters = orbit.rotor.parameters
    periods = np.linspace(20.0, 40.0, 4001)
    bounds = np.array([_printed_tail(parameters, period)[1] for period in periods])
    beyond = np.abs(period_condition(orbit.rotor, periods) - 1.0) * np.exp(0.5 * parameters.gamma * periods) / bounds
    short, long = period_condition(orbit.rotor, np.array([1.0, LONG])).tolist()
    tail = (long - 1.0) * math.exp(0.5 * parameters.gamma * LONG)
    return {
        "second_form": _Values(printed_second_form(parameters, 1.0), short),
        "tail": _Values(_printed_tail(parameters, LONG)[0], tail, {"long": f"{LONG:g}"}),
        "bound": _Values(1.0, float(beyond.max()), {"worst": f"{periods[beyond.argmax()]:.3g}"}),
    }


def printed_matrix(parameters: Parameters, period: float) -> np.ndarray:
    """Return ``(e^{−AT} − 1)⁻¹`` as printed after (4.1), shape (2, 2), with scalar ``e^{ΛT}`` for its ``e^{AT}``."""
    upper, lower = _exponents(parameters)
    corner = 1.0 - parameters.omega**2 - 1j * parameters.gamma
    v_upper, v_lower = -upper / corner, -lower / corner
    up, down = cmath.exp(upper * period), cmath.exp(lower * period)
    kappa = 1.0 / ((1.0 - down) * (1.0 - up) * (v_lower - v_upper))
    return kappa * np.array(
        [
            [v_lower * up - v_upper * down - up * down, v_upper * v_lower * (down - up)],
            [up - down, v_lower * down - v_upper * up - up * down],
        ]
    )


def _printed_tail(parameters: Parameters, period: float) -> tuple[float, float]:
    """Return ``F₁ − 1`` by (4.7) and the distance of the bounds (4.8) from 1, as printed, both times ``e^{γT/2}``.

    The extra factor ``T`` of the printed ``s₄``, with which its phase would grow with ``T²``, is left out.
    """
    leading, size = 0.0, 0.0
    s1 = math.sqrt(4.0 * parameters.omega**2 - parameters.gamma**2)
    for sign in (-1, 1):
        _, s3, s4, zeta = _letters(parameters, period, sign)
        leading += sign * s3 * math.cos(s4 + zeta)
        size += s3
    scale = (1.0 + parameters.d) / s1
    return scale * leading, scale * size


def _letters(parameters: Parameters, period: float, sign: int) -> tuple[float, float, float, float]:
    """Return ``s₂``, ``s₃``, ``s₄`` and ``ζ`` as printed below (4.6)."""
    gamma, omega, mu = parameters.gamma, parameters.omega, parameters.mu
    s1 = math.sqrt(4.0 * omega**2 - gamma**2)
    s2, s3 = 2.0 + sign * s1 + gamma * mu, math.sqrt((1.0 + mu**2) * (1.0 + omega**2 + sign * s1))
    s4, s5 = (2.0 * sign + s1) * period / 2.0, -sign * gamma + (2.0 * sign + s1) * mu
    return s2, s3, s4, 2.0 * math.atan(s5 / (s3 + s2))


def printed_second_form(parameters: Parameters, period: float) -> float:
    """Return the second form of (4.6) as printed."""
    gamma, omega = parameters.gamma, parameters.omega
    s1 = math.sqrt(4.0 * omega**2 - gamma**2)
    half = math.exp(gamma * period / 2.0)
    total = 0.0
    for sign in (-1, 1):
        s2, s3, s4, zeta = _letters(parameters, period, sign)
        top = s2 * half - 2.0 * s3 * half**2 * math.cos(s4 * period + zeta)
        total -= sign * top / (1.0 + half**2 - 2.0 * half * math.cos(s4 * period))
    return 1.0 + (1.0 + parameters.d) / (2.0 * s1 * half) * total


def _exponents(parameters: Parameters) -> tuple[complex, complex]:
    """Return ``λ±`` of (3.5)."""
    root = math.sqrt(4.0 * parameters.omega**2 - parameters.gamma**2)
    return complex(-parameters.gamma, -2.0 + root) / 2.0, complex(-parameters.gamma, -2.0 - root) / 2.0


def _stability(branches: FirstPair) -> _Values:
    doubling = branches.special("period-doubling", "d")
    # The multiplier that leaves the unit circle; a torus would be born from a complex pair.
    critical = max(doubling.orbit.multipliers.values, key=abs)
    return _Values(None, float(critical.real), {"doubling": f"{doubling.value:.7f}"})


def _local_theory(branches: FirstPair) -> dict[str, _Values]:
    """Evaluate the misprints of section 5 at the birth of ``B1,b``."""
    hopf = branches.hopf
    cycle = max(hopf.cycles, key=lambda entry: entry.period)
    outward = 1.0 - abs(jeffcott(machine_at(hopf.gamma + 1e-6)).equilibrium)
    condition = PeriodCondition.of(jeffcott(machine_at(hopf.gamma)).system)
    change = float((condition.factor * condition.a22(np.array([cycle.period]))[0]).real)
    return {
        "side": _Values(-1.0, math.copysign(1.0, outward)),
        "direction": _Values(0.5 * math.pi, _direction_of_kick(branches, cycle.period)),
        "condition": _Values(1.0 - change, 1.0 + change),
        "slope": _Values(-cycle.angular_slope, cycle.angular_slope),
    }


def _letters_of_section_5(branches: FirstPair) -> dict[str, _Values]:
    """Evaluate the symbols of section 5 that are printed in place of others, on the small ``B1,b``."""
    hopf = branches.hopf
    cycle = max(hopf.cycles, key=lambda entry: entry.period)
    rotor = jeffcott(machine_at(hopf.gamma))
    rest = rotor.equilibrium  # u₀ = e^{iΨ}, as σ = 1
    shift = (
        -1j * rest / complex(rotor.parameters.omega**2 - 1.0, hopf.gamma)
    )  # u₁ = c e^{iψ} of the equilibrium, with β₁ = i and Γ₁ = 0
    across = cycle.angle_slope * 1j * rest  # r₁,₀ e^{iθ₁,₀} with θ₁,₀ = Ψ + π/2
    condition = PeriodCondition.of(rotor.system)
    # From ṙ = −ε r₁,₀θ̇₁,₀ at the impact; the normal is e^{iΨ}.
    lever = complex((condition.factor * condition.a12(np.array([cycle.period])))[0]) * cycle.radial_slope * rest
    printed, right = abs(shift / abs(shift) + abs(shift) * across), abs(rest + SMALL * across)
    return {
        "place": _Values(printed, right, {"small": f"{SMALL:g}"}),
        "shift": _Values(abs(rest - lever), abs(shift - lever)),
    }


def _direction_of_kick(branches: FirstPair, period: float) -> float:
    """Return the angle from the normal at the boundary equilibrium to the kick of a small orbit, without friction."""
    rotor = jeffcott(machine_at(branches.hopf.gamma + 1e-7))
    orbits = find_orbits(rotor)
    small = min(orbits, key=lambda orbit: abs(orbit.period - period) + abs(orbit.radial_speed))
    normal = jeffcott(machine_at(branches.hopf.gamma)).equilibrium
    log = small.trajectory(1.5).contacts
    change = complex(log.radial_speed_after[0] - log.radial_speed[0], log.angular_speed_after[0] - log.angular_speed[0])
    jump = change * cmath.rect(1.0, log.angle[0])
    parameters = rotor.parameters
    scale = -(1.0 + parameters.d) * complex(1.0, parameters.mu) * small.radial_speed
    return cmath.phase(jump / (scale * normal))


def _grazing_regions(plane: DampingStiffnessPlane) -> _Values:
    gamma, omega = plane.meeting("grazing", "boundary-equilibrium").value
    left = [region for region in plane.regions if region.point[0] < gamma]
    above = next(region.source for region in left if region.point[1] > omega)
    below = next(region.source for region in left if region.point[1] <= omega)
    return _Values(None, omega, {"above": above, "below": below, "grazing": f"{gamma:.7f}"})
