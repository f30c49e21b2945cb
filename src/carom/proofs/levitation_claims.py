r"""Any rotor: levitation is stable, stays clear of its touchdown bearings, and kicks up to a speed never touch.

As long as nothing touches and no limit of a magnetic bearing is reached, the deviation ``e`` of the state from the steady motion obeys ``ė = A e``.  With a form
``e*Pe``, ``P = G*G``, that decays, ``|w e| ≤ |w G⁻¹| |G e(0)|`` for any row ``w``.  A wall, or a limit, leaves the room ``r`` beside the steady motion: sag, forward
and backward part each in the worst direction.  So a kick of a speed ``v`` in any direction and at any instant of the turn never reaches it for
``v < r / (|w G⁻¹| |G b|)``, where ``b`` is the state just after a kick of one.  A step of the unbalance by ``Δ`` moves the steady motion itself by as much as ``Δ`` times
that of an unbalance of one, ``x``: it never reaches the wall for ``Δ < r / (|w x| + |w G⁻¹| |G x|)``.

``G`` comes from the modes in doubles.  With ``A = V Λ V⁻¹`` and ``G = √D V⁻¹``, ``D_k = |w V|_k / |V⁻¹b|_k`` is best, and then the bound is that of the moduli of the
modes, ``r / Σ_k |w V|_k |V⁻¹b|_k``.  Each wall has a form of its own.  In balls ``B = G A G⁻¹`` is enclosed; the form decays where the Hermitian matrix ``B + B*`` is negative definite, which
Gershgorin's discs show.  ``G⁻¹`` in balls shows that ``G`` is not singular.

Anisotropic bearings make this a system of ``(z, z̄)``, with the same formulas for twice as many coordinates.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import reduce
from typing import NamedTuple

import numpy as np
from flint import acb, acb_mat, arb

from carom.proofs.balls import Enclosure, decided, enclosures_of, rational
from carom.proofs.claims import Claim, Document, Evidence, NotShownError, claim_of
from carom.proofs.hypotheses import StatedEquations, array_of, balls, text_of

THEOREM = "levitation"
OPTIONS = ("kicks_up_to",)
NOT_CLAIMED = (
    "what larger kicks and steps of the unbalance do: they may touch, and may still come back",
    "anything about motions in contact: synchronous rubs, bouncing, whirl, and what comes back from them",
    "anything about base shocks",
    "that the equations describe the machine: their numbers are taken as doubles, computed from those of its file",
)
_ANY = "in any direction and at any instant of the turn"
SMALLEST = 1e-9
"""Share of the largest part of a mode below which its weight in a form no longer counts."""


class _Linear(NamedTuple):
    """The system in balls: states are the coordinates, then the rates of those with mass."""

    generator: acb_mat
    kicks: tuple[acb_mat, ...]
    """States just after a kick of one, the sum of which with any phases is meant: one, or two where ``(z, z̄)`` are the coordinates."""
    steps: tuple[acb_mat, ...]
    """Parts of the steady motion of an unbalance of one, forward and backward."""
    rows: list[acb_mat]
    """Of each wall and limit."""
    steady: list[arb]
    """Distance of the steady motion there: a bound."""
    rooms: list[arb]
    bearings: int
    """How many of the rows are those of touchdown bearings."""
    units: tuple[float, ...]
    """Speed and length in SI units that count one; empty where they are not known."""

    def both(self, name: str, size: arb) -> dict[str, Enclosure]:
        """A ``speed`` or a ``change`` of the unbalance, and the same in SI units where these are known."""
        known = dict(zip(("speed", "change"), self.units, strict=False))
        return enclosures_of(**{name: size}, **({f"{name}_si": size * arb(known[name])} if name in known else {}))


def levitation_claims(stated: StatedEquations, evidence: Evidence, options: Mapping[str, object]) -> list[Claim]:
    """Claims from forms that are searched for or read."""
    try:
        held = _linear(stated)
    except ZeroDivisionError:
        return [_stable(0, "the equations of its steady motion could not be solved in balls")]
    recorded: object = evidence.take("forms", lambda: [text_of(each) for each in _forms(held)])
    if not (isinstance(recorded, list) and len(recorded) == len(held.rows)):
        raise NotShownError("the forms of the certificate are not complete")
    clear = [decided(room) for room in held.rooms]
    claims, kicks, steps = [_stable(0, "no form in doubles was found that decays")], [], []
    for place, form in enumerate(map(array_of, recorded)):
        evidence.tell(place / len(recorded))
        shown = _shown(held, form, place)
        if shown is None:
            return [claims[0], _clear(held, clear)]
        kicks.append(shown[0])
        steps.append(shown[1])
    claims = [_stable(1, ""), _clear(held, clear)]
    if not all(sign > 0 for sign in clear):
        return claims
    return [*claims, *_sizes(kicks, steps, options, held)]


def _stable(sign: int, reason: str) -> Claim:
    statement = "As long as nothing touches, every deviation from the steady motion dies out, exponentially: levitation is stable."
    return claim_of("levitation", "stable", statement, sign, reason=reason, limited=False)


def _clear(held: _Linear, clear: list[int]) -> Claim:
    """Claim about the steady motion."""
    names = [f"bearing_{place + 1}" for place in range(held.bearings)]
    names += [f"limit_{place + 1}" for place in range(len(held.rows) - held.bearings)]
    return claim_of(
        "levitation",
        "clear",
        "Levitating with its sag and its unbalance, the rotor stays inside its touchdown bearings and its magnetic bearings below their limits; the numbers are "
        "upper bounds, as a share of each clearance and in the unit of each limit.",
        1 if all(sign > 0 for sign in clear) else 0,
        reason="sag and whirl may reach a touchdown bearing or a limit",
        enclosures=enclosures_of(**dict(zip(names, held.steady, strict=True))),
        limited=False,
    )


def _sizes(kicks: list[arb], steps: list[arb], options: Document, held: _Linear) -> list[Claim]:
    """Claims about kicks and steps that never touch."""
    speed, change, asked = _least(kicks), _least(steps), options["kicks_up_to"]
    below = " nor asks its magnetic bearings for more than a limit" if len(held.rows) > held.bearings else ""
    after = f"the rotor never touches{below}, and goes back to levitation"
    kick = f"kick out of levitation of less than speed, in c_r Omega of the fixed frame, {_ANY}"
    step = f"step of the unbalance by less than change, as an eccentricity in c_r, {_ANY}"
    claims = [
        claim_of(
            about, "never touch", f"After every {words}, {after}.", decided(size), enclosures=held.both(name, size)
        )
        for about, words, name, size in (
            ("kicks", kick, "speed", speed),
            ("steps of the unbalance", step, "change", change),
        )
    ]
    claims = claims if held.steps else claims[:1]
    if asked is not None:
        size = rational(Fraction(float.fromhex(asked)))
        claims.append(
            claim_of(
                "kicks",
                "asked never touch",
                f"After every kick up to speed, in c_r Omega of the fixed frame, {after}.",
                1 if size < speed else 0,
                reason="faster kicks are open: some may touch and still come back",
                enclosures=held.both("speed", size),
                limited=False,
            )
        )
    return claims


def _least(sizes: list[arb]) -> arb:
    return arb(reduce(lambda one, other: one.min(other), sizes).lower())


def _linear(stated: StatedEquations) -> _Linear:
    given = {name: stated.array(name) for name in stated.numbers}
    mass, damping, stiffness, across = (given[name] for name in ("mass", "damping", "stiffness", "across"))
    forces, planes = [given["forcing"], given["push"]], given["planes"]
    n, still = len(mass), given["weight"]
    double, none = len(across) > 0, np.zeros(len(mass))
    if double:
        rest = np.zeros_like(mass)
        mass = np.block([[mass, rest], [rest, mass.conj()]])
        damping = np.block([[damping, across[0]], [across[0].conj(), damping.conj()]])
        stiffness = np.block([[stiffness, across[1]], [across[1].conj(), stiffness.conj()]])
        forces = [np.append(each, none) for each in forces]
        still = np.append(still, still.conj())
        planes = np.append(planes, np.zeros_like(planes), axis=1)
    has_mass = np.asarray(mass.any(axis=1))
    whole = balls(stiffness) - balls(mass) + balls(damping) * acb(0, 1)
    answers = [whole.solve(balls(each)) for each in forces]
    sag = balls(stiffness).solve(balls(still))
    forward, steps = (_parts(each, has_mass, n, double) for each in answers)
    kick = np.append(np.zeros(len(mass)), given["translation"][has_mass[:n]])
    kicks: tuple[np.ndarray, ...] = (kick,)
    if double:
        moved = given["translation"][has_mass[:n]]
        kicks = (np.append(kick, 0.0 * moved), np.concatenate([0.0 * kick, moved.conj()]))
    rows = [balls(np.append(row, np.zeros(has_mass.sum()))[None]) for row in planes]
    bounds = [arb(1)] * len(rows)
    for limit in given["limits"]:
        by_place, by_rate = np.split(limit[:-1], 2)
        if by_rate[~has_mass[:n]].any():
            raise NotShownError("a limit asks by the rate of a coordinate without mass")
        if double:
            by_place, by_rate = np.append(by_place, none), np.append(by_rate, none)
        rows.append(balls(np.append(by_place, by_rate[has_mass])[None]))
        bounds.append(arb(limit[-1].real))
    resting = _state(sag, np.zeros(has_mass.sum()))
    steady = [sum((_size(row * part) for part in (resting, *forward)), arb(0)) for row in rows]
    return _Linear(
        _generator(mass, damping, stiffness, has_mass),
        tuple(balls(each) for each in kicks),
        steps if given["push"].any() else (),
        rows,
        steady,
        [bound - reach for bound, reach in zip(bounds, steady, strict=True)],
        len(planes),
        tuple(given["units"].real.tolist()),
    )


def _state(coordinates: acb_mat, rates: np.ndarray) -> acb_mat:
    return acb_mat([[entry] for entry in coordinates.entries()] + [[entry] for entry in rates.tolist()])


def _parts(answer: acb_mat, has_mass: np.ndarray, n: int, double: bool) -> tuple[acb_mat, ...]:
    """States of a whirl at time zero: what turns with ``e^{it}``, and with ``e^{−it}`` where ``(z, z̄)`` are the coordinates."""
    entries, unit = answer.entries(), acb(0, 1)

    def with_rates(values: list[acb], turn: acb) -> acb_mat:
        return acb_mat([[each] for each in values] + [[turn * values[place]] for place in np.flatnonzero(has_mass)])

    ahead = with_rates(entries, unit)
    if not double:
        return (ahead,)
    back = [each.conjugate() for each in (*entries[n:], *entries[:n])]
    return ahead, with_rates(back, -unit)


def _size(matrix: acb_mat) -> arb:
    """Euclidean size of a row or a column."""
    return sum((entry.real**2 + entry.imag**2 for entry in matrix.entries()), arb(0)).sqrt()


def _generator(mass: np.ndarray, damping: np.ndarray, stiffness: np.ndarray, has_mass: np.ndarray) -> acb_mat:
    """Rates of the states per state."""
    n, count = len(mass), int(has_mass.sum())
    own, others = np.ix_(has_mass, has_mass), np.ix_(~has_mass, ~has_mass)
    rates: list[list[acb | int]] = [[0] * (n + count) for _ in range(n)]
    for place, row in enumerate(np.flatnonzero(has_mass).tolist()):
        rates[row][n + place] = 1
    if not has_mass.all():
        held = np.concatenate([stiffness[~has_mass], damping[np.ix_(~has_mass, has_mass)]], axis=1)
        solved = balls(damping[others]).solve(balls(held)).tolist()
        for row, entries in zip(np.flatnonzero(~has_mass).tolist(), solved, strict=True):
            rates[row] = [-entry for entry in entries]
    forces = balls(np.append(stiffness[has_mass], np.zeros((count, count)), axis=1)) + balls(
        damping[has_mass]
    ) * acb_mat(rates)
    pushed = balls(mass[own]).solve(forces)
    return acb_mat(rates + [[-entry for entry in row] for row in pushed.tolist()])


def _middles(matrix: acb_mat) -> np.ndarray:
    return np.array([[complex(entry.mid()) for entry in row] for row in matrix.tolist()])


def _forms(held: _Linear) -> list[np.ndarray]:
    """``G`` in doubles for each wall, from the modes."""
    _, modes = np.linalg.eig(_middles(held.generator))
    inverse, found = np.linalg.inv(modes), []
    shares = sum(np.abs(inverse @ _middles(kick)[:, 0]) for kick in held.kicks)
    for row in held.rows:
        seen = np.abs(_middles(row)[0] @ modes)
        weights = np.maximum(seen, SMALLEST * seen.max()) / np.maximum(shares, SMALLEST * np.max(shares))
        found.append(np.sqrt(weights)[:, None] * inverse)
    return found


def _shown(held: _Linear, form: np.ndarray, place: int) -> tuple[arb, arb] | None:
    """Sizes of kicks and of steps of the unbalance below which a wall is never reached; ``None`` if the form is not shown to decay."""
    count = held.generator.nrows()
    if form.shape != (count, count):
        raise NotShownError("a form of the certificate has another size")
    given = balls(form)
    try:
        back = given.inv()
    except ZeroDivisionError:
        return None
    turned = (given * held.generator * back).tolist()
    for first in range(count):
        disc = turned[first][first].real * 2
        for other in range(count):
            if other != first:
                disc += abs(turned[first][other] + turned[other][first].conjugate())
        if not disc < 0:
            return None
    gain, room = _size(held.rows[place] * back), held.rooms[place]

    def grown(parts: tuple[acb_mat, ...]) -> arb:
        return gain * sum((_size(given * part) for part in parts), arb(0))

    moved = sum((_size(held.rows[place] * part) for part in held.steps), arb(0))
    return room / grown(held.kicks), room / (moved + grown(held.steps)) if held.steps else arb("inf")
