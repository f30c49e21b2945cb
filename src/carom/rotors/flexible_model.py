"""What defines the rotor of a flexible machine: the parameters of the machine by their names."""

from __future__ import annotations

import cmath
import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.base.outcome import InputError, shown
from carom.models import Limit, LinearEquations
from carom.models.system import System
from carom.parameters import Field, read_quantity
from carom.rotors.attachments import UNBALANCE_FIELDS, Unbalance
from carom.rotors.bearing_limits import asked_by_currents

if TYPE_CHECKING:
    from carom.rotors.reduced_machine import ReducedMachine

ROUNDED = 1e-12
"""Share of a weight up to which what bias currents leave of it is none."""
_WALLS = "wall_"
"""How names of walls in units of the equations begin; the machine has the entries of touchdown bearings in their place."""


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleDefinition(LinearEquations):
    """A flexible machine by a few vectors, without its weight; see :class:`~carom.models.LinearEquations` for its numbers.

    Another value of a parameter keeps the vectors, which depend on none of them, and makes the equations anew.

    Attributes
    ----------
    reduced : ReducedMachine
        The machine and its vectors.
    growth : float
        How fast a motion of the whole machine grows, in units of the speed; 0 where none does.  No unbalance changes it.
    """

    reduced: Any = None
    growth: float = 0.0

    @property
    def finite_elements(self) -> ReducedMachine:
        """The machine and its vectors."""
        machine: ReducedMachine = self.reduced
        return machine

    @cached_property
    def system(self) -> System:
        """Modes, contact planes and contact law; it knows whether a motion of the machine grows that its vectors leave out."""
        return dataclasses.replace(super().system, growth=self.growth)

    @cached_property
    def _own(self) -> dict[str, Field]:
        """Parameters of the machine."""
        return self.reduced.machine.varied_in_model

    @property
    def varied(self) -> Mapping[str, Field]:
        """Parameters that can be varied: those of the machine, and the dimensionless ones of a linear rotor."""
        others = {name: field for name, field in super().varied.items() if not name.startswith(_WALLS)}
        return {**others, **self._own}

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Limits of the magnetic bearings of the machine."""
        return self.finite_elements.limits

    def held_by_bias(self, weight: np.ndarray, limits: int) -> tuple[np.ndarray, np.ndarray]:
        """See :meth:`carom.models.definition.Definition.held_by_bias`; sensors are not displaced, and the shaft bends between them."""
        reduced, scales = self.reduced, self.reduced.scales
        unit = scales.length * math.sqrt(scales.mass) * scales.speed**2
        pushed, currents = reduced.held_by_bias(weight * unit)
        asked = asked_by_currents(reduced.equations, reduced.machine.bearings, currents)
        left = weight + pushed / unit
        left[np.abs(left) <= ROUNDED * np.abs(weight).max()] = 0.0
        return left, asked if len(asked) == limits else np.zeros(limits)

    def pushed_by_currents(self, current: complex) -> np.ndarray:
        """See :meth:`carom.models.definition.Definition.pushed_by_currents`."""
        reduced: ReducedMachine = self.reduced
        at, scales, found = reduced.machine, reduced.scales, np.zeros(len(self.mass), complex)
        if not at.bearings:
            return super().pushed_by_currents(current)
        unit = scales.length * math.sqrt(scales.mass) * scales.speed**2
        for each in at.bearings:
            found[: reduced.vectors] += each.ki * current / unit * (at.rotor.row_at(each.node) @ reduced.basis.shapes)
        return found

    def value(self, name: str) -> float:
        """Value of a parameter.

        Raises
        ------
        InputError
            No such name, or parts with different values.
        """
        if name in self._own:
            return float(self.reduced.machine.value(name))
        if name not in self.varied:
            raise self.reduced.machine.unknown(name, "wanted")
        return super().value(name)

    def replace(self, **changes: Any) -> Any:
        """Return the rotor with other values of its parameters, whether it then levitates or not; with other attributes, a plain linear rotor.

        Raises
        ------
        InputError
            A name is unknown or a value not allowed, or there is no unbalance to be multiplied or turned.
        """
        if {field.name for field in dataclasses.fields(LinearEquations)} & (changes.keys() - self._own.keys()):
            own = {field.name: getattr(self, field.name) for field in dataclasses.fields(LinearEquations)}
            return LinearEquations(**own).replace(**changes)
        # What numbers of the equations mean depends on speed and clearance, which are numbers of the machine.
        of_machine = {
            name: read_quantity(self._own[name], given) for name, given in changes.items() if name in self._own
        }
        rotor = self._made(**of_machine) if of_machine else self
        for name in (each for each in changes if each not in of_machine):
            rotor = rotor._with_number(name, changes[name])
        return rotor

    def _made(self, **changes: object) -> FlexibleDefinition:
        return self.finite_elements.of(self.reduced.machine.replace(**changes)).definition

    def _with_number(self, name: str, given: object) -> FlexibleDefinition:
        """Copy with one dimensionless parameter changed; the SI values follow."""
        reduced: ReducedMachine = self.reduced
        if name in reduced.machine.varied:
            allowed = "left as it is: where it is 0 another value gives a controller more states; set it in the machine, as --set does"
            raise InputError(name, shown(given), allowed)
        if name not in self.varied:
            raise reduced.machine.unknown(name, given)
        value = read_quantity(self.varied[name], given)
        own, _, number = name.rpartition("_") if name[-1].isdigit() else (name, "", "")
        plane = f"_{number}" if number else ""
        if own == "mu":
            return self._made(**{f"friction{plane}": value})
        if own == "radius_ratio":
            rooms = dict(enumerate(reduced.machine.clearances, start=1))
            planes = [int(number)] if number else list(rooms)
            return self._made(**{f"rotor_radius_{plane}": value * rooms[plane] for plane in planes})
        turn, factor = 0.0, 1.0
        if own == "rho":
            present = self.value(own)
            if not present:
                allowed = f"cannot be set: {name} = 0 now, and only another value can be multiplied"
                raise InputError(name, shown(value), allowed)
            factor = value / present
        else:
            turn = value - self.unbalance_phase
        unbalances = [
            dataclasses.replace(each, size=factor * each.size, angle=each.angle + turn)
            for each in reduced.machine.unbalances
        ]
        return reduced.of(dataclasses.replace(reduced.machine, unbalances=unbalances)).definition

    def unbalance_push(self, node: int | None = None) -> np.ndarray:
        """See :meth:`carom.models.Definition.unbalance_push`; at a node, with the phase of the unbalance there, otherwise of that of the rotor as a whole."""
        reduced, (node, own) = self.reduced, self._unbalance_at(node)
        push, size = np.zeros(len(self.mass), complex), math.sqrt(reduced.machine.rotor.mass)
        push[: reduced.vectors] = size * (reduced.machine.rotor.row_at(node) @ reduced.basis.shapes)
        return push * cmath.exp(1j * (cmath.phase(own) if own else self.unbalance_phase))

    def unbalance_along(self, node: int | None = None) -> float | None:
        """See :meth:`carom.models.Definition.unbalance_along`."""
        node, own = self._unbalance_at(node)
        others = any(each.node != node for each in self.reduced.machine.unbalances)
        return None if others else abs(own) / self.reduced.scales.unbalance

    def with_changed_unbalance(self, change: complex, node: int | None = None) -> tuple[FlexibleDefinition, float]:
        """See :meth:`carom.models.Rotor.with_changed_unbalance`."""
        changed, turned = super().with_changed_unbalance(change, node)
        reduced, (node, own) = self.reduced, self._unbalance_at(node)
        unit = cmath.rect(reduced.scales.unbalance, cmath.phase(own) if own else self.unbalance_phase)
        size, angle = cmath.polar((own + change * unit) * cmath.exp(-1j * turned))
        others = [each for each in reduced.machine.unbalances if each.node != node]
        at_node = [Unbalance(node, size, angle)] if size and UNBALANCE_FIELDS["size"].contains(size) else []
        machine = dataclasses.replace(reduced.machine, unbalances=[*others, *at_node])
        return dataclasses.replace(changed, reduced=reduced.of(machine)), turned

    def _unbalance_at(self, node: int | None) -> tuple[int, complex]:
        """A node, by default that of the only unbalance, and the unbalance there, kg m."""
        machine = self.reduced.machine
        nodes = sorted({each.node for each in machine.unbalances})
        if node is None and len(nodes) != 1:
            allowed = "the node at which the unbalance changes, where not one node alone has an unbalance"
            raise InputError("blade_loss_node", None, f"{allowed}; such as that of a disc")
        at = nodes[0] if node is None else node
        machine.rotor.check_node("blade_loss_node", at)
        return at, complex(sum(cmath.rect(each.size, each.angle) for each in machine.unbalances if each.node == at))
