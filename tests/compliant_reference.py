"""Reference for compliant walls: linear rotors of any size, followed by a general integrator from event to event.

Nothing here shares a formula or a line with the package.  In the co-rotating frame

    M Ü + D U̇ + K U = F + Σ Fₖ e^{σₖt} + Σ_p m_p W_pᴴ f_p,      f_p = (−N_p + iT_p) n_p,      n = y/|y|,   y = WU,

with the mass ``m_p = 1/(W_p M⁻¹ W_pᴴ)`` that plane ``p`` feels, so that forces are per felt mass.  Each plane is in one of five
phases, and within a phase the equations are smooth:

- ``away``: ``δ = |y| − 1 < 0``, no force;
- ``slide+``, ``slide-``: the wall pushes with ``N > 0`` and friction ``T = ∓μN`` opposes the slip ``v = surface + δ + Im(n̄ẏ)``;
- ``roll``: ``v = 0``, and ``T`` is what keeps it so, at most ``μN`` in size (Filippov's solution of Coulomb's law);
- ``separated``: ``δ > 0``, but the law asks for a pull, which a wall does not give: no force.

A phase ends where one of its *margins* falls through zero.  Margins are looked at several times a step of DOP853 on its
interpolant, dips between are minimised, and the event is then approached by integrations of their own, which do not
depend on the interpolant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853, solve_ivp
from scipy.optimize import brentq, minimize_scalar

AWAY, FORWARD, BACKWARD, ROLLING, SEPARATED = "away", "slide+", "slide-", "roll", "separated"
TOUCHING = (FORWARD, BACKWARD, ROLLING)

RELATIVE, ABSOLUTE = 1e-13, 1e-14
LONGEST_STEP = 0.2
"""Of a step, in the time that the fastest frequency of the rotor or of a wall takes for one radian."""
LOOKS = 5
"""Times in a step at which margins are looked at."""
MOST_EVENTS = 20_000


class KelvinVoigt(NamedTuple):
    """``N = κδ + cδ̇``."""

    stiffness: float
    damping: float

    def push(self, depth: float, rate: float) -> float:
        return self.stiffness * depth + self.damping * rate

    def pushes(self, depth: float, rate: float) -> float:
        """Positive where the law asks for a push, at an indented place."""
        return self.push(depth, rate)

    @property
    def ends_in_depth(self) -> bool:
        """Whether the push vanishes before the indentation does."""
        return self.damping > 0.0

    @property
    def fastest(self) -> float:
        return math.sqrt(self.stiffness)


class HuntCrossley(NamedTuple):
    """``N = κδⁿ(1 + χδ̇)``."""

    stiffness: float
    dissipation: float
    exponent: float

    def push(self, depth: float, rate: float) -> float:
        power = depth if self.exponent == 1.0 else max(depth, 0.0) ** self.exponent
        return self.stiffness * power * (1.0 + self.dissipation * rate)

    def pushes(self, depth: float, rate: float) -> float:
        """Positive where the law asks for a push, at an indented place."""
        return 1.0 + self.dissipation * rate

    @property
    def ends_in_depth(self) -> bool:
        """Whether the push vanishes before the indentation does: only where something tears the rotor away."""
        return False

    @property
    def fastest(self) -> float:
        return math.sqrt(self.exponent * self.stiffness)


@dataclass(frozen=True)
class Plane:
    """A contact plane: displacement there per coordinate, law of the wall, friction, slip at rest in the turning frame."""

    row: tuple[complex, ...]
    law: KelvinVoigt | HuntCrossley
    friction: float
    surface_speed: float


class Contact(NamedTuple):
    """What happens at all planes at one time: arrays of shape (P,)."""

    depth: np.ndarray
    rate: np.ndarray
    slip: np.ndarray
    push: np.ndarray
    friction: np.ndarray
    acceleration: np.ndarray


class Event(NamedTuple):
    """A plane goes over to a phase."""

    time: float
    plane: int
    phase: str
    position: np.ndarray
    velocity: np.ndarray


@dataclass(frozen=True, eq=False)
class Followed:
    """Events of a motion, and where it is at its end."""

    events: list[Event]
    time: float
    position: np.ndarray
    velocity: np.ndarray
    phases: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Rotor:
    """``M, D, K`` of shape (n, n), the force ``F`` of shape (n,), planes, and forces with their exponent in time."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    forcing: np.ndarray
    planes: Sequence[Plane]
    turning: Sequence[tuple[complex, np.ndarray]] = ()

    def __post_init__(self):
        rows = np.array([plane.row for plane in self.planes], complex)
        moved = np.linalg.solve(self.mass, rows.conj().T)
        object.__setattr__(self, "_rows", rows)
        object.__setattr__(self, "_moved", moved / np.einsum("pn,np->p", rows, moved).real)
        object.__setattr__(self, "_inverse", np.linalg.inv(self.mass))
        object.__setattr__(self, "_surface", np.array([plane.surface_speed for plane in self.planes]))
        n = len(rows.T)
        accelerations = -self._inverse @ np.concatenate([self.stiffness, self.damping], axis=1)
        rates = np.linalg.eigvals(np.concatenate([np.eye(n, 2 * n, n), accelerations]))
        object.__setattr__(self, "_fastest", max([*np.abs(rates), 1.0, *(abs(each) for each, _ in self.turning)]))

    @classmethod
    def planar(cls, gamma: float, omega: float, rho: float, phi: float, plane: Plane, weight: float = 0.0) -> Rotor:
        """Planar rotor of mass one with its unbalance, and with a weight that pulls along the negative real axis at time zero."""
        one = np.ones((1, 1), complex)
        matrices = one, (gamma + 2j) * one, (omega**2 - 1.0 + 1j * gamma) * one
        force = np.array([rho * np.exp(1j * phi)])
        return cls(*matrices, force, [plane], [(-1j, np.array([-weight + 0j]))] if weight else [])

    def contact(self, time: float, position: np.ndarray, velocity: np.ndarray, phases: Sequence[str]) -> Contact:
        """Forces at the planes, and the acceleration that they cause together with everything else."""
        place, speed = self._rows @ position, self._rows @ velocity
        radius = np.abs(place)
        normal = place / np.maximum(radius, 1e-300)
        depth, local = radius - 1.0, normal.conj() * speed
        slip = self._surface + depth + local.imag
        push, friction = np.zeros(len(radius)), np.zeros(len(radius))
        for p, (plane, phase) in enumerate(zip(self.planes, phases, strict=True)):
            if phase in TOUCHING:
                push[p] = plane.law.push(depth[p], local.real[p])
                friction[p] = plane.friction * push[p] * {FORWARD: -1.0, BACKWARD: 1.0, ROLLING: 0.0}[phase]
        pulls = self.forcing + sum(force * np.exp(rate * time) for rate, force in self.turning)
        free = self._inverse @ (pulls - self.damping @ velocity - self.stiffness @ position)
        acceleration = free + self._moved @ ((-push + 1j * friction) * normal)
        rolling = [p for p, phase in enumerate(phases) if phase == ROLLING]
        if rolling:
            # d/dt (δ + Im(n̄ẏ)) = δ̇(1 − Im(n̄ẏ)/|y|) + Im(n̄ÿ), linear in the unknown friction of all planes that roll.
            along = self._moved[:, rolling] * (1j * normal[rolling])
            lever = (normal[rolling].conj()[:, None] * (self._rows[rolling] @ along)).imag
            misses = (local.real * (1.0 - local.imag / radius) + (normal.conj() * (self._rows @ acceleration)).imag)[
                rolling
            ]
            friction[rolling] = np.linalg.solve(lever, -misses)
            acceleration = acceleration + along @ friction[rolling]
        return Contact(depth, local.real, slip, push, friction, acceleration)


