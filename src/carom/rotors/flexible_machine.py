"""A flexible rotor on magnetic bearings, inside touchdown bearings, and its parts in the units of people."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np

from carom.base.arguments import Count, Positive, checked
from carom.base.outcome import InputError, shown
from carom.models import Rotor
from carom.parameters import Field, Gravity
from carom.parameters.fields import RPM
from carom.parameters.formats import format_angle, format_entry, number
from carom.parameters.tables import read_entries
from carom.rotors.attachments import HOUSING_FIELDS, PLANE_FIELDS, Housing, TouchdownPlane, Unbalance
from carom.rotors.controllers import Controller, Series
from carom.rotors.equations import loops_of
from carom.rotors.free_motions import Slowest, slowest_of
from carom.rotors.free_rotor import FreeRotor
from carom.rotors.machine_parameters import WHOLE, NamedParameters
from carom.rotors.magnetic_bearing import BEARING_FIELDS, MagneticBearing
from carom.rotors.reduced_machine import ReducedMachine
from carom.rotors.reduction import MORE, RIGID, Basis, rubin_basis
from carom.rotors.rigid_body import RigidRotor
from carom.rotors.shaft_parts import read_parts
from carom.rotors.shared_controller import SharedController, loops_in
from carom.rotors.support import SUPPORT_FIELDS, Support

ACCURACY = 0.02
"""Error of contact forces by reduction that is accepted by default; it is that of one
straight contact, and motions with bending of their own may differ by more (``docs/decisions/flexible-rotors.md``)."""
_KINDS = {
    "bearings": MagneticBearing,
    "touchdowns": TouchdownPlane,
    "unbalances": Unbalance,
    "supports": Support,
    "shared_controllers": SharedController,
    "housings": Housing,
}


@dataclass(frozen=True, eq=False)
class FlexibleMachine(NamedParameters):
    """A flexible rotor on magnetic bearings, inside touchdown bearings, in SI units.

    Attributes
    ----------
    rotor : FlexibleRotor, MatrixRotor or RigidRotor
    speed : float or str
        Rotational speed, rad/s, or text such as ``"3000 rpm"``.
    clearance : float or str
        Radial clearance, m, at touchdown bearings that state none of their own; lengths of the model are in this unit.
    bearings : sequence of MagneticBearing
        Without any, and without supports, the rotor is free.
    touchdowns : sequence of TouchdownPlane
        One or more.
    unbalances : sequence of Unbalance, optional
    gravity : carom.parameters.Gravity, optional
        By default the rotor has no weight.
    supports : sequence of Support, optional
        What holds the rotor with and without its magnetic bearings.
    shared_controllers : sequence of SharedController, optional
        Of magnetic bearings that have no controller of their own.
    housings : sequence of Housing, optional
        On which magnetic bearings, touchdown bearings and supports stand; the others stand on the ground.

    Raises
    ------
    InputError
        A part is of another kind, a value is out of range, a part sits at a node that the shaft does not have, or two bearings of one kind at one node.
    """

    rotor: FreeRotor
    speed: float
    clearance: float
    bearings: Sequence[MagneticBearing]
    touchdowns: Sequence[TouchdownPlane]
    unbalances: Sequence[Unbalance] = ()
    gravity: Gravity | None = None
    supports: Sequence[Support] = ()
    shared_controllers: Sequence[SharedController] = ()
    housings: Sequence[Housing] = ()

    def __post_init__(self) -> None:
        rotor: object = self.rotor
        if not isinstance(rotor, FreeRotor):
            raise InputError("rotor", shown(rotor), "carom.rotors.FlexibleRotor, MatrixRotor or RigidRotor")
        if not isinstance(self.gravity, Gravity | None):
            raise InputError("gravity", shown(self.gravity), "carom.parameters.Gravity, or None")
        for name, kind in _KINDS.items():
            read_parts(self, name, kind, needed=name == "touchdowns")
        read_entries(self, WHOLE)
        for name in ("bearings", "touchdowns", "unbalances", "supports"):
            for part in getattr(self, name):
                self.rotor.check_node(f"{name.removesuffix('s')} node", part.node)
                for node in getattr(part, "sensor_nodes", ()):
                    self.rotor.check_node("sensor node", node)
        for support in self.supports:
            support.at(self.speed)  # which refuses a speed that its table does not have
        for name in ("bearings", "touchdowns"):
            nodes = [part.node for part in getattr(self, name)]
            if twice := [node for place, node in enumerate(nodes) if node in nodes[:place]]:
                allowed = "a node of its own for each: several at one node are one with the sum of their forces"
                raise InputError(f"{name.removesuffix('s')} node", twice[0], allowed)
        for of_one_kind in zip(*(housing.parts(self) for housing in self.housings), strict=True):
            standing = list(chain(*of_one_kind))
            if len(set(standing)) < len(standing):
                raise InputError("housings", "two under one part", "one housing at most for each part")
        loops_in(self.rotor, self.bearings, self.shared_controllers)  # which refuses a bearing without a controller
        if self.rotor.bends and not all(each.bearing.is_compliant for each in self.touchdowns):
            allowed = "'kelvin-voigt' or 'hunt-crossley': a rigid wall has no answer on a rotor that bends"
            raise InputError("law", "rigid", allowed)

    def rows(self) -> list[tuple[str, str]]:
        """Its parts in the units of people."""
        return list(part_rows(self))

    @cached_property
    def _rows(self) -> list[np.ndarray]:
        """Where forces act and displacements are measured, each place once."""
        held = [self.rotor.tilt_at(each.node)[None] for each in self.supports if each.tilts]
        rows = np.concatenate([*loops_of(self), *held])
        return list(np.unique(rows[rows.any(axis=1)], axis=0))

    def basis(self, modes: int) -> Basis:
        """Vectors of the reduction with so many modes of the free rotor, at least the rigid ones."""
        return rubin_basis(self.rotor, self._rows, max(modes, RIGID))

    def finer_than(self, basis: Basis, times: float = MORE) -> Basis | None:
        """So many times as many vectors; ``None`` of all modes."""
        total = len(self.rotor.free_modes.frequencies)
        if basis.modes == total:
            return None
        return self.basis(min(total, basis.modes + math.ceil((times - 1.0) * len(basis.frequencies))))

    @checked
    def reduce(self, accuracy: Positive = ACCURACY) -> ReducedMachine:
        """Return the machine with as few vectors as this accuracy of contact forces needs.

        Parameters
        ----------
        accuracy : float
            Largest :attr:`ReducedMachine.error` allowed.

        Raises
        ------
        InputError
            The accuracy is no number above 0.
        """
        total = len(self.rotor.free_modes.frequencies)
        for modes in range(RIGID + 1, total):
            found = ReducedMachine(self, self.basis(modes))
            if found.error <= accuracy and found.comes_back:
                return found
        return self.with_modes(total)

    @checked
    def with_modes(self, modes: Count) -> ReducedMachine:
        """Return the machine with so many modes of the free rotor, two of which are rigid, and the vectors beside them; at most all modes."""
        return ReducedMachine(self, self.basis(modes))

    @cached_property
    def whole(self) -> ReducedMachine:
        """The machine with all modes: nothing is reduced."""
        return self.with_modes(len(self.rotor.free_modes.frequencies))

    @property
    def speed_range(self) -> tuple[float, float]:
        """Lowest and highest speed for which the coefficients of all its supports are known, rad/s."""
        tables = [each.speeds for each in self.supports if each.speeds]
        return max((each[0] for each in tables), default=0.0), min((each[-1] for each in tables), default=math.inf)

    @property
    def slowest(self) -> Slowest:
        """What decides whether it levitates at its speed, from all its modes: no reduction does."""
        return slowest_of(self.whole.equations, self.speed)

    @cached_property
    def model(self) -> Rotor:
        """Rotor of the reduced machine that levitates, for ``carom.simulate`` and all the others: see :attr:`ReducedMachine.model`."""
        return self.reduce().model


@checked
def rigid_rotor(
    *,
    mass: Any,
    polar_inertia: Any,
    diametral_inertia: Any,
    stations: Sequence[Any],
    pivot: Any = None,
    bearings: Sequence[MagneticBearing] = (),
    **others: Any,
) -> FlexibleMachine:
    """Return the machine of a rigid rotor with two complex degrees of freedom, displacement and tilt.

    Parameters
    ----------
    mass, polar_inertia, diametral_inertia, stations, pivot
        See :class:`RigidRotor`.
    bearings, **others
        Attributes of :class:`FlexibleMachine`: speed, clearance, touchdowns and so on; the ``node`` of a part is the number of its station, from 0 on.

    Raises
    ------
    InputError
        A value is not allowed.

    Examples
    --------
    >>> import carom as cm
    >>> from carom.rotors import PID, MagneticBearing, TouchdownPlane
    >>> ends = [MagneticBearing(node, "100 N/A", "-1e5 N/m", PID("6000 A/m", 0.0, "8 A s/m", "0.1 ms")) for node in (0, 1)]
    >>> wall = cm.parameters.TouchdownBearing("hunt-crossley", stiffness="5e7 N/m", dissipation="1 s/m")
    >>> machine = cm.rotors.rigid_rotor(
    ...     mass="12 kg",
    ...     polar_inertia="0.01 kg m^2",
    ...     diametral_inertia="0.15 kg m^2",
    ...     stations=["-0.12 m", "0.15 m"],
    ...     speed="20000 rpm",
    ...     clearance="0.25 mm",
    ...     bearings=ends,
    ...     touchdowns=[TouchdownPlane(node, wall, "20 mm", 0.15) for node in (0, 1)],
    ... )
    >>> [f"{whirl.frequency:.1f} Hz, {whirl.sense}" for whirl in cm.rotors.find_whirls(machine)[:2]]
    ['42.1 Hz, backward', '44.6 Hz, forward']
    """
    rotor = RigidRotor(mass, polar_inertia, diametral_inertia, stations, pivot)
    return FlexibleMachine(rotor, bearings=bearings, **others)


def part_rows(machine: FlexibleMachine) -> Iterator[tuple[str, str]]:
    """The rotor and what stands around it, part by part; places along the shaft are from its beginning."""
    from carom.rotors.loop_sensitivity import sampling_error  # which is about machines

    places = 1e3 * machine.rotor.node_places

    def at(*nodes: int) -> str:
        return f"{' and '.join(number(float(places[node])) for node in nodes)} mm"

    yield "rotor", machine.rotor.words
    yield "speed", f"{number(machine.speed / RPM)} rpm"
    for place, bearing in enumerate(machine.bearings, start=1):
        seen = "" if bearing.sensor_nodes == (bearing.node,) else f", sensors at {at(*bearing.sensor_nodes)}"
        own = f"{_entries(bearing, BEARING_FIELDS)}; {_law(bearing.controller)}"
        yield f"magnetic bearing {place}", f"at {at(bearing.node)}{seen}: {own}"
        if bearing.y is not None:
            other = f"{_entries(bearing.y, BEARING_FIELDS)}; {_law(bearing.y.controller)}"
            yield f"magnetic bearing {place}, second axis", other
    if error := sampling_error(machine):
        shown = f"exponents up to {number(error[0])} 1/s right to {error[1]:.1g}, beside the motion from sample to sample with all images"
        yield "sampled controllers", shown
    for place, shared in enumerate(machine.shared_controllers, start=1):
        laws = (f"{name} {_law(getattr(shared, name))}" for name in shared.parts)
        listed = ", ".join(str(number + 1) for number in shared.numbers(machine.bearings))
        yield f"shared controller {place}", f"of magnetic bearings {listed}: {'; '.join(laws)}"
    for place, support in enumerate(machine.supports, start=1):
        known = f"; from a table of {len(support.speeds)} speeds" if support.speeds else ""
        yield f"support {place}", f"at {at(support.node)}: {_entries(support.at(machine.speed), SUPPORT_FIELDS)}{known}"
    for place, housing in enumerate(machine.housings, start=1):
        parts = zip(("magnetic bearing", "touchdown bearing", "support"), housing.parts(machine), strict=True)
        under = "; ".join(f"{name} {', '.join(str(each + 1) for each in listed)}" for name, listed in parts if listed)
        yield f"housing {place}", f"{_entries(housing, HOUSING_FIELDS)}; under {under}"
    for place, (plane, clearance) in enumerate(zip(machine.touchdowns, machine.clearances, strict=True), start=1):
        fields = {name: PLANE_FIELDS[name] for name in ("clearance", *PLANE_FIELDS)}
        shown = f"{_entries(replace(plane, clearance=clearance), fields)}; {plane.bearing.words}"
        yield f"touchdown bearing {place}", f"at {at(plane.node)}: {shown}"
    for place, unbalance in enumerate(machine.unbalances, start=1):
        shown = f"{number(1e6 * unbalance.size)} g mm, at {format_angle(unbalance.angle)}"
        yield f"unbalance {place}", f"at {at(unbalance.node)}: {shown}"


def _law(controller: Controller | None) -> str:
    """A controller in words; of a sampled one how well it is approximated."""
    if controller is None:
        return "shared controller"
    whole = controller if isinstance(controller, Series) else Series(controller, ())
    listed = (whole.controller, *whole.filters)
    names = [_entries(each, each.fields) if hasattr(each, "fields") else type(each).__name__ for each in listed]
    space, rule, name = whole.sampled, getattr(whole.controller, "sampling", None), "; ".join(names)
    if space.sample_time is None:
        return name
    error, time = space.sampling_error(space.highest), 1e6 * space.sample_time
    return f"{name}{f', {rule}' if rule else ''}; in z every {number(time)} us with its hold, as a quotient in s right to {error:.1g} up to {number(space.highest / (2.0 * math.pi))} Hz"


def _entries(part: object, fields: Mapping[str, Field]) -> str:
    """Entries of a part by their names in the file, without those that are zero or not there."""
    given = ((name, getattr(part, name), field) for name, field in fields.items())
    return ", ".join(
        f"{name.replace('_', ' ')} {format_entry(field, value)}"
        for name, value, field in given
        if value and (name, value) != ("gain_factor", 1.0)
    )
