"""The largest force with which magnetic bearings control a rotor."""

from __future__ import annotations

from dataclasses import dataclass

from carom.base.arguments import NotNegative, Positive, checked
from carom.parameters.told import number


@checked
@dataclass(frozen=True)
class ControlLimit:
    """The largest control force ``ki i`` of all magnetic bearings of the planar rotor together, along each of two perpendicular axes.

    The controller asks for ``(k + pull) z + c ż`` with the stiffness and the damping of the levitation, and gets no more than this force along
    an axis.  The magnets pull the rotor away from the centre, whatever the current, by ``pull`` times its displacement.

    Attributes
    ----------
    force : float
        N.
    pull : float
        Size of the negative stiffness of all bearings, N/m.
    """

    force: Positive
    pull: NotNegative = 0.0

    @property
    def words(self) -> str:
        """Both in the units of people."""
        pull = f" against a negative stiffness of {number(self.pull)} N/m" if self.pull else ""
        return f"a control force of at most {number(self.force)} N along each axis{pull}"
