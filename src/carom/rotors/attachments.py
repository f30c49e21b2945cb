"""What is attached to a rotor beside its magnetic bearings: unbalances, and touchdown bearings around it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from carom.base.outcome import InputError, shown
from carom.parameters import MACHINE_FIELDS, Field, TouchdownBearing
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.rotors.shaft_parts import read_node

UNBALANCE_FIELDS: Mapping[str, Field] = by_name(
    Field("size", "", "unbalance", "an unbalance", "kg m", 1e-15, 1e6, '"10 g mm"', True),
    Field("angle", "", "angle of the unbalance", "an angle", "rad", -1e6, 1e6, '"90 deg"'),
)
HOUSING_FIELDS: Mapping[str, Field] = by_name(
    Field("mass", "", "mass of a housing", "a mass", "kg", 1e-12, 1e9, '"20 kg"'),
    Field("stiffness", "", "stiffness of the mount of a housing", "a stiffness", "N/m", 1e-9, 1e15, '"5e7 N/m"', True),
    Field("damping", "", "damping of the mount of a housing", "a damping", "N s/m", 1e-12, 1e12, '"500 N s/m"', True),
)
PLANE_FIELDS: Mapping[str, Field] = {
    **{name: MACHINE_FIELDS[name] for name in ("rotor_radius", "friction", "clearance")},
    "farthest": Field("farthest", "", "distance followed, in clearances", "a number", "", 1.0, 1e6, "2"),
}


@dataclass(frozen=True)
class Unbalance:
    """An unbalance at a node.

    Parameters
    ----------
    node : int
    size : float or str
        Mass times its distance from the axis, kg m, or text such as ``"10 g mm"``.
    angle : float or str, optional
        Where it is on the rotor, rad, in the sense of rotation from one mark for all.

    Raises
    ------
    InputError
        A value is not of this kind or out of range.
    """

    node: int
    size: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "node", read_node("unbalance node", self.node))
        read_entries(self, UNBALANCE_FIELDS)


@dataclass(frozen=True)
class Housing:
    """A mass on a mount to the ground, such as a pedestal, on which magnetic bearings with their sensors, touchdown bearings and supports stand.

    It moves parallel to itself, alike in both directions: magnets react on it, sensors and touchdown bearings measure and meet what the rotor does
    relative to it, with levitation and without.

    Parameters
    ----------
    mass, stiffness, damping : float or str
        kg, N/m, N s/m.
    bearings, touchdowns, supports : sequence of int, optional
        Numbers of the parts that stand on it, from 1; by default all parts of the machine.

    Raises
    ------
    InputError
        A value is not of this kind or out of range.
    """

    mass: float
    stiffness: float
    damping: float = 0.0
    bearings: Sequence[int] | None = None
    touchdowns: Sequence[int] | None = None
    supports: Sequence[int] | None = None

    def __post_init__(self) -> None:
        read_entries(self, HOUSING_FIELDS)
        for name in SEATED:
            given: object = getattr(self, name)
            listed = tuple(given) if isinstance(given, Iterable) and not isinstance(given, str) else given
            if listed is not None and not (isinstance(listed, tuple) and all(isinstance(each, int) for each in listed)):
                raise InputError(name, shown(given), "a list of numbers of parts, from 1")
            object.__setattr__(self, name, listed)

    def parts(self, machine: object) -> tuple[tuple[int, ...], ...]:
        """Numbers of the magnetic bearings, touchdown bearings and supports of a machine that stand on it, from 0 on."""
        everything = all(getattr(self, name) is None for name in SEATED)
        found = []
        for name in SEATED:
            count, listed = len(getattr(machine, name)), getattr(self, name) or ()
            if not set(listed) <= set(range(1, count + 1)):
                raise InputError(f"[[housing]]: {name}", shown(list(listed)), f"numbers from 1 to {count}")
            found.append(tuple(range(count)) if everything else tuple(number - 1 for number in listed))
        return tuple(found)


SEATED = ("bearings", "touchdowns", "supports")
"""Parts that may stand on a housing."""


@dataclass(frozen=True)
class TouchdownPlane:
    """A node at which a touchdown bearing stands around the rotor.

    Parameters
    ----------
    node : int
    bearing : carom.parameters.TouchdownBearing
        It is compliant, unless the rotor is rigid: on one that bends a rigid wall would have no answer that stays as modes are added.  A restitution
        in place of the damping of Kelvin–Voigt is that of the whole mass.
    rotor_radius : float or str
        Radius of the rotor there, m.
    friction : float or str
    clearance : float or str, optional
        Radial clearance there, m; by default that of the machine.
    farthest : float, optional
        Distance from the centre, in clearances, up to which the rotor is followed in a compliant wall; 2 by default.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, a rigid bearing has no restitution, or its centre lies off the place of levitation.
    """

    node: int
    bearing: TouchdownBearing
    rotor_radius: float
    friction: float
    clearance: float | None = None
    farthest: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "node", read_node("touchdown node", self.node))
        if not isinstance(self.bearing, TouchdownBearing):
            raise InputError("bearing", shown(self.bearing), "carom.parameters.TouchdownBearing")
        if not self.bearing.is_compliant and self.bearing.restitution is None:
            raise InputError("restitution", None, "the law rigid needs it, such as restitution = 0.8")
        if self.bearing.offset:
            raise InputError(
                "offset", self.bearing.offset, "0: bearings of a flexible rotor are centred where it levitates"
            )
        read_entries(self, PLANE_FIELDS)

    def stiffness(self, energy: float) -> float:
        """Stiffness, N/m, at the depth to which this energy, J, presses it in."""
        stiffness, n = self.bearing.spring
        depth: float = ((n + 1.0) * energy / stiffness) ** (1.0 / (n + 1.0))
        return stiffness * n * depth ** (n - 1.0)
