"""A shaft with discs as finite elements."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import read_quantity
from carom.parameters.fields import length_field
from carom.rotors.free_rotor import BendingRotor, RotorMatrices
from carom.rotors.shaft_parts import Damping, Disc, ShaftSection, beam_element, read_parts

ELEMENTS = 32
"""Elements of a shaft of equal sections, unless a length is stated."""
MOST_ELEMENTS = 500
"""With more, matrices take gigabytes; a shaft needs dozens."""
LONGEST = length_field("longest_element", "", "longest element", 1e-6, 1e3, '"20 mm"')


@dataclass(frozen=True, eq=False)
class FlexibleRotor(BendingRotor):
    """A shaft of cylindrical sections with discs, by finite elements of Timoshenko's beam, in SI units.

    Nodes are the boundaries of the sections: 0 is the beginning of the first one.  Each section is divided into elements.
    Coordinates are a complex displacement ``x + iy``, m, and a complex tilt ``dx/ds + i dy/ds`` at the ends of all elements in turn.

    Attributes
    ----------
    sections : sequence of ShaftSection
    discs : sequence of Disc
    damping : ProportionalDamping or ModalDamping
        There is no default: without damping of the bending modes, results of contacts with stiff walls depend on details of the model.
    longest_element : float or str, optional
        m; by default a 32nd of the shaft.
    internal : ProportionalDamping or ModalDamping, optional
        Damping that turns with the shaft, such as that of its material, ``D_i (ż − iΩz)``; a loss factor is twice the damping ratio.  By default there is none.

    Raises
    ------
    InputError
        A part is of another kind, or a disc sits at a node that the shaft does not have.
    """

    sections: Sequence[ShaftSection]
    discs: Sequence[Disc]
    damping: Damping
    longest_element: float | None = None
    internal: Damping | None = None

    def __post_init__(self) -> None:
        read_parts(self, "sections", ShaftSection, needed=True)
        if len(self.sections) > MOST_ELEMENTS:
            allowed = f"at most {MOST_ELEMENTS}; neighbouring sections of one diameter are one section"
            raise InputError("sections", len(self.sections), allowed)
        if not isinstance(self.damping, Damping):
            allowed = "carom.rotors.ModalDamping, such as ModalDamping(0.005), or ProportionalDamping"
            raise InputError("damping", shown(self.damping), allowed)
        self._check_internal()
        given = self.longest_element
        longest = self.length / ELEMENTS if given is None else read_quantity(LONGEST, given)
        object.__setattr__(self, "longest_element", longest)
        if sum(self.divisions) > MOST_ELEMENTS:
            allowed = f"a length with which the shaft has at most {MOST_ELEMENTS} elements, such as {max(self.length / ELEMENTS, 2.0 * longest):.3g} m"
            raise InputError("longest_element", shown(longest if given is None else given), allowed)
        self._read_discs()

    def _refused_modes(self) -> InputError:
        place, thin = min(enumerate(self.sections), key=lambda each: each[1].outer_diameter)
        thickest = max(section.outer_diameter for section in self.sections)
        allowed = f"a diameter nearer to that of the others (up to {thickest:g} m): beside them it bends like a hair; is its unit right?"
        return InputError(f"[[section]] {place + 1}: outer_diameter", thin.outer_diameter, allowed)

    @property
    def entries(self) -> Mapping[str, Any]:  # type: ignore[override]
        """The length of its elements."""
        return {"longest_element": self.longest_element}

    @property
    def length(self) -> float:
        """Length of the shaft, m."""
        return math.fsum(section.length for section in self.sections)

    @cached_property
    def divisions(self) -> tuple[int, ...]:
        """Number of elements of each section."""
        longest = cast("float", self.longest_element)
        # A section that is a whole number of longest elements, but for rounding, gets that number.
        return tuple(max(1, math.ceil(section.length / longest * (1.0 - 1e-12))) for section in self.sections)

    @cached_property
    def places(self) -> np.ndarray:  # type: ignore[override]
        """Where the ends of all elements lie along the shaft, m, shape (E + 1,)."""
        lengths = [
            section.length / count
            for section, count in zip(self.sections, self.divisions, strict=True)
            for _ in range(count)
        ]
        return np.append(0.0, np.cumsum(lengths))

    def place_of(self, node: int) -> int:
        """Number of the place of a node."""
        return sum(self.divisions[:node])

    @cached_property
    def node_places(self) -> np.ndarray:  # type: ignore[override]
        """Where its nodes are, from node 0 on, m."""
        return np.append(0.0, np.cumsum([section.length for section in self.sections]))

    @cached_property
    def matrices(self) -> RotorMatrices:  # type: ignore[override]
        """``M``, ``K`` and ``G``."""
        return self._with_discs(*self._assembled[:3])

    @property
    def axial_stiffness(self) -> np.ndarray | None:  # type: ignore[override]
        """Stiffness by axial forces; ``None`` without any."""
        return self._assembled[3] if self._assembled[3].any() else None

    @cached_property
    def _assembled(self) -> np.ndarray:
        matrices = np.zeros((4, 2 * len(self.places), 2 * len(self.places)))
        first = 0
        for section, count in zip(self.sections, self.divisions, strict=True):
            element = beam_element(section, section.length / count)
            for _ in range(count):
                matrices[:, first : first + 4, first : first + 4] += element
                first += 2
        return matrices

    @property
    def mass(self) -> float:  # type: ignore[override]
        """Mass, kg."""
        return math.fsum([section.mass for section in self.sections] + [disc.mass for disc in self.discs])
