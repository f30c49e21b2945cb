"""Sections of a shaft, and what they are made of."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.parameters.fields import by_name, length_field
from carom.parameters.tables import read_entries

MATERIAL_FIELDS: Mapping[str, Field] = by_name(
    Field("elastic_modulus", "E", "elastic modulus", "a modulus", "Pa", 1e3, 1e15, '"211 GPa"'),
    Field("density", "", "density", "a density", "kg/m^3", 1.0, 1e6, '"7860 kg/m^3"'),
    Field("poisson_ratio", "", "Poisson's ratio", "a number", "", 0.0, 0.5, "0.3"),
)
SECTION_FIELDS: Mapping[str, Field] = by_name(
    length_field("length", "L", "length of the section", 1e-6, 1e3, '"94 mm"'),
    length_field("outer_diameter", "", "outer diameter of the section", 1e-6, 1e2, '"8 mm"'),
    length_field("inner_diameter", "", "inner diameter of the section", 1e-6, 1e2, '"4 mm"', True),
)


@dataclass(frozen=True)
class Material:
    """An elastic material; that of steel by default.

    Every value is a number in the SI unit below, or text with a unit such as ``"211 GPa"``.

    Parameters
    ----------
    elastic_modulus : float or str
        ``E``, Pa.
    density : float or str
        kg/m³.
    poisson_ratio : float or str
        From 0 to 0.5.

    Raises
    ------
    InputError
        A value is not of this kind or out of range.
    """

    elastic_modulus: float = 211e9
    density: float = 7850.0
    poisson_ratio: float = 0.3

    def __post_init__(self) -> None:
        read_entries(self, MATERIAL_FIELDS)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus ``G``, Pa."""
        return self.elastic_modulus / (2.0 * (1.0 + self.poisson_ratio))


@dataclass(frozen=True)
class ShaftSection:
    """A cylindrical section of a shaft, hollow or not.

    Every length is a number in m, or text with a unit such as ``"94 mm"``.

    Parameters
    ----------
    length, outer_diameter : float or str
        m.
    inner_diameter : float or str, optional
        m; 0 by default.
    material : Material, optional

    Raises
    ------
    InputError
        A value is not of this kind or out of range, or the inner diameter is not below the outer one.
    """

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    material: Material = Material()

    def __post_init__(self) -> None:
        read_entries(self, SECTION_FIELDS)
        if not isinstance(self.material, Material):
            raise InputError("material", shown(self.material), "carom.rotors.Material")
        if self.inner_diameter >= self.outer_diameter:
            allowed = f"a length below the outer diameter, {self.outer_diameter:g} m"
            raise InputError("inner_diameter", self.inner_diameter, allowed)

    @property
    def area(self) -> float:
        """Area of the cross-section, m²."""
        return math.pi / 4.0 * (self.outer_diameter**2 - self.inner_diameter**2)

    @property
    def second_moment(self) -> float:
        """Second moment of area about a diameter, m⁴."""
        return math.pi / 64.0 * (self.outer_diameter**4 - self.inner_diameter**4)

    @property
    def shear_coefficient(self) -> float:
        """Area that resists shear over the area, by Cowper (Journal of Applied Mechanics 33, 1966) for hollow circles."""
        ratio, nu = (self.inner_diameter / self.outer_diameter) ** 2, self.material.poisson_ratio
        whole = (1.0 + ratio) ** 2
        return 6.0 * (1.0 + nu) * whole / ((7.0 + 6.0 * nu) * whole + (20.0 + 12.0 * nu) * ratio)

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self.material.density * self.area * self.length
