"""Find the parts of a picture that are too small to be visible and need a close-up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from carom.plots.plane import Complex

_SMALL = 0.15
"""Distance [c_r] within which a small path stays from its first point, and within which points join its close-up."""
_MOST = 2
"""Largest number of close-ups."""


@dataclass
class Closeup:
    """A square of the plane to be enlarged."""

    members: list[int] = field(default_factory=list)
    """Indices of the paths that it enlarges."""
    places: list[Complex] = field(default_factory=list)
    """Everything that it must show: complex positions."""

    @property
    def middle(self) -> complex:
        """Centre of the square."""
        low, high = self._corners()
        return (low + high) / 2.0

    @property
    def half(self) -> float:
        """Half the side of the square: twice the extent of its content, which leaves room for names beyond the wall."""
        low, high = self._corners()
        return max(high.real - low.real, high.imag - low.imag)

    def distance(self, place: complex) -> float:
        """Return the distance of a point from the nearest position shown."""
        return min(float(np.abs(shown - place).min()) for shown in self.places)

    def _corners(self) -> tuple[complex, complex]:
        every = np.concatenate(self.places)
        return complex(every.real.min(), every.imag.min()), complex(every.real.max(), every.imag.max())


def closeups(paths: Sequence[Complex], points: Sequence[complex], wall: float = 1.0) -> list[Closeup]:
    """Group small paths with the paths and points near them, in close-ups from left to right in the plane.

    Positions are complex, in the unit of the clearance `wall`.  The two with the most members are kept.
    """
    small = _SMALL * wall
    found: list[Closeup] = []
    for i, line in enumerate(paths):
        if float(np.abs(line - line[0]).max()) > small:
            continue
        near = [closeup for closeup in found if closeup.distance(complex(line[0])) < small]
        home = near[0] if near else Closeup()
        if not near:
            found.append(home)
        home.members.append(i)
        home.places.append(line)
    for point in points:
        for closeup in found:
            if closeup.distance(point) < small:
                closeup.places.append(np.array([point], dtype=complex))
                break
    kept = sorted(found, key=lambda closeup: -len(closeup.members))[:_MOST]
    return sorted(kept, key=lambda closeup: closeup.middle.real)
