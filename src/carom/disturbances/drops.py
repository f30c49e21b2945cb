"""Levitation lost: the rotor falls with the whirl and the unbalance that it has at that moment."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.disturbances.coordinates import Coordinate, Starts
from carom.disturbances.model import Disturbance
from carom.disturbances.single import Echo, Single, moving
from carom.parameters import MACHINE_FIELDS, Gravity, own_size, own_time
from carom.parameters.formats import format_angle, format_quantity, number

if TYPE_CHECKING:
    from carom.models import Rotor, Subject
    from carom.motions.starts import State

ASSUMED = Gravity()
"""Weight of a rotor that states none: 9.81 m/s² downward."""


@checked
@dataclass(frozen=True)
class Drop(Disturbance):
    """Levitation is lost at time zero, when the co-rotating frame coincides with the fixed one.

    Attributes
    ----------
    at : State or Single, optional
        State at the release, or what leads to it, as a kick or a whirl; by default the rotor levitates, which is its whirl about the static sag.
    phase : float or str, optional
        Angle from the direction of the fall to the unbalance at the release, in the sense of rotation: in rad, or text with a
        unit, such as ``"90 deg"``.  By default the unbalance lies at its phase in the machine.
    regained_after : float or str, optional
        Time after which the bearing holds the rotor as before, in ``1/Ω`` or text with a unit; by default never.
    race_speed : float or str, optional
        Speed of the race at the release, in ``Ω`` or text with a unit; by default that of the model, which is 0 for a machine file.
    """

    at: State | Single | None = None
    phase: float | str | None = None
    regained_after: float | str | None = None
    race_speed: float | str | None = None
    kind: ClassVar[str] = "drop"
    noun: ClassVar[str] = "drops"
    changes_machine: ClassVar[bool] = True
    many: ClassVar[bool] = False

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """None: all of a drop is stated."""
        return ()

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """A drop is no start of a levitating rotor."""
        allowed = "followed by carom.simulate, and mapped by carom.basins.map_drops"
        raise InputError("disturbance", self.kind, allowed)

    def stages(self, machine: Subject) -> tuple[Rotor, State]:
        """See :meth:`apply`."""
        return self.apply(machine)

    def apply(self, machine: Subject, *values: float | str, instant: float | str = 0.0) -> tuple[Rotor, State]:
        """Return the rotor that falls, and levitates again if levitation is regained, and its start.

        A rotor that states no weight falls by :data:`ASSUMED`, which the bias currents of its bearings carry while it levitates.

        Raises
        ------
        InputError
            The rotor has neither weight nor scales, its levitation does not stay inside the wall, it has several coordinates, its race does not turn,
            or a text is no such size.
        """
        from carom.models import Stage, Trigger, in_stages, rotor_of
        from carom.models.stages import stages_of

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
        from carom.motions.starts import State

        if self.at is None:
            rotor.system.require_levitation()
        at = State.of(*rotor.system.kicked(0.0)) if self.at is None else self.at
        state = at if isinstance(at, State) else at.stages(rotor)[1]
        if self.race_speed is None:
            return state
        radii = [race.radius for race in rotor.races if race is not None]
        if not radii:
            raise InputError("race_speed", self.race_speed, "a touchdown bearing with a race that turns: race_inertia")
        speed = own_size("race_speed", self.race_speed, "speed", rotor.scales)
        return State(state.position, state.velocity, tuple(radius * speed for radius in radii))

    def echo_at(self, rotor: Rotor, falling: Rotor, state: State, gravity: Gravity | None) -> Echo:
        """What was done to a rotor, which then falls from a state by a weight; by :data:`ASSUMED` if none is stated."""
        from carom.motions.starts import amplitudes_of

        scales, widths = rotor.scales, falling.system.widths.tolist()
        phase = self.unbalance_angle(rotor)
        if len(widths) == 1:  # on a mount the rotor is the first of two coordinates
            place, rate = (complex(np.ravel(part)[0]) for part in (state.position, state.velocity))
            begun = moving(place, rate, scales)
            where, sizes = f"rotor centre {begun.words}", dict(begun.sizes)
        else:  # in several bearings coordinates are no places
            amplitudes, _ = amplitudes_of(falling, state)
            each = (falling.system.at_plane(amplitudes, plane) for plane in range(len(widths)))
            places = [
                moving(width * complex(place), width * complex(rate), scales)
                for width, (place, rate) in zip(widths, each, strict=True)
            ]
            where = "; ".join(f"at touchdown bearing {count} {one.words}" for count, one in enumerate(places, 1))
            sizes = {f"{name}_{count}": size for count, one in enumerate(places, 1) for name, size in one.sizes.items()}
        sizes["unbalance_angle"] = phase, ""
        back = ""
        if self.regained_after is not None:
            regained = own_time("regained_after", self.regained_after, scales)
            sizes["regained_after"], back = (
                (regained, "time"),
                f"; levitation returns after {format_quantity(regained, 'time', scales)}",
            )
        if self.race_speed is not None and scales is not None:
            turning, shown = own_size("race_speed", self.race_speed, "speed", scales), MACHINE_FIELDS["speed"]
            sizes["race_speed"] = turning, "speed"
            back = f"; the inner race turns at {number(shown.in_usual_unit(turning * scales.speed), 6)} {shown.usual_unit}{back}"
        words = (
            f"Release: {where}; gravity {(gravity or ASSUMED).words}; angles are measured from the fixed x axis in the "
            f"sense of rotation (unbalance at the release: {format_angle(phase)}){back}"
        )
        assumed = "" if gravity else f". The file has no [gravity]: {ASSUMED.words} is assumed"
        return Echo(self.kind, words + assumed, sizes)


@checked
def drop(
    at: State | Single | None = None,
    *,
    phase: float | str | None = None,
    regained_after: float | str | None = None,
    race_speed: float | str | None = None,
) -> Drop:
    """Levitation is lost: stiffness and damping of the bearing act no longer, weight and unbalance do.

    Parameters
    ----------
    at : State or Single, optional
        State at the release, or what leads to it, such as ``carom.kick("50 mm/s")`` or ``carom.disturbances.whirl("0.1 mm", "80 Hz")``; by
        default the rotor levitates.
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