def follow(
    rotor: Rotor,
    position: Sequence[complex],
    velocity: Sequence[complex],
    until: float,
    start: float = 0.0,
    phases: Sequence[str] | None = None,
) -> Followed:
    """Follow a motion.  Without ``phases`` planes begin in those that their place says; one that rolls cannot be stated so."""
    state, time = np.concatenate([position, velocity]).astype(complex), start
    motion = _Motion(rotor, _first_phases(rotor, state) if phases is None else list(phases))
    events: list[Event] = []
    while True:
        time, state, ended = _next_event(motion, time, state, until)
        if not ended:
            break
        for plane, change in ended:
            motion.phases[plane] = _phase_after(motion, time, state, plane, change)
            events.append(Event(time, plane, motion.phases[plane], *_halves(state)))
        if len(events) > MOST_EVENTS:
            raise RuntimeError(f"more than {MOST_EVENTS} events, the last at {time}")
    return Followed(events, time, *_halves(state), tuple(motion.phases))


@dataclass
class _Motion:
    """A rotor and the phases of its planes."""

    rotor: Rotor
    phases: list[str]

    def contact(self, time: float, state: np.ndarray) -> Contact:
        return self.rotor.contact(time, *_halves(state), self.phases)

    def rates(self, time: float, state: np.ndarray) -> np.ndarray:
        return np.concatenate([_halves(state)[1], self.contact(time, state).acceleration])

    @property
    def longest_step(self) -> float:
        walls = [
            plane.law.fastest for plane, phase in zip(self.rotor.planes, self.phases, strict=True) if phase != AWAY
        ]
        return LONGEST_STEP / max([self.rotor._fastest, *walls])

    def margins(self, time: float, state: np.ndarray) -> dict[tuple[int, str], float]:
        """What is positive in the phases, by plane and by what happens where it falls through zero."""
        at, found = self.contact(time, state), {}
        for p, (plane, phase) in enumerate(zip(self.rotor.planes, self.phases, strict=True)):
            depth, asked = at.depth[p], plane.law.pushes(at.depth[p], at.rate[p])
            if phase == AWAY:
                found[p, "touch"] = -depth
                continue
            if phase == SEPARATED:
                found[p, "leave"], found[p, "touch"] = depth, -asked
                continue
            if not plane.law.ends_in_depth:
                found[p, "leave"] = depth
            if plane.law.ends_in_depth or isinstance(plane.law, HuntCrossley):
                found[p, "separate"] = asked
            if phase == ROLLING:
                found[p, "slide-"] = plane.friction * at.push[p] - at.friction[p]
                found[p, "slide+"] = plane.friction * at.push[p] + at.friction[p]
            else:
                found[p, "stop"] = at.slip[p] * (1.0 if phase == FORWARD else -1.0)
        return found


