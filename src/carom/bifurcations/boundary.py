"""Classification of boundary equilibria: what happens where levitation meets the wall.

With the gap ``g = 1 − |U*|`` between the contact-free equilibrium and the wall, two kinds of motion shrink into it as
``g → 0``; both grow in proportion to ``|g|``, so the side on which they exist is a sign.

*A synchronous rub.*  Its normal force solves ``|h|²N² + 2 Re(h) N + 1 − |U*|² = 0`` with ``h = H(1 + iμ)`` and the static
receptance ``H = 1/(ω² − 1 + iγ)`` (:func:`~carom.closed_forms.equilibria.find_equilibria`), so the branch that meets the wall has

    N ≈ −g/Re h = g ρ²/(κ − μγ),      κ = 1 − ω².

If ``κ < μγ``, ``N > 0`` where the contact-free equilibrium is virtual: the motion changes continuously from one to the other,
*persistence*.  The rub is then the larger root, which is stable.  If ``κ > μγ``, both exist on the side where the rotor
levitates, with the rub a saddle, and neither exists on the other: a *non-smooth fold*, beyond which the rotor must
leave.

*Orbits with one impact a period*, one for each root ``T`` of ``F₁`` (the non-smooth Hopf bifurcation, Proposition 4.3 of
the source paper): from ``|1 + q a₁₂ ṙ| = |U*|``,

    ṙ ≈ −g/Re(q a₁₂(T)).

Where ``Re(q a₁₂) < 0`` the orbit (``a``, ``b``) exists on the side where the rotor levitates, and bounds the
disturbances that come back; otherwise the orbit (``c``, ``d``) takes over on the other side.  They are known to first order in the gap (:func:`~carom.closed_forms.small_cycles`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Literal, get_args

from carom.base.arguments import checked
from carom.base.outcome import STEADY_WORDS
from carom.base.results import Result
from carom.closed_forms.periods import PeriodCondition
from carom.closed_forms.small_cycles_at_walls import small_cycles
from carom.closed_forms.thresholds import BoundaryKind, Gain, boundary_balance, boundary_kind, ranges_of
from carom.models import Subject, exact_rotor_of, jeffcott
from carom.orbits.names import OrbitName
from carom.orbits.single_impact import longest_within_reach
from carom.parameters import Parameters

Side = Literal["above", "below"]
"""On which side of the value the rotor levitates."""


@dataclass(frozen=True, eq=False, repr=False)
class SmallOrbit(Result):
    """An orbit with one impact a period that shrinks into the boundary equilibrium.

    Attributes
    ----------
    name : OrbitName
        ``"B1,a"`` and so on.
    period : float
        In ``1/Ω``; it stays finite as the orbit shrinks.
    speed_rate : float
        Radial speed (``c_r Ω``) per clearance of distance between the contact-free equilibrium and the wall.
    levitating_side : bool
        Whether it exists where the contact-free equilibrium is inside the wall; otherwise it exists where that is
        outside.
    admissible : bool
        Whether it stays inside the wall between impacts.
    stable : bool
    """

    name: OrbitName
    period: float
    speed_rate: float
    levitating_side: bool
    admissible: bool
    stable: bool


@dataclass(frozen=True, eq=False, repr=False)
class BoundaryEquilibrium(Result):
    """A contact-free equilibrium that lies on the wall, and what meets it there.

    Attributes
    ----------
    gain : {"gamma", "omega"}
        The parameter that was varied to find it.
    value : float
        Value of this parameter.
    parameters : Parameters
        Parameters at the boundary equilibrium.
    levitates : {"above", "below"}
        Side of ``value`` on which the contact-free equilibrium is inside the wall.
    kind : {"persistence", "non-smooth fold", "degenerate"}
        What happens to the equilibria.
    force_rate : float
        Normal force (``m c_r Ω²``) of the synchronous rub per clearance of gap ``1 − |U*|``.
    orbits : tuple of SmallOrbit
        Orbits that shrink into it, virtual ones included.
    complete : bool
        Whether these are all such orbits with one impact a period.
    """

    gain: Gain
    value: float
    parameters: Parameters
    levitates: Side
    kind: BoundaryKind
    force_rate: float
    orbits: tuple[SmallOrbit, ...]
    complete: bool

    @property
    def words(self) -> str:
        """What happens there, in words."""
        lost = "falls" if self.levitates == "above" else "rises"
        return f"Where {self.gain} {lost} to {self.value:.7g}, {_EQUILIBRIA[self.kind]} {self._orbits_in_words()}"

    def _orbits_in_words(self) -> str:
        real = [orbit for orbit in self.orbits if orbit.admissible]
        sentences = []
        for inside, side in ((True, "bound its recovery on the side where it levitates"), (False, "take over beyond")):
            group = [orbit for orbit in real if orbit.levitating_side == inside]
            if group:
                listed = ", ".join(f"{orbit.name} ({'stable' if orbit.stable else 'unstable'})" for orbit in group)
                sentences.append(f"Bouncing orbits that shrink to zero amplitude there {side}: {listed}.")
        return " ".join(sentences) if sentences else "No bouncing orbit with one impact a period shrinks to this point."


_EQUILIBRIA = {
    "persistence": (f"levitation turns into a stable {STEADY_WORDS['rub']} that begins without force (persistence)."),
    "non-smooth fold": (
        f"levitation meets an unstable {STEADY_WORDS['rub']} and both vanish (non-smooth fold): the rotor must move to another motion."
    ),
    "degenerate": "levitation ends on the wall in the degenerate case between persistence and non-smooth fold.",
}


@checked
def boundary_equilibria(machine: Subject, gain: Gain = "gamma") -> tuple[BoundaryEquilibrium, ...]:
    """Find where the contact-free equilibrium meets the wall along a gain, and classify what happens.

    ``|U*| = 1`` is ``ρ² = (1 − ω²)² + γ²``, from (3.7) of the source paper.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    gain : {"gamma", "omega"}
        The parameter that is varied through positive values, all others fixed.

    Returns
    -------
    tuple of BoundaryEquilibrium
        At most one along ``gamma`` and two along ``omega``, in ascending order.

    Raises
    ------
    InputError
        There is no such gain.

    See Also
    --------
    carom.closed_forms.rub_limit : where the stable rub ends
    carom.find_bifurcations : all branches along a parameter

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml")
    >>> (boundary,) = cm.bifurcations.boundary_equilibria(machine)
    >>> print(f"{boundary.value:.10f}", boundary.kind)
    0.0724686787 non-smooth fold
    """
    rotor = exact_rotor_of(machine)
    ranges, sides = ranges_of("contact-free", rotor.parameters, gain), get_args(Side)
    ends = [pair for span in ranges for pair in zip(span, sides, strict=True)]
    return tuple(_classified(rotor.parameters, gain, end.value, side) for end, side in ends if end.kind)


def _classified(parameters: Parameters, gain: Gain, value: float, levitates: Side) -> BoundaryEquilibrium:
    at = parameters.replace(**{gain: value})
    balance = boundary_balance(at)
    orbits, complete = _small_orbits(at)
    force_rate = at.rho * at.rho / balance if balance != 0.0 else math.inf
    return BoundaryEquilibrium(gain, value, at, levitates, boundary_kind(at), force_rate, orbits, complete)


def _small_orbits(at: Parameters) -> tuple[tuple[SmallOrbit, ...], bool]:
    """Orbits that shrink into the boundary equilibrium, and whether these are all."""
    if at.gamma <= 0.0:
        return (), False
    rotor, found = jeffcott(at), []
    longest = longest_within_reach(rotor)
    cycles_there = small_cycles(rotor, longest=longest)
    starts_below = PeriodCondition.planar(at).roots(longest).starts_below
    for root, cycle in enumerate(cycles_there.cycles):
        # F₁ starts positive unless d = 1, when T = 0 may be the shorter root of the first pair.
        pair, longer = divmod(root + int(starts_below), 2)
        name = OrbitName(pair + 1, bool(longer), not cycle.levitating_side)
        found.append(SmallOrbit(name, *(getattr(cycle, each.name) for each in fields(SmallOrbit)[1:])))
    return tuple(sorted(found, key=lambda orbit: orbit.name)), cycles_there.complete
