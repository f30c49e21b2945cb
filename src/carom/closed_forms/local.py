"""Local theory of the non-smooth Hopf bifurcation: cycles that shrink into a boundary equilibrium.

Where the contact-free equilibrium reaches the wall, the motion near it is homogeneous: small impacting cycles have a
period ``T`` that does not depend on their size, and everything else grows linearly with the distance ``ε`` from the
bifurcation.  For the general complex system of the source paper (5.1),

    ü + αu̇ + βu = Γ,   |u| < σ,

the cycles follow from the exact conditions of :mod:`carom.orbits.single_impact` by expansion in ``ε``.  With ``K = Γ/β`` the
equilibrium, ``κ = Re(K'/K)`` the rate at which it leaves the wall, and ``q = (1 + d)(1 + iμ)``:

    F₁(T) = 1 + Re(q a₂₂(T)) = 0,     ṙ' = κσ/Re(q a₁₂),     θ̇' = −Im(q a₂₂) ṙ'/σ,
    θ₀' = Im(K'/K) − κ Im(q a₁₂)/Re(q a₁₂).

(The source paper prints the first with a minus sign, and the last display of its section 5 with the opposite sign of
``θ̇``; both contradict the exact branches.)
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.closed_forms.periods import PeriodCondition
from carom.core.flow import fly_all
from carom.core.friction import sliding_factor
from carom.core.wall import Wall
from carom.models import Subject, System, exact_rotor_of, second_order_system

ON_WALL = 1e-9
"""Distance from the wall, in clearances, at which the equilibrium counts as on it."""


@checked
@dataclass(frozen=True)
class ContactSystem:
    """``ü + αu̇ + βu = Γ`` inside ``|u| < σ`` with impacts of restitution ``d`` and friction ``μ``.

    Attributes
    ----------
    damping, stiffness, force : complex
        ``α``, ``β`` and ``Γ``.
    wall : float
        ``σ``.
    friction, restitution : float
        ``μ`` and ``d``.
    """

    damping: complex
    stiffness: complex
    force: complex
    wall: float = 1.0
    friction: float = 0.0
    restitution: float = 1.0

    @classmethod
    @checked
    def of_rotor(cls, machine: Subject) -> ContactSystem:
        """Return the planar rotor in the co-rotating frame, ``α = γ + 2i``, ``β = ω² − 1 + iγ``, ``Γ = ρe^{iφ}``."""
        parameters = exact_rotor_of(machine).parameters
        return cls(
            complex(parameters.gamma, 2.0),
            complex(parameters.omega**2 - 1.0, parameters.gamma),
            cmath.rect(parameters.rho, parameters.phi),
            1.0,
            parameters.mu,
            parameters.d,
        )

    @property
    def equilibrium(self) -> complex:
        """``K = Γ/β``."""
        return self.force / self.stiffness

    @cached_property
    def system(self) -> System:
        """The system in the form that the kernels take, in units of ``σ``."""
        return second_order_system(
            exponents=self.exponents,
            equilibrium=self.equilibrium / self.wall,
            wall=Wall(self.friction, self.restitution, np.inf),
        )

    @property
    def exponents(self) -> tuple[complex, complex]:
        """Roots of ``λ² + αλ + β``, the one with the smaller real part first.

        The root of smaller modulus is computed from the product of both, which avoids cancellation.
        """
        split = cmath.sqrt(self.damping**2 - 4.0 * self.stiffness)
        if (self.damping.conjugate() * split).real < 0.0:
            split = -split
        larger = -0.5 * (self.damping + split)
        smaller = self.stiffness / larger if larger else 0j
        return (larger, smaller) if larger.real <= smaller.real else (smaller, larger)


@dataclass(frozen=True)
class LocalCycle:
    """A family of small impacting cycles, to first order in ``ε``.

    Attributes
    ----------
    period : float
        ``T``, the same for all sizes.
    radial_slope, angular_slope, angle_slope : float
        ``dṙ/dε``, ``dθ̇/dε`` and ``dθ₀/dε`` of the state just before the impact.
    criticality : {"subcritical", "supercritical"}
        Subcritical: the cycles exist on the side where the contact-free equilibrium is admissible.
    """

    period: float
    radial_slope: float
    angular_slope: float
    angle_slope: float
    criticality: Literal["subcritical", "supercritical"]


@dataclass(frozen=True)
class NonSmoothHopf:
    """A non-smooth Hopf point.

    Attributes
    ----------
    system : ContactSystem
        The system at the bifurcation.
    leaving : float
        ``κ``: the equilibrium's distance from the centre grows by ``κσε``, so it is admissible for ``κε < 0``.
    cycles : tuple of LocalCycle
        One for each root of ``F₁``; an even number (none or several pairs).
    """

    system: ContactSystem
    leaving: float
    cycles: tuple[LocalCycle, ...]


@checked
def non_smooth_hopf(system: ContactSystem, equilibrium_rate: complex) -> NonSmoothHopf:
    """Cycles that emerge where an equilibrium reaches the wall.

    Parameters
    ----------
    system : ContactSystem
        The system at the bifurcation: ``|K| = σ`` to within 1e-9.
    equilibrium_rate : complex
        ``dK/dε = (Γ₁ − β₁K)/β``.

    Raises
    ------
    InputError
        The equilibrium is not on the wall, or the free motion is not damped.
    """
    distance = abs(system.equilibrium) / system.wall - 1.0
    if abs(distance) > ON_WALL:
        raise InputError("equilibrium", system.equilibrium, f"on the wall |u| = {system.wall:g}")
    rate = equilibrium_rate / system.equilibrium
    condition = PeriodCondition.of(system.system)
    periods = condition.roots().periods
    levers = condition.factor * condition.a12(periods)
    turns = condition.factor * condition.a22(periods)
    cycles = []
    for period, lever, turn in zip(periods, levers, turns, strict=True):
        slope = rate.real * system.wall / lever.real
        cycles.append(
            LocalCycle(
                period=float(period),
                radial_slope=float(slope),
                angular_slope=float(-turn.imag * slope / system.wall),
                angle_slope=float(rate.imag - rate.real * lever.imag / lever.real),
                criticality="subcritical" if lever.real < 0.0 else "supercritical",
            )
        )
    return NonSmoothHopf(system, float(rate.real), tuple(cycles))


@checked
def cycle_determinant(system: System, period: float, direction: complex = 1.0) -> float:
    """``det(reset · e^{MT} − 1)`` of the linearised contact at a boundary equilibrium, for any number of modes.

    With the reset ``1 − b rᵀ`` (``r`` reads the speed along the wall's normal, ``b`` is the change of the amplitudes for
    a unit of it) the determinant lemma gives ``det(e^{MT} − 1) F₁(T)``: its zeros are the periods of the cycles.
    The result is the determinant of the real map over ``(Re c, Im c)``, shape (4n, 4n).

    Parameters
    ----------
    direction : complex
        Unit normal of the wall at the equilibrium.  The determinant does not depend on it.
    """
    arrays = system.arrays
    free = np.eye(system.modes)[system.free]
    units = np.concatenate([free, 1j * free])
    ends = fly_all(arrays, units, np.full(len(units), float(period)))
    factor = sliding_factor(float(arrays.friction[0]), float(arrays.restitution[0]))
    columns = []
    for unit, end in zip(units, ends, strict=True):
        speed = (np.conj(direction) * (arrays.rate_rows[0] @ end)).real
        image = (end - arrays.columns[:, 0] * factor * direction * speed - unit)[system.free]
        columns.append(np.concatenate([image.real, image.imag]))
    return float(np.linalg.det(np.array(columns).T))
