"""The theorems by name, and the search for a proof, at a precision that rises by itself.

A theorem is a function of a rotor in ball arithmetic and of evidence.

A theorem never searches outside of :meth:`~carom.proofs.claims.Evidence.take`, and verifies all that it takes.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

from carom.base.arguments import checked, whole
from carom.base.outcome import InputError, shown
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.loading import load
from carom.models import Rotor, Subject, rotor_of
from carom.parameters import Field, own_size, read_quantity
from carom.parameters.quantities import read_exact
from carom.proofs import levitation_claims, state_claims
from carom.proofs.balls import at_precision
from carom.proofs.claims import Claim, Document, Evidence, NotShownError, Proof, claim_of, rational_of
from carom.proofs.families import FAMILIES, KICKS
from carom.proofs.hypotheses import Given, Hypotheses, StatedEquations, hypotheses_of, written_exactly
from carom.proofs.kick_claims import BOX_NOT_CLAIMED, BOX_THEOREM, NOT_CLAIMED, kick_claims, options_of
from carom.proofs.lines import line_of
from carom.proofs.periods import PeriodProof, all_periods
from carom.proofs.points import point_claims
from carom.proofs.ranges import range_claims
from carom.proofs.rotor import ProvenRotor
from carom.proofs.several_impacts import MOST_IMPACTS, several_impact_claims
from carom.proofs.single_impact import candidates, orbit_claims, slip_claim
from carom.proofs.steady import steady_claims
from carom.proofs.steady_lines import steady_line_claims
from carom.proofs.whirl import whirl_claims

MOST_PLACES = 4
"""Periods that a reason names."""


@dataclass(frozen=True)
class Theorem:
    """A theorem by its claims and what is not claimed.

    Attributes
    ----------
    claims : callable
        Takes a :class:`~carom.proofs.rotor.ProvenRotor`, or equations of any rotor, :class:`~carom.proofs.claims.Evidence` and options.
    not_claimed : tuple of str
    options : tuple of str
        Names of its options.
    """

    claims: Callable[[Any, Evidence, Document], list[Claim]]
    not_claimed: tuple[str, ...]
    options: tuple[str, ...]


def _single_impact(rotor: ProvenRotor, evidence: Evidence, options: Document) -> list[Claim]:
    """Equilibria, and all orbits with one impact a period."""
    longest = options.get("longest_period")
    periods = all_periods(rotor, evidence, None if longest is None else rational_of(longest), int(options["cells"]))
    slip = slip_claim(rotor.numbers)
    claims = [*steady_claims(rotor), *whirl_claims(rotor), _periods_claim(rotor, periods), slip]
    admissible, doubts = [], []
    if not periods.complete:
        doubts.append("not all periods are known")
    if slip.status != "proven":
        doubts.append("motions whose impacts stop the slip are not excluded")
    for done, (names, found) in enumerate(candidates(rotor, periods)):
        evidence.tell(0.3 + 0.7 * done / len(periods.roots))
        if not found:
            statement = "The closing conditions of an orbit with one impact a period have solutions at this root of F1."
            known = found is not None
            reason = "its radial speeds are not real" if known else "its two radial speeds may meet in a fold"
            claims.append(rotor.claim(names, "solution", statement, -1 if known else 0, reason))
            doubts += [] if found is not None else [f"it is open whether {names} exist"]
        for name, course in (found or {}).items():
            shown, status = orbit_claims(rotor, name, course)
            claims += shown
            admissible += [name] if status == "proven" else []
            doubts += [f"it is open whether {name} is a motion"] if status == "undecided" else []
    statement = "The machine has no motion with one impact a period that is synchronous with the shaft."
    if admissible:
        names = ", ".join(sorted(admissible, key=lambda name: (len(name), name)))
        statement = (
            f"The machine has exactly these motions with one impact a period, synchronous with the shaft: {names}."
        )
    limited = any(claim.limited_by_precision for claim in claims)
    complete = claim_of(
        "machine", "orbits", statement, 0 if doubts else 1, reason="; ".join(doubts), limited=bool(doubts) and limited
    )
    return [*claims, complete]


def _periods_claim(rotor: ProvenRotor, periods: PeriodProof) -> Claim:
    """Claim that the roots found are all there are."""
    count = len(periods.roots)
    places = list(dict.fromkeys(f"{float(low):.10g}" for low, _ in periods.open))
    more = f" and {len(places) - MOST_PLACES} more periods" if len(places) > MOST_PLACES else ""
    reasons = [f"F1 may have roots next to T = {', '.join(places[:MOST_PLACES])}{more}"] if places else []
    if not periods.none_beyond:
        reasons.append(f"periods beyond {float(periods.end):.6g}/Omega were not looked at")
        if not rotor.numbers.gamma > 0:
            reasons.append("without damping there is no longest period")
    return claim_of(
        "machine",
        "periods",
        f"F1 has exactly {count} root{'' if count == 1 else 's'} T > 0, each of them simple.",
        1 if periods.complete else 0,
        reason="; ".join(reasons),
        limited=bool(periods.open) and rotor.hypotheses.exact and bool(rotor.numbers.gamma > 0),
    )


THEOREMS: Mapping[str, Theorem] = {
    "single-impact orbits": Theorem(
        _single_impact,
        (
            "that there are no orbits with several impacts a period, with impacts and lasting contact, or irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks above the contact-free speed",
            "which disturbances end in a rub",
            "whether other sliding or whirling motions repeat, or whether there is whirl with bounces",
        ),
        ("longest_period", "cells"),
    ),
    "orbits of several impacts": Theorem(
        lambda rotor, evidence, options: [
            *_single_impact(rotor, evidence, options),
            *several_impact_claims(rotor, evidence, options),
        ],
        (
            "that there are no other orbits with two or more impacts a period: those listed are what a search found",
            "that there are no orbits with lasting contact or with impacts that stop the slip, and no irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks above the contact-free speed",
        ),
        ("longest_period", "cells", "impacts"),
    ),
    "along a parameter": Theorem(
        lambda rotor, evidence, options: [
            *point_claims(rotor, evidence, options),
            *range_claims(rotor, evidence, options),
            *steady_line_claims(rotor, options),
        ],
        (
            "what is stated as open on an interval, except for the points listed there",
            "that there are no other bifurcation points there: those listed are what a search in double precision found",
            "that the orbit at a point has the name it is listed by",
            "that there are no orbits with several impacts a period, with lasting contact, or irregular motions",
            "which disturbances lead to an orbit or to levitation: basins, and recovery from kicks",
        ),
        ("along", "from", "to", "blocks", "narrowest"),
    ),
    **{
        about: Theorem(partial(kick_claims, family), NOT_CLAIMED, options_of(family))
        for about, family in FAMILIES.items()
    },
    BOX_THEOREM: Theorem(partial(kick_claims, KICKS), BOX_NOT_CLAIMED, (*options_of(KICKS), "box")),
    levitation_claims.THEOREM: Theorem(
        levitation_claims.levitation_claims, levitation_claims.NOT_CLAIMED, levitation_claims.OPTIONS
    ),
    state_claims.THEOREM: Theorem(state_claims.state_claims, state_claims.NOT_CLAIMED, state_claims.OPTIONS),
}
"""Theorems by their names in certificates."""


TIME = Field("time_limit", "", "time to search", "a time", "s", 1e-3, 1e9, '"10 min"')
LONGEST = Field("longest_period", "T", "longest period", "a time in 1/Omega", "", 1e-9, 1e9, "20")
FIRST_BITS, MOST_BITS = 128, 1024
"""Precision to begin with, and beyond which a claim is left undecided."""
MOST_BLOCKS, NARROWEST = 2000, "1/10000"
"""Blocks of a parameter after which the search ends, and the share of the interval at which a block is left open."""
MOST_CELLS = 2000
"""Cells of the periods after which the search ends."""


@checked
@shows_progress
def prove(
    machine: Subject | Hypotheses | str | os.PathLike[str] | Mapping[str, Given],
    settings: Iterable[str] = (),
    *,
    longest_period: Given | None = None,
    impacts: Annotated[int, whole(1, MOST_IMPACTS)] = 1,
    along: str | None = None,
    interval: tuple[Given, Given] | None = None,
    time_limit: str | float | None = None,
    progress: ShowProgress = None,
) -> Proof:
    """Prove what can be proven of a machine's equilibria and of its orbits with one impact a period.

    With ``impacts`` above 1 the claims are also about orbits with at most so many impacts a period that a search finds.
    With ``along`` they are instead about bifurcation points along a parameter, and about all orbits with one impact a
    period for all its values in an interval: whether they are motions of the machine and whether they are stable; and about
    levitation, rubs, the contact-free kick and whirl.
    An undecided claim says why.  Of a machine that is no planar rotor in a rigid wall, or that has weight or limits, it is proven that it levitates, and which kicks and
    steps of the unbalance never touch (:func:`~carom.proofs.prove_levitation`).

    Parameters
    ----------
    machine : Machine, Case, Parameters, model, path, mapping or Hypotheses
        See :func:`~carom.proofs.hypotheses_of`: the decimal numbers of a file count as they are written, those of a Machine,
        Case, Parameters or model as doubles.
    longest_period : number, optional
        Look only for periods up to this, in ``1/Ω``; by default for all.
    impacts : int
        At most so many a period, 1 to 24.
    along : str, optional
        A parameter: dimensionless, an entry of the machine's table, or a term that sets one, such as ``derivative_gain``.
    interval : pair of numbers, optional
        Its ends, such as ``("0.084", "0.177")`` or ``("300 N s/m", "2000 N s/m")``; as with ``machine`` a float is a double.
    time_limit : str or float, optional
        When to end searches that can end early, such as that along the interval, in s or with a unit: the rest is open then.

    Raises
    ------
    InputError
        A number cannot be used.

    See Also
    --------
    carom.proofs.check : verify a proof without any search
    carom.find_orbits : the same orbits in double precision

    Examples
    --------
    >>> import carom as cm
    >>> proof = cm.prove("examples/source-paper.toml")
    >>> proof["B1,d stable"].status
    'proven'
    """
    tell, seconds = (
        Reporter.of(progress, "proving"),
        math.inf if time_limit is None else read_quantity(TIME, time_limit),
    )
    if (model := without_closed_forms(machine, settings)) is not None and along is None:
        return prove_levitation(model, progress=tell)
    hypotheses = hypotheses_of(machine, settings, () if along is None else (along,))
    if (along is None) is not (interval is None):
        raise InputError("along", shown(along), "needs an interval, and an interval needs a parameter")
    if along is not None and interval is not None:
        if impacts != 1 or longest_period is not None:
            raise InputError("along", shown(along), "cannot be combined with a longest period or with several impacts")
        start, stop = (written_exactly(end) for end in interval)
        line_of(hypotheses, along, start, stop)
        limits = {"blocks": MOST_BLOCKS, "narrowest": NARROWEST}
        return proof_of(
            "along a parameter", hypotheses, {"along": along, "from": start, "to": stop, **limits}, tell, seconds
        )
    limit = None if longest_period is None else str(read_exact(LONGEST, written_exactly(longest_period)).high)
    options = {"longest_period": limit, "cells": MOST_CELLS}
    if impacts == 1:
        return proof_of("single-impact orbits", hypotheses, options, tell, seconds)
    return proof_of("orbits of several impacts", hypotheses, {**options, "impacts": impacts}, tell, seconds)


def without_closed_forms(machine: object, settings: Iterable[str] = ()) -> Rotor | None:
    """The model of a machine whose contacts have no theorems: all but the planar rotor in a rigid wall, without weight and limits."""
    if isinstance(machine, Hypotheses | Mapping):
        return None
    case: Any = machine
    if isinstance(machine, str | os.PathLike):
        try:
            case = load(machine, settings)
        except InputError:  # a number that only a theorem takes, such as a fraction
            return None
    model = rotor_of(case)
    return None if model.has_closed_forms else model


def prove_levitation(model: Rotor, kicks_up_to: float | str | None = None, *, progress: ShowProgress = None) -> Proof:
    """Prove of any rotor that it levitates, and which kicks and steps of the unbalance never touch (:mod:`carom.proofs.levitation_claims`).

    Parameters
    ----------
    model : Model
        Its equations count as doubles; of a flexible machine those of all its modes.
    kicks_up_to : float or str, optional
        A speed that is asked for, in ``c_r Ω`` or text with a unit.

    Raises
    ------
    InputError
        A force acts that changes in the fixed frame, or the speed cannot be read.
    """
    size = None if kicks_up_to is None else own_size("kicks_up_to", kicks_up_to, "velocity", model.scales).hex()
    return proof_of("levitation", StatedEquations.of(model), {"kicks_up_to": size}, Reporter.of(progress, "proving"))


def proof_of(
    theorem: str,
    hypotheses: Hypotheses | StatedEquations,
    options: Document,
    tell: Reporter | None = None,
    seconds: float = math.inf,
) -> Proof:
    """Prove the claims of a theorem, with more bits as long as more bits may decide a claim; each search ends after so many seconds."""
    bits, done, tell = FIRST_BITS, 0.0, tell or Reporter()
    while True:
        # Mostly the first bits suffice; further ones share what is left of the bar.
        end = done + 0.9 * (1.0 - done)
        tell(done)
        try:
            evidence = Evidence(tell=tell.part(done, end, f"proving with {bits} bits"), seconds=seconds)
            proof = proof_at(bits, theorem, hypotheses, options, evidence)
        except NotShownError:
            # A search and its check differ by rounding: more bits settle it.
            if bits >= MOST_BITS:
                raise
        else:
            if bits >= MOST_BITS or not any(claim.limited_by_precision for claim in proof.claims):
                tell(1.0)
                return proof
        bits, done = 2 * bits, end


def proof_at(
    bits: int, theorem: str, hypotheses: Hypotheses | StatedEquations, options: Document, evidence: Evidence
) -> Proof:
    """Claims of a theorem at one precision, from evidence that is searched for or read."""
    with at_precision(bits):
        stated: Any = hypotheses if isinstance(hypotheses, StatedEquations) else ProvenRotor(hypotheses)
        claims = THEOREMS[theorem].claims(stated, evidence, options)
    not_claimed = THEOREMS[theorem].not_claimed
    return Proof(theorem, hypotheses, options, tuple(claims), bits, not_claimed, evidence.document())
