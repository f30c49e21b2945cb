"""The misprints of the source paper: the values of the printed formulas compared with the correct ones.

Each is evaluated on motions of the machine; the correct value comes from the general code of the package, which does
not use the printed formulas.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from carom.closed_forms.local import ContactSystem
from carom.closed_forms.periods import PeriodCondition
from carom.models import Jeffcott
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import find_orbits, period_condition
from carom.parameters import Parameters
from carom.reproductions.mora2014.branches import FirstPair
from carom.reproductions.mora2014.plane import DampingStiffnessPlane
from carom.reproductions.mora2014.propositions import fixed_points
from carom.reproductions.mora2014.source import SCALES, machine_at

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


def misprints(pair: FirstPair, plane: DampingStiffnessPlane) -> tuple[Misprint, ...]:
    """List the misprints in the order of the text."""
    orbit = find_orbits(Jeffcott(machine_at(0.1)))["B1,d"]
    return (
        *_impact_law(orbit),
        *_closed_forms(orbit),
        *_propositions(),
        *_stability(pair),
        *_local_theory(pair),
        _grazing_regions(plane),
    )


def _impact_law(orbit: Orbit) -> Iterator[Misprint]:
    """List the misprints of section 2, evaluated on ``B1,d`` at ``γ = 0.1``."""
    motion = orbit.trajectory(1.5)
    parameters = orbit.rotor.parameters
    impulse = SCALES.impulse * float(motion.contacts.normal_impulse[0])
    yield Misprint(
        "(2.5)",
        "(1 + d)ṙ⁻, without the mass: a speed",
        "m(1 + d)ṙ⁻",
        "normal impulse of B1,d at γ = 0.1 (right: N s; printed: m/s)",
        (1.0 + parameters.d) * orbit.radial_speed * SCALES.velocity,
        impulse,
    )
    yield Misprint(
        "(2.3), section 4",
        "slip R/c_r + θ̇ with θ̇ of the co-rotating frame",
        "R/c_r + 1 + θ̇",
        "slip velocity of B1,d at γ = 0.1, in c_r Ω",
        parameters.radius_ratio + orbit.angular_speed,
        float(motion.contacts.slip_before[0]),
    )


def _closed_forms(orbit: Orbit) -> Iterator[Misprint]:
    """List the misprints of section 4, evaluated on the same orbit."""
    parameters, period = orbit.rotor.parameters, orbit.period
    factor = (1.0 + parameters.d) * complex(1.0, parameters.mu)
    yield Misprint(
        "matrix after (4.1)",
        "− e^{AT} in the diagonal (a matrix; evaluated as − e^{ΛT})",
        "− (v₋ − v₊) e^{ΛT}",
        "1 + Re(q a₂₂), zero at the period of B1,d at γ = 0.1",
        1.0 + (factor * printed_matrix(parameters, period)[1, 1]).real,
        float(period_condition(orbit.rotor, np.array([period]))[0]),
    )
    before = orbit.section.state
    yield Misprint(
        "(4.2)",
        "velocity before the impact ṙ + iθ̇U₀",
        "(ṙ + iθ̇)U₀",
        "its modulus for B1,d at γ = 0.1, in c_r Ω",
        abs(orbit.radial_speed + 1j * orbit.angular_speed * before.position),
        abs(before.velocity),
    )
    yield from _second_form(orbit)


def _second_form(orbit: Orbit) -> Iterator[Misprint]:
    """List the misprints of the second form of (4.6), and of the conclusions of the text from it."""
    parameters = orbit.rotor.parameters
    yield Misprint(
        "(4.6), second form",
        "cos(s₄T + ζ), ζ = 2 arctan(s₅/(s₃ + s₂)), s₄ with a factor T",
        "cos(s₄T − ζ), ζ = 2 arctan(s₅/(2s₃ + s₂)), s₄ without it",
        "F₁(T) at T = 1, γ = 0.1",
        printed_second_form(parameters, 1.0),
        float(period_condition(orbit.rotor, np.array([1.0]))[0]),
    )
    leading, _ = _printed_tail(parameters, LONG)
    yield Misprint(
        "(4.7)",
        "the ζ of (4.6)",
        "cos(s₄T − ζ) with the right ζ, as there",
        f"(F₁(T) − 1)e^{{γT/2}} at T = {LONG:g}, γ = 0.1",
        leading,
        float(period_condition(orbit.rotor, np.array([LONG]))[0] - 1.0) * math.exp(0.5 * parameters.gamma * LONG),
    )
    periods = np.linspace(20.0, 40.0, 4001)
    bounds = np.array([_printed_tail(parameters, period)[1] for period in periods])
    beyond = np.abs(period_condition(orbit.rotor, periods) - 1.0) * np.exp(0.5 * parameters.gamma * periods) / bounds
    yield Misprint(
        "(4.8)",
        "|F₁ − 1| < (1 + d)e^{−γT/2}(s₃⁻ + s₃⁺)/s₁",
        "that over 1 − e^{−γT/2}: as printed only in the limit of long periods",
        f"largest |F₁ − 1| over the printed bound for T in 20…40, γ = 0.1 (at T = {periods[beyond.argmax()]:.3g})",
        1.0,
        float(beyond.max()),
    )


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


def _propositions() -> Iterator[Misprint]:
    yield Misprint(
        "Proposition 4.1",
        "up to 2N fixed points for N pairs of periods",
        "up to 4N",
        "fixed points at γ = 0.1, where N = 1",
        2.0,
        float(fixed_points(machine_at(0.1)).total),
    )
    yield Misprint(
        "Proposition 4.1",
        "B_n,c and B_n,d are admissible for γ < γ*",
        "they meet the wall from inside, but need not stay inside between impacts",
        "admissible ones for N = 1 at γ = 0.06",
        2.0,
        float(fixed_points(machine_at(0.06)).admissible),
    )


def _stability(branches: FirstPair) -> Iterator[Misprint]:
    doubling = branches.special("period-doubling", "d")
    # The multiplier that leaves the unit circle; a torus would be born from a complex pair.
    critical = max(doubling.orbit.multipliers.values, key=abs)
    yield Misprint(
        "section 4a",
        "B1,d is quasi-periodically stable above γ = 0.083",
        "a real multiplier passes −1: period doubling",
        f"that multiplier at γ = {doubling.value:.7f}",
        None,
        float(critical.real),
    )


def _local_theory(branches: FirstPair) -> Iterator[Misprint]:
    """List the misprints of section 5, evaluated at the birth of ``B1,b``."""
    hopf = branches.hopf
    cycle = max(hopf.cycles, key=lambda entry: entry.period)
    rotor = Jeffcott(machine_at(hopf.gamma))
    outward = 1.0 - abs(Jeffcott(machine_at(hopf.gamma + 1e-6)).equilibrium)
    yield Misprint(
        "section 5, choice of ε",
        "with γ = γ* + ε the equilibrium is inside if ε is negative",
        "if ε is positive, as the printed −2εγ* < 0 says",
        "sign of ε for which it is inside",
        -1.0,
        math.copysign(1.0, outward),
    )
    yield from _letters_of_section_5(branches)
    turn = _direction_of_kick(branches, cycle.period)
    yield Misprint(
        "section 5, reset at order ε",
        "the velocity jumps along e^{iθ₁,₀}, that is e^{iΨ} turned by π/2",
        "along e^{iΨ}: a factor −i is missing",
        "angle from e^{iΨ} to the jump over −(1 + d)(1 + iμ)ṙ of B1,b at γ* + 1e-7, in rad",
        0.5 * math.pi,
        turn,
    )
    condition = PeriodCondition.of(rotor.system)
    change = float((condition.factor * condition.a22(np.array([cycle.period]))[0]).real)
    yield Misprint(
        "(5.4)",
        "F₁ = 1 − (1 + d)Re((1 + iμ)a₂₂)",
        "1 + (1 + d)Re((1 + iμ)a₂₂)",
        "F₁ at the period of the small B1,b, which must be zero",
        1.0 - change,
        1.0 + change,
    )
    yield Misprint(
        "section 5, last display",
        "θ̇ = ε ṙ₁,₀₋",
        "θ̇ = −ε ṙ₁,₀₋",
        "dθ̇/dγ of B1,b at γ*",
        -cycle.angular_slope,
        cycle.angular_slope,
    )


def _letters_of_section_5(branches: FirstPair) -> Iterator[Misprint]:
    """List the symbols of section 5 that are printed in place of others, evaluated on the small ``B1,b``."""
    hopf = branches.hopf
    cycle = max(hopf.cycles, key=lambda entry: entry.period)
    system = ContactSystem.of_rotor(machine_at(hopf.gamma))
    rest = system.equilibrium  # u₀ = e^{iΨ}, as σ = 1
    shift = -1j * rest / system.stiffness  # u₁ = c e^{iψ} of the equilibrium, with β₁ = i and Γ₁ = 0
    across = cycle.angle_slope * 1j * rest  # r₁,₀ e^{iθ₁,₀} with θ₁,₀ = Ψ + π/2
    yield Misprint(
        "section 5, place of the impact",
        "|σe^{iψ} + c r₁,₀e^{iθ₁,₀}|, with c and ψ those of the shifted equilibrium",
        "|σe^{iΨ} + ε r₁,₀e^{iθ₁,₀}|",
        f"its value for B1,b at γ* + {SMALL:g}, which must be σ = 1",
        abs(shift / abs(shift) + abs(shift) * across),
        abs(rest + SMALL * across),
    )
    condition = PeriodCondition.of(system.system)
    # From ṙ = −ε r₁,₀θ̇₁,₀ at the impact; the normal is e^{iΨ}.
    lever = complex((condition.factor * condition.a12(np.array([cycle.period])))[0]) * cycle.radial_slope * rest
    yield Misprint(
        "section 5, solution for w₁,₀₋",
        "−A₀⁻¹b, and z₀ in b₁",
        "−A₀⁻¹b₁ with b₁ = (0, Γ₁ − β₁u₀)",
        "modulus of its position for B1,b, which must be |r₁,₀|",
        abs(rest - lever),
        abs(shift - lever),
    )


def _direction_of_kick(branches: FirstPair, period: float) -> float:
    """Return the angle from the normal at the boundary equilibrium to the kick of a small orbit, without friction."""
    rotor = Jeffcott(machine_at(branches.hopf.gamma + 1e-7))
    orbits = find_orbits(rotor)
    small = min(orbits, key=lambda orbit: abs(orbit.period - period) + abs(orbit.radial_speed))
    normal = Jeffcott(machine_at(branches.hopf.gamma)).equilibrium
    log = small.trajectory(1.5).contacts
    change = complex(log.radial_speed_after[0] - log.radial_speed[0], log.angular_speed_after[0] - log.angular_speed[0])
    jump = change * cmath.rect(1.0, log.angle[0])
    parameters = rotor.parameters
    scale = -(1.0 + parameters.d) * complex(1.0, parameters.mu) * small.radial_speed
    return cmath.phase(jump / (scale * normal))


def _grazing_regions(plane: DampingStiffnessPlane) -> Misprint:
    gamma, omega = plane.meeting("grazing", "boundary-equilibrium").value
    sides = [
        next(
            region.source for region in plane.regions if region.point[0] < gamma and (region.point[1] > omega) == above
        )
        for above in (True, False)
    ]
    return Misprint(
        "section 4b",
        "B1,d grazes in regions R1 and R2",
        f"in {sides[0]} and {sides[1]}: there is no orbit in R2",
        f"ω at which the grazing curve passes from one to the other, γ = {gamma:.7f}",
        None,
        omega,
    )
