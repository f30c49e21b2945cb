"""By how much the vectors left out of a flexible machine change a motion with contact: twice as many follow it until its first contacts are over."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from carom.base.results import Result
from carom.models import Rotor
from carom.motions.load_sums import follow_loads
from carom.motions.loads import DropLoads, FirstContact
from carom.parameters.formats import number
from carom.rotors import ReducedMachine

BEYOND = 3.0
"""Error over the change by twice as many vectors, which are off too: of random machines the error was up to 2.3 times the change."""
LATER = 1.05
"""Share of the time of a first peak up to which it is waited for."""
MOST_EVENTS = 5_000
"""Events up to which the finer motion is followed."""


@dataclass(frozen=True, repr=False)
class ReductionError(Result):
    """How the peak forces of first contacts change with twice as many vectors.

    Attributes
    ----------
    vectors, finer : int
        Of the motion, and of the one it is compared with.
    changes : tuple of float or None
        For each touchdown bearing the change of the peak force of its first contact, relative to the larger of both; ``None`` where there is no contact.
    """

    vectors: int
    finer: int
    changes: tuple[float | None, ...]

    @property
    def error(self) -> float:
        """Estimated error of the peak forces of first contacts, relative: three times the largest change."""
        return BEYOND * max(each for each in self.changes if each is not None)

    @property
    def words(self) -> str:
        """The same in a sentence."""
        parts = [
            f"by {number(100.0 * change, 2)} % at touchdown bearing {place}"
            for place, change in enumerate(self.changes, start=1)
            if change is not None
        ]
        together = " and ".join([", ".join(parts[:-1]), parts[-1]]) if len(parts) > 1 else parts[0]
        return (
            f"With {self.finer} vectors in place of {self.vectors} the peak force of the first contact changes {together} along this motion; "
            f"estimated error of these forces: {number(100.0 * self.error, 2)} %. Later contacts may differ by more; a smaller accuracy takes more vectors."
        )

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        changes = list(self.changes)
        return {"vectors": self.vectors, "finer": self.finer, "first_peak_changes": changes, "error": self.error}


def reduction_error(
    reduced: ReducedMachine, loads: DropLoads, again: Callable[[ReducedMachine], tuple[Rotor, Any]]
) -> ReductionError | None:
    """Compare the loads of a motion with those by twice as many vectors; ``None`` of all modes, and without contact with compliant bearings.

    ``again`` gives the rotor and the start of the same motion by other vectors.
    """
    first = [plane.first for plane in loads.planes]
    touched = [each for each in first if each is not None]
    finer = reduced.finer
    if finer is None or not touched:
        return None
    until = max(LATER * each.peak_time + 2.0 * (each.peak_time - each.start) for each in touched)
    followed = follow_loads(*again(finer), until, max_events=MOST_EVENTS)
    changes = tuple(_change(one, plane.first) for one, plane in zip(first, followed.planes, strict=True))
    return ReductionError(reduced.vectors, finer.vectors, changes)


def _change(one: FirstContact | None, other: FirstContact | None) -> float | None:
    if one is None:  # what the finer one touches after that is not looked at
        return None
    forces = one.force, 0.0 if other is None else other.force
    return abs(forces[0] - forces[1]) / max(forces)
