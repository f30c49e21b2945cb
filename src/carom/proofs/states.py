"""Prove that from all states up to a speed the rotor returns to levitation: no other attractor begins there."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping

from carom.base.arguments import checked
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.models import Subject
from carom.proofs.claims import Proof
from carom.proofs.hypotheses import Given, Hypotheses, hypotheses_of, written_exactly
from carom.proofs.proving import proof_of
from carom.proofs.sizes import LargestSpeed
from carom.proofs.state_claims import SPEED, THEOREM


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
