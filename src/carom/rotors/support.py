"""Supports beside the magnetic bearings: seals, fluid-film bearings, springs, which may be anisotropic."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import MACHINE_FIELDS, Field, read_quantity
from carom.parameters.fields import RPM, by_name
from carom.parameters.formats import number
from carom.parameters.tables import read_entries
from carom.rotors.shaft_parts import read_node

Coefficient = Any
"""A number; of a support with a table a tuple of one for each speed."""
_ALONG = {"xx": "along x by a displacement along x", "xy": "along x by one along y", "yx": "along y by one along x", "yy": "along y by one along y"}  # fmt: skip

SUPPORT_FIELDS: Mapping[str, Field] = by_name(
    *(Field(f"k{axes}", f"k_{{{axes}}}", f"stiffness of a support, {along}", "a stiffness", "N/m", -1e15, 1e15, '"2e6 N/m"', True) for axes, along in _ALONG.items()),
    *(Field(f"c{axes}", f"c_{{{axes}}}", f"damping of a support, {along.replace('displacement', 'velocity')}", "a damping", "N s/m", -1e12, 1e12, '"500 N s/m"', True) for axes, along in _ALONG.items()),
    Field("rotating_damping", "c_r", "damping of a support that turns with the shaft", "a damping", "N s/m", 1e-30, 1e12, '"100 N s/m"', True),
    Field("tilt_stiffness", "", "moment of a support per tilt, alike in both directions", "a tilt stiffness", "N m/rad", -1e15, 1e15, '"2e4 N m/rad"', True),
    Field("tilt_damping", "", "moment of a support per rate of tilt", "a tilt damping", "N m s/rad", -1e12, 1e12, '"5 N m s/rad"', True),
)  # fmt: skip


def _directions(xx: float, xy: float, yx: float, yy: float) -> tuple[complex, complex]:
    """``a`` and ``b`` of the force ``−a z − b z̄``, of which ``−xx x − xy y`` is the part along x."""
    return 0.5 * complex(xx + yy, yx - xy), 0.5 * complex(xx - yy, yx + xy)


@dataclass(frozen=True)
class Support:
    """A spring and damper between the rotor and the ground at a node, with coefficients for both directions: a seal, a fluid-film bearing.

    It acts with, and without, magnetic bearings:

        f_x = −kxx x − kxy y − cxx ẋ − cxy ẏ,      f_y = −kyx x − kyy y − cyx ẋ − cyy ẏ,

    and with a damping ``c_r`` that turns with the shaft, such as that of a coupling or a sleeve, ``−c_r (ż − iΩz)`` more, with ``z = x + iy``.  A tilt
    ``θ`` is met by the moment ``−k_θ θ − c_θ θ̇``.

    Axes are those of the fixed frame, y upward as weight is counted.  With
    ``kxx = kyy``, ``kxy = −kyx``, and so the damping, both directions are alike; otherwise the rotor has twice as many modes.

    Parameters
    ----------
    node : int
    kxx, kyy : float, str, or sequence of these
        Stiffness, N/m.
    kxy, kyx, cxx, cxy, cyx, cyy : float, str, or sequence of these, optional
        Cross-coupled stiffness, N/m, and damping, N s/m; 0 by default.
    rotating_damping : float, str, or sequence of these, optional
        ``c_r``, N s/m; 0 by default.
    tilt_stiffness, tilt_damping : float, str, or sequence of these, optional
        ``k_θ``, N m/rad, and ``c_θ``, N m s/rad; 0 by default.
    speeds : sequence of float or str, optional
        Speeds of the shaft, rad/s, increasing, for each of which a coefficient that changes has a value; between them it is linear.  Beyond them
        it is not known.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, or there are not as many values as speeds.
    """

    node: int
    kxx: Coefficient
    kyy: Coefficient
    kxy: Coefficient = 0.0
    kyx: Coefficient = 0.0
    cxx: Coefficient = 0.0
    cxy: Coefficient = 0.0
    cyx: Coefficient = 0.0
    cyy: Coefficient = 0.0
    rotating_damping: Coefficient = 0.0
    tilt_stiffness: Coefficient = 0.0
    tilt_damping: Coefficient = 0.0
    speeds: Sequence[float] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "node", read_node("support node", self.node))
        listed = [name for name in SUPPORT_FIELDS if isinstance(getattr(self, name), list | tuple)]
        if not listed and self.speeds == ():
            read_entries(self, SUPPORT_FIELDS)
            return
        given = self.speeds if isinstance(self.speeds, list | tuple) else [self.speeds]
        speeds = tuple(read_quantity(replace(MACHINE_FIELDS["speed"], name="speeds"), each) for each in given)
        if len(speeds) < 2 or (np.diff(speeds) <= 0.0).any():
            allowed = "two or more speeds, increasing, where a coefficient has several values"
            raise InputError("speeds", shown(given), allowed)
        for name in listed:
            if len(getattr(self, name)) != len(speeds):
                allowed = f"{len(speeds)} values, one for each of the speeds, or one number"
                raise InputError(name, shown(getattr(self, name)), allowed)
        rows = [
            replace(self, speeds=(), **{name: getattr(self, name)[place] for name in listed})
            for place in range(len(speeds))
        ]
        for name in SUPPORT_FIELDS:
            values = tuple(getattr(row, name) for row in rows)
            object.__setattr__(self, name, values if name in listed else values[0])
        object.__setattr__(self, "speeds", speeds)

    def at(self, speed: float) -> Self:
        """Return it with the coefficients of one speed, rad/s.

        Raises
        ------
        InputError
            The speed is beyond those of its table.
        """
        if not self.speeds:
            return self
        low, high = self.speeds[0], self.speeds[-1]
        if not low <= speed <= high:
            allowed = f"{number(low / RPM)} to {number(high / RPM)} rpm: beyond, the coefficients of a support at node {self.node} are not known"
            raise InputError("speed", f"{number(speed / RPM)} rpm", allowed)
        values = ((name, getattr(self, name)) for name in SUPPORT_FIELDS)
        here: dict[str, Coefficient] = {
            name: np.interp(speed, self.speeds, each) for name, each in values if isinstance(each, tuple)
        }
        return replace(self, speeds=(), **here)

    def coefficients(self, speed: float) -> np.ndarray:
        """Damping and stiffness at a speed, 1/s, by velocity and displacement, then by their conjugates, shape (2, 2)."""
        at = self.at(speed)
        damping, stiffness = _directions(at.cxx, at.cxy, at.cyx, at.cyy), _directions(at.kxx, at.kxy, at.kyx, at.kyy)
        return np.array([damping, stiffness]).T + at.rotating_damping * turning(speed)

    def of_tilt(self, speed: float) -> np.ndarray:
        """The same of tilts."""
        at = self.at(speed)
        return np.array([[at.tilt_damping, at.tilt_stiffness], [0.0, 0.0]])

    @property
    def tilts(self) -> bool:
        """Whether it meets tilts."""
        return any(self.of_tilt(speed).any() for speed in self.speeds or (0.0,))

    @property
    def is_anisotropic(self) -> bool:
        """Whether both directions differ, at any of its speeds."""
        return any(self.coefficients(speed)[1].any() for speed in self.speeds or (0.0,))


def turning(speed: float) -> np.ndarray:
    """What a damping of one that turns with the shaft is in the fixed frame, ``ż − iΩz``: factors of damping and stiffness, none of conjugates."""
    return np.array([[1.0, -1j * speed], [0.0, 0.0]])
