"""Response of a levitating flexible rotor to its unbalance, over the speed of the shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from carom.arguments import checked
from carom.outcome import InputError
from carom.parameters import Zones
from carom.results import Result
from carom.rotors.equations import Equations, loops_of
from carom.rotors.flexible_machine import FlexibleMachine
from carom.rotors.whirls import speeds_of


class Ellipses(NamedTuple):
    """Ellipses ``ahead e^{iΩt} + behind e^{−iΩt}`` round which displacements go; both are complex and of one shape, with the angles at time zero."""

    ahead: np.ndarray
    behind: np.ndarray

    @property
    def major(self) -> np.ndarray:
        """Longer half axes: the largest displacements."""
        return np.asarray(np.abs(self.ahead) + np.abs(self.behind))

    @property
    def minor(self) -> np.ndarray:
        """Shorter half axes; below zero where they go round against the shaft."""
        return np.asarray(np.abs(self.ahead) - np.abs(self.behind))

    @property
    def direction(self) -> np.ndarray:
        """Angles of the longer half axes in the fixed frame, rad."""
        return np.asarray(0.5 * (np.angle(self.ahead) + np.angle(self.behind)))


@dataclass(frozen=True, eq=False, repr=False)
class FlexibleResponse(Result):
    """Synchronous whirl of a levitating flexible rotor without contact, ``ahead e^{iΩt} + behind e^{−iΩt}``.

    It goes round circles, and there is no part that goes behind, unless supports act differently in two directions.

    Attributes
    ----------
    speeds : ndarray, shape (m,)
        rad/s.
    touchdowns : ndarray of complex, shape (m, P)
        What goes ahead at the touchdown bearings, relative to their mounts, m.
    sensors : ndarray of complex, shape (m, B)
        What the sensors of each magnetic bearing measure of that, m.
    currents : ndarray of complex, shape (m, B)
        A, before a limit of the amplifier.
    machine : FlexibleMachine
    behind : tuple of ndarray of complex
        What goes behind in these three, of their shapes.
    """

    speeds: np.ndarray
    touchdowns: np.ndarray
    sensors: np.ndarray
    currents: np.ndarray
    machine: FlexibleMachine
    behind: tuple[np.ndarray, np.ndarray, np.ndarray]

    figure: ClassVar[str] = "flexible_response"
    rests_on: ClassVar = ()

    @property
    def touchdown_ellipses(self) -> Ellipses:
        """Ellipses at the touchdown bearings."""
        return Ellipses(self.touchdowns, self.behind[0])

    @property
    def sensor_ellipses(self) -> Ellipses:
        """Ellipses that the sensors measure."""
        return Ellipses(self.sensors, self.behind[1])

    @property
    def current_ellipses(self) -> Ellipses:
        """Ellipses of the currents."""
        return Ellipses(self.currents, self.behind[2])

    @property
    def room(self) -> np.ndarray:
        """Clearance that is left at each touchdown bearing, as a share, shape (m, P); below 0 it touches."""
        return np.asarray(1.0 - self.touchdown_ellipses.major / self.machine.clearances)

    @property
    def zones(self) -> tuple[str, ...]:
        """Zone of ISO 14839-2 at each speed, by the largest displacement: the worst of all touchdown bearings."""
        largest = (self.touchdown_ellipses.major / self.machine.clearances).max(axis=1)
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
    ahead, behind = np.swapaxes([_answer(whole.equations, speed) for speed in listed.tolist()], 0, 1)
    seen = loops_of(flexible.rotor, flexible.bearings, flexible.touchdowns).sensors @ whole.basis.shapes

    def seen_of(part: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        held = whole.equations
        return part @ held.planes.T, part[:, : whole.vectors] @ seen.T, part @ held.currents.T

    touchdowns, sensors, currents = seen_of(ahead)
    return FlexibleResponse(listed, touchdowns, sensors, currents, flexible, seen_of(behind))


def _answer(equations: Equations, speed: float) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates (n,) of what goes round with the shaft and of what goes against it, at time zero."""
    if not equations.mirrored:
        ahead = equations.response(speed)
        return ahead, np.zeros_like(ahead)
    ahead, behind = np.split(equations.both.response(speed), 2)
    return ahead, behind.conj()
