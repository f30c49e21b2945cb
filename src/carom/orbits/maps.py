"""The map from one impact to the next, its derivative, and the multipliers of any return map."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.base.arguments import Positive, checked
from carom.base.outcome import InputError, Outcome, Phase, shown
from carom.base.results import Result
from carom.core import variation
from carom.core.event_log import EventLog
from carom.core.settling import memory
from carom.models import Subject, rotor_of
from carom.models.subjects import refuse_forces
from carom.motions.simulation import follow, tools
from carom.motions.starts import LARGEST_SPEED, State
from carom.orbits.shooting import Links

Stability = Literal["stable", "neutral", "unstable"]
ROUNDING = 1e-12
"""Error of multipliers from closed forms and exact derivatives."""


@dataclass(frozen=True, eq=False, repr=False)
class Multipliers(Result):
    """Floquet multipliers of a periodic orbit on a section: the non-trivial ones.

    Attributes
    ----------
    values : ndarray of complex, shape (n,)
        Largest modulus first; of a conjugate pair the one with positive imaginary part first.
    error : float
        Of the largest modulus.
    """

    values: np.ndarray
    error: float = ROUNDING

    @property
    def spectral_radius(self) -> float:
        """Largest modulus."""
        return float(np.abs(self.values).max())

    @property
    def stability(self) -> Stability:
        """Stable where all multipliers lie inside the unit circle, unstable where one lies outside, neutral where the largest modulus is one within its error."""
        growth = self.spectral_radius - 1.0
        return "neutral" if abs(growth) <= self.error else "stable" if growth < 0.0 else "unstable"

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return self.stability == "stable"

    @property
    def instability(self) -> str:
        """How small disturbances grow, in words; ``""`` if they do not."""
        if self.stability != "unstable":
            return ""
        leader = self.values[0]
        if abs(leader.imag) > 1e-9 * abs(leader):
            return "in an oscillation from impact to impact"
        return "monotonically" if leader.real > 0 else "in alternation from impact to impact"


@checked
def multipliers(jacobian: np.ndarray) -> Multipliers:
    """Eigenvalues of the derivative of a return map.

    Parameters
    ----------
    jacobian : ndarray, shape (n, n)
    """
    if np.ndim(jacobian) != 2 or len(set(np.shape(jacobian))) != 1 or not np.size(jacobian):
        raise InputError("jacobian", np.shape(jacobian), "a square matrix")
    return multipliers_of_all([np.asarray(jacobian)])[0]


def multipliers_of_all(jacobians: Sequence[np.ndarray]) -> list[Multipliers]:
    """:func:`multipliers` of several return maps of the same size."""
    if not jacobians:
        return []
    # Conjugates are exact, so that their moduli are equal.
    found = np.linalg.eigvals(np.array(jacobians)).astype(complex).tolist()
    return [Multipliers(np.array(sorted(each, key=lambda value: (-abs(value), -value.imag)))) for each in found]


def multipliers_of(links: Links) -> Multipliers:
    """Non-trivial Floquet multipliers: those of the return map, in an orthonormal basis of the section at the first node."""
    monodromy = links.monodromy
    if not np.isfinite(monodromy).all():
        return multipliers(np.full((len(monodromy) - 1,) * 2, np.inf))
    # Its range is the section: the last passage ends there.
    basis = np.linalg.svd(links.passages[-1])[0][:, :-1]
    return multipliers(basis.T @ monodromy @ basis)


@checked
@dataclass(frozen=True)
class Section:
    """A state on the wall just before an impact, in the co-rotating frame.

    Attributes
    ----------
    angle : float
        ``θ`` in rad.
    radial_speed, angular_speed : float
        ``ṙ`` in ``c_r Ω`` and ``θ̇`` in ``Ω``.
    """

    angle: float
    radial_speed: float
    angular_speed: float

    @classmethod
    @checked
    def from_state(cls, position: complex, velocity: complex) -> Section:
        """Read a state on the wall in polar coordinates."""
        if position == 0.0:
            raise InputError("position", position, "a place on the wall")
        normal = position / abs(position)
        local = normal.conjugate() * velocity
        return cls(cmath.phase(position), local.real, local.imag / abs(position))

    @property
    def state(self) -> State:
        """The same state as ``U`` and ``U̇``."""
        position = cmath.rect(1.0, self.angle)
        return State(position, complex(self.radial_speed, self.angular_speed) * position)


@dataclass(frozen=True, eq=False, repr=False)
class ImpactMap(Result):
    """One application of the impact map ``P_I``: from just before an impact to just before the next.

    Attributes
    ----------
    outcome : Outcome
        ``CONTACT`` if there is a next impact.  Otherwise the reason; ``image`` and ``jacobian`` are then ``None``.
    image : Section or None
    duration : float
        Time of flight in ``1/Ω``.
    jacobian : ndarray or None, shape (3, 3)
        Derivative of the image ``(θ, ṙ, θ̇)`` with respect to the section, including the saltation term for the change
        of the time of impact.
    """

    outcome: Outcome
    image: Section | None
    duration: float
    jacobian: np.ndarray | None


@checked
def impact_map(machine: Subject, section: Section, longest_flight: Positive = 1000.0) -> ImpactMap:
    """Impact map ``P_I`` of the source paper (section 3a), with its derivative.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    section : Section
        State just before an impact; ``radial_speed`` above zero.
    longest_flight : float
        Time in ``1/Ω`` after which the rotor counts as not returning to the wall.

    Raises
    ------
    InputError
        The rotor does not move toward the wall, its wall is compliant, or it has several coordinates, of which the section is no state.
    """
    rotor = rotor_of(machine)
    refuse_forces(rotor)
    if rotor.system.arrays["stiffness"].any():
        raise InputError("machine", "a compliant wall", "rigid walls: contact with a compliant wall is not an impact")
    if len(rotor.system.rest) > 1:
        raise InputError("machine", shown(machine), "a rotor of one coordinate, whose state the section is")
    if not section.radial_speed > 0.0:
        raise InputError("radial speed", section.radial_speed, "above 0: the rotor must be about to reach the wall")
    if max(section.radial_speed, abs(section.angular_speed)) > LARGEST_SPEED:
        raise InputError("section", section, f"speeds up to {LARGEST_SPEED:g}")
    state = section.state
    amplitudes = rotor.system.amplitudes(state.position, state.velocity)
    log = EventLog.empty(2, len(amplitudes))
    bounces = memory(len(amplitudes), stop_at_landing=True)
    contact = np.array([Phase.FLIGHT])
    outcome, time, count = follow(tools(rotor), amplitudes, longest_flight, contact, log, bounces)
    if count < 2:
        return ImpactMap(Outcome.CLEAR if outcome is Outcome.TIME_REACHED else outcome, None, time, None)
    position, velocity = rotor.system.state(log.before[1])
    image = Section.from_state(complex(position), complex(velocity))
    jacobian = np.empty((3, 3))
    variation.section_jacobian(rotor.system.arrays, log.before[:2], np.array([time]), jacobian)
    return ImpactMap(Outcome.CONTACT, image, time, jacobian)
