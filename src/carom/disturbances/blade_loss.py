"""Loss of a blade: the unbalance of the levitating rotor becomes another one, in size and phase."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of
from carom.disturbances.model import Disturbance
from carom.outcome import InputError
from carom.parameters import own_size

if TYPE_CHECKING:
    from carom.models import Model, Subject
    from carom.motions.starts import State


@dataclass(frozen=True)
class BladeLoss(Disturbance):
    """The unbalance jumps from that of the machine to another one, for example because a blade is lost.

    Before the loss the rotor whirls without contact with the unbalance of the machine; where it then is, is the start of
    the motion of the machine with the unbalance after the loss (:meth:`machine_after`).  The phase of that unbalance
    relative to the one before is free.  A loss of unbalance ``δ`` leads from ``ρ`` to some unbalance of at most ``ρ + δ``.

    Attributes
    ----------
    eccentricity_after : float
        Eccentricity after the loss, in clearances: the unbalance divided by the mass of the rotor.  The unbalance of a
        rotor of several coordinates keeps its distribution.

    See Also
    --------
    carom.disturbances.UnbalanceStep : steps to the unbalance of the machine, from others

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml", ["eccentricity=0.1 mm"])
    >>> loss = cm.disturbances.BladeLoss.of(machine, "0.2 mm")
    >>> cm.map_basins(machine, cm.Grid(loss, (36,))).share_recovered.count
    18
    """

    eccentricity_after: float
    kind: ClassVar[str] = "blade-loss"
    noun: ClassVar[str] = "phases of the unbalance after the loss"
    measured_in: ClassVar[dict[str, str]] = {"eccentricity_after": "length"}

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Phase of the unbalance after the loss."""
        return (angle_coordinate("phase_after", "phase of the unbalance after the loss, relative to that before it"),)

    def machine_after(self, rotor: Model) -> Model:
        """Return the machine with the unbalance after the loss."""
        return rotor.replace(rho=self.eccentricity_after)

    def starts(self, rotor: Model, *values: np.ndarray) -> Starts:
        """Levitation of the machine before the loss, in the frame in which the phase of the unbalance after it stays the same.

        Weight has its direction at time zero, when the loss happens.
        """
        (phase,) = values
        rest, levitates = rotor.system.rest, rotor.system.rest_radius < 1.0
        none = np.zeros(np.shape(phase), bool)
        cosine, sine = np.cos(phase), np.sin(phase)
        if len(rest) > 1:
            cosine, sine = cosine[..., None], sine[..., None]
        nowhere = np.zeros(np.broadcast_shapes(cosine.shape, rest.shape if len(rest) > 1 else ()), complex)
        states = _levitation(rotor, cosine, sine) if levitates else (nowhere, nowhere)
        return Starts(*states, none | levitates, none, none)

    def release(self, machine: Subject, phase: float = 0.0) -> tuple[Model, State]:
        """Return the machine after the loss and the state in which it starts, for :func:`carom.simulate`.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
            Before the loss.
        phase : float
            Phase of the unbalance after the loss relative to the one before, rad.

        Raises
        ------
        InputError
            The rotor cannot levitate inside the wall before the loss.
        """
        from carom.models import model_of
        from carom.motions.starts import State

        rotor = model_of(machine)
        starts = self.starts(rotor, np.array(own_size("phase", phase, "angle", None)))
        if not starts.exists:
            radius = f"|U*| = {rotor.system.rest_radius:.6g}"
            raise InputError("disturbance", radius, "needs levitation inside the wall before the loss")
        return self.machine_after(rotor), State.of(starts.positions, starts.velocities)

    def lost(self, rotor: Model, phase: float) -> float:
        """Unbalance lost if the unbalance after it has this phase: ``|ρ'e^{iβ} − ρ|``, in ``m c_r``."""
        return abs(cmath.rect(self.eccentricity_after, phase) - rotor.value("rho"))


def _levitation(rotor: Model, cosine: np.ndarray, sine: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities of levitation with the unbalance turned back by angles: the whirl turns with it, the static sag does not."""
    whirl = rotor.system.rest
    sag = falling = np.zeros_like(whirl)
    if rotor.system.forced is not None:
        sag, falling = rotor.replace(rho=0.0).system.kicked(0.0)
        whirl = rotor.system.kicked(0.0)[0] - sag
    if len(whirl) == 1:
        whirl, sag, falling = whirl[0], sag[0], falling[0]
    turned = complex_of(whirl.real * cosine + whirl.imag * sine, whirl.imag * cosine - whirl.real * sine)
    return turned + sag, np.zeros_like(turned) + falling
