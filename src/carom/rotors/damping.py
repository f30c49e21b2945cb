"""Damping of a shaft, as it is seen in the fixed frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from carom.parameters import Field
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries

PROPORTIONAL_FIELDS: Mapping[str, Field] = by_name(
    Field("of_mass", "", "damping over mass", "a rate", "1/s", 1e-12, 1e9, '"10 1/s"', True),
    Field("of_stiffness", "", "damping over stiffness", "a time", "s", 1e-15, 1e3, '"10 us"', True),
)
MODAL_FIELDS: Mapping[str, Field] = by_name(
    Field("ratio", "", "damping ratio of the bending modes", "a number", "", 1e-9, 0.9, "0.005", True)
)


@dataclass(frozen=True)
class ProportionalDamping:
    """A damping matrix ``αM + βK``.

    Parameters
    ----------
    of_mass : float or str
        ``α``, 1/s.  It slows down the rotor as a whole too, as air would.
    of_stiffness : float or str
        ``β``, s.

    Raises
    ------
    InputError
        A value is not of this kind or below zero.
    """

    of_mass: float = 0.0
    of_stiffness: float = 0.0

    def __post_init__(self) -> None:
        read_entries(self, PROPORTIONAL_FIELDS)

    def rate(self, frequency: float) -> float:
        """Damping over mass, 1/s, of a mode of the free rotor at rest with this frequency, rad/s."""
        return self.of_mass + self.of_stiffness * frequency**2


@dataclass(frozen=True)
class ModalDamping:
    """One damping ratio of all bending modes of the free rotor at rest; the rotor as a whole is not damped.

    Parameters
    ----------
    ratio : float or str
        ``ζ``; measured ones of solid shafts lie between 0.001 and 0.01.

    Raises
    ------
    InputError
        It is not a number from 0 to 0.9.
    """

    ratio: float

    def __post_init__(self) -> None:
        read_entries(self, MODAL_FIELDS)

    def rate(self, frequency: float) -> float:
        """Damping over mass, 1/s, of a mode of the free rotor at rest with this frequency, rad/s."""
        return 2.0 * self.ratio * frequency


Damping = ProportionalDamping | ModalDamping
"""What damps a shaft: each mode of the free rotor at rest by itself."""
