r"""What is born where levitation of a rotor of any number of modes meets a wall: rubs, and cycles with one contact a period.

To first order in the gap ``g`` the motion there is piecewise linear and homogeneous (:mod:`carom.closed_forms.piecewise`).  So every
motion that shrinks into that point exists on one side of it, with a period that does not depend on ``g`` and sizes proportional to it.

*Rub.*  At rest in contact ``g = Re(h) N``, with a spring ``g = (Re(h) + 1/κ) N`` of the wall; ``h = H(1 + iμ)`` with the static receptance ``H`` of
the plane.  Above zero the rub takes over from levitation, *persistence*; below it both meet and vanish, a *non-smooth fold*.

*Rigid wall.*  With ``a₁₂ = W(e^{−MT} − 1)^{-1}B`` and ``a₂₂ = WM(e^{−MT} − 1)^{-1}B``

    F₁(T) = 1 + Re(q a₂₂) = 0,      g = Re(q a₁₂) δ̇,

for any number of modes: the condition of the source paper for the periods, and for the side.  Where ``Re(q a₁₂) < 0`` the cycle exists where the rotor
levitates, *subcritical*; else beyond, *supercritical*.

*Wall that gives way.*  A flight ``F = e^{AT₁}`` and a contact ``C = e^{A_cT₂}`` with the state ``x_r`` at rest in contact, per gap, close with the state
``gX`` at the beginning of contact if

    (1 − FC) X = F(1 − C) x_r,      δ(X) = 0,      N(x_r + C(X − x_r)) = 0:

two equations for ``T₁`` and ``T₂``.  The cycle exists on the side on which it comes in: ``g δ̇(X) > 0``.

Multipliers are those of ``FC`` or of ``F`` and the arrival, with what its instant depends on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from carom.arguments import Positive, Whole, checked
from carom.closed_forms.periods import PeriodCondition
from carom.closed_forms.piecewise import Pieces
from carom.closed_forms.statics import exponent_of
from carom.models import Rotor, Subject, System, rotor_of
from carom.outcome import InputError
from carom.results import Result

LONGEST = 8.0 * math.pi
"""Longest flight, in ``1/Ω``, of the cycles in a wall that gives way: four turns of the shaft."""
FLIGHTS, CONTACTS = 160, 60
"""Durations at which the equations of such cycles are looked at, evenly spaced and from the shortest on."""
BRIEFEST = 0.02
"""Shortest contact looked at, in the shortest time in which a motion in contact changes."""
STEPS, CLOSED, SAME = 30, 1e-11, 1e-6
"""Steps of Newton's method, what may be left, and the relative distance of durations that are the same."""
WITHIN = 16
"""Parts of a flight or a contact at whose ends it is seen, in the middle of it, whether there may be a motion."""
SAMPLES = 600
"""Instants of a flight, or a contact, at which it is seen whether it stays there."""
ROUNDING = 1e-9
"""Depth, relative to the largest, that counts as none."""


