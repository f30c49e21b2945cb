"""What a shaft is made of: sections of a material, with the matrices of their elements, discs, and damping.

An element is a beam by Timoshenko: bending, shear, rotary inertia and gyroscopic moments.  The shaft is round, so both planes of bending
are one complex displacement ``w = x + iy`` and one tilt ``φ`` of the cross-section, which is ``dw/ds`` without shear.  Between the ends both follow the static course without loads, with
``Φ = 12EI/(κGA L²)`` and ``ξ = s/L``,

    (1 + Φ) w = (1 − 3ξ² + 2ξ³ + Φ(1 − ξ)) w₁ + L (ξ − 2ξ² + ξ³ + Φ(ξ − ξ²)/2) φ₁ + …,      φ = dw/ds − γ,

with one shear angle ``γ``, and the matrices are the integrals of the energies (see for example Friswell, Penny, Garvey and Lees, *Dynamics of
Rotating Machines*, 2010, sections 5.4 and 5.5).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval

from carom.base.arguments import checked
from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.parameters.fields import by_name, length_field
from carom.parameters.tables import read_entries


def read_node(name: str, given: object) -> int:
    """The number of a node; whether the shaft has it is seen where both meet."""
    if isinstance(given, bool) or not hasattr(given, "__index__") or given.__index__() < 0:
        raise InputError(name, shown(given), "the number of a node: a whole number of at least 0")
    return int(given.__index__())


def read_parts(whole: object, name: str, kind: type, needed: bool = False) -> None:
    """Make an attribute a tuple of parts of a kind; refuse others, and none where one is needed."""
    given: object = getattr(whole, name)
    listed = tuple(given) if isinstance(given, Iterable) else (None,)
    if not all(isinstance(each, kind) for each in listed) or (needed and not listed):
        least = ", one or more" if needed else ""
        raise InputError(name, shown(given), f"a sequence of carom.rotors.{kind.__name__}{least}")
    object.__setattr__(whole, name, listed)


def inertia_field(name: str, symbol: str, words: str, example: str, zero: bool = True) -> Field:
    """A moment of inertia."""
    return Field(name, symbol, words, "a moment of inertia", "kg m^2", 1e-15, 1e9, example, zero)


MATERIAL_FIELDS: Mapping[str, Field] = by_name(
    Field("elastic_modulus", "E", "elastic modulus", "a modulus", "Pa", 1e3, 1e15, '"211 GPa"'),
    Field("density", "", "density", "a density", "kg/m^3", 1.0, 1e6, '"7860 kg/m^3"'),
    Field("poisson_ratio", "", "Poisson's ratio", "a number", "", 0.0, 0.5, "0.3"),
    Field("shear_modulus", "G", "shear modulus, where it does not follow from Poisson's ratio", "a modulus", "Pa", 1e3, 1e15, '"5 GPa"'),
)  # fmt: skip
AXIAL_FORCE = Field(
    "axial_force", "", "axial force in the shaft, tension above zero", "a force", "N", -1e12, 1e12, '"-5 kN"', True
)
SECTION_FIELDS: Mapping[str, Field] = by_name(
    length_field("length", "L", "length of the section", 1e-6, 1e3, '"94 mm"'),
    length_field("outer_diameter", "", "outer diameter of the section", 1e-6, 1e2, '"8 mm"'),
    length_field("inner_diameter", "", "inner diameter of the section", 1e-6, 1e2, '"4 mm"', True),
    AXIAL_FORCE,
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
    shear_modulus : float or str, optional
        ``G``, Pa; by default ``E/(2(1 + ν))``.  Of a composite it is another one.

    Raises
    ------
    InputError
        A value is not of this kind or out of range.
    """

    elastic_modulus: float = 211e9
    density: float = 7850.0
    poisson_ratio: float = 0.3
    shear_modulus: float | None = None

    def __post_init__(self) -> None:
        read_entries(self, MATERIAL_FIELDS)

    @property
    def shear(self) -> float:
        """Shear modulus ``G``, Pa."""
        return self.shear_modulus or self.elastic_modulus / (2.0 * (1.0 + self.poisson_ratio))


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
    axial_force : float or str, optional
        N, tension above zero, which keeps its size and its direction along the axis; 0 by default.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, or the inner diameter is not below the outer one.
    """

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    material: Material = Material()
    axial_force: float = 0.0

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


POINTS, WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Four points integrate polynomials of degree 7 exactly; those here have degree 6."""


def beam_element(section: ShaftSection, length: float) -> np.ndarray:
    """Matrices of ``w₁, φ₁, w₂, φ₂`` of an element of a section with this length, m, shape (4, 4, 4): those of ``M ẅ − iΩG ẇ + (K + K_N) w = 0``.

    First mass, kg, kg m and kg m², and stiffness, N/m, N and N m; then the gyroscopic one, by the speed of the shaft, rad/s, and the stiffness by an axial
    force ``N``, which has the energy ``½ N ∫ |dw/ds|² ds``.
    """
    material = section.material
    bending = material.elastic_modulus * section.second_moment
    shear = section.shear_coefficient * material.shear * section.area
    displacement, slope, curvature, angle = _courses(length, 12.0 * bending / (shear * length**2))

    def integral(courses: np.ndarray) -> np.ndarray:
        weighted: np.ndarray = 0.5 * length * np.einsum("k,ik,jk->ij", WEIGHTS, courses, courses)
        return weighted

    rotary = material.density * section.second_moment * integral(slope - angle[:, None])
    return np.array(
        [
            material.density * section.area * integral(displacement) + rotary,
            bending * integral(curvature) + shear * length * np.outer(angle, angle),
            2.0 * rotary,  # the polar moment of a round section is twice that about a diameter
            section.axial_force * integral(slope),
        ]
    )


def _courses(length: float, phi: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, its slope, and the curvature (4, k) at the places of integration, and the shear angle (4,), for ones at each end in turn."""
    half, at = 0.5 * phi, 0.5 * (1.0 + POINTS)
    # By powers of the place, in units of the length.
    course = np.array(
        [
            [1.0 + phi, -phi, -3.0, 2.0],
            [0.0, 1.0 + half, -2.0 - half, 1.0],
            [0.0, phi, 3.0, -2.0],
            [0.0, -half, half - 1.0, 1.0],
        ]
    ).T
    units = np.array([1.0, length, 1.0, length]) / (1.0 + phi)
    angle = np.array([-phi, -half, phi, -half]) * units / length
    displacement, slope, curvature = (
        polyval(at, polyder(course, order)) * (units / length**order)[:, None] for order in range(3)
    )
    return displacement, slope, curvature, angle


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
