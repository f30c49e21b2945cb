r"""What is born where levitation of a rotor of any number of modes meets a wall: rubs, and cycles with one contact a period.

To first order in the gap ``g`` the motion there is piecewise linear and homogeneous (:mod:`carom.closed_forms.piecewise`).  So every
motion that shrinks into that point exists on one side of it, with a period that does not depend on ``g`` and sizes proportional to it.

*Rub.*  At rest in contact ``g = Re(h) N``, with a spring ``g = (Re(h) + 1/κ) N`` of the wall; ``h = H(1 + iμ)`` with the static receptance ``H`` of
the plane.  Above zero the rub takes over from levitation, *persistence*; below it both meet and vanish, a *non-smooth fold*.

*Rigid wall.*  With ``a₁₂ = W(e^{−MT} − 1)^{-1}B`` and ``a₂₂ = WM(e^{−MT} − 1)^{-1}B``

    F₁(T) = 1 + Re(q a₂₂) = 0,      g = Re(q a₁₂) δ̇,

for any number of modes: the condition of the source paper for the periods, and for the side.  Where ``Re(q a₁₂) < 0`` the cycle exists where the rotor
levitates, *subcritical*; else beyond, *supercritical*.

Multipliers are those of the flight and the impact, with what its instant depends on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from carom.base.arguments import Positive, Whole, checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.closed_forms.periods import PeriodCondition
from carom.closed_forms.piecewise import Pieces
from carom.closed_forms.statics import exponent_of
from carom.models import Rotor, Subject, System, rotor_of

SAMPLES = 600
"""Instants of a flight at which it is seen whether it stays off the wall."""
ROUNDING = 1e-9
"""Depth, relative to the largest, that counts as none."""


@dataclass(frozen=True, eq=False, repr=False)
class SmallCycle(Result):
    """A cycle with one impact a period that shrinks into the point where levitation meets a rigid wall.

    Attributes
    ----------
    period : float
        In ``1/Ω``.
    speed_rate : float
        Speed of the impact, ``c_r Ω``, per clearance of distance of levitation from the wall.
    levitating_side : bool
        Whether it exists where the rotor levitates inside the wall; otherwise beyond.
    admissible : bool
        Whether it stays off the wall in flight; other planes are clear.
    multipliers : ndarray of complex, shape (2N − 1,)
        Of the linear motion, N that of its complex amplitudes, without that along the cycle.
    state : ndarray of complex, shape (N,)
        Amplitudes of the free modes just before the impact, per distance.
    """

    shown: ClassVar = ("period", "speed_rate", "criticality", "admissible", "stable")

    period: float
    speed_rate: float
    levitating_side: bool
    admissible: bool
    multipliers: np.ndarray
    state: np.ndarray

    @property
    def criticality(self) -> Literal["subcritical", "supercritical"]:
        """Subcritical: it exists where the rotor levitates."""
        return "subcritical" if self.levitating_side else "supercritical"

    @property
    def stable(self) -> bool:
        """Whether small vibrations about it decay."""
        return bool(np.abs(self.multipliers).max(initial=0.0) < 1.0)


@dataclass(frozen=True, eq=False, repr=False)
class WallMeeting(Result):
    """What is born where levitation of a rotor meets a wall.

    Attributes
    ----------
    rotor : Model
    plane : int
        The plane.
    gap : float
        Distance of levitation from the wall there, in clearances, below zero inside: the test function, zero where they meet.
    force_rate : float
        Normal force of the rub, in ``m c_r Ω²``, per gap: its sign says on which side the rub exists.  Zero in a
        wall whose force grows with a higher power of the depth, into which levitation goes on.
    rub_eigenvalues : ndarray of complex, shape (2N,)
        Exponents of small motions in contact with a compliant wall; empty for a rigid wall.
    cycles : tuple of SmallCycle
        By growing period, virtual ones included; of rigid walls only.
    complete : bool
        Whether these are provably all with one impact a period: of rigid walls.
    """

    shown: ClassVar = ("rotor", "plane", "gap", "kind", "rub_stable", "cycles")

    rotor: Rotor
    plane: int
    gap: float
    force_rate: float
    rub_eigenvalues: np.ndarray
    cycles: tuple[SmallCycle, ...]
    complete: bool

    @property
    def kind(self) -> Literal["persistence", "non-smooth fold"]:
        """Whether the rub takes over from levitation, or both vanish."""
        return "persistence" if self.force_rate >= 0.0 else "non-smooth fold"

    def coordinates(self, cycle: SmallCycle) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and rates of the rotor just before the impact of a cycle, to first order in the present gap, both (n,).

        They are those of a motion if the gap is on the side of the cycle.
        """
        system = self.rotor.system
        amplitudes = np.zeros(system.modes, complex)
        amplitudes[system.free] = abs(self.gap) * cycle.state
        position, velocity = system.state(amplitudes)
        return np.atleast_1d(position), np.atleast_1d(velocity)

    @property
    def rub_stable(self) -> bool | None:
        """Whether the rub that begins there is stable, in a compliant wall; ``None`` for a rigid one."""
        return bool(self.rub_eigenvalues.real.max() < 0.0) if len(self.rub_eigenvalues) else None


