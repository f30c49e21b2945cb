"""Levitation of any linear rotor, with weight or without: a circle about the static sag, once round it per turn of the shaft."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from carom.base.arguments import Reals, checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.models import Rotor, Subject, rotor_of
from carom.models.limits import saturates

Status = Literal["admissible", "boundary", "virtual"]
BOUNDARY = 1e-12
"""Distance from the wall (in clearances) or normal force (in ``m c_r Ω²``) that counts as zero."""


def status_of(margin: float) -> Status:
    """Status of a motion by its distance from the nearest wall that it must not reach, or a force that must push."""
    if abs(margin) <= BOUNDARY:
        return "boundary"
    return "admissible" if margin > 0 else "virtual"


@dataclass(frozen=True, eq=False, repr=False)
class Levitation(Result):
    """The steady motion without contact.

    In the fixed frame the coordinates are ``sag + whirl·e^{it}``, and ``+ opposite·e^{−it}`` where bearings are anisotropic: then each
    goes round an ellipse.

    Attributes
    ----------
    rotor : Model
    sag : complex, or ndarray of complex, shape (n,)
        Coordinates where weight, and the pull of a bearing off centre, hold the rotor without unbalance: ``K sag = M g`` with the
        matrices of the fixed frame, in which damping does not act on what stands still.
    whirl : complex, or ndarray of complex, shape (n,)
        Response to the unbalance, which turns with the shaft: the equilibrium without weight.
    opposite : complex, or ndarray of complex, shape (n,)
        Its part that turns against the shaft.
    sags, radii : ndarray, shape (P,)
        Distance of the middle of the circle from the centre, and its radius, at each contact plane in its clearance; of an ellipse the longer half axis.
    eigenvalues : ndarray of complex, shape (N,)
        Exponents of small disturbances, in the co-rotating frame, in ``Ω``.
    """

    shown: ClassVar[tuple[str, ...]] = ("rotor", "sag", "whirl", "reach", "inside", "stable")
    kind: ClassVar[Literal["contact-free"]] = "contact-free"
    planes: ClassVar[tuple[int, ...]] = ()
    normal_force: ClassVar[float] = 0.0

    rotor: Rotor
    sag: complex | np.ndarray
    whirl: complex | np.ndarray
    opposite: complex | np.ndarray
    sags: np.ndarray
    radii: np.ndarray
    eigenvalues: np.ndarray

    @property
    def reach(self) -> float:
        """Largest distance from the centre at any plane, in its clearance."""
        return float((self.sags + self.radii).max())

    @property
    def radius(self) -> float:
        """The same: what an amplitude in a clearance is measured by."""
        return self.reach

    @property
    def position(self) -> Any:
        """Coordinates at time zero."""
        return self.sag + self.whirl + self.opposite

    @property
    def status(self) -> Status:
        """Whether it lies inside all walls, touches one, or would lie outside, as of an equilibrium."""
        return status_of(1.0 - self.reach)

    @property
    def inside(self) -> bool:
        """Whether it stays inside all walls."""
        return self.reach < 1.0

    @property
    def stable(self) -> bool:
        """Whether small vibrations decay; not where the magnetic bearings would have to give more than their limits."""
        system = self.rotor.system
        kept = not saturates(system, np.zeros(system.modes), system.outer)
        return kept and bool(self.eigenvalues.real.max() < 0.0)

    @checked
    def path(self, times: Reals) -> np.ndarray:
        """Coordinates in the fixed frame at times in ``1/Ω``, of their shape; of several coordinates with a last axis of these."""
        turns = np.exp(1j * np.asarray(times))
        turned = np.multiply.outer(turns, self.whirl) + np.multiply.outer(turns.conj(), self.opposite)
        return self.sag + turned


@checked
def levitation(machine: Subject) -> Levitation:
    """Levitation of a rotor, whether or not it stays inside the wall.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model

    Raises
    ------
    InputError
        Nothing holds the rotor, or there is no steady motion: a force changes in the fixed frame.

    See Also
    --------
    carom.find_equilibria : without weight, levitation and synchronous rubs
    carom.find_attractors : on which motions disturbances end

    Examples
    --------
    >>> import carom as cm
    >>> held = cm.closed_forms.levitation(cm.load("examples/dropped-rotor.toml"))
    >>> print(f"{abs(held.sag):.4f} + {abs(held.whirl):.4f} = {held.reach:.4f}")
    0.3924 + 0.0088 = 0.4012
    """
    model = rotor_of(machine)
    system, arrays = model.system, model.system.arrays
    if system.is_externally_forced:
        system.refuse_non_stationary()
    if system.rest_radius == np.inf:
        raise InputError("levitation", "none, nothing holds the rotor", "a rotor that is held against its weight")

    def shown(coordinates: np.ndarray) -> Any:
        return complex(coordinates[0]) if len(coordinates) == 1 else coordinates

    return Levitation(
        model,
        shown(system.shapes @ system.outer),
        shown(system.whirl),
        shown(system.backward_whirl),
        np.abs(arrays["rows"] @ system.outer),
        np.abs(system.planes @ system.whirl if system.shaft else arrays["offsets"])
        + np.abs(system.planes @ system.backward_whirl),
        np.asarray(system.exponents),
    )
