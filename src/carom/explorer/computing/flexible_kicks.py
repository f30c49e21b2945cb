"""Where kicks of a flexible machine end: a picture that is filled in, coarse at first."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from carom.basins import Share
from carom.disturbances import VelocityKick
from carom.disturbances.following import NO_START, follow
from carom.explorer.computing.kicks import NOWHERE, Ending
from carom.models import Rotor, rotor_of
from carom.outcome import Outcome
from carom.parameters import Case, Scales
from carom.plots.style import OUTCOMES
from carom.progress import Reporter, ShowProgress

CELLS = 36
"""Cells along each side of the picture: some 1,000 kicks."""
COARSE, FINE = (9, 3), (1,)
"""Cells along each side of the squares that one kick, that of their middle, stands for: of the first picture, and of the fine one."""
FOLLOWING = "following kicks"
AT_ONCE = 1.0
"""Seconds after which what has been found is shown."""
FEWEST, MOST = 8, 256
"""Kicks that are followed together."""
TIMES, DIRECTIONS = (2.0, 4.0, 8.0, 16.0), 8
"""Multiples of what must be survived, and directions, that are tried for the range of the picture."""
ROOM = 1.4
"""Range of the picture over the first of these sizes of which a kick is lost."""
MACHINES = 32
"""Number of machines whose first range is kept."""
MOST_EVENTS = 20_000
"""Events after which a kick is given up."""


@dataclass(frozen=True, eq=False)
class KickPicture:
    """Where kicks end, as far as they have been followed; their directions are those of the fixed frame at the instant of the kick.

    Attributes
    ----------
    largest : float
        Largest kick, in units of the equations.
    outcomes : ndarray of int, shape (n, n)
        Codes of :class:`~carom.outcome.Outcome` by upward (rows) and rightward part, both ascending; -1 without a kick.
    followed : ndarray of bool, shape (n, n)
        Which kicks have been followed; each other cell has the outcome of the nearest that is known, if there is one.
    """

    largest: float
    outcomes: np.ndarray
    followed: np.ndarray

    @property
    def sizes(self) -> np.ndarray:
        """Sizes of the kicks, in units of the equations."""
        middles = self.largest * _middles(len(self.outcomes))
        return np.hypot(middles[:, None], middles[None, :])

    def share_up_to(self, size: float) -> Share:
        """Share that comes back of those followed, up to a size in units of the equations."""
        inside = self.followed & (self.outcomes != NO_START) & (self.sizes <= size)
        back = inside & (self.outcomes == Outcome.LEVITATED)
        return Share.of(int(back.sum()), int(inside.sum()), drawn=False)

    @property
    def share(self) -> Share:
        """Share of the area of the picture that comes back, as far as it is known: small kicks are followed first, so of those followed more do."""
        known = self.outcomes != NO_START
        return Share.of(int((self.outcomes == Outcome.LEVITATED).sum()), int(known.sum()), drawn=False)

    @property
    def smallest_lost(self) -> float | None:
        """Smallest kick followed that does not come back; ``None`` without one."""
        lost = self.sizes[self.followed & (self.outcomes != Outcome.LEVITATED) & (self.outcomes != NO_START)]
        return float(lost.min()) if lost.size else None

    @property
    def whole(self) -> bool:
        """Whether all have been followed."""
        return bool(self.followed.all())

    @property
    def cells(self) -> tuple[np.ndarray, tuple[Ending, ...]]:
        """Index of the ending of each cell, as in :class:`~carom.explorer.computing.kicks.KickMap`, and the endings."""
        places, endings = np.full(self.outcomes.shape, NOWHERE, np.uint8), []
        exists = self.outcomes != NO_START
        codes = np.unique(self.outcomes[exists]).tolist()
        for place, code in enumerate(sorted(codes, key=lambda code: (not Outcome(code).settled, code))):
            chosen, outcome = self.outcomes == code, Outcome(code)
            look, share = OUTCOMES[outcome.label], float(chosen.sum() / exists.sum())
            places[chosen] = place
            endings.append(Ending(look.words, look.colour, look.hatch[:1], share, outcome is Outcome.LEVITATED))
        return places, tuple(endings)


def _middles(cells: int) -> np.ndarray:
    """Middles of cells, over the largest kick."""
    return np.asarray((np.arange(cells) + 0.5) * 2.0 / cells - 1.0)


def empty_picture(largest: float) -> KickPicture:
    """The picture of kicks up to a size in units of the equations, before any is followed."""
    middles = _middles(CELLS)
    beyond = np.hypot(middles[:, None], middles[None, :]) > 1.0
    return KickPicture(largest, np.full(beyond.shape, NO_START), beyond)


def fill_picture(
    rotor: Rotor, begun: KickPicture, strides: Sequence[int], progress: ShowProgress = None
) -> Iterator[KickPicture]:
    """Follow the kicks of a picture that are still missing, the middles of squares of these sizes; yield it about every second."""
    middles, largest = begun.largest * _middles(CELLS), begun.largest
    outcomes, followed = begun.outcomes.copy(), begun.followed.copy()
    exists = np.hypot(middles[:, None], middles[None, :]) <= largest
    cost, total = AT_ONCE / FEWEST, exists.sum()
    tell = Reporter.of(progress, FOLLOWING)
    for stride in strides:
        left = _middle_cells(stride, exists & ~followed)
        while len(left):
            count = int(min(max(AT_ONCE / cost, FEWEST), MOST))
            now, left = left[:count], left[count:]
            began = time.perf_counter()
            rows, columns = now.T
            done = (followed & exists).sum()
            part = tell.part(done / total, (done + len(now)) / total)
            found = _ends(rotor, middles[columns], middles[rows], part)
            cost = (time.perf_counter() - began) / len(now)
            followed[rows, columns] = True
            for row, column, outcome in zip(rows.tolist(), columns.tolist(), found.tolist(), strict=True):
                square = tuple(slice(max(at - stride // 2, 0), at + stride // 2 + 1) for at in (row, column))
                outcomes[square][exists[square] & ~followed[square]] = outcome
                outcomes[row, column] = outcome
            yield KickPicture(largest, outcomes.copy(), followed.copy())


def _middle_cells(stride: int, wanted: np.ndarray) -> np.ndarray:
    """Rows and columns of the middle cells of squares, shape (n, 2), those of the smallest kicks first."""
    at = np.arange(stride // 2, CELLS, stride)
    cells = np.stack(np.meshgrid(at, at, indexing="ij"), axis=-1).reshape(-1, 2)
    cells = cells[wanted[cells[:, 0], cells[:, 1]]]
    return cells[np.hypot(*(cells - (CELLS - 1) / 2.0).T).argsort(kind="stable")]


def _ends(rotor: Rotor, right: np.ndarray, up: np.ndarray, progress: ShowProgress = None) -> np.ndarray:
    """Outcomes of kicks by their parts, in units of the equations."""
    starts = VelocityKick().starts(rotor, np.hypot(right, up), np.arctan2(up, right))
    return np.asarray(follow(rotor, starts, max_events=MOST_EVENTS, progress=progress).outcomes)


@lru_cache(maxsize=MACHINES)
def opening_size(case: Case) -> float:
    """Range with which the page of a machine begins, in m/s: one in which some kicks are lost, if such are found."""
    rotor = rotor_of(case)
    scales = rotor.scales or Scales(1.0, 1.0, 1.0)  # a flexible machine has some
    required = case.requirement.own(scales).kick
    angles = math.tau * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    for times in TIMES:
        size = times * required
        if (_ends(rotor, size * np.cos(angles), size * np.sin(angles)) != Outcome.LEVITATED).any():
            break
    return float(f"{ROOM * size * scales.velocity:.2g}")
