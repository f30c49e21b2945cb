"""Supports beside the magnetic bearings: seals, fluid-film bearings, springs, which may be anisotropic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from carom.parameters import Field
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.rotors.shaft_parts import read_node

_AXES = ("xx", "xy", "yx", "yy")
_ALONG = {"xx": "along x by a displacement along x", "xy": "along x by one along y", "yx": "along y by one along x", "yy": "along y by one along y"}  # fmt: skip


def _stiffness(axes: str) -> Field:
    return Field(f"k{axes}", f"k_{{{axes}}}", f"stiffness of a support, {_ALONG[axes]}", "a stiffness", "N/m", -1e15, 1e15, '"2e6 N/m"', True)  # fmt: skip


def _damping(axes: str) -> Field:
    words = f"damping of a support, {_ALONG[axes].replace('displacement', 'velocity')}"
    return Field(f"c{axes}", f"c_{{{axes}}}", words, "a damping", "N s/m", -1e12, 1e12, '"500 N s/m"', True)


SUPPORT_FIELDS: Mapping[str, Field] = by_name(*map(_stiffness, _AXES), *map(_damping, _AXES))


class Directions(NamedTuple):
    """A linear force ``−a z − b z̄`` in two directions."""

    alike: complex
    """``a``, by the displacement or the velocity."""
    across: complex
    """``b``, by its conjugate: 0 where the directions are alike."""

    @classmethod
    def of(cls, xx: float, xy: float, yx: float, yy: float) -> Directions:
        """Of the coefficients of both axes: a force ``−xx x − xy y`` along x."""
        return cls(0.5 * complex(xx + yy, yx - xy), 0.5 * complex(xx - yy, yx + xy))


@dataclass(frozen=True)
class Support:
    """A spring and damper between the rotor and the ground at a node, with coefficients for both directions: a seal, a fluid-film bearing, a pedestal.

    It acts with, and without, magnetic bearings:

        f_x = −kxx x − kxy y − cxx ẋ − cxy ẏ,      f_y = −kyx x − kyy y − cyx ẋ − cyy ẏ.

    Axes are those of the fixed frame, y upward as weight is counted.  Coefficients are those of the speed of the machine.  With
    ``kxx = kyy``, ``kxy = −kyx``, and so the damping, both directions are alike; otherwise the rotor has twice as many modes.

    Parameters
    ----------
    node : int
    kxx, kyy : float or str
        Stiffness, N/m.
    kxy, kyx, cxx, cxy, cyx, cyy : float or str, optional
        Cross-coupled stiffness, N/m, and damping, N s/m; 0 by default.

    Raises
    ------
    InputError
        A value is not of this kind or out of range.
    """

    node: int
    kxx: float
    kyy: float
    kxy: float = 0.0
    kyx: float = 0.0
    cxx: float = 0.0
    cxy: float = 0.0
    cyx: float = 0.0
    cyy: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "node", read_node("support node", self.node))
        read_entries(self, SUPPORT_FIELDS)

    @property
    def stiffness(self) -> Directions:
        """Stiffness, N/m."""
        return Directions.of(self.kxx, self.kxy, self.kyx, self.kyy)

    @property
    def damping(self) -> Directions:
        """Damping, N s/m."""
        return Directions.of(self.cxx, self.cxy, self.cyx, self.cyy)
