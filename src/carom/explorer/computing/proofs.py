"""Which kicks of a picture are proven to come back, within a limit of time."""

from __future__ import annotations

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


def find_proven(
    rotor: Rotor, plane: DisturbancePlane, largest: float, progress: ShowProgress = None
) -> dict[str, object]:
    """Prove kicks up to a size, in units of the equations; of other disturbances nothing is proven.

    ``share`` is that of the area that is proven, and ``open``, uint8 of shape (n, n), is 1 where nothing is proven, by second (rows) and first component,
    both ascending.
    """
    if plane.name != "kick":
        raise InputError("what disturbs the rotor", plane.nouns[1], "kicks: of other disturbances nothing is proven")
    from carom.proofs import ProvenKicks, prove_kicks  # only here: they need an extra

    known = exact_rotor_of(rotor)
    kicks = ProvenKicks.of(prove_kicks(known, largest, time_limit=LIMIT, progress=progress), known)
    middles = kicks.largest * ((np.arange(CELLS) + 0.5) * 2.0 / CELLS - 1.0)
    places = kicks.at(*np.meshgrid(middles, middles))
    left = np.array([*(part.open for part in kicks.parts), True])[places]
    share = number(rounded_down(100.0 * kicks.share)) if kicks.share else "0"
    return {"words": kicks.words, "share": f"{share} %", "open": left.astype(np.uint8)}
