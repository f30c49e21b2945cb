r"""What is born where levitation of a rotor of any number of modes meets a wall: rubs, and cycles with one contact a period.

To first order in the gap ``g`` the motion there is piecewise linear and homogeneous, as below.  So every
motion that shrinks into that point exists on one side of it, with a period that does not depend on ``g`` and sizes proportional to it.

*Rub.*  At rest in contact ``g = Re(h) N``, with a spring ``g = (Re(h) + 1/κ) N`` of the wall; ``h = H(1 + iμ)`` with the static receptance ``H`` of
the plane.  Above zero the rub takes over from levitation, *persistence*; below it both meet and vanish, a *non-smooth fold*.

*Rigid wall.*  With ``a₁₂ = W(e^{−MT} − 1)^{-1}B`` and ``a₂₂ = WM(e^{−MT} − 1)^{-1}B``

    F₁(T) = 1 + Re(q a₂₂) = 0,      g = Re(q a₁₂) δ̇,

for any number of modes: the condition of the source paper for the periods, and for the side.  Where ``Re(q a₁₂) < 0`` the cycle exists where the rotor
levitates, *subcritical*; else beyond, *supercritical*.

Multipliers are those of the flight and the impact, with what its instant depends on.

*The pieces of linear motion.*  Let ``y*`` be the place at rest of a plane, ``n = y*/|y*|`` and ``g = |y*| − 1`` the gap, below zero where the rotor levitates.  With the
amplitudes ``c`` of the free modes, ``ċ = Mc``, the row ``W`` of the plane and what an impulse there does, ``B``, a plane that is near
``y*`` is ``δ = g + Re(n̄Wc)`` deep in its wall, up to terms of second order, and slip is forward.

*Rigid wall.*  An impact at ``δ = 0`` with ``δ̇ > 0`` changes ``c`` by ``−Bqnδ̇`` with ``q = (1 + d)(1 + iμ)``.

*Wall with a linear spring.*  While the force ``N = κδ + ηδ̇`` per effective mass pushes, ``ċ = Mc − (1 + iμ)Bn N``.  Where contact begins
the rates jump by ``ηδ̇``; where it ends nothing does.

All of it is homogeneous in ``c`` and ``g``: only the sign of ``g`` matters, and motions are proportional to its size.  A wall whose force grows with a
higher power of the depth has no effect to first order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from scipy.linalg import expm  # type: ignore[import-untyped]

from carom.base.arguments import Positive, Whole, checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.closed_forms.periods import PeriodCondition
from carom.closed_forms.statics import exponent_of
from carom.core.friction import sliding_factor
from carom.models import Rotor, Subject, System, rotor_of
from carom.models.subjects import refuse_forces


@dataclass(frozen=True, eq=False)
class Pieces:
    """Motion next to a point of a wall, over real and imaginary parts of the amplitudes of the free modes.

    Attributes
    ----------
    flight : ndarray, shape (2N, 2N)
        Rates per state in flight.
    depth, speed : ndarray, shape (2N,)
        ``δ − g`` and ``δ̇`` per state.
    push : ndarray, shape (2N,)
        What changes the state with a normal force of one, per effective mass.
    impact_column : ndarray, shape (2N,)
        What changes it with an impact of speed one at a rigid wall.
    stiffness, loss : float
        ``κ`` and ``η``; zero for a rigid wall.
    """

    flight: np.ndarray
    depth: np.ndarray
    speed: np.ndarray
    push: np.ndarray
    impact_column: np.ndarray
    stiffness: float
    loss: float

    @classmethod
    def of(cls, system: System, plane: int) -> Pieces:
        """Pieces at a plane of a system, which is not at rest in the centre of it."""
        arrays, free = system.arrays, system.free
        rest = complex(arrays.offsets[plane])
        if rest == 0.0:
            raise InputError("plane", plane, "one that is off its centre at rest: otherwise there is no direction")
        normal = rest / abs(rest)
        generator = system.generator[np.ix_(free, free)]
        row, column = arrays.rows[plane, free] * normal.conjugate(), arrays.columns[free, plane] * normal
        friction, restitution = float(arrays.friction[plane]), float(arrays.restitution[plane])
        return cls(
            flight=np.block([[generator.real, -generator.imag], [generator.imag, generator.real]]),
            depth=_read(row),
            speed=_read(row @ generator),
            push=_written(-complex(1.0, friction) * column),
            impact_column=_written(-sliding_factor(friction, restitution) * column),
            stiffness=float(arrays.stiffness[plane]),
            # The dissipation of a Hunt–Crossley wall acts on what is small already.
            loss=0.0 if arrays.law_number[plane] else float(arrays.loss[plane]),
        )

    @property
    def rigid(self) -> bool:
        """Whether the wall is rigid."""
        return not self.stiffness

    @cached_property
    def force(self) -> np.ndarray:
        """Normal force per state, beside that of the gap."""
        return self.stiffness * self.depth + self.loss * self.speed

    @cached_property
    def contact(self) -> np.ndarray:
        """Rates per state in contact, shape (2N, 2N)."""
        return self.flight + np.outer(self.push, self.force)

    @cached_property
    def compliance(self) -> float:
        """Gap per normal force at rest in contact: ``Re h``, how far the force and its friction move the plane, and how far the wall is indented."""
        moved = float(self.depth @ np.linalg.solve(self.flight, self.push))
        return moved if self.rigid else moved + 1.0 / self.stiffness

    def in_flight(self, time: float) -> np.ndarray:
        """State after a flight per state before it."""
        return expm(self.flight * time)

    def before_impact(self, state: np.ndarray) -> np.ndarray:
        """Derivative of the state after an impact by that before it, as it happens earlier or later, shape (2N, 2N)."""
        unit, ahead = np.eye(len(state)), self.depth / (self.speed @ state)
        before = self.flight @ state
        reset = unit + np.outer(self.impact_column, self.speed)
        return reset + np.outer(self.flight @ reset @ state - reset @ before, ahead)


def _read(row: np.ndarray) -> np.ndarray:
    """``Re(row c)`` per real and imaginary parts of ``c``."""
    return np.concatenate([row.real, -row.imag])


def _written(column: np.ndarray) -> np.ndarray:
    return np.concatenate([column.real, column.imag])


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
    refuse_forces(model)
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
