"""The planar rigid rotor: parameters, and the system that follows from them."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from carom.arguments import checked
from carom.core.laws.rigid import Rigid
from carom.core.planar import planar_exponents
from carom.core.wall import Wall
from carom.models.from_modes import second_order_system
from carom.models.linear import LinearRotor
from carom.models.linear_parameters import refuse_node
from carom.models.model import Matrices, Model, Rates
from carom.models.system import System
from carom.models.touchdown import Touchdown
from carom.outcome import InputError, shown
from carom.parameters import Field, Numbers, Parameters, Scales


@dataclass(frozen=True)
class Jeffcott(Model):
    """Rigid rotor on a linear isotropic bearing inside a circular clearance (Föppl–Jeffcott rotor).

    In the co-rotating frame ``Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ}`` [1]_ (2.13), with the exponents
    ``λ± = (−γ − 2i ± √(γ² − 4ω²))/2``.

    Attributes
    ----------
    parameters : Parameters

    Raises
    ------
    InputError
        ``parameters`` is not an instance of :class:`~carom.parameters.Parameters`.

    References
    ----------
    .. [1] Mora, Budd, Glendinning, Keogh, "Non-smooth Hopf-type bifurcations arising from impact–friction contact
       events in rotating machinery", Proc. R. Soc. A 470 (2014).
    """

    parameters: Parameters

    def __post_init__(self) -> None:
        if not isinstance(self.parameters, Parameters):
            raise InputError("parameters", shown(self.parameters), "must be carom.parameters.Parameters")

    @cached_property
    def system(self) -> System:
        """Modes, contact plane and contact law."""
        parameters = self.parameters
        gamma, omega = parameters.gamma, parameters.omega
        return second_order_system(
            exponents=planar_exponents(gamma, omega),
            equilibrium=self.equilibrium,
            wall=Wall(parameters.mu, parameters.d, parameters.radius_ratio + 1.0),
        )

    @property
    def matrices(self) -> Matrices:
        """``z̈ + γż + ω²z = ρe^{iφ}e^{it}`` as matrices of one row."""
        at = self.parameters
        mass, damping, gyroscopic, stiffness = np.reshape((1.0 + 0j, at.gamma, 0.0, at.omega**2), (4, 1, 1))
        return Matrices(mass, damping, gyroscopic, stiffness, np.array([cmath.rect(at.rho, at.phi)]))

    @property
    def planar(self) -> Parameters:
        """Its parameters."""
        return self.parameters

    @property
    def has_closed_forms(self) -> bool:
        """All that are known."""
        return True

    def without_levitation(self) -> Model:
        """See :meth:`~carom.models.Model.without_levitation`."""
        at = self.parameters
        mass, _, gyroscopic, _, forcing = self.matrices
        return LinearRotor.in_fixed_frame(
            mass=mass,
            damping=np.zeros_like(mass),
            stiffness=np.zeros_like(mass),
            gyroscopic=gyroscopic,
            forcing=forcing,
            touchdowns=[Touchdown((1.0,), Rigid(at.d), at.mu, at.radius_ratio + 1.0)],
            translation=self.system.translated,
            scales=self.scales,
        )

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """See :meth:`~carom.models.Model.unbalance_push`."""
        refuse_node(node)
        return np.array([cmath.rect(1.0, self.unbalance_phase)])

    def unbalance_along(self, node: int | None = None) -> float | None:
        """See :meth:`~carom.models.Model.unbalance_along`."""
        return self.parameters.rho

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[Jeffcott, float]:
        """See :meth:`~carom.models.Model.with_changed_unbalance`."""
        refuse_node(node)
        after = self.parameters.rho + change
        return self.replace(rho=abs(after)), cmath.phase(after) if after else 0.0

    @property
    def words(self) -> str:
        """Its parameters in a line (:attr:`carom.parameters.Parameters.words`)."""
        return self.parameters.words

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed that convert results to SI units, if known."""
        return self.parameters.scales

    @property
    def unbalance_phase(self) -> float:
        """Angle of the unbalance in the co-rotating frame, in rad."""
        return self.parameters.phi

    @cached_property
    def equilibrium(self) -> complex:
        """Contact-free equilibrium position ``U*``; it may lie outside the clearance."""
        at = self.parameters
        # Adding zero turns a negative zero, the quotient for a balanced rotor, into zero.
        return cmath.rect(at.rho, at.phi) / complex(at.omega**2 - 1.0, at.gamma) + 0j

    @property
    def varied(self) -> Mapping[str, Field]:
        """Parameters that can be varied."""
        return self.parameters.varied

    @checked
    def value(self, name: str) -> float:
        """Value of a parameter (:meth:`carom.parameters.Parameters.value`)."""
        return self.parameters.value(name)

    def replace(self, **changes: Any) -> Jeffcott:
        """Return the rotor with other parameters (:meth:`carom.parameters.Parameters.replace`)."""
        return Jeffcott(self.parameters.replace(**changes))

    @checked
    def rates(self, name: str) -> Rates:
        """Return the derivatives of the equations of motion by a parameter."""
        at = self.parameters
        at.value(name)  # refuses an unknown name
        gamma, omega, rho, phi, mu, d, radius_ratio = Numbers.of(at).rates(name)
        return Rates(
            np.array([[complex(-2.0 * at.omega * omega, -gamma), -gamma]]),
            np.array([complex(rho, at.rho * phi) * cmath.exp(1j * at.phi)]),
            *np.array([[mu], [d], [radius_ratio]]),
        )

    def attributes(self) -> dict[str, str]:
        """Return the parameters and the scales as attributes of a dataset, exact to the last bit."""
        return self.parameters.attributes()
