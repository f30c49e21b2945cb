"""Disturbances that change the machine: a blade is lost, so that the unbalance changes by a vector, or levitation, so that the rotor falls.

A rotor falls with the whirl and the unbalance that it has at that moment.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of
from carom.disturbances.kicks_and_shocks import levitating_at
from carom.disturbances.model import Disturbance
from carom.disturbances.single import Echo, Part, Single, eccentricity_words, moving
from carom.parameters import MACHINE_FIELDS, Gravity, RecoveryAction, own_size, own_time
from carom.parameters.formats import format_angle, format_quantity, number
from carom.parameters.tables import STIFFNESS

if TYPE_CHECKING:
    from carom.disturbances.base_motion import BaseMotion
    from carom.models import Rotor, Subject
    from carom.motions.starts import State
    from carom.parameters import Scales


SAME_CIRCLE = 14
"""Decimals of a clearance to which unbalances are of one size."""


@dataclass(frozen=True)
class BladeLoss(Disturbance):
    """The unbalance changes by a vector of a stated size, for example because a blade is lost; its phase is free.

    Before the loss the rotor whirls without contact with the unbalance of the machine; where it then is, is the start of the motion of the machine
    with the unbalance after the loss.  These two differ by the change, so each phase leads to another machine (``after`` of
    :class:`~carom.disturbances.Starts`).

    Attributes
    ----------
    change : float
        Size of the change of the unbalance, divided by the mass of the rotor, in clearances.
    node : int, optional
        Where the unbalance of a flexible machine changes; by default at the only node that has an unbalance.

    See Also
    --------
    carom.closed_forms.contact_free_blade_loss : change up to which contact is impossible

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml", ["eccentricity=0.1 mm"])
    >>> loss = cm.disturbances.BladeLoss.of(machine, "9000 g mm")
    >>> cm.map_basins(machine, cm.Grid(loss, (36,))).share_recovered.count
    20
    """

    change: float
    node: int | None = None
    kind: ClassVar[str] = "blade-loss"
    noun: ClassVar[str] = "blade losses"
    measured_in: ClassVar[dict[str, str]] = {"change": "unbalance"}
    changes_machine: ClassVar[bool] = True
    parts: ClassVar = (
        Part("change", "CHANGE", "unbalance", optional=False),
        Part("phase", "PHASE", "angle", 0.0),
        Part("node", "NODE", "node"),
    )
    example: ClassVar = "'0.1 mm,30 deg' or '5000 g mm,30 deg,node 2'"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Phase of the change."""
        return (angle_coordinate("phase", "phase of the change of the unbalance, relative to that before it"),)

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """Levitation of the machine before the loss, in the frame in which the phase of the unbalance stays the same."""
        (phases,) = values
        return starts_after(rotor, self.change, phases, self.node, instant)

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """See :meth:`carom.disturbances.Disturbance.echo`; the eccentricity is stated of rotors with one unbalance alone."""
        (phase,), scales = values, rotor.scales
        kind, noun = ("unbalance", "unbalance") if scales else ("length", "eccentricity")
        words = (
            f"Blade loss: the {noun}{self._where} changes by {format_quantity(self.change, kind, scales)} at {format_angle(phase)} from that before it, "
            "in the sense of rotation"
        )
        sizes = {"change": (self.change, kind), "phase": (phase, "")}
        if rotor.numbers is not None:
            before = rotor.value("rho")
            after = before + cmath.rect(self.change, phase)
            words += f": from {format_quantity(before, kind, scales)} to {format_quantity(abs(after), kind, scales)}, turned by {format_angle(cmath.phase(after))}"
            sizes |= {"before": (before, kind), "after": (abs(after), kind)}
        return Echo(self.kind, words, sizes)

    def up_to_words(self, before: float | None, scales: Scales | None) -> str:
        """See :meth:`carom.disturbances.Disturbance.up_to_words`."""
        start = "" if before is None else f" from {eccentricity_words(before, scales)}"
        change = eccentricity_words(self.change, scales)
        return f"{self.coordinates[0].words}: all around; eccentricity{self._where} changes{start} by {change}"

    @property
    def _where(self) -> str:
        return "" if self.node is None else f" at node {self.node}"


def starts_after(
    rotor: Rotor,
    sizes: np.ndarray | float,
    phases: np.ndarray,
    node: int | None = None,
    instants: np.ndarray | float = 0.0,
) -> Starts:
    """Starts after changes of the unbalance of these sizes and phases at these instants, with the machine after each."""
    sizes, phases, instants = np.broadcast_arrays(sizes, phases, instants)
    after, turned = np.empty(phases.shape, object), np.empty(phases.shape)
    before = rotor.definition.unbalance_along(node)
    known: dict[float, Rotor] = {}
    for place in np.ndindex(phases.shape):
        change = cmath.rect(float(sizes[place]), float(phases[place]))
        changed, turned[place] = rotor.with_changed_unbalance(change, node)
        if before is not None:  # all of a circle lead to one machine, up to rounding
            changed = known.setdefault(round(abs(before + change), SAME_CIRCLE), changed)
        after[place] = changed
    return levitating_before(rotor, turned, instants)._replace(after=after)


def levitating_before(rotor: Rotor, turned: np.ndarray, instants: np.ndarray) -> Starts:
    """Levitation at instants of the turn, seen in frames that have turned by these angles with the unbalance after it."""
    system, before = rotor.system, levitating_at(rotor, 0.0, instants)
    if before.exists.any() and system.is_externally_forced:
        system.refuse_non_stationary()
    turn = complex_of(np.cos(turned), -np.sin(turned))
    turn = turn if len(system.rest) == 1 else turn[..., None]
    # What does not turn with the shaft, as weight, is seen in a frame that has turned as it is later in the turn.
    begins = turned + instants if system.is_time_dependent else np.zeros(turned.shape)
    return before._replace(positions=before.positions * turn, velocities=before.velocities * turn, begins=begins)


