"""Prove which kicks out of levitation, shocks of the base and steps of the unbalance come back through contact, as far as a time allows.

And that all states up to a speed do: no other attractor begins there.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from typing import Annotated

from carom.base.arguments import Count, checked, whole
from carom.base.outcome import InputError, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.core.processors import available_cores
from carom.models import Subject
from carom.parameters import read_quantity
from carom.proofs.balls import at_precision
from carom.proofs.claims import Proof
from carom.proofs.families import KICKS, SHOCKS, STEPS, DisturbanceFamily
from carom.proofs.hypotheses import Given, Hypotheses, hypotheses_of, written_exactly
from carom.proofs.kick_cells import IMPACTS, written
from carom.proofs.kick_claims import BOX_NOT_CLAIMED, BOX_THEOREM, NOT_CLAIMED, claims_of, options_of
from carom.proofs.kick_discs import KickDisc
from carom.proofs.kick_search import BITS, search
from carom.proofs.proving import TIME, proof_of, prove_levitation, without_closed_forms
from carom.proofs.state_claims import SPEED, THEOREM, LargestSpeed

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
    if (model := without_closed_forms(machine, settings)) is not None and not along:
        return prove_levitation(
            model, kicks_up_to if isinstance(kicks_up_to, int | float) else str(kicks_up_to), progress=progress
        )
    hypotheses, tell = hypotheses_of(machine, settings, list(along or ())), Reporter.of(progress, "proving")
    return prove_disc(KICKS, hypotheses, kicks_up_to, most_impacts, time_limit, workers, tell, along or {})


def prove_disc(
    family: DisturbanceFamily,
    hypotheses: Hypotheses,
    largest: Given,
    most_impacts: int,
    time_limit: str | float | None,
    workers: int | None,
    tell: Reporter,
    along: Mapping[str, tuple[Given, Given]] | None = None,
) -> Proof:
    """Prove which disturbances of a family return, as :func:`prove_kicks` does for kicks."""
    box = tuple((name, *map(written_exactly, ends)) for name, ends in (along or {}).items())
    disc = KickDisc(family, hypotheses, written_exactly(largest).removeprefix("double "), most_impacts, box)
    seconds = math.inf if time_limit is None else read_quantity(TIME, time_limit)
    with at_precision(BITS):
        if not disc.levitates:
            advice = "the rotor must levitate inside the wall, with damping above 0, for it to come back"
            raise InputError("machine", shown(hypotheses.values), advice)
        tree = search(disc, seconds, workers or available_cores(), tell)
        claims = claims_of(disc, tree)
    tell(1.0)
    options: dict[str, object] = dict(zip(options_of(family), (disc.largest, most_impacts), strict=True))
    if box:
        options["box"] = [list(entry) for entry in box]
    theorem, not_claimed = (BOX_THEOREM, BOX_NOT_CLAIMED) if box else (family.about, NOT_CLAIMED)
    return Proof(theorem, hypotheses, options, tuple(claims), BITS, not_claimed, {"cells": written(tree)})


@checked
@shows_progress
def prove_shocks(
    machine: Subject | Hypotheses | str | os.PathLike[str] | Mapping[str, Given],
    shocks_up_to: str,
    settings: Iterable[str] = (),
    *,
    most_impacts: Annotated[int, whole(0, len(IMPACTS) - 1)] = USUAL_IMPACTS,
    time_limit: str | float | None = USUAL_TIME,
    workers: Count | None = None,
    progress: ShowProgress = None,
) -> Proof:
    """Prove which shocks of the base return a levitating rotor to levitation, through contact.

    The base is accelerated by a half-sine pulse of one duration, with any peak up to a largest one, in any direction.  The disc of peaks and
    directions is covered with cells, as that of :func:`prove_kicks`.  Shocks that may bring the rotor to the wall before they are over are left open.

    Parameters
    ----------
    machine, settings, most_impacts, time_limit, workers
        As for :func:`prove_kicks`.
    shocks_up_to : str
        The largest peak and the duration: ``"5 g, 11 ms"`` for a machine file in SI units, plain numbers in ``c_r Ω²`` and ``1/Ω`` for
        all others.

    Raises
    ------
    InputError
        A number cannot be used.

    See Also
    --------
    carom.BaseShock : the same shocks, simulated
    carom.closed_forms.contact_free_shock : shocks that never bring the rotor to the wall

    Examples
    --------
    >>> from carom.proofs import prove_shocks
    >>> proof = prove_shocks("examples/spindle.toml", "80 g, 0.2 ms")
    >>> proof["shocks all recover"].status
    'proven'
    """
    hypotheses, tell = hypotheses_of(machine, settings), Reporter.of(progress, "proving")
    return prove_disc(SHOCKS, hypotheses, shocks_up_to, most_impacts, time_limit, workers, tell)


@checked
@shows_progress
def prove_unbalance_steps(
    machine: Subject | Hypotheses | str | os.PathLike[str] | Mapping[str, Given],
    unbalance_up_to: Given,
    settings: Iterable[str] = (),
    *,
    most_impacts: Annotated[int, whole(0, len(IMPACTS) - 1)] = USUAL_IMPACTS,
    time_limit: str | float | None = USUAL_TIME,
    workers: Count | None = None,
    progress: ShowProgress = None,
) -> Proof:
    """Prove after which steps of the unbalance a levitating rotor returns to levitation, through contact.

    The unbalance of the machine is that after the step, for example with a blade lost.  Before it the rotor levitates with another one, which
    differs by any change up to a largest one, in any direction.  The disc of changes is covered with cells, as that of :func:`prove_kicks`.
    What would not have levitated inside the wall before is left open.

    Parameters
    ----------
    machine, settings, most_impacts, time_limit, workers
        As for :func:`prove_kicks`.
    unbalance_up_to : str or number
        The largest change: an eccentricity or an unbalance with a unit, ``"0.1 mm"`` or ``"2000 g mm"``, for a machine file in SI units, a
        number in ``c_r`` for all others.

    Raises
    ------
    InputError
        A number cannot be used.

    See Also
    --------
    carom.disturbances.BladeLoss : the unbalance changes from that of the machine instead, simulated

    Examples
    --------
    >>> from carom.proofs import prove_unbalance_steps
    >>> proof = prove_unbalance_steps("examples/spindle.toml", "40 um")
    >>> proof["unbalance steps all recover"].status
    'proven'
    """
    hypotheses, tell = hypotheses_of(machine, settings), Reporter.of(progress, "proving")
    return prove_disc(STEPS, hypotheses, unbalance_up_to, most_impacts, time_limit, workers, tell)


@checked
@shows_progress
def prove_states(
    machine: Subject | Hypotheses | str | os.PathLike[str] | Mapping[str, Given],
    states_up_to: Given,
    settings: Iterable[str] = (),
    *,
    progress: ShowProgress = None,
) -> Proof:
    """Prove that the rotor returns to levitation from every state inside the clearance or on its wall, up to a speed.

    Every motion is meant that begins there, with all its impacts, chatter and lasting contact.  The proof has three claims: up to which speed all states return;
    from which speed on some do not, by a rub, a whirl or an orbit that is proven; and whether all up to the speed given return, which is proven, refuted or open.

    Parameters
    ----------
    machine : Machine, Case, Parameters, model, path, mapping or Hypotheses
        As for :func:`~carom.prove`.
    states_up_to : str or number
        Largest speed of a state in the fixed frame: text with a unit for a machine file in SI units, a number in ``c_r Ω`` for all others.
    settings : iterable of str
        As for :func:`~carom.prove`.

    Raises
    ------
    InputError
        A number cannot be used.

    See Also
    --------
    carom.proofs.prove_kicks : kicks out of levitation only, with their number of impacts
    carom.find_attractors : where states end, sampled

    Examples
    --------
    >>> from carom.proofs import prove_states
    >>> proof = prove_states("examples/spindle.toml", "140 mm/s")
    >>> proof["states all recover"].status
    'proven'
    """
    hypotheses, tell = hypotheses_of(machine, settings), Reporter.of(progress, "proving")
    limit = LargestSpeed(hypotheses, written_exactly(states_up_to).removeprefix("double "), SPEED)
    return proof_of(THEOREM, hypotheses, {"states_up_to": limit.text}, tell)
