"""Which kicks of a picture are proven to come back, within a limit of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.base.outcome import InputError
from carom.base.progress import ShowProgress
from carom.explorer.computing.planes import DisturbancePlane
from carom.models import Rotor, exact_rotor_of
from carom.parameters.formats import number, rounded_down

LIMIT = "30 s"
"""Time for the search."""
CELLS = 240
"""Cells along each side of the picture of what is proven."""


@dataclass(frozen=True, eq=False)
class ProvenPicture:
    """What is proven of the kicks of a picture.

    Attributes
    ----------
    words : str
    share : str
        Share of the area that is proven.
    open : ndarray of uint8, shape (n, n)
        1 where nothing is proven, by second (rows) and first component, both ascending.
    """

    words: str
    share: str
    open: np.ndarray


def find_proven(rotor: Rotor, plane: DisturbancePlane, largest: float, progress: ShowProgress = None) -> ProvenPicture:
    """Prove kicks up to a size, in units of the equations; of other disturbances nothing is proven."""
    if plane.name != "kick":
        raise InputError("what disturbs the rotor", plane.nouns[1], "kicks: of other disturbances nothing is proven")
    from carom.proofs import ProvenKicks, prove_kicks  # only here: they need an extra

    known = exact_rotor_of(rotor)
    kicks = ProvenKicks.of(prove_kicks(known, largest, time_limit=LIMIT, progress=progress), known)
    middles = kicks.largest * ((np.arange(CELLS) + 0.5) * 2.0 / CELLS - 1.0)
    places = kicks.at(*np.meshgrid(middles, middles))
    left = np.array([*(part.open for part in kicks.parts), True])[places]
    share = number(rounded_down(100.0 * kicks.share)) if kicks.share else "0"
    return ProvenPicture(kicks.words, f"{share} %", left.astype(np.uint8))