@dataclass(frozen=True, eq=False, repr=False)
class SmallCycle(Result):
    """A cycle with one contact a period that shrinks into the point where levitation meets the wall.

    Attributes
    ----------
    flight, contact : float
        Durations, in ``1/Ω``; contact with a rigid wall takes none.
    speed_rate : float
        Speed of the arrival, ``c_r Ω``, per clearance of distance of levitation from the wall.
    levitating_side : bool
        Whether it exists where the rotor levitates inside the wall; otherwise beyond.
    admissible : bool
        Whether it stays off the wall in flight, and pushes it in contact; other planes are clear.
    multipliers : ndarray of complex, shape (2N − 1,)
        Of the linear motion, N that of its complex amplitudes, without that along the cycle.
    state : ndarray of complex, shape (N,)
        Amplitudes of the free modes just before contact, per distance.
    """

    shown: ClassVar = ("period", "contact", "speed_rate", "criticality", "admissible", "stable")

    flight: float
    contact: float
    speed_rate: float
    levitating_side: bool
    admissible: bool
    multipliers: np.ndarray
    state: np.ndarray

    @property
    def period(self) -> float:
        """Duration of both."""
        return self.flight + self.contact

    @property
    def criticality(self) -> Literal["subcritical", "supercritical"]:
        """Subcritical: it exists where the rotor levitates."""
        return "subcritical" if self.levitating_side else "supercritical"

    @property
    def stable(self) -> bool:
        """Whether small disturbances of it die out."""
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
        Exponents of small motions in contact with a wall that gives way; empty for a rigid wall.
    cycles : tuple of SmallCycle
        By growing period, virtual ones included.
    complete : bool
        Whether these are provably all with one contact a period: of rigid walls.
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
        """Coordinates and rates of the rotor just before contact in a cycle, to first order in the present gap, both (n,).

        They are those of a motion if the gap is on the side of the cycle.
        """
        system = self.rotor.system
        amplitudes = np.zeros(system.modes, complex)
        amplitudes[system.free] = abs(self.gap) * cycle.state
        position, velocity = system.state(amplitudes)
        return np.atleast_1d(position), np.atleast_1d(velocity)

    @property
    def rub_stable(self) -> bool | None:
        """Whether the rub that begins there is stable, in a wall that gives way; ``None`` for a rigid one."""
        return bool(self.rub_eigenvalues.real.max() < 0.0) if len(self.rub_eigenvalues) else None


@checked
def small_cycles(machine: Subject, plane: Whole | None = None, longest: Positive | None = None) -> WallMeeting:
    """Rubs and cycles that are born where levitation meets a wall, for any number of modes and planes.

    The rotor is taken as it is, so it should be near that point: results hold to first order in the gap.  The derivation is in
    :mod:`carom.closed_forms.wall_meetings`.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Without weight or other forces that change with time in its frame.
    plane : int, optional
        Plane at which they meet, by default that which levitation is nearest to, or deepest in.  Others are clear.
    longest : float, optional
        Longest flight searched, in ``1/Ω``: by default all in a rigid wall, four turns in a wall that gives way.

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
    >>> meeting = cm.closed_forms.small_cycles(machine)
    >>> meeting.kind, [(f"{cycle.period:.4f}", cycle.criticality) for cycle in meeting.cycles]
    ('non-smooth fold', [('0.6668', 'subcritical'), ('3.0765', 'subcritical')])
    """
    model = rotor_of(machine)
    system = model.system
    system.refuse_forces()
    radii = np.abs(system.arrays.offsets)
    place = int(radii.argmax()) if plane is None else plane
    if place >= len(radii):
        raise InputError("plane", place, f"a contact plane of the rotor, from 0 to {len(radii) - 1}")
    pieces = Pieces.of(system, place)
    felt = pieces.rigid or exponent_of(system.contacts[place].wall) == 1.0
    eigenvalues = np.linalg.eigvals(pieces.contact if felt else pieces.flight) if not pieces.rigid else np.empty(0)
    lever = pieces.compliance if felt else math.inf
    found: list[SmallCycle] = []
    complete = False
    if pieces.rigid:
        found, complete = _bouncing(system, place, pieces, longest)
    elif felt:
        found = _in_wall(pieces, longest or LONGEST)
    return WallMeeting(
        rotor=model,
        plane=place,
        gap=float(radii[place]) - 1.0,
        force_rate=float(system.arrays.masses[place]) / lever if lever else math.inf,
        rub_eigenvalues=eigenvalues,
        cycles=tuple(sorted(found, key=lambda each: each.period)),
        complete=complete,
    )


def _cycle(
    pieces: Pieces, state: np.ndarray, flight: float, contact: float, carried: np.ndarray, admissible: bool
) -> SmallCycle:
    """A cycle from its state before contact for a gap of one, or of minus one if the plane would leave the wall."""
    speed, half = float(pieces.speed @ state), len(state) // 2
    side = math.copysign(1.0, speed)
    multipliers = np.linalg.eigvals(carried)
    own = np.delete(multipliers, np.abs(multipliers - 1.0).argmin())
    amplitudes = side * (state[:half] + 1j * state[half:])
    return SmallCycle(flight, contact, abs(speed), side < 0.0, admissible, own, amplitudes)


# ------------------------------------------------------------------------------------------------------- rigid walls