@checked
def small_cycles(machine: Subject, plane: Whole | None = None, longest: Positive | None = None) -> WallMeeting:
    """Rubs and cycles that are born where levitation meets a wall, for any number of modes and planes.

    The rotor is taken as it is, so it should be near that point: results hold to first order in the gap.  The derivation is in
    :mod:`carom.closed_forms.small_cycles_at_walls`.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Without weight or other forces that change with time in its frame.
    plane : int, optional
        Plane at which they meet, by default that which levitation is nearest to, or deepest in.  Others are clear.
    longest : float, optional
        Longest flight searched, in ``1/Ω``: by default all.

    Raises
    ------
    InputError
        There is no such plane, the plane is at its centre at rest, or forces change with time.
    CaromError
        A rigid wall, and damping too weak to search all periods: give a shorter ``longest``.

    See Also
    --------
    carom.bifurcations.boundary_equilibria : the same, with the orbits

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/source-paper.toml", ["gamma=0.0724686787"])
    >>> found = cm.closed_forms.small_cycles(machine)
    >>> found.kind, [(f"{cycle.period:.4f}", cycle.criticality) for cycle in found.cycles]
    ('non-smooth fold', [('0.6668', 'subcritical'), ('3.0765', 'subcritical')])
    """
    model = rotor_of(machine)
    model.refuse_forces()
    system = model.system
    radii = np.abs(system.arrays.offsets)
    place = int(radii.argmax()) if plane is None else plane
    if place >= len(radii):
        raise InputError("plane", place, f"a contact plane of the rotor, from 0 to {len(radii) - 1}")
    pieces = Pieces.of(system, place)
    linear = pieces.rigid or exponent_of(system.contacts[place].wall) == 1.0
    eigenvalues = np.linalg.eigvals(pieces.contact if linear else pieces.flight) if not pieces.rigid else np.empty(0)
    lever = pieces.compliance if linear else math.inf
    found, complete = _bouncing(system, place, pieces, longest) if pieces.rigid else ([], False)
    return WallMeeting(
        rotor=model,
        plane=place,
        gap=float(radii[place]) - 1.0,
        force_rate=float(system.arrays.masses[place]) / lever if lever else math.inf,
        rub_eigenvalues=eigenvalues,
        cycles=tuple(sorted(found, key=lambda each: each.period)),
        complete=complete,
    )


def _bouncing(system: System, plane: int, pieces: Pieces, longest: float | None) -> tuple[list[SmallCycle], bool]:
    """Cycles of bounces off a rigid wall, and whether they are all."""
    roots = PeriodCondition.of(system, plane=plane).roots(longest)
    found = []
    for period in roots.periods.tolist():
        flight = pieces.in_flight(period)
        # Before the impact, per speed: (1 − F) x = F b, with the change b by an impact of speed one.
        before_impact = np.linalg.solve(np.eye(len(flight)) - flight, flight @ pieces.impact_column)
        lever = -float(pieces.depth @ before_impact)
        if lever == 0.0:
            continue
        state = before_impact / lever
        carried = flight @ pieces.before_impact(state)
        left = state + pieces.impact_column * (pieces.speed @ state)
        depths = _along(pieces, left, period)[1:-1] @ pieces.depth + 1.0
        inside = bool((math.copysign(1.0, lever) * depths).max() <= ROUNDING * np.abs(depths).max())
        # For a gap of one, or of minus one if the plane would leave the wall.
        speed, half = float(pieces.speed @ state), len(state) // 2
        multipliers = np.linalg.eigvals(carried)
        own = np.delete(multipliers, np.abs(multipliers - 1.0).argmin())
        amplitudes = math.copysign(1.0, speed) * (state[:half] + 1j * state[half:])
        found.append(SmallCycle(period, abs(speed), speed < 0.0, inside, own, amplitudes))
    return found, roots.proven


def _along(pieces: Pieces, state: np.ndarray, time: float) -> np.ndarray:
    """States in a flight at evenly spaced instants, shape (m, 2N)."""
    step, states = pieces.in_flight(time / SAMPLES), [state]
    for _ in range(SAMPLES):
        states.append(step @ states[-1])
    return np.array(states)
