"""Where kicks out of the resting motion end, on a grid over their two components."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from carom.basins import Basin, Share, map_basins
from carom.closed_forms import find_equilibria
from carom.disturbances import Coordinate, Disturbance, Grid, KickPlane, Starts, outward_from
from carom.disturbances.echo import angles_words
from carom.models import Jeffcott
from carom.motions import State
from carom.outcome import STEADY_WORDS
from carom.parameters import Case
from carom.parameters.told import told, told_angle
from carom.plots.cells import MotionLook, motion_looks
from carom.progress import ShowProgress

NOWHERE = 255
"""Cell without a start."""
FIRST = 0.31, 0.12
"""The kick with which the page begins: its parts outward and in the sense of rotation, of the largest."""


@dataclass(frozen=True)
class RestKick(KickPlane):
    """A kick like that of :class:`KickPlane`, of a rotor that cannot levitate and rests on the wall.

    Attributes
    ----------
    position : complex
        Where it rests, in clearances.
    """

    position: complex = 1.0 + 0.0j
    kind: ClassVar[str] = "rest-kick"

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Radial and tangential part."""
        return KickPlane(self.fastest).coordinates

    def starts(self, rotor: Jeffcott, *values: np.ndarray) -> Starts:  # type: ignore[override]
        """The resting motion with the velocity changed."""
        radial, tangential = values
        outward = self.position / abs(self.position)
        there = self.within(radial, tangential)
        return Starts.of(np.full(np.shape(radial), self.position), outward * (radial + 1j * tangential), there)


@dataclass(frozen=True)
class Rest:
    """The motion that kicks disturb.

    Attributes
    ----------
    words : str
    levitates : bool
    position : complex
        In clearances, co-rotating frame.
    outward : complex
        Direction of a kick outward, a number of modulus one.
    """

    words: str
    levitates: bool
    position: complex
    outward: complex

    def kicked(self, radial: float, tangential: float) -> State:
        """State just after a kick, whose parts are in ``c_r Ω``."""
        return State(self.position, self.outward * complex(radial, tangential))

    def kicks(self, fastest: float) -> Disturbance:
        """All kicks up to a size in ``c_r Ω``."""
        return KickPlane(fastest) if self.levitates else RestKick(fastest, self.position)


def rest_of(rotor: Jeffcott) -> Rest:
    """The motion that kicks disturb: levitation, otherwise the stable rub, otherwise rest where levitation meets the wall."""
    place = rotor.equilibrium
    if abs(place) < 1.0:
        return Rest(STEADY_WORDS["contact-free"], True, place, outward_from(rotor))
    for found in find_equilibria(rotor):
        if found.kind == "rub" and found.status == "admissible" and found.stable:
            return Rest(f"the {STEADY_WORDS['rub']}", False, complex(found.position), complex(found.position))
    on_wall = place / abs(place)
    return Rest("rest on the bearing", False, on_wall, on_wall)


@dataclass(frozen=True, eq=False)
class Ending:
    """One motion on which kicks end, with the look that figures give it.

    Attributes
    ----------
    share : float
        Share of all kicks up to the largest, 0 to 1.
    hatch : str
        Texture for print without colour; empty for none.
    """

    words: str
    colour: str
    hatch: str
    share: float


@dataclass(frozen=True, eq=False)
class KickMap:
    """Where kicks end.

    Attributes
    ----------
    rest : Rest
    basin : Basin
    fastest : float
        Largest kick, in ``c_r Ω``: the radius of the disc.
    cells : ndarray of uint8, shape (n, n)
        Index of the ending by tangential (rows) and radial component (columns), both ascending; ``NOWHERE`` without one.
    endings : tuple of Ending
    smallest_lost : float or None
        Smallest kick of the picture that does not come back, in ``c_r Ω``.
    """

    rest: Rest
    basin: Basin
    fastest: float
    cells: np.ndarray
    endings: tuple[Ending, ...]
    smallest_lost: float | None

    @property
    def share(self) -> Share:
        """Share of the kicks that comes back to levitation."""
        return self.basin.share_recovered


def largest_kick(case: Case) -> float:
    """Largest kick, the one to be survived: in m/s if the machine is known, so that axes stay where the speed changes."""
    scales = case.parameters.scales
    return case.requirement.own(scales).kick * (scales.velocity if scales else 1.0)


def opening_words(case: Case) -> str:
    """What the page begins with: the kicks of the picture, and the one that is drawn."""
    rotor = Jeffcott(case.parameters)
    fastest, rest = largest_kick(case) / (rotor.scales.velocity if rotor.scales else 1.0), rest_of(rotor)
    angle = told_angle(cmath.phase(complex(rest.kicked(*FIRST).velocity)) % math.tau)
    largest, outward, along = (told(part * fastest, "velocity", rotor.scales) for part in (1.0, *FIRST))
    return (
        f"{case.name}: kicks of up to {largest}, which disturb {rest.words}; drawn first is the kick of {outward} outward and "
        f"{along} in the sense of rotation, at {angle}; {angles_words(rotor.unbalance_phase)}"
    )


def map_kicks(rotor: Jeffcott, cells: int, largest: float, progress: ShowProgress = None) -> KickMap:
    """Follow a grid of kicks to where they end; ``largest`` is that of :func:`largest_kick`."""
    rest = rest_of(rotor)
    fastest = largest / (rotor.scales.velocity if rotor.scales else 1.0)
    basin = map_basins(rotor, Grid(rest.kicks(fastest), (cells, cells)), progress=progress)
    looks = motion_looks(basin)
    places = np.full(len(basin.motions) + 1, NOWHERE, np.uint8)
    for place, look in enumerate(looks):
        places[look.index] = place
    radial, tangential = (axis.middles(cells) for axis in basin.coordinates)
    lost = np.hypot(*np.meshgrid(radial, tangential, indexing="ij"))[basin.exists & ~basin.recovered]
    index = basin.dataset["motion"].values
    return KickMap(
        rest=rest,
        basin=basin,
        fastest=fastest,
        cells=np.ascontiguousarray(places[index].T),
        endings=tuple(_ending(look) for look in looks),
        smallest_lost=float(lost.min()) if lost.size else None,
    )


def _ending(look: MotionLook) -> Ending:
    return Ending(look.words, look.colour, look.look.hatch[:1], look.share)
