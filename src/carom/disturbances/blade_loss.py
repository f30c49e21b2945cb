"""Loss of a blade: the unbalance of the levitating rotor becomes another one, in size and phase."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of, sagged
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

    def starts(self, rotor: Model, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """Levitation of the machine before the loss, in the frame in which the phase of the unbalance stays the same.

        Under weight it goes round its sag; this frame coincides with the fixed one at instant zero.
        """
        from carom.models.weight import refuse_unsteady

        phase, begun = np.broadcast_arrays(*values, instant)
        levitates = rotor.system.rest_radius < 1.0
        if levitates:
            refuse_unsteady(rotor)
        cosine, sine, rest = np.cos(phase), np.sin(phase), rotor.system.rest * levitates
        if len(rest) > 1:
            cosine, sine = cosine[..., None], sine[..., None]
        else:
            rest = rest[0]
        positions = complex_of(rest.real * cosine + rest.imag * sine, rest.imag * cosine - rest.real * sine)
        none = np.zeros(np.shape(phase), bool)
        # What goes round against the shaft turns the other way with the phase.
        opposite = None if rotor.system.mirrored is None else (cosine + 1j * sine) * rotor.system.rest_mirrored
        if levitates:
            positions, velocities = sagged(rotor, positions, opposite, begun)
        else:
            velocities = np.zeros_like(positions)
        return Starts(positions, velocities, none | levitates, none, none, np.zeros(np.shape(phase))).at(begun)

    def release(self, machine: Subject, phase: float = 0.0, instant: float = 0.0) -> tuple[Model, State]:
        """Return the machine after the loss and the state in which it starts, for :func:`carom.simulate`.

        Parameters
        ----------
        machine : Machine, Case, Parameters or model
            Before the loss.
        phase : float
            Phase of the unbalance after the loss relative to the one before, rad.
        instant : float
            Angle by which the shaft has turned at the loss, rad, since the frame of :meth:`starts` coincided with the fixed one.

        Raises
        ------
        InputError
            The rotor cannot levitate inside the wall before the loss.
        """
        from carom.models import model_of
        from carom.motions.starts import State

        rotor = model_of(machine)
        turned, begun = own_size("phase", phase, "angle", None), own_size("instant", instant, "angle", None)
        starts = self.starts(rotor, np.array(turned), instant=begun)
        if not starts.exists:
            radius = f"|U*| = {rotor.system.rest_radius:.6g}"
            raise InputError("disturbance", radius, "needs levitation inside the wall before the loss")
        return self.machine_after(rotor), State.of(starts.positions, starts.velocities, time=float(starts.begins))

    def lost(self, rotor: Model, phase: float) -> float:
        """Unbalance lost if the unbalance after it has this phase: ``|ρ'e^{iβ} − ρ|``, in ``m c_r``."""
        return abs(cmath.rect(self.eccentricity_after, phase) - rotor.value("rho"))
