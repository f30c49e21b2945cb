"""Levitation lost: the rotor falls with the whirl and the unbalance that it has at that moment."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from carom.arguments import checked
from carom.models import Model, Stage, Staged, Subject, Trigger, model_of
from carom.models.weight import levitation_of, weight_of, without_levitation
from carom.motions.starts import Kick, State, time_until
from carom.outcome import InputError, shown
from carom.parameters import own_size


@checked
@dataclass(frozen=True)
class Drop:
    """Levitation is lost at time zero, when the co-rotating frame coincides with the fixed one.

    Attributes
    ----------
    at : State or Kick, optional
        State at the release; by default the rotor levitates, which is its whirl about the static sag.
    phase : float or str, optional
        Angle from the direction of the fall to the unbalance at the release, in the sense of rotation: in rad, or text with a
        unit, such as ``"90 deg"``.  By default the unbalance lies at its phase in the machine.
    regained_after : float or str, optional
        Time after which the bearing holds the rotor as before, in ``1/Ω`` or text with a unit; by default never.
    """

    at: State | Kick | None = None
    phase: float | str | None = None
    regained_after: float | str | None = None

    @checked
    def stages(self, machine: Subject) -> tuple[Model, State]:
        """Return the rotor that falls, and levitates again if levitation is regained, and its start.

        Raises
        ------
        InputError
            No weight acts on the rotor, its levitation does not stay inside the wall, it has several coordinates, or a text is no
            such size.
        """
        rotor = model_of(machine)
        weight = weight_of(rotor)
        if weight is None:
            allowed = "a drop needs weight: a table [gravity] in the machine file, or --set gravity=9.81 for once"
            raise InputError("gravity", None, allowed)
        if isinstance(rotor, Staged):
            raise InputError("machine", shown(machine), "a machine of one stage: a drop makes stages of its own")
        if self.phase is not None:
            down = cmath.phase(complex(weight @ rotor.system.translated.conj()))
            ahead = down + own_size("phase", self.phase, "angle", rotor.scales)
            rotor = rotor.replace(phi=math.remainder(ahead, 2.0 * math.pi))
        start = self._start(rotor)
        falling = without_levitation(rotor)
        if self.regained_after is None:
            return falling, start
        time = time_until(self.regained_after, rotor.scales, "regained_after")
        return Staged((Stage(falling, Trigger(time=time)), Stage(rotor))), start

    def _start(self, rotor: Model) -> State:
        """State at the release."""
        if isinstance(self.at, State):
            return self.at
        position, velocity = (values if len(values) > 1 else values[0] for values in levitation_of(rotor))
        return State.of(position, velocity) if self.at is None else self.at.state(rotor)


@checked
def drop(
    at: State | Kick | None = None, *, phase: float | str | None = None, regained_after: float | str | None = None
) -> Drop:
    """Levitation is lost: stiffness and damping of the bearing act no longer, weight and unbalance do.

    Parameters
    ----------
    at : State or Kick, optional
        State at the release; by default the rotor levitates.
    phase : float or str, optional
        Angle from the direction of the fall to the unbalance at the release, in the sense of rotation: in rad, or text with a
        unit, such as ``"90 deg"``; by default that of the machine.
    regained_after : float or str, optional
        Time after which levitation is back, in ``1/Ω`` or text with a unit, such as ``"50 ms"``; by default never.

    See Also
    --------
    carom.simulate : follow it
    carom.parameters.Gravity : the weight that it needs
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
    return Drop(at, phase, regained_after)
