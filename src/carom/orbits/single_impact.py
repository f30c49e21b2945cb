"""Orbits of a rotor: all with one impact a period in closed form, with admissibility and multipliers, or those that a search finds."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from carom.base.arguments import Count, Positive, Reals, Seed, checked
from carom.base.outcome import InputError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Members, in_a_line
from carom.closed_forms.periods import PeriodCondition, PeriodRoots
from carom.core.planar import impact_jacobian
from carom.models import Rotor, Subject, exact_rotor_of, rotor_of
from carom.orbits.admissibility import slip_stays_forward, why_virtual
from carom.orbits.maps import Multipliers, Section, multipliers_of_all
from carom.orbits.names import OrbitName, Slip
from carom.orbits.orbit import Orbit
from carom.orbits.search import Impacts, search_orbits
from carom.orbits.searched import Searched
from carom.orbits.shooting import ShootingStart
from carom.orbits.simulated import SimulatedOrbit
from carom.orbits.simulated_search import search_simulated
from carom.orbits.word import Kind, Word

_CLOSED_FORMS_ALONE = (
    "none, except for the planar rotor in a rigid bearing without weight and limits, whose orbits have closed forms"
)
A_FEW = 30
"""Guesses of a search that is asked for no number of impacts."""
MOST_RADIANS = 1500.0
"""Largest modulus ``|λT|`` of the fastest mode over the longest period that is searched: some hundred orbits."""


FORWARD, BACKWARD = Word.of(Kind.IMPACT_FORWARD), Word.of(Kind.IMPACT_BACKWARD)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitSet(Members[Orbit]):
    """Orbits of a rotor; look one up by index or by name, ``orbits["B1,d"]``.

    Without a search they are all with one impact a period of the planar rotor, virtual ones included.  With a search they are admissible:
    first those known before, of the planar rotor all with one impact, under their names; then
    those that the search found, the fewest impacts first, then the shortest period.  It proves nothing: an orbit to which no guess led is missing.

    Attributes
    ----------
    rotor : Rotor
    members : tuple of Orbit
    impacts : int
        Most impacts a period.
    search : Searched or None
        How much was searched; ``None`` without a search.
    periods : ndarray
        All roots of ``F₁``, each of which gives up to two orbits; empty with a search.
    longest_period : float
        End of the searched range; infinite with a search.
    complete : bool
        Whether there is provably no other root.
    slip_stays_forward : bool
        Whether it is proven that the slip of every orbit inside the wall stays forward throughout its impacts.
        Otherwise orbits with backward slip are listed too, but without a search orbits whose impacts stop the slip are missing.
        Only a rotor about as small as its clearance can have either.
    """

    figure: ClassVar[str] = "equilibria_and_orbits"
    called: ClassVar[str] = "orbit"

    # Not narrower: without a search it is a planar rotor, whose parameters are read.
    rotor: Any
    # Not narrower: those of a search are closed as words of impacts, or on the flow of the simulator.
    members: tuple[Any, ...]
    impacts: int
    search: Searched | None
    periods: np.ndarray
    longest_period: float
    complete: bool
    slip_stays_forward: bool

    @classmethod
    @checked
    def none(cls, rotor: Rotor) -> OrbitSet:
        """No orbits, and none searched: of a rotor whose motions never repeat."""
        return cls(rotor, (), 1, None, np.empty(0), 0.0, complete=False, slip_stays_forward=False)

    def rows(self) -> list[tuple[str, str]]:
        """Each orbit, and whether the list is complete or how much was searched."""
        shown = []
        for orbit in self:
            stable = orbit.multipliers.stability
            period, speed = (self.line_of(name, getattr(orbit, name)) for name in ("period", "radial_speed"))
            words = f"{stable}, {orbit.segments}"
            if self.search is None:
                words = f"radial speed {speed}, {stable}, {orbit.reason or 'admissible'}"
            shown.append((orbit.name, f"period {period}, {words}"))
        end = ("complete", in_a_line(self.complete)) if self.search is None else ("search", self.argument)
        return [("rotor", in_a_line(self.rotor)), *shown, end]

    @property
    def argument(self) -> str:
        """Why no orbit is missing, in one sentence; or how much was searched, in a few."""
        if self.search is not None:
            return self.search.words
        if self.rotor.system.why_not_stationary is not None:
            return f"There are no periodic orbits: with {self.rotor.system.why_not_stationary[0]} no motion repeats itself."
        count = len(self.periods)
        found = f"F1 has {count or 'no'} root{'' if count == 1 else 's'} for 0 < T ≤ {self.longest_period:.4g}/Ω"
        search = f"{found}, isolated by a bound on its second derivative"
        beyond = "for longer periods the decay of the free motion keeps F1 above zero"
        stopping = "an impact that stops the slip would throw the rotor beyond the clearance"
        return (
            f"{search}; {beyond if self.complete else 'longer periods were not searched'}; "
            f"{stopping if self.slip_stays_forward else 'orbits whose impacts stop the slip were not searched'}."
        )


@checked
def period_condition(machine: Subject, periods: Reals) -> np.ndarray:
    """``F₁(T) = 1 + Re(q a₂₂(T))``, whose roots are the periods of single-impact orbits (source paper (4.4))."""
    rotor = exact_rotor_of(machine)
    return PeriodCondition.planar(rotor.parameters).value(np.asarray(periods, float))


@checked
@shows_progress
def find_orbits(
    machine: Subject,
    longest_period: Positive | None = None,
    *,
    impacts: Impacts | None = None,
    guesses: Count | None = None,
    seed: Seed = 0,
    progress: ShowProgress = None,
) -> OrbitSet:
    """All orbits with one impact a period, synchronous with the shaft, or a search for those with at most so many.

    With ``q = (1 + d)(1 + iμ)`` and the return of the flight to its start, ``a₁₂`` and ``a₂₂`` of
    :mod:`carom.closed_forms.periods`, the conditions of the source paper (4.3)–(4.5) are: the period is a root of
    ``F₁(T) = 1 + Re(q a₂₂)``; ``|1 + q a₁₂ ṙ|² = |U*|²`` gives two radial speeds; ``U₀ = U*/(1 + q a₁₂ ṙ)`` and
    ``θ̇ = −Im(q a₂₂) ṙ``.  Orbits whose slip ``s + 1 + θ̇`` is backward solve the same with ``−μ``; they are searched unless the
    rotor is so large that they cannot stay inside the wall.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Any; a planar rotor on a rigid bearing with positive damping, or with ``longest_period``.
    longest_period : float, optional
        Search only periods up to this, in ``1/Ω``; where all orbits with one impact have closed forms.
    impacts : int, optional
        Orbits with at most this many impacts a period instead, with lasting contact too: those with one impact of the planar
        rotor, and others by Newton's method from ends and stretches of simulated motions; what is found is exact, but nothing proves
        that it is all.  Of rotors without closed forms the default is a short search of those with one impact.
    guesses, seed : int
        Number of stretches that this search tries for each number of impacts, by default 1500 or, for a rotor of many states, as many as
        take about a minute; and the seed of the random starts.
    progress : callable or bool, optional
        See :func:`~carom.motions.simulate`.

    Returns
    -------
    OrbitSet
        All orbits with one impact, virtual ones included, each with its reason; or the admissible orbits with at most so many
        impacts that are known, and what was searched.

    Raises
    ------
    InputError
        Without damping there are infinitely many with one impact; give ``longest_period``.  ``impacts`` or ``guesses`` is no
        whole number, or below 1.

    See Also
    --------
    carom.continue_orbit : follow an orbit along a parameter
    carom.orbits.orbit_of_motion : the orbit on which a motion has settled
    carom.prove : the same as theorems

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> orbits = cm.find_orbits(machine)
    >>> [orbit.name for orbit in orbits if orbit.admissible]
    ['B1,a', 'B1,b', 'B1,c', 'B1,d']
    >>> print(f"{orbits['B1,d'].period:.6f}", orbits["B1,d"].stable)
    2.328416 True
    """
    rotor = rotor_of(machine)
    if impacts is None and rotor.has_closed_forms:
        return _in_closed_form(rotor, longest_period)
    if longest_period is not None:
        raise InputError("longest_period", longest_period, _CLOSED_FORMS_ALONE)
    if impacts is None:
        impacts, guesses = 1, guesses or A_FEW
    tell = Reporter.of(progress, "searching orbits")
    rotor.system.refuse_non_stationary()
    members: tuple[Orbit | SimulatedOrbit, ...]
    if rotor.has_closed_forms:
        there = [orbit for orbit in orbits_within_reach(rotor) if orbit.admissible]
        members, search = search_orbits(rotor, impacts, guesses, seed, there, tell)
    else:
        members, search = search_simulated(rotor, impacts, guesses, seed, tell)
    return OrbitSet(rotor, members, impacts, search, np.empty(0), math.inf, complete=False, slip_stays_forward=False)


def _in_closed_form(rotor: Rotor, longest_period: float | None) -> OrbitSet:
    """All orbits with one impact a period up to a longest one."""
    roots = PeriodCondition.planar(rotor.parameters).roots(longest_period)
    orbits = _orbits_at(rotor, roots, 1)
    forward_only = slip_stays_forward(rotor)
    if not forward_only:
        backward = PeriodCondition.planar(rotor.parameters, slip=-1)
        surface = rotor.parameters.radius_ratio + 1.0
        found = _orbits_at(rotor, backward.roots(longest_period), -1)
        orbits += [orbit for orbit in found if surface + orbit.angular_speed < 0.0 < orbit.radial_speed]
    reached = roots.periods, roots.longest_period, roots.proven
    return OrbitSet(rotor, tuple(orbits), 1, None, *reached, slip_stays_forward=forward_only)


@checked
def orbits_within_reach(machine: Subject) -> OrbitSet:
    """All single-impact orbits; where little or no damping makes them too many, only those of shorter period.

    Returns
    -------
    OrbitSet
        Its ``complete`` and ``argument`` tell whether the list was cut.
    """
    rotor = exact_rotor_of(machine)
    return find_orbits(rotor, longest_within_reach(rotor))


def longest_within_reach(rotor: Rotor) -> float | None:
    """Period up to which :func:`orbits_within_reach` looks, in ``1/Ω``; ``None`` where it looks for all orbits."""
    condition = PeriodCondition.planar(rotor.parameters)
    limit = min(MOST_RADIANS / float(abs(rotor.system.arrays["exponents"]).max()), condition.longest_distinct())
    return None if condition.longest_period() <= limit else limit


def _orbits_at(rotor: Rotor, roots: PeriodRoots, slip: Slip) -> list[Orbit]:
    """Orbits at all roots, in the order of their pairs and letters."""
    parameters, periods = rotor.parameters, roots.periods.tolist()
    gamma, omega, friction, d = parameters.gamma, parameters.omega, slip * parameters.mu, parameters.d
    levers, turns = roots.returns.T.tolist()
    found = list(orbits_of_roots(rotor, roots, slip))
    stability = multipliers_of_all(
        [impact_jacobian(gamma, omega, friction, d, periods[root], speed) for _, root, speed in found]
    )
    orbits = []
    for (name, root, speed), nontrivial in zip(found, stability, strict=True):
        position = rotor.equilibrium / (1.0 + levers[root] * speed)
        section = Section(cmath.phase(position), speed, -turns[root].imag * speed)
        orbits.append(orbit_at(rotor, name, periods[root], section, nontrivial))
    return sorted(orbits, key=lambda orbit: orbit.name.place)


def orbits_of_roots(rotor: Rotor, roots: PeriodRoots, slip: Slip = 1) -> Iterator[tuple[OrbitName, int, float]]:
    """Name, index of the root and radial speed of each orbit."""
    for root, lever in enumerate(roots.returns[:, 0].tolist()):
        # F₁ starts positive unless d = 1, when T = 0 may be the shorter root of the first pair.
        pair, longer = divmod(root + int(roots.starts_below), 2)
        for faster, speed in enumerate(radial_speeds(abs(rotor.equilibrium), lever)):
            yield OrbitName(pair + 1, bool(longer), bool(faster), slip), root, speed


def orbit_at(rotor: Rotor, name: OrbitName, period: float, section: Section, nontrivial: Multipliers) -> Orbit:
    """Orbit of known period, in ``1/Ω``, and state just before the impact, with its admissibility checked."""
    before = section.state
    word = FORWARD if name.slip > 0 else BACKWARD
    start = ShootingStart(np.array([[before.position, before.velocity]]), np.array([period]))
    return Orbit(rotor, name, word, *start, nontrivial, why_virtual(rotor, word, start))


def radial_speeds(rest: float, lever: complex) -> tuple[float, ...]:
    """Both solutions of ``|1 + q a₁₂ ṙ|² = |U*|²``, the lower first; empty if they are not real or ``U* = 0``.

    ``rest`` is ``|U*|``, and ``lever`` is ``q a₁₂``.
    """
    square, half = abs(lever) ** 2, lever.real
    constant = (1.0 - rest) * (1.0 + rest)
    discriminant = half**2 - square * constant
    if discriminant < 0.0 or rest == 0.0:
        return ()
    larger = -(half + math.copysign(math.sqrt(discriminant), half))
    if larger == 0.0:
        return (0.0, 0.0)
    return tuple(sorted((larger / square, constant / larger)))
