"""Loss of a blade: the unbalance of the levitating rotor changes by a vector."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of
from carom.disturbances.kicks_and_shocks import levitating_at
from carom.disturbances.model import Disturbance
from carom.disturbances.single import Echo, Part, eccentricity_words
from carom.parameters.formats import format_angle, format_quantity

if TYPE_CHECKING:
    from carom.models import Rotor
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