def _bouncing(system: System, plane: int, pieces: Pieces, longest: float | None) -> tuple[list[SmallCycle], bool]:
    """Cycles of bounces off a rigid wall, and whether they are all."""
    roots = PeriodCondition.of(system, plane=plane).roots(longest)
    found = []
    for period in roots.periods.tolist():
        flight = pieces.in_flight(period)
        # Before the arrival, per speed: (1 − F) x = F b, with the change b by an arrival of speed one.
        arrival = np.linalg.solve(np.eye(len(flight)) - flight, flight @ pieces.strike)
        lever = -float(pieces.depth @ arrival)
        if lever == 0.0:
            continue
        state = arrival / lever
        carried = flight @ pieces.arrival(state)
        left = state + pieces.strike * (pieces.speed @ state)
        depths = _along(pieces, left, period)[1:-1] @ pieces.depth + 1.0
        inside = bool((math.copysign(1.0, lever) * depths).max() <= ROUNDING * np.abs(depths).max())
        found.append(_cycle(pieces, state, period, 0.0, carried, inside))
    return found, roots.proven


def _along(pieces: Pieces, state: np.ndarray, time: float) -> np.ndarray:
    """States in a flight at evenly spaced instants, shape (m, 2N)."""
    step, states = pieces.in_flight(time / SAMPLES), [state]
    for _ in range(SAMPLES):
        states.append(step @ states[-1])
    return np.array(states)


# ---------------------------------------------------------------------------------------------- walls that give way


class _Try(NamedTuple):
    """The state before contact, per gap, of two durations; what is left of both equations, and its derivative."""

    state: np.ndarray
    misses: np.ndarray
    slopes: np.ndarray


def _in_wall(pieces: Pieces, longest: float) -> list[SmallCycle]:
    """Cycles in a wall that gives way, found from a grid of durations: where both equations change their sign."""
    fastest = float(np.abs(np.linalg.eigvals(pieces.contact)).max())
    shortest, step = BRIEFEST / fastest, longest / FLIGHTS
    flights = np.linspace(step, longest, FLIGHTS)
    if shortest < step:
        flights = np.concatenate([np.geomspace(shortest, step, CONTACTS)[:-1], flights])
    contacts = np.geomspace(shortest, longest, CONTACTS)
    found: list[SmallCycle] = []
    known: list[np.ndarray] = []
    for start in _cells(pieces, flights, contacts):
        times = _solved(pieces, start)
        if times is None or any(np.abs(times / other - 1.0).max() < SAME for other in known):
            continue
        known.append(times)
        cycle = _closed(pieces, *times.tolist())
        if cycle.admissible:
            found.append(cycle)
    return found


def _cells(pieces: Pieces, flights: np.ndarray, contacts: np.ndarray) -> list[np.ndarray]:
    """Middles of the cells of the grid at whose corners both equations have both signs, and which may hold a motion."""
    unit, rest = np.eye(len(pieces.depth)), pieces.pressed
    held = pieces.stiffness + pieces.force @ rest
    inside = np.array([pieces.in_contact(time) for time in contacts.tolist()])
    pushes = np.array([_seen(pieces.in_contact(time / WITHIN), pieces.force) for time in contacts.tolist()])
    table, possible = np.empty((len(flights), len(contacts), 2)), np.empty((len(flights), len(contacts)), bool)
    for number, time in enumerate(flights.tolist()):
        flight = pieces.in_flight(time)
        right = (flight @ (rest - inside @ rest).T).T[..., None]
        states = np.linalg.solve(unit - flight @ inside, right)[..., 0]
        ends = rest + np.einsum("kij,kj->ki", inside, states - rest)
        table[number, :, 0] = 1.0 + states @ pieces.depth
        table[number, :, 1] = pieces.stiffness + ends @ pieces.force
        side = np.sign(states @ pieces.speed)[:, None]
        forces = side * (held + np.einsum("kti,ki->kt", pushes, states - rest))
        depths = side * (1.0 + ends @ _seen(pieces.in_flight(time / WITHIN), pieces.depth).T)
        possible[number] = (forces.min(axis=1) > 0.0) & (depths.max(axis=1) < 0.0)
    corners = [(slice(None, -1), slice(None, -1)), (slice(1, None), slice(None, -1))]
    corners += [(slice(None, -1), slice(1, None)), (slice(1, None), slice(1, None))]
    values = np.stack([table[corner] for corner in corners])
    both = ((values.min(axis=0) < 0.0) & (values.max(axis=0) > 0.0)).all(axis=-1)
    both &= np.any([possible[corner] for corner in corners], axis=0)
    return [
        np.sqrt([flights[i] * flights[i + 1], contacts[k] * contacts[k + 1]]) for i, k in np.argwhere(both).tolist()
    ]