ASSUMED = Gravity(carried_by=STIFFNESS)
"""Weight of a rotor that states none, once it falls: 9.81 m/s² downward."""
AXIAL_LANDING = "Nothing pulls the rotor to a side; what the axial touchdown bearing does to it is left out"


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
    recovery : carom.parameters.RecoveryAction, optional
        When the bearing holds the rotor again, and what its controller does then, in place of ``regained_after``.
    base : Single, optional
        A shock or a recorded motion of the base that begins at the release.
    """

    at: State | Single | None = None
    phase: float | str | None = None
    regained_after: float | str | None = None
    race_speed: float | str | None = None
    recovery: RecoveryAction | None = None
    base: Single | None = None
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

        A rotor that states no weight falls by :data:`ASSUMED`.  A vertical one is
        pulled to no side: it drifts with the velocity that its centre of mass has in its whirl.

        Raises
        ------
        InputError
            The rotor has neither weight nor scales, its levitation does not stay inside the wall, it has several coordinates, its race does not turn,
            or a text is no such size.
        """
        from carom.models import Stage, Trigger, in_stages, rotor_of
        from carom.models.stages import stages_of

        rotor = rotor_of(machine)
        if not (rotor.is_vertical or rotor.acting.whole_weight is not None or rotor.scales):
            raise InputError("gravity", None, "a drop needs weight, in m/s^2: a machine with mass, clearance and speed")
        if stages_of(rotor)[0].rotor is not rotor:
            raise InputError("machine", shown(machine), "a machine of one stage: a drop makes stages of its own")
        if self.phase is not None:
            rotor = rotor.replace(phi=self.unbalance_angle(rotor))
        start = self._start(rotor)
        falling = rotor.without_levitation()
        if rotor.acting.whole_weight is None and not rotor.is_vertical:
            falling = falling.under_gravity(ASSUMED)
        kept = rotor.equations.regained
        carry = None if kept is None else np.diag(np.tile(kept, 2))
        if self.base is not None:
            if self.regained_after is not None or self.recovery is not None:
                raise InputError("base", self.base.model.kind, "left out beside levitation that is regained")
            size, angle, _ = self.base.model.whole(self.base.values, 0.0, rotor.scales)
            shaken = cast("BaseMotion", self.base.model).stages_of_base(falling, size, angle, start.time)
            return in_stages((*shaken, Stage(falling))), start
        if self.recovery is not None:
            from carom.disturbances.recovering import recovery_stages

            if self.regained_after is not None:
                raise InputError("regained_after", self.regained_after, "left out beside recovery, which says when")
            return in_stages(tuple(recovery_stages(rotor, falling, self.recovery, carry))), start
        if self.regained_after is None:
            return falling, start
        time = own_time("regained_after", self.regained_after, rotor.scales)
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
        return math.remainder(rotor.acting.direction_of_fall + ahead, 2.0 * math.pi)

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
            where, sizes = "", {}
            for plane, width in enumerate(widths):
                place, rate = (width * complex(each) for each in falling.system.at_plane(amplitudes, plane))
                begun = moving(place, rate, scales)
                where += f"{'; ' if plane else ''}at touchdown bearing {plane + 1} {begun.words}"
                sizes |= {f"{name}_{plane + 1}": size for name, size in begun.sizes.items()}
        sizes["unbalance_angle"] = phase, ""
        back = ""
        if self.regained_after is not None:
            regained = own_time("regained_after", self.regained_after, scales)
            sizes["regained_after"] = regained, "time"
            back = f"; levitation returns after {format_quantity(regained, 'time', scales)}"
        if self.race_speed is not None and scales is not None:
            turning, shown = own_size("race_speed", self.race_speed, "speed", scales), MACHINE_FIELDS["speed"]
            sizes["race_speed"] = turning, "speed"
            back = f"; the inner race turns at {number(shown.in_usual_unit(turning * scales.speed), 6)} {shown.usual_unit}{back}"
        if self.recovery is not None:
            back = f"; levitation {self.recovery.words}"
        if self.base is not None:
            shaken = self.base.model.echo(rotor, *self.base.model.whole(self.base.values, 0.0, scales)[:-1])
            back = f"{back}; from then on {shaken.words}"
            sizes |= {f"base_{name}": size for name, size in shaken.sizes.items()}
        words = (
            f"Release: {where}; gravity {(gravity or ASSUMED).words}; angles are measured from the fixed x axis in the "
            f"sense of rotation (unbalance at the release: {format_angle(phase)}){back}"
        )
        assumed = "" if gravity else f". The file has no [gravity]: {ASSUMED.words} is assumed"
        if rotor.is_vertical:
            assumed = f". {AXIAL_LANDING}"
        return Echo(self.kind, words + assumed, sizes)


@checked
def drop(
    at: State | Single | None = None,
    *,
    phase: float | str | None = None,
    regained_after: float | str | None = None,
    race_speed: float | str | None = None,
    recovery: RecoveryAction | None = None,
    base: Single | None = None,
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
    base : Single, optional
        A shock or a recorded motion of the base that begins at the release, such as ``carom.BaseShock.read("5 g, 11 ms", machine)``.
    recovery : carom.parameters.RecoveryAction, optional
        When levitation is back, and what the controller does then, in place of ``regained_after``.

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
    return Drop(at, phase, regained_after, race_speed, recovery, base)
