"""Discs: rigid bodies on a shaft."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.parameters import Field
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.rotors.entries import inertia_field, read_node
from carom.rotors.sections import ShaftSection

DISC_FIELDS: Mapping[str, Field] = by_name(
    Field("mass", "", "mass of the disc", "a mass", "kg", 1e-12, 1e9, '"0.85 kg"', True),
    inertia_field("diametral_inertia", "", "inertia of the disc about a diameter", '"4.8e-4 kg m^2"'),
    inertia_field("polar_inertia", "", "inertia of the disc about the axis", '"4.0e-4 kg m^2"'),
)


@dataclass(frozen=True)
class Disc:
    """A rigid disc at a node of a shaft.

    Every value is a number in the SI unit below, or text with a unit.

    Parameters
    ----------
    node : int
        Boundary of the sections at which its centre of mass lies: 0 is the beginning of the first section.
    mass : float or str
        kg.
    diametral_inertia, polar_inertia : float or str
        Moments of inertia about a diameter through its centre of mass and about the axis of the shaft, kg m².

    Raises
    ------
    InputError
        A value is not of this kind or out of range, or the polar inertia is more than twice the diametral one.
    """

    node: int
    mass: float
    diametral_inertia: float
    polar_inertia: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "node", read_node("disc node", self.node))
        read_entries(self, DISC_FIELDS)
        check_inertias(self.polar_inertia, self.diametral_inertia)

    @classmethod
    @checked
    def of_body(cls, node: int, body: ShaftSection) -> Disc:
        """Disc with the form of a hollow cylinder.

        Parameters
        ----------
        node : int
        body : ShaftSection
            The cylinder; its length is the width of the disc.

        Raises
        ------
        InputError
            As for the disc itself.
        """
        polar = body.mass * (body.outer_diameter**2 + body.inner_diameter**2) / 8.0
        return cls(node, body.mass, 0.5 * polar + body.mass * body.length**2 / 12.0, polar)


def check_inertias(polar: float, diametral: float) -> None:
    """Refuse what no body has: of a flat disc the polar inertia is twice the diametral one, of every other body less; data are rounded."""
    if polar > 2.001 * diametral:
        raise InputError("polar_inertia", polar, f"at most twice the diametral inertia, {diametral:g} kg m^2")