def _halves(state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position and velocity."""
    n = len(state) // 2
    return state[:n], state[n:]


def _first_phases(rotor: Rotor, state: np.ndarray) -> list[str]:
    motion = _Motion(rotor, [AWAY] * len(rotor.planes))
    at, phases = motion.contact(0.0, state), []
    for plane, depth, rate, slip in zip(rotor.planes, at.depth, at.rate, at.slip, strict=True):
        if depth < 0.0 or (depth == 0.0 and rate <= 0.0):
            phases.append(AWAY)
        elif plane.law.pushes(depth, rate) <= 0.0:
            phases.append(SEPARATED)
        else:
            phases.append(FORWARD if slip > 0.0 else BACKWARD)
    return phases


def _phase_after(motion: _Motion, time: float, state: np.ndarray, plane: int, change: str) -> str:
    known = {"leave": AWAY, "separate": SEPARATED, "slide+": FORWARD, "slide-": BACKWARD}
    if change in known:
        return known[change]
    slip = motion.contact(time, state).slip[plane]
    if change == "touch" and slip != 0.0:
        return FORWARD if slip > 0.0 else BACKWARD
    rolling = _Motion(motion.rotor, [*motion.phases[:plane], ROLLING, *motion.phases[plane + 1 :]]).contact(time, state)
    need, most = rolling.friction[plane], motion.rotor.planes[plane].friction * rolling.push[plane]
    if abs(need) <= most:
        return ROLLING
    return BACKWARD if need > 0.0 else FORWARD


# ------------------------------------------------------------------------------------------------ events


class _Piece(NamedTuple):
    """A step of the integrator: where it begins, and its interpolant."""

    start: float
    state: np.ndarray
    at: Callable[[float], np.ndarray]


def _next_event(
    motion: _Motion, time: float, state: np.ndarray, until: float
) -> tuple[float, np.ndarray, list[tuple[int, str]]]:
    """Time, state and changes of the first event; no change if there is none before the end."""
    if time >= until:
        return time, state, []
    solver = DOP853(motion.rates, time, state, until, motion.longest_step, RELATIVE, ABSOLUTE)
    pieces: list[_Piece] = []
    values = motion.margins(time, state)
    past: list[tuple[float, dict[tuple[int, str], float]]] = [(time, values)]
    while solver.status == "running":
        begin, before = solver.t, solver.y.copy()
        solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"the integrator gave up at {solver.t}")
        pieces = [*pieces[-1:], _Piece(begin, before, solver.dense_output())]
        for look in np.linspace(begin, solver.t, LOOKS + 1)[1:]:
            past = [*past[-2:], (look, motion.margins(look, pieces[-1].at(look)))]
            found = [each for name in values if (each := _crossing(motion, pieces, past, name))]
            if found:
                return _at_event(motion, pieces, *min(found))
    return solver.t, solver.y, []


def _value(motion: _Motion, pieces: list[_Piece], name: tuple[int, str]) -> Callable[[float], float]:
    def value(time: float) -> float:
        piece = pieces[-1] if time >= pieces[-1].start else pieces[0]
        return motion.margins(time, piece.at(time))[name]

    return value


def _crossing(motion, pieces, past, name) -> tuple[float, tuple[int, str]] | None:
    """Where a margin falls through zero between the last looks, on the interpolant."""
    value, (low, high) = _value(motion, pieces, name), past[-2:]
    if high[1][name] <= 0.0:
        begin = low[0]
        if low[1][name] <= 0.0:
            # Only where the phase begins at this margin's zero: rising from it, or not at all.
            tries = [low[0] + (high[0] - low[0]) * 0.5**k for k in range(1, 40)]
            begin = next((time for time in tries if value(time) > 0.0), math.nan)
            if math.isnan(begin):
                return low[0], name
        return brentq(value, begin, high[0], xtol=1e-300, rtol=8.9e-16), name
    if len(past) == 3 and past[0][1][name] > low[1][name] < high[1][name] and low[1][name] > 0.0:
        dip = minimize_scalar(value, bounds=(past[0][0], high[0]), method="bounded", options={"xatol": 1e-12})
        if dip.fun < 0.0:
            return brentq(value, past[0][0], dip.x, xtol=1e-300, rtol=8.9e-16), name
    return None


def _at_event(motion, pieces, time, name) -> tuple[float, np.ndarray, list[tuple[int, str]]]:
    """Place an event without the interpolant, and name all that happen there."""
    piece = pieces[-1] if time >= pieces[-1].start else pieces[0]
    shift = 1e-6 * motion.longest_step

    def flown(end: float) -> np.ndarray:
        if end <= piece.start:
            return piece.state
        span = (piece.start, end)
        return solve_ivp(motion.rates, span, piece.state, "DOP853", rtol=RELATIVE, atol=ABSOLUTE).y[:, -1]

    def slope(state: np.ndarray, of: tuple[int, str]) -> float:
        rates = motion.rates(time, state)
        ahead, behind = (motion.margins(time + h, state + h * rates)[of] for h in (shift, -shift))
        return (ahead - behind) / (2.0 * shift)

    state = flown(time)
    for _ in range(3):
        step = motion.margins(time, state)[name] / slope(state, name)
        if not abs(step) > 1e-16 * (1.0 + abs(time)):
            break
        time = max(time - step, piece.start)
        state = flown(time)
    ended = [name]
    for other, value in motion.margins(time, state).items():
        # In symmetric rotors planes change together, but for rounding errors of the time.
        falls = slope(state, other)
        if other[0] != name[0] and falls < 0.0 and abs(value) < 1e-13 * (1.0 + abs(time)) * abs(falls):
            ended.append(other)
    return time, state, ended
