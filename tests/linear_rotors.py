"""Rotors of several coordinates and contact planes, and their equations written down a second time, in the fixed frame.

Nothing here shares a formula with the package: forces are physical ones on the coordinates, and a general integrator
follows the motion.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from carom.models import Rigid, Rotor, Touchdown, from_matrices

TOLERANCE = 1e-12


def touchdowns(planes, friction, restitution, surface_speed):
    """Contact planes with rigid walls, from one number of each plane."""
    walls = zip(planes, map(Rigid, map(float, restitution)), friction, surface_speed, strict=True)
    return [Touchdown(tuple(plane), law, float(mu), float(speed)) for plane, law, mu, speed in walls]


def planar_rotor(damping, stiffness, force, touchdowns, **more):
    """The planar rotor of unit mass in any walls."""
    return from_matrices(
        mass=[[1.0]], damping=[[damping]], stiffness=[[stiffness]], forcing=[force], touchdowns=touchdowns, **more
    )


@dataclass(frozen=True, eq=False)
class FixedFrame:
    """``M Z̈ + (D − iG) Ż + K Z = F e^{it}`` with contact planes; see :func:`carom.models.from_matrices`."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    gyroscopic: np.ndarray
    forcing: np.ndarray
    planes: np.ndarray
    friction: float
    restitution: float
    radius_ratio: float
    translation: np.ndarray

    @property
    def model(self) -> Rotor:
        count = np.ones(len(self.planes))
        return from_matrices(
            mass=self.mass,
            damping=self.damping,
            stiffness=self.stiffness,
            gyroscopic=self.gyroscopic,
            forcing=self.forcing,
            touchdowns=touchdowns(
                self.planes, self.friction * count, self.restitution * count, (self.radius_ratio + 1.0) * count
            ),
            translation=self.translation,
        )

    @property
    def felt(self) -> np.ndarray:
        """Mass that an impulse at each plane moves."""
        return np.array([1.0 / (row @ np.linalg.solve(self.mass, row)) for row in self.planes])

    def free(self, time, position, velocity):
        """Acceleration of the coordinates without contact."""
        force = self.forcing * np.exp(1j * time) - self.stiffness @ position
        return np.linalg.solve(self.mass, force - (self.damping - 1j * self.gyroscopic) @ velocity)

    def rubbing(self, time, position, velocity, slips):
        """Acceleration and normal forces of contact that lasts at some planes, ``slips``: plane to the sign of slip.

        A sign of zero: it rolls.  The unknown forces, normal and along growing angle, keep each plane on its wall, and the
        contact point of one that rolls at rest.
        """
        free, unknown, conditions = self.free(time, position, velocity), [], []
        pulls = {}
        for plane in slips:
            outward = self.planes[plane] @ position
            push = np.linalg.solve(self.mass, self.planes[plane].astype(complex))
            pulls[plane] = (-push * outward, push * 1j * outward)
        for plane, sign in slips.items():
            row, place = self.planes[plane], self.planes[plane] @ position
            speed = row @ velocity
            normal = [(np.conj(place) * (row @ part)).real for pull in pulls.values() for part in pull]
            along = [(np.conj(place) * (row @ part)).imag for pull in pulls.values() for part in pull]
            unknown.append(normal)
            conditions.append(-(np.conj(place) * (row @ free)).real - abs(speed) ** 2)
            if sign == 0:
                unknown.append(along)
                conditions.append(-(np.conj(place) * (row @ free)).imag)
            else:
                law = np.zeros(2 * len(slips))
                law[2 * list(slips).index(plane) : 2 * list(slips).index(plane) + 2] = sign * self.friction, 1.0
                unknown.append(law)
                conditions.append(0.0)
        forces = np.linalg.solve(np.array(unknown), np.array(conditions)).reshape(-1, 2)
        total = free + sum(
            force * part
            for pair, pull in zip(forces, pulls.values(), strict=True)
            for force, part in zip(pair, pull, strict=True)
        )
        return total, forces

    def follow(self, start, stop, position, velocity, slips=None):
        """State at the end of a flight or of a stretch of lasting contact."""
        flown = solve_ivp(
            self._rates(slips or {}), (start, stop), _packed(position, velocity), "DOP853", rtol=TOLERANCE, atol=1e-14
        )
        return _unpacked(flown.y[:, -1])

    def bounces(self, position, velocity, until, most):
        """First impacts of a motion that starts inside: time, plane, and state just before each."""
        found, time = [], 0.0
        while len(found) < most:
            events = [_arrival(row) for row in self.planes]
            flown = solve_ivp(
                self._rates({}),
                (time, until),
                _packed(position, velocity),
                "DOP853",
                rtol=TOLERANCE,
                atol=1e-14,
                events=events,
                max_step=0.2,
            )
            if flown.status != 1:
                break
            plane = next(p for p, times in enumerate(flown.t_events) if len(times))
            time, state = float(flown.t_events[plane][0]), flown.y_events[plane][0]
            position, velocity = _unpacked(state)
            found.append((time, plane, position, velocity))
            velocity = self.struck(plane, position, velocity)
        return found

    def struck(self, plane, position, velocity):
        """Velocity after an impact."""
        row, mass = self.planes[plane], self.felt[plane]
        outward = row @ position / abs(row @ position)
        local = np.conj(outward) * (row @ velocity)
        normal = mass * (1.0 + self.restitution) * local.real
        slip = self.radius_ratio + local.imag
        along = min(self.friction * normal, mass * abs(slip)) * np.sign(slip)
        return velocity - np.linalg.solve(self.mass, row * (normal + 1j * along) * outward)

    def _rates(self, slips):
        def rates(time, state):
            position, velocity = _unpacked(state)
            if slips:
                return _packed(velocity, self.rubbing(time, position, velocity, slips)[0])
            return _packed(velocity, self.free(time, position, velocity))

        return rates

    def energy(self, position, velocity):
        """Kinetic energy and energy of the springs."""
        kinetic = np.einsum("...i,ij,...j->...", velocity.conj(), self.mass, velocity).real
        return 0.5 * kinetic + 0.5 * np.einsum("...i,ij,...j->...", position.conj(), self.stiffness, position).real


