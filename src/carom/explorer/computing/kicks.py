"""Where kicks, shocks or losses of a blade end, on a grid over their two components."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from carom.base.outcome import InputError, Outcome
from carom.base.progress import ShowProgress
from carom.basins import Share, map_basins
from carom.disturbances import Grid
from carom.disturbances.following import NO_START, follow
from carom.disturbances.machine_changes import levitating_before
from carom.explorer.computing.planes import DisturbancePlane, ShockPlane
from carom.explorer.computing.rest import Rest, rest_of
from carom.models import Rotor
from carom.plots.cells import motion_looks
from carom.plots.style import OUTCOMES, Look

NOWHERE = 255
"""Cell without a start."""
TRIED, TRIED_SLOWLY = 24, 6
"""Cells along each side of the pictures from which the first range is chosen, and of a rotor whose motions take long."""
MANY_MODES = 6
"""Modes from which motions take long to follow."""
RANGES = tuple(math.sqrt(2.0) ** power for power in range(8))
"""Ranges that the page may begin with, relative to what must be survived: no narrower, so that this is in the picture."""
MACHINES = 32
"""Number of machines whose first range is kept: it takes seconds to find where motions in the wall have to be followed."""
WANTED = 0.2
"""Share of a picture that should come back: then both what returns and what is lost are seen, and where they meet."""


@dataclass(frozen=True, eq=False)
class KickMap:
    """Where the disturbances of a plane end.

    Attributes
    ----------
    rest : Rest
    plane : DisturbancePlane
    largest : float
        Largest disturbance, in units of the equations: the radius of the disc.
    outcomes : ndarray of int, shape (n, n)
        Codes of :class:`~carom.base.outcome.Outcome` by first (rows) and second component, both ascending; -1 without a start.
    touched : ndarray of bool, shape (n, n)
        Whether the rotor met the wall.
    cells : ndarray of uint8, shape (n, n)
        Place of the ending by second (rows) and first component, both ascending; ``NOWHERE`` without one.
    endings : list of dict
        Motions on which disturbances end, with the looks that figures give them and their shares of all.
    """

    rest: Rest
    plane: DisturbancePlane
    largest: float
    outcomes: np.ndarray
    touched: np.ndarray
    cells: np.ndarray
    endings: list[dict[str, object]]

    @property
    def middles(self) -> np.ndarray:
        """Components of the middles of cells, in units of the equations."""
        return self.largest * ((np.arange(len(self.cells)) + 0.5) * 2.0 / len(self.cells) - 1.0)

    @property
    def exists(self) -> np.ndarray:
        """Which cells are starts, by first and second component."""
        return self.outcomes != NO_START

    @property
    def recovered(self) -> np.ndarray:
        """Which come back."""
        return self.outcomes == Outcome.LEVITATED

    @property
    def sizes(self) -> np.ndarray:
        """Sizes of the disturbances."""
        return np.hypot(self.middles[:, None], self.middles[None, :])

    @property
    def smallest_lost(self) -> float | None:
        """Smallest disturbance of the picture that does not come back, in units of the equations."""
        lost = self.sizes[self.exists & ~self.recovered]
        return float(lost.min()) if lost.size else None

    def share_up_to(self, size: float) -> Share:
        """Share that comes back of the disturbances up to a size in units of the equations, by area."""
        inside = self.exists & (self.sizes <= size)
        return Share.of(int((self.recovered & inside).sum()), int(inside.sum()), drawn=False)

    @property
    def share(self) -> Share:
        """Share of all that comes back."""
        return self.share_up_to(math.inf)


def map_kicks(
    rotor: Rotor, plane: DisturbancePlane, cells: int, largest: float, progress: ShowProgress = None
) -> KickMap:
    """Follow a grid of disturbances up to a size, in the units of planes, to where they end."""
    rest, own = rest_of(rotor), plane.own(largest, rotor.scales)
    if plane.name == "blade-loss":
        return _map_losses(rotor, rest, plane, cells, own)
    model = rest.kicks(own) if plane.name == "kick" else ShockPlane(own, plane.lasting(rotor))
    basin = map_basins(rotor, Grid(model, (cells, cells), 0.0), progress=progress)
    looks, places = motion_looks(basin), np.full(len(basin.motions) + 1, NOWHERE, np.uint8)
    for place, each in enumerate(looks):
        places[each.index] = place
    found = np.ascontiguousarray(places[basin.dataset["motion"].values].T)
    endings = [_ending(each.words, each.colour, each.look, each.share, each.name.outcome) for each in looks]
    return KickMap(rest, plane, own, basin.outcomes, basin.touched, found, endings)


def _ending(words: str, colour: str, look: Look, share: float, outcome: int) -> dict[str, object]:
    """A motion on which disturbances end; ``back`` says whether it is the levitation to which they should come back."""
    back = outcome == Outcome.LEVITATED
    return {"words": words, "colour": colour, "hatch": look.hatch[:1], "share": share, "back": back}


def _map_losses(rotor: Rotor, rest: Rest, plane: DisturbancePlane, cells: int, largest: float) -> KickMap:
    """The same of losses of a blade.

    Changes that leave one size of the unbalance lead to one machine.  So a cell shows the nearest of few sizes, each with many phases; motions are stated
    by their outcome alone.
    """
    before, middles = rotor.value("rho"), (np.arange(cells) + 0.5) * 2.0 / cells - 1.0
    changes = largest * (middles[:, None] + 1j * middles[None, :])
    exists = np.abs(changes) <= largest
    after, width = (before + changes)[exists], 2.0 * largest / cells
    phases = math.ceil(math.tau * (before + largest) / width)
    levels, which = np.unique(np.rint(np.abs(after) / width), return_inverse=True)
    machines = [rotor.with_changed_unbalance(level * width - before)[0] for level in levels.tolist()]
    turned = np.rint(np.angle(after) / math.tau * phases) / phases * math.tau
    found = follow(machines, levitating_before(rotor, turned, np.zeros(turned.shape)), which=which)
    outcomes, touched = np.full(exists.shape, NO_START), np.zeros(exists.shape, bool)
    outcomes[exists], touched[exists] = found.outcomes, found.impacts > 0
    exists = outcomes != NO_START
    if not exists.any():
        raise InputError(
            "disturbance",
            f"|U*| = {rotor.system.rest_radius:.6g}",
            "one of a machine that levitates inside the wall before it",
        )
    codes, counts = np.unique(outcomes[exists], return_counts=True)
    places = np.where(exists, np.searchsorted(codes, outcomes), NOWHERE).astype(np.uint8)
    looks, shares = [OUTCOMES[Outcome(code).label] for code in codes], (counts / counts.sum()).tolist()
    each = zip(looks, shares, codes.tolist(), strict=True)
    endings = [_ending(look.words, look.colour, look, share, code) for look, share, code in each]
    return KickMap(rest, plane, largest, outcomes, touched, np.ascontiguousarray(places.T), endings)


def is_slow(rotor: Rotor) -> bool:
    """Whether motions of a rotor take long to follow: it has many modes."""
    return len(rotor.system.exponents) > MANY_MODES


@lru_cache(maxsize=MACHINES)
def opening_range(rotor: Rotor, plane: DisturbancePlane) -> float:
    """The range with which the page begins, in the units of planes: one in which a good part comes back, and a good part is lost.

    Of a rotor whose motions take long it is the first at which some are lost.
    """
    best, least, slow = plane.usual, math.inf, is_slow(rotor)
    for times in RANGES[::2] if slow else RANGES:
        share = map_kicks(rotor, plane, TRIED_SLOWLY if slow else TRIED, times * plane.usual).share.fraction
        if (apart := abs(math.log(max(share, 1e-9) / WANTED))) < least:
            best, least = times * plane.usual, apart
        if share < (1.0 if slow else WANTED):
            break
    return best


def representative_kicks(found: KickMap) -> tuple[tuple[float, float], tuple[float, float]]:
    """Two disturbances of one size where there are such, of which the first comes back after contact and the second is lost.

    Both are far from where the other outcome begins.  The components are in units of the equations.
    """
    lost, back = found.exists & ~found.recovered, found.recovered & found.touched
    inside = {"lost": _depth(lost), "back": _depth(found.recovered)}
    inside["back"] = np.where(back, inside["back"], 0.0) if back.any() else inside["back"]
    rings = np.minimum((found.sizes / found.largest * TRIED).astype(int), TRIED - 1)
    best, pair = -1.0, None
    for ring in range(TRIED):
        here = [np.where(rings == ring, inside[name], 0.0) for name in ("back", "lost")]
        depth = min(float(part.max()) for part in here)
        if depth > best:
            best, pair = depth, [int(part.argmax()) for part in here]
    if best <= 0.0 or pair is None:
        inside = {name: np.where(found.sizes > 0.1 * found.largest, depth, 0.0) for name, depth in inside.items()}
        pair = [
            int(inside[name].argmax()) if inside[name].any() else _beside(found, turn)
            for name, turn in (("back", 1), ("lost", -1))
        ]
    first, second = (np.unravel_index(place, found.sizes.shape) for place in pair)
    middles = found.middles
    return (
        (float(middles[first[0]]), float(middles[first[1]])),
        (float(middles[second[0]]), float(middles[second[1]])),
    )


def _depth(area: np.ndarray) -> np.ndarray:
    """Number of times that the edge of an area can be taken away before a cell goes."""
    from scipy.ndimage import distance_transform_cdt  # type: ignore[import-untyped]  # takes 50 ms to load

    depth: np.ndarray = distance_transform_cdt(np.pad(area, 1), "taxicab")[1:-1, 1:-1]
    return depth


def _beside(found: KickMap, turn: int) -> int:
    """Some cell well inside the disc."""
    cells = len(found.cells)
    return int(np.ravel_multi_index((int(0.65 * cells), int((0.5 + 0.2 * turn) * cells)), (cells, cells)))
