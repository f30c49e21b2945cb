"""Prove which kicks out of levitation, or other disturbances, come back through contact, as far as a time allows."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from typing import Annotated, Any, NamedTuple

from carom.base.arguments import Count, checked, whole
from carom.base.outcome import InputError, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.core.processors import available_cores
from carom.models import Subject
from carom.parameters import read_quantity
from carom.proofs.balls import at_precision
from carom.proofs.claims import Proof
from carom.proofs.families import KICKS, DisturbanceFamily
from carom.proofs.hypotheses import Given, Hypotheses, hypotheses_of, written_exactly
from carom.proofs.kick_cells import IMPACTS, written
from carom.proofs.kick_claims import BOX_NOT_CLAIMED, BOX_THEOREM, NOT_CLAIMED, claims_of, options_of
from carom.proofs.kick_discs import KickDisc
from carom.proofs.kick_search import BITS, search
from carom.proofs.proving import TIME, prove_levitation, without_closed_forms

USUAL_TIME = "10 min"
USUAL_IMPACTS = 12


@checked
@shows_progress
def prove_kicks(
    machine: Subject | Hypotheses | str | os.PathLike[str] | Mapping[str, Given],
    kicks_up_to: Given,
    settings: Iterable[str] = (),
    *,
    along: Mapping[str, tuple[Given, Given]] | None = None,
    most_impacts: Annotated[int, whole(0, len(IMPACTS) - 1)] = USUAL_IMPACTS,
    time_limit: str | float | None = USUAL_TIME,
    workers: Count | None = None,
    progress: ShowProgress = None,
) -> Proof:
    """Prove which kicks out of levitation return to it, through contact.

    The disc of kick velocities, seen in the fixed frame, is covered with cells.  All flights of a cell are followed together in ball
    arithmetic, through impacts, until none reaches the wall any more.  What cannot be shown of a cell is tried on both halves of it,
    until nothing is open or time is up.  The proof has two claims: which share of the disc surely returns, up to which speed all kicks do,
    and with how many impacts at most; and whether all of it does, with the reasons of what is open.

    With ``along`` all this is shown for all machines of a box at once, whose cells are halved in the parameters too.  Where something stays open
    along one parameter, further claims say up to which speed all kicks return on each stretch.

    Parameters
    ----------
    machine : Machine, Case, Parameters, model, path, mapping or Hypotheses
        As for :func:`~carom.prove`.
    kicks_up_to : str or number
        Radius of the disc: text with a unit for a machine file in SI units, a number in ``c_r Ω`` for all others.
    settings : iterable of str
        As for :func:`~carom.prove`.
    along : mapping of str to pairs of numbers, optional
        Up to three parameters with both ends of their intervals, such as ``{"damping": ("280 N s/m", "420 N s/m")}``: dimensionless numbers,
        and for a machine file its entries, gains of magnetic bearings included.  A float is a double.
    most_impacts : int
        A kick that may have more of them is left open; at most 35.
    time_limit : str or float
        When to end the search, in s or with a unit; with ``None`` when nothing is open.
    workers : int, optional
        Processes; by default as many as there are cores.

    Raises
    ------
    InputError
        A number cannot be used.

    See Also
    --------
    carom.proofs.prove_shocks, carom.proofs.prove_unbalance_steps : the same of other disturbances
    carom.closed_forms.contact_free_kick : kicks that never reach the wall
    carom.map_basins : the same disc, sampled

    Examples
    --------
    >>> from carom.proofs import prove_kicks
    >>> proof = prove_kicks("examples/spindle.toml", "111 mm/s")
    >>> proof["kicks all recover"].status
    'proven'
    """
    limits = Limits(most_impacts, time_limit, workers)
    if (model := without_closed_forms(machine, settings)) is not None and not along:
        return prove_levitation(
            model, kicks_up_to if isinstance(kicks_up_to, int | float) else str(kicks_up_to), progress=progress
        )
    hypotheses, tell = hypotheses_of(machine, settings, list(along or ())), Reporter.of(progress, "proving")
    return prove_disc(KICKS, hypotheses, kicks_up_to, limits, tell, along or {})


class Limits(NamedTuple):
    """How far a search goes: what :func:`prove_kicks` takes."""

    most_impacts: int
    time_limit: str | float | None
    workers: int | None


def prove_disc(
    family: DisturbanceFamily,
    hypotheses: Hypotheses,
    largest: Given,
    limits: Limits,
    tell: Reporter,
    along: Mapping[str, tuple[Given, Given]] | None = None,
) -> Proof:
    """Prove which disturbances of a family return, as :func:`prove_kicks` does for kicks."""
    box = tuple((name, *map(written_exactly, ends)) for name, ends in (along or {}).items())
    disc = KickDisc(family, hypotheses, written_exactly(largest).removeprefix("double "), limits.most_impacts, box)
    seconds = math.inf if limits.time_limit is None else read_quantity(TIME, limits.time_limit)
    with at_precision(BITS):
        if not disc.levitates:
            advice = "the rotor must levitate inside the wall, with damping above 0, for it to come back"
            raise InputError("machine", shown(hypotheses.values), advice)
        tree = search(disc, seconds, limits.workers or available_cores(), tell)
        claims = claims_of(disc, tree)
    tell(1.0)
    options: dict[str, Any] = dict(zip(options_of(family), (disc.largest, limits.most_impacts), strict=True))
    if box:
        options["box"] = [list(entry) for entry in box]
    theorem, not_claimed = (BOX_THEOREM, BOX_NOT_CLAIMED) if box else (family.about, NOT_CLAIMED)
    return Proof(theorem, hypotheses, options, tuple(claims), BITS, not_claimed, {"cells": written(tree)})
