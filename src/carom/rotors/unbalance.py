"""Response of a levitating flexible rotor to its unbalance, over the speed of the shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.arguments import checked
from carom.outcome import InputError
from carom.parameters import Zones
from carom.results import Result
from carom.rotors.equations import loops_of
from carom.rotors.flexible_machine import FlexibleMachine
from carom.rotors.whirls import speeds_of


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleResponse(Result):
    """Synchronous whirl of a levitating flexible rotor without contact; all amplitudes are radii, with the angle at time zero.

    Attributes
    ----------
    speeds : ndarray, shape (m,)
        rad/s.
    touchdowns : ndarray of complex, shape (m, P)
        At the touchdown bearings, relative to their mounts, m.
    sensors : ndarray of complex, shape (m, B)
        What the sensors of each magnetic bearing measure, m.
    currents : ndarray of complex, shape (m, B)
        A, before a limit of the amplifier.
    machine : FlexibleMachine
    """

    speeds: np.ndarray
    touchdowns: np.ndarray
    sensors: np.ndarray
    currents: np.ndarray
    machine: FlexibleMachine

    figure: ClassVar[str] = "flexible_response"
    rests_on: ClassVar = ()

    @property
    def room(self) -> np.ndarray:
        """Clearance that is left at each touchdown bearing, as a share, shape (m, P); below 0 it touches."""
        return np.asarray(1.0 - np.abs(self.touchdowns) / self.machine.clearances)

    @property
    def zones(self) -> tuple[str, ...]:
        """Zone of ISO 14839-2 at each speed: the worst of all touchdown bearings."""
        largest = (np.abs(self.touchdowns) / self.machine.clearances).max(axis=1)
        return tuple(Zones().zone(float(each)) for each in largest)


@checked
def unbalance_response(flexible: FlexibleMachine, speeds: Sequence[float]) -> FlexibleResponse:
    """Compute the response to the unbalances of a flexible machine, from all its modes.

    Parameters
    ----------
    flexible : FlexibleMachine
    speeds : sequence of float
        rad/s, above 0.

    Raises
    ------
    InputError
        There is no unbalance, no speed, or one that is not above 0.

    See Also
    --------
    carom.rotors.campbell : where its resonances are
    """
    if not flexible.unbalances:
        raise InputError("unbalances", None, "one or more carom.rotors.Unbalance")
    listed, whole = speeds_of(speeds), flexible.whole
    at = np.array([whole.equations.response(speed) for speed in listed.tolist()])
    seen = loops_of(flexible.rotor, flexible.bearings, flexible.touchdowns).sensors @ whole.basis.shapes
    return FlexibleResponse(
        speeds=listed,
        touchdowns=at @ whole.equations.planes.T,
        sensors=at[:, : whole.vectors] @ seen.T,
        currents=at @ whole.equations.currents.T,
        machine=flexible,
    )
