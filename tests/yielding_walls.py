"""Contact with walls that give way, written down a second time in the fixed frame and followed by a general integrator.

Nothing here shares a formula with the package: forces act on coordinates, contacts change at events of the integrator, and impulses and
works are states of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from linear_rotors import FixedFrame
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from carom.models import HuntCrossley, KelvinVoigt, LinearRotor, Touchdown

TOLERANCE = 1e-12
FLIES, PARTED = "flies", "parted"
PER_PLANE = 5
"""Integrals of a plane: normal force, friction, power of friction, power of the drive, power lost in the damper."""


def with_walls(rotor: FixedFrame, law, scales=None) -> LinearRotor:
    """The rotor with walls of this law at all planes."""
    touchdowns = [Touchdown(tuple(row), law, rotor.friction, rotor.radius_ratio + 1.0) for row in rotor.planes]
    model = rotor.model
    return LinearRotor(
        mass=model.mass,
        damping=model.damping,
        stiffness=model.stiffness,
        forcing=model.forcing,
        touchdowns=touchdowns,
        translation=rotor.translation,
        scales=scales,
    )


def free_mass(law, friction=0.0) -> LinearRotor:
    """A mass on which nothing acts but its wall."""
    return with_walls(
        FixedFrame(
            mass=np.eye(1),
            damping=np.zeros((1, 1)),
            stiffness=np.zeros((1, 1)),
            gyroscopic=np.zeros((1, 1)),
            forcing=np.zeros(1),
            planes=np.eye(1),
            friction=friction,
            restitution=0.0,
            radius_ratio=20.0,
            translation=np.ones(1),
        ),
        law,
    )


@dataclass
class Touch:
    """A contact: times, speeds, extremes, and integrals in the order of :data:`PER_PLANE`."""

    plane: int
    start: float
    entry: float
    before: np.ndarray
    senses: set
    peak: float = 0.0
    deepest: float = 0.0
    parted: float = 0.0
    end: float = np.nan
    exit: float = np.nan
    integrals: np.ndarray | None = None


class Walls:
    """A rotor between walls of one law; followed with :meth:`follow`."""

    def __init__(self, rotor: FixedFrame, law: KelvinVoigt | HuntCrossley) -> None:
        self.rotor, self.law, self.size = rotor, law, len(rotor.mass)
        self.pushes = np.linalg.solve(rotor.mass, rotor.planes.T.astype(complex)).T
        self.states: list = [FLIES] * len(rotor.planes)
        self.touches: list[Touch] = []

    def elastic(self, depth):
        exponent = getattr(self.law, "exponent", 1.0)
        return self.law.stiffness * max(depth, 0.0) ** exponent

    def stored(self, depth):
        exponent = getattr(self.law, "exponent", 1.0)
        return self.law.stiffness * max(depth, 0.0) ** (exponent + 1.0) / (exponent + 1.0)

    def press(self, depth, rate):
        if isinstance(self.law, KelvinVoigt):
            return self.law.stiffness * depth + self.law.damping * rate
        return self.elastic(depth) * (1.0 + self.law.dissipation * rate)

    def local(self, plane, position, velocity):
        """Normal, depth, radial speed and slip."""
        place, speed = self.rotor.planes[plane] @ position, self.rotor.planes[plane] @ velocity
        normal = place / abs(place)
        along = np.conj(normal) * speed
        return normal, abs(place) - 1.0, along.real, self.rotor.radius_ratio + along.imag

    def forces(self, time, position, velocity, states):
        """Normal and friction force at each plane, and the acceleration; those that roll are solved for."""
        acceleration = self.rotor.free(time, position, velocity)
        forces = np.zeros((len(states), 2))
        for plane, state in enumerate(states):
            if state not in (FLIES, PARTED):
                normal, depth, rate, _ = self.local(plane, position, velocity)
                forces[plane, 0] = self.press(depth, rate)
                forces[plane, 1] = -state * self.rotor.friction * forces[plane, 0]
                acceleration = acceleration + self.pushes[plane] * normal * (-forces[plane, 0] + 1j * forces[plane, 1])
        rolling = [plane for plane, state in enumerate(states) if state == 0]
        if rolling:
            # The slip s + Im(n̄ż) keeps its value: Im(n̄z̈) = θ̇ṙ.
            needs, matrix = [], np.zeros((len(rolling), len(rolling)))
            normals = [self.local(plane, position, velocity)[0] for plane in rolling]
            for i, p in enumerate(rolling):
                row, place = self.rotor.planes[p], self.rotor.planes[p] @ position
                along = np.conj(normals[i]) * (row @ velocity)
                needs.append(along.imag / abs(place) * along.real - (np.conj(normals[i]) * (row @ acceleration)).imag)
                for j, q in enumerate(rolling):
                    matrix[i, j] = (np.conj(normals[i]) * (row @ self.pushes[q]) * 1j * normals[j]).imag
            for plane, normal, grip in zip(rolling, normals, np.linalg.solve(matrix, needs), strict=True):
                forces[plane, 1] = grip
                acceleration = acceleration + self.pushes[plane] * normal * 1j * grip
        return forces, acceleration

    def unpack(self, state):
        x, y, vx, vy = state[: 4 * self.size].reshape(4, -1)
        return x + 1j * y, vx + 1j * vy

    def rates(self, time, state):
        position, velocity = self.unpack(state)
        forces, acceleration = self.forces(time, position, velocity, self.states)
        works = np.zeros((len(self.states), PER_PLANE))
        for plane, (push, grip) in enumerate(forces):
            if self.states[plane] not in (FLIES, PARTED):
                _, depth, rate, slip = self.local(plane, position, velocity)
                lost = (push - self.elastic(depth)) * rate
                works[plane] = push, grip, grip * slip, -grip * self.rotor.radius_ratio, lost
        moved = [velocity.real, velocity.imag, acceleration.real, acceleration.imag]
        return np.concatenate([*moved, works.ravel()])

    def events(self):
        """Functions that end a phase, each with its plane and name."""
        found = []

        def add(plane, name, direction, value):
            def event(time, state):
                return value(time, *self.unpack(state))

            event.terminal, event.direction = True, direction
            found.append((plane, name, event))

        for plane, state in enumerate(self.states):

            def depth(_, position, velocity, plane=plane):
                return self.local(plane, position, velocity)[1]

            def press(_, position, velocity, plane=plane):
                if isinstance(self.law, HuntCrossley):
                    return 1.0 + self.law.dissipation * self.local(plane, position, velocity)[2]
                return self.press(*self.local(plane, position, velocity)[1:3])

            def slip(_, position, velocity, plane=plane, state=state):
                return state * self.local(plane, position, velocity)[3]

            def spare(time, position, velocity, plane=plane):
                push, grip = self.forces(time, position, velocity, self.states)[0][plane]
                return self.rotor.friction * push - abs(grip)

            if state == FLIES:
                add(plane, "enters", 1, depth)
                continue
            add(plane, "leaves", -1, depth)
            add(plane, "meets" if state == PARTED else "parts", 1 if state == PARTED else -1, press)
            if state in (-1, 1):
                add(plane, "stops", -1, slip)
            elif state == 0:
                add(plane, "slips", -1, spare)
        return found

    def begin(self, plane, time, position, velocity):
        """Sense of the slip with which contact goes on: zero if the plane can roll."""
        _, _, _, slip = self.local(plane, position, velocity)
        if abs(slip) > 1e-9:
            return int(np.sign(slip))
        push, grip = self.forces(time, position, velocity, [*self.states[:plane], 0, *self.states[plane + 1 :]])[0][
            plane
        ]
        return 0 if abs(grip) <= self.rotor.friction * push else -int(np.sign(grip))

    def follow(self, position, velocity, until, step=0.05):
        """Follow a start; the contacts are in ``touches``, and the state at the end is returned."""
        time, open_touches = 0.0, {}
        state = np.concatenate(
            [position.real, position.imag, velocity.real, velocity.imag, np.zeros(PER_PLANE * len(self.states))]
        )
        while time < until:
            events = self.events()
            calm = all(one == FLIES for one in self.states)
            done = solve_ivp(
                self.rates,
                (time, until),
                state,
                "DOP853",
                rtol=TOLERANCE,
                atol=1e-14,
                events=[event for *_, event in events],
                max_step=step if calm else 0.1 * step,
                dense_output=True,
            )
            for plane, touch in open_touches.items():
                self.note_extremes(plane, touch, done.sol, time, float(done.t[-1]))
            time, state = float(done.t[-1]), done.y[:, -1]
            position, velocity = self.unpack(state)
            integrals = state[4 * self.size :].reshape(-1, PER_PLANE)
            for (plane, name, _), hits in zip(events, done.t_events, strict=True):
                if len(hits):
                    self.change(plane, name, time, position, velocity, integrals[plane].copy(), open_touches)
        return position, velocity

    def change(self, plane, name, time, position, velocity, integrals, open_touches):
        _, depth, rate, _ = self.local(plane, position, velocity)
        if name == "enters":
            open_touches[plane] = Touch(plane, time, rate, integrals, set())
        elif name == "leaves":
            touch = open_touches.pop(plane)
            touch.end, touch.exit, touch.integrals = time, rate, integrals - touch.before
            self.touches.append(touch)
        elif name == "parts":
            open_touches[plane].parted += self.stored(depth)
        elif name == "meets":
            open_touches[plane].parted -= self.stored(depth)
        if name == "slips":
            push_and_grip = self.forces(time, position, velocity, self.states)[0][plane]
            self.states[plane] = -int(np.sign(push_and_grip[1]))
        elif name in ("leaves", "parts"):
            self.states[plane] = FLIES if name == "leaves" else PARTED
        else:
            self.states[plane] = self.begin(plane, time, position, velocity)
        if plane in open_touches:
            open_touches[plane].senses.add(self.states[plane])

    def note_extremes(self, plane, touch, course, start, end):
        """Deepest point and largest force on a smooth stretch."""
        if self.states[plane] == PARTED:
            return

        def depth(time):
            return self.local(plane, *self.unpack(course(time)))[1]

        def push(time):
            return self.press(*self.local(plane, *self.unpack(course(time)))[1:3])

        for value, name in ((depth, "deepest"), (push, "peak")):
            times = np.linspace(start, end, 41)
            best = int(np.argmax([value(time) for time in times]))
            span = times[max(best - 1, 0)], times[min(best + 1, 40)]
            found = minimize_scalar(lambda time, value=value: -value(time), bounds=span, options={"xatol": 1e-12})
            setattr(touch, name, max(getattr(touch, name), -found.fun, value(start), value(end)))