def _seen(step: np.ndarray, row: np.ndarray) -> np.ndarray:
    """What a row reads after one, two, ... steps, without the first and last quarter of them, per state before, shape (m, 2N)."""
    rows = [row]
    for _ in range(WITHIN - WITHIN // 4):
        rows.append(rows[-1] @ step)
    return np.array(rows[WITHIN // 4 :])


def _tried(pieces: Pieces, flight_time: float, contact_time: float) -> _Try:
    unit, rest = np.eye(len(pieces.depth)), pieces.pressed
    flight, inside = pieces.in_flight(flight_time), pieces.in_contact(contact_time)
    matrix = unit - flight @ inside
    state = np.linalg.solve(matrix, flight @ (rest - inside @ rest))
    end = rest + inside @ (state - rest)
    leaving = pieces.contact @ (end - rest)
    moved = np.linalg.solve(matrix, np.stack([pieces.flight @ state, flight @ leaving], axis=1))
    ends = inside @ moved
    ends[:, 1] += leaving
    misses = np.array([1.0 + pieces.depth @ state, (pieces.stiffness + pieces.force @ end) / pieces.stiffness])
    return _Try(state, misses, np.stack([pieces.depth @ moved, pieces.force @ ends / pieces.stiffness]))


def _solved(pieces: Pieces, times: np.ndarray) -> np.ndarray | None:
    """Durations that close a cycle, by Newton's method; ``None`` if it does not converge."""
    begin = times
    for _ in range(STEPS):
        here = _tried(pieces, *times.tolist())
        if not np.isfinite(here.slopes).all() or abs(np.linalg.det(here.slopes)) == 0.0:
            return None
        change = np.linalg.solve(here.slopes, here.misses)
        share = min(1.0, float((0.3 * times / np.maximum(np.abs(change), 1e-300)).min()))
        times = times - share * change
        if share == 1.0 and (np.abs(change) <= CLOSED * times).all():
            return times if (np.abs(np.log(times / begin)) < 1.0).all() else None
    return None


def _closed(pieces: Pieces, flight_time: float, contact_time: float) -> SmallCycle:
    here = _tried(pieces, flight_time, contact_time)
    state, rest = here.state, pieces.pressed
    flight, inside = pieces.in_flight(flight_time), pieces.in_contact(contact_time)
    side = math.copysign(1.0, float(pieces.speed @ state))
    step, beside, contacts = pieces.in_contact(contact_time / SAMPLES), state - rest, []
    for _ in range(SAMPLES):
        beside = step @ beside
        contacts.append(rest + beside)
    inner = np.array(contacts[:-1])
    pushes = side * (pieces.stiffness + inner @ pieces.force)
    states = _along(pieces, contacts[-1], flight_time)[:-1]
    depths, rates = side * (1.0 + states @ pieces.depth), states @ pieces.speed
    # A plane that has left the wall that comes back more slowly is still in it.
    off = int(np.argmax(depths <= ROUNDING * np.abs(depths).max()))
    clear = bool(depths[off:].max() <= ROUNDING * np.abs(depths).max() and (side * rates[:off] <= 0.0).all())
    deep = bool((side * (1.0 + inner @ pieces.depth)).min() >= 0.0)
    pushing = bool(pushes.min() >= -ROUNDING * np.abs(pushes).max())
    carried = flight @ inside @ pieces.arrival(state)
    return _cycle(pieces, state, flight_time, contact_time, carried, clear and deep and pushing)