def to_fixed(time, position, velocity):
    """State in the fixed frame of one in the co-rotating frame."""
    turn = np.exp(1j * np.asarray(time))[..., None]
    return position * turn, (velocity + 1j * position) * turn


def _packed(position, velocity):
    return np.concatenate([position.real, position.imag, velocity.real, velocity.imag])


def _unpacked(state):
    x, y, vx, vy = state.reshape(4, -1)
    return x + 1j * y, vx + 1j * vy


def _arrival(row):
    def gap(_time, state):
        return abs(row @ _unpacked(state)[0]) - 1.0

    gap.terminal, gap.direction = True, 1.0
    return gap


def tilting(planes=2, arms=(0.8, -0.7), **changes):
    """Rigid rotor on two bearings: translation and tilt, with gyroscopic moments; four modes."""
    ends = np.array([[1.0, arm] for arm in arms])
    numbers = {
        "mass": np.diag([1.0, 0.4]),
        "damping": 0.05 * ends.T @ ends,
        "stiffness": 0.3 * ends.T @ ends,
        "gyroscopic": np.diag([0.0, 0.3]),
        "forcing": np.array([0.25 * np.exp(0.2j), 0.05]),
        "planes": ends[:planes],
        "friction": 0.15,
        "restitution": 0.9,
        "radius_ratio": 20.0,
        "translation": np.array([1.0, 0.0]),
    }
    return FixedFrame(**{**numbers, **changes})


def bending(planes=2, **changes):
    """Four masses on a flexible shaft, supported at both ends; eight modes."""
    chain = np.diag([1.0, 2.0, 2.0, 1.0]) - np.diag(np.ones(3), 1) - np.diag(np.ones(3), -1)
    support = np.diag([0.5, 0.0, 0.0, 0.4])
    numbers = {
        "mass": np.diag([0.2, 0.3, 0.3, 0.2]),
        "damping": 0.02 * np.eye(4) + 0.1 * support,
        "stiffness": 2.5 * chain + support,
        "gyroscopic": np.zeros((4, 4)),
        "forcing": np.array([0.0, 0.1 * np.exp(0.2j), 0.05, 0.0]),
        "planes": np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.1, 0.0]])[:planes],
        "friction": 0.12,
        "restitution": 0.8,
        "radius_ratio": 15.0,
        "translation": np.ones(4),
    }
    return FixedFrame(**{**numbers, **changes})


def single(planes=2, **changes):
    """One coordinate, whose bearing is tighter than one: two modes."""
    numbers = {
        "mass": np.array([[1.0]]),
        "damping": np.array([[0.1]]),
        "stiffness": np.array([[0.6]]),
        "gyroscopic": np.zeros((1, 1)),
        "forcing": np.array([0.25 * np.exp(0.2j)]),
        "planes": np.array([[1.25], [1.2]])[:planes],
        "friction": 0.15,
        "restitution": 0.9,
        "radius_ratio": 20.0,
        "translation": np.ones(1),
    }
    return FixedFrame(**{**numbers, **changes})


def as_matrices(planar):
    """The planar rotor by its matrices, of one coordinate."""
    at, matrices = planar.parameters, planar.matrices
    (plane,) = touchdowns([[1.0]], [at.mu], [at.d], [at.radius_ratio + 1.0])
    return from_matrices(**matrices._asdict(), touchdowns=[plane], scales=planar.scales)


def random_rotor(seed, *, n=None, planes=None, unbalance=None, damping=None, friction=None):
    """A rotor of one to three coordinates and planes; what is given is fixed, everything else random."""
    random = np.random.default_rng(seed)
    n, planes = n or int(random.integers(1, 4)), planes or int(random.integers(1, 4))
    mass, stiffness = (part @ part.T for part in random.normal(size=(2, n, n)))
    mass, stiffness = mass + 0.3 * np.eye(n), (stiffness + 0.1 * np.eye(n)) * 10.0 ** random.uniform(-1.0, 1.5)
    rows = random.normal(size=(planes, n))
    size = 10.0 ** random.uniform(-0.5, 0.5, planes) / np.sqrt(
        np.einsum("pn,np->p", rows, np.linalg.solve(mass, rows.T))
    )
    force = random.normal(size=n) * (unbalance or 10.0 ** random.uniform(-1.0, 0.5)) * np.exp(1j)
    return from_matrices(
        mass=mass,
        damping=(damping or 10.0 ** random.uniform(-2.0, 0.0)) * mass,
        stiffness=stiffness,
        gyroscopic=random.choice([0.0, 1.0]) * np.diag(random.random(n)),
        forcing=force,
        touchdowns=touchdowns(
            rows * size[:, None],
            np.full(planes, friction) if friction else random.choice([0.0, 0.05, 0.3, 1.0], planes),
            random.choice([0.0, 0.3, 0.8, 0.95], planes),
            1.0 + 10.0 ** random.uniform(0.0, 2.0, planes),
        ),
    )
