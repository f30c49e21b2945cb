"""Prove which shocks of the base, and which steps of the unbalance, come back through contact."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Annotated

from carom.base.arguments import Count, checked, whole
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.models import Subject
from carom.proofs.claims import Proof
from carom.proofs.families import SHOCKS, STEPS
from carom.proofs.hypotheses import Given, Hypotheses, hypotheses_of
from carom.proofs.kick_cells import IMPACTS
from carom.proofs.kicks import USUAL_IMPACTS, USUAL_TIME, Limits, prove_disc


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
    limits = Limits(most_impacts, time_limit, workers)
    return prove_disc(SHOCKS, hypotheses_of(machine, settings), shocks_up_to, limits, Reporter.of(progress, "proving"))


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
    limits = Limits(most_impacts, time_limit, workers)
    hypotheses, tell = hypotheses_of(machine, settings), Reporter.of(progress, "proving")
    return prove_disc(STEPS, hypotheses, unbalance_up_to, limits, tell)
