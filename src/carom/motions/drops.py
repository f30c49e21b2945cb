"""Levitation lost: the rotor falls with the whirl and the unbalance that it has at that moment."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.models import Rotor, Stage, Subject, Trigger, in_stages, rotor_of
from carom.models.stages import stages_of
from carom.models.weight import levitation_of
from carom.motions.starts import Kick, State
from carom.parameters import Gravity, own_size, own_time

ASSUMED = Gravity()
"""Weight of a rotor that states none: 9.81 m/s² downward."""


@checked
@dataclass(frozen=True)
class Whirl:
    """A whirl about the centre of the bearing, as it is at one instant, when the co-rotating frame coincides with the fixed one.

    Attributes
    ----------
    radius : float or str
        In clearances, or text with a unit, such as ``"0.1 mm"``.
    speed : float or str
        In ``Ω``, or text with a unit, such as ``"80 Hz"``; negative for backward whirl.
    angle : float or str
        Where the rotor is, in the fixed frame: in rad, or text with a unit.
    """

    radius: float | str
    speed: float | str
    angle: float | str = 0.0

    def stages(self, machine: Subject) -> tuple[Rotor, State]:
        """Return the machine, which goes on levitating, and its start."""
        rotor = rotor_of(machine)
        return rotor, self.state(rotor)

    def state(self, rotor: Rotor) -> State:
        """Return the state at that instant; what does not move with the rotor, such as a mount, is at rest.

        Raises
        ------
        InputError
            A text is no such size, or the radius is below zero or beyond the wall.
        """
        radius = own_size("whirl radius", self.radius, "length", rotor.scales)
        if not 0.0 <= radius <= 1.0:
            raise InputError("whirl radius", self.radius, "must be from 0 to the clearance")
        place = cmath.rect(radius, own_size("whirl angle", self.angle, "angle", rotor.scales))
        turning = 1j * (own_size("whirl speed", self.speed, "speed", rotor.scales) - 1.0) * place
        return State.of(place * rotor.system.translated, turning * rotor.system.translated)


@checked
@dataclass(frozen=True)
class Drop:
    """Levitation is lost at time zero, when the co-rotating frame coincides with the fixed one.

    Attributes
    ----------
    at : State, Kick or Whirl, optional
        State at the release; by default the rotor levitates, which is its whirl about the static sag.
    phase : float or str, optional
        Angle from the direction of the fall to the unbalance at the release, in the sense of rotation: in rad, or text with a
        unit, such as ``"90 deg"``.  By default the unbalance lies at its phase in the machine.
    regained_after : float or str, optional
        Time after which the bearing holds the rotor as before, in ``1/Ω`` or text with a unit; by default never.
    race_speed : float or str, optional
        Speed of the race at the release, in ``Ω`` or text with a unit; by default that of the model, which is 0 for a machine file.
    """

    at: State | Kick | Whirl | None = None
    phase: float | str | None = None
    regained_after: float | str | None = None
    race_speed: float | str | None = None

    @checked
    def stages(self, machine: Subject) -> tuple[Rotor, State]:
        """Return the rotor that falls, and levitates again if levitation is regained, and its start.

        A rotor that states no weight falls by :data:`ASSUMED`, which the bias currents of its bearings carry while it levitates.

        Raises
        ------
        InputError
            The rotor has neither weight nor scales, its levitation does not stay inside the wall, it has several coordinates, its race does not turn,
            or a text is no such size.
        """
        rotor = rotor_of(machine)
        if rotor.weight is None and rotor.scales is None:
            raise InputError("gravity", None, "a drop needs weight, in m/s^2: a machine with mass, clearance and speed")
        if stages_of(rotor)[0].rotor is not rotor:
            raise InputError("machine", shown(machine), "a machine of one stage: a drop makes stages of its own")
        if self.phase is not None:
            rotor = rotor.replace(phi=self.unbalance_angle(rotor))
        start = self._start(rotor)
        falling = rotor.without_levitation()
        if rotor.weight is None:
            falling = falling.under_gravity(ASSUMED)
        if self.regained_after is None:
            return falling, start
        time = own_time("regained_after", self.regained_after, rotor.scales)
        kept = rotor.equations.regained
        carry = None if kept is None else np.diag(np.tile(kept, 2))
        return in_stages((Stage(falling, Trigger(time=time), carry), Stage(rotor))), start

    def unbalance_angle(self, rotor: Rotor) -> float:
        """Angle of the unbalance at the release, in the fixed frame, in rad.

        Raises
        ------
        InputError
            The phase is no angle.
        """
        if self.phase is None:
            return rotor.unbalance_phase
        ahead = own_size("phase", self.phase, "angle", rotor.scales)
        return math.remainder(rotor.direction_of_fall + ahead, 2.0 * math.pi)

    def _start(self, rotor: Rotor) -> State:
        """State at the release; by default with the races as the model has them."""
        at = self.at
        state = State.of(*levitation_of(rotor)) if at is None else at if isinstance(at, State) else at.state(rotor)
        if self.race_speed is None:
            return state
        radii = [race.radius for race in rotor.races if race is not None]
        if not radii:
            raise InputError("race_speed", self.race_speed, "a touchdown bearing with a race that turns: race_inertia")
        speed = own_size("race_speed", self.race_speed, "speed", rotor.scales)
        return State(state.position, state.velocity, tuple(radius * speed for radius in radii))


@checked
def drop(
    at: State | Kick | Whirl | None = None,
    *,
    phase: float | str | None = None,
    regained_after: float | str | None = None,
    race_speed: float | str | None = None,
) -> Drop:
    """Levitation is lost: stiffness and damping of the bearing act no longer, weight and unbalance do.

    Parameters
    ----------
    at : State, Kick or carom.motions.Whirl, optional
        State at the release; by default the rotor levitates.
    phase : float or str, optional
        Angle from the direction of the fall to the unbalance at the release, in the sense of rotation: in rad, or text with a
        unit, such as ``"90 deg"``; by default that of the machine.
    regained_after : float or str, optional
        Time after which levitation is back, in ``1/Ω`` or text with a unit, such as ``"50 ms"``; by default never.
    race_speed : float or str, optional
        Speed of the race of the touchdown bearing at the release, in ``Ω`` or text with a unit, such as ``"500 rpm"``.

    See Also
    --------
    carom.simulate : follow it
    carom.motions.drop_loads : what the touchdown bearing bears
    carom.parameters.Gravity : the weight by which it falls
    carom.kick : the rotor is kicked, and goes on levitating

    Examples
    --------
    A rotor released at rest in the centre falls freely:

    >>> import carom as cm
    >>> machine = cm.load("examples/dropped-rotor.toml", ["eccentricity=0"])
    >>> motion = cm.simulate(machine, cm.drop(cm.State(0)))
    >>> print(f"{motion.contacts.time[0] * motion.rotor.scales.time * 1e3:.6f} ms")
    7.139216 ms
    """
    return Drop(at, phase, regained_after, race_speed)
