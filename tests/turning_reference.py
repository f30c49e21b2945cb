"""Rotors whose shaft changes its speed, written down a second time in the fixed frame, for a general integrator.

The numbers of a state are coordinates ``Z``, their rates, angle ``ϑ`` and speed ``σ`` of the shaft, and the surface speeds of the races,
``M Z̈ + D Ż + K Z = F (σ² − iβ) e^{iϑ} + Σ Wᴴ(−N + iF)n`` with ``n = y/|y|``, ``Jβ = Σ sF`` and ``σ̇ = β + T/J`` in contact.  Forces are physical ones; those that
a condition fixes (what keeps a plane on a rigid wall, or lets it roll) follow from the residuals of all conditions, which are linear.
"""

from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from carom.models import KelvinVoigt, Rigid

SLIDES, PARTED, AWAY = "contact", "parted", "flight"
MOST_EVENTS = 200
TOLERANCES = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}


class Turning:
    """A :class:`~carom.models.Rotor` with a shaft, under a weight per mass; each plane is in a phase and, in contact, has a sense of slip."""

    def __init__(self, rotor, weight=0.0):
        self.weight = weight
        matrices, equations = rotor.matrices, rotor.equations
        self.mass, self.damping, self.stiffness = matrices.mass, matrices.damping, matrices.stiffness
        self.forcing, self.shaft, self.touchdowns = equations.forcing, equations.shaft, equations.touchdowns
        self.planes, self.count = equations.planes, len(equations.forcing)
        self.phases = [AWAY] * len(self.planes)
        self.senses = [1] * len(self.planes)
        self.seen, self.contacts, self.impacts = set(), 0, 0

    def start(self, position, velocity, speed=1.0, angle=0.0):
        """Numbers of a state in the frame that turns at the nominal speed, at time zero."""
        z = np.atleast_1d(np.asarray(position, complex))
        v = np.atleast_1d(np.asarray(velocity, complex)) + 1j * z
        races = [0.0 if each.race is None else each.race.surface_speed for each in self.touchdowns]
        return np.concatenate([z.real, z.imag, v.real, v.imag, [angle, speed], races])

    def parts(self, y):
        n = self.count
        return (
            y[:n] + 1j * y[n : 2 * n],
            y[2 * n : 3 * n] + 1j * y[3 * n : 4 * n],
            y[4 * n],
            y[4 * n + 1],
            y[4 * n + 2 :],
        )

    def seen_in_the_frame(self, time, y):
        """Position and velocity in the frame that turns at the nominal speed, speed and angle ahead of it, races."""
        z, v, angle, speed, races = self.parts(y)
        turn = np.exp(-1j * time)
        return z * turn, (v - 1j * z) * turn, speed, angle - time, races

    def local(self, plane, y):
        """Radius, direction and local velocity of a plane."""
        z, v, *_ = self.parts(y)
        place = self.planes[plane] @ z
        return abs(place), place / abs(place), (self.planes[plane] @ v) * abs(place) / place

    def slip(self, plane, y):
        _, _, _, speed, races = self.parts(y)
        return (self.touchdowns[plane].surface_speed - 1.0) * speed + self.local(plane, y)[2].imag - races[plane]

    def law_force(self, plane, y):
        radius, _, along = self.local(plane, y)
        depth, law = radius - 1.0, self.touchdowns[plane].law
        if isinstance(law, KelvinVoigt):
            return law.stiffness * depth + law.damping * along.real
        return law.stiffness * max(depth, 0.0) ** law.exponent * (1.0 + law.dissipation * along.real)

    def touching(self):
        return [plane for plane, phase in enumerate(self.phases) if phase == SLIDES]

    def rates(self, y, forces):
        """Rates of the numbers with a normal force and friction at each plane in contact."""
        _, v, _, speed, races = self.parts(y)
        torque = 0.0
        slowed = (
            np.array([0.0 if each.race is None else -each.race.drag / each.race.inertia for each in self.touchdowns])
            * races
        )
        for plane, (_, grip) in forces.items():
            each = self.touchdowns[plane]
            torque += (each.surface_speed - 1.0) * grip
            slowed[plane] -= 0.0 if each.race is None else each.race.radius**2 / each.race.inertia * grip
        faster = torque / self.shaft.inertia
        driven = self.shaft.torque / self.shaft.inertia if forces else 0.0
        a = self.accelerations(y, forces, faster)
        return np.concatenate([v.real, v.imag, a.real, a.imag, [speed, faster + driven], slowed])

    def accelerations(self, y, forces, faster):
        z, v, angle, speed, _ = self.parts(y)
        force = self.forcing * (speed**2 - 1j * faster) * np.exp(1j * angle) - self.damping @ v - self.stiffness @ z
        for plane, (push, grip) in forces.items():
            force = force + self.planes[plane].conj() * complex(-push, grip) * self.local(plane, y)[1]
        return np.linalg.solve(self.mass, force) + self.weight

    def rate(self, _, y):
        return self.rates(y, self.forces(y))

    def plane_rates(self, plane, y, forces):
        """Second derivative of the distance from the centre, and rate of the slip."""
        radius, normal, along = self.local(plane, y)
        n, rates = self.count, self.rates(y, forces)
        a = (self.planes[plane] @ (rates[2 * n : 3 * n] + 1j * rates[3 * n : 4 * n])) * normal.conjugate()
        outward = a.real + along.imag**2 / radius
        turned = a.imag - along.imag * along.real / radius
        return outward, (self.touchdowns[plane].surface_speed - 1.0) * rates[4 * n + 1] + turned - rates[
            4 * n + 2 + plane
        ]

    def forces(self, y):
        """Normal force and friction of each plane in contact."""
        touching = self.touching()
        if not touching:
            return {}

        def residuals(values):
            forces = dict(zip(touching, values.reshape(-1, 2), strict=True))
            found = []
            for plane, (push, grip) in forces.items():
                outward, slipping = self.plane_rates(plane, y, forces)
                rigid = isinstance(self.touchdowns[plane].law, Rigid)
                found.append(outward if rigid else push - self.law_force(plane, y))
                sense = self.senses[plane]
                found.append(grip + sense * self.touchdowns[plane].friction * push if sense else slipping)
            return np.array(found)

        size = 2 * len(touching)
        offset = residuals(np.zeros(size))
        columns = np.array([residuals(one) - offset for one in np.eye(size)]).T
        return dict(zip(touching, np.linalg.solve(columns, -offset).reshape(-1, 2), strict=True))

    def strike(self, plane, y):
        """Numbers after an impact at a rigid wall, with the jump of the unbalance as the speed jumps."""
        n, each, angle = self.count, self.touchdowns[plane], self.parts(y)[2]
        arm = each.surface_speed - 1.0

        def after(push, grip):
            normal, faster = self.local(plane, y)[1], arm * grip / self.shaft.inertia
            kick = self.planes[plane].conj() * complex(-push, grip) * normal - 1j * faster * self.forcing * np.exp(
                1j * angle
            )
            kick = np.linalg.solve(self.mass, kick)
            changed = y.copy()
            changed[2 * n : 3 * n] += kick.real
            changed[3 * n : 4 * n] += kick.imag
            changed[4 * n + 1] += faster
            if each.race is not None:
                changed[4 * n + 2 + plane] -= each.race.radius**2 / each.race.inertia * grip
            return changed

        def ends(push, grip):
            changed = after(push, grip)
            return np.array([self.local(plane, changed)[2].real, self.slip(plane, changed)])

        start = ends(0.0, 0.0)
        matrix = np.array([ends(1.0, 0.0) - start, ends(0.0, 1.0) - start]).T
        aim = -each.law.restitution * start[0]
        push, grip = np.linalg.solve(matrix, [aim - start[0], -start[1]])
        if abs(grip) > each.friction * push:
            ratio = -np.sign(start[1]) * each.friction
            push = (aim - start[0]) / (matrix[0, 0] + ratio * matrix[0, 1])
            grip = ratio * push
        self.impacts += 1
        return after(push, grip)

    def events(self):
        """Margins that end the present phases, each with its direction, plane and what follows."""
        found = []
        for plane, phase in enumerate(self.phases):
            gap, pull = partial(self.gap, plane), partial(self.pull, plane)
            law = self.touchdowns[plane].law
            if phase == AWAY:
                found.append((gap, 1, plane, "strike" if isinstance(law, Rigid) else SLIDES))
                continue
            if phase == PARTED:
                found += [(gap, -1, plane, AWAY), (pull, 1, plane, SLIDES)]
                continue
            found.append((pull if isinstance(law, Rigid) else gap, -1, plane, AWAY))
            if isinstance(law, KelvinVoigt):
                found.append((pull, -1, plane, PARTED))
            found.append((partial(self.until_slip, plane), -1, plane, "slip"))
        return found

    def gap(self, plane, _, y):
        return self.local(plane, y)[0] - 1.0

    def pull(self, plane, _, y):
        rigid = isinstance(self.touchdowns[plane].law, Rigid)
        return self.forces(y)[plane][0] if rigid else self.law_force(plane, y)

    def until_slip(self, plane, _, y):
        return self.senses[plane] * self.slip(plane, y) if self.senses[plane] else self.spare(plane, y)

    def spare(self, plane, y):
        push, grip = self.forces(y)[plane]
        return self.touchdowns[plane].friction * push - abs(grip)

    def change_slip(self, plane, y):
        """Where the slip ends: the plane rolls if friction can hold it, and slips against what it cannot."""
        sense, self.senses[plane] = self.senses[plane], 0
        if self.spare(plane, y) <= 0.0 or not sense:
            grip = self.forces(y)[plane][1]
            self.senses[plane] = -1 if grip > 0.0 else 1

    def follow(self, y, until, time=0.0, closest=0.005):
        for _ in range(MOST_EVENTS):
            margins = self.events()
            functions = []
            for margin, direction, *_ in margins:
                margin.terminal, margin.direction = True, direction
                functions.append(margin)
            step = closest if any(phase != AWAY for phase in self.phases) else 0.1
            found = solve_ivp(self.rate, (time, until), y, max_step=step, events=functions, **TOLERANCES)
            time, y = found.t[-1], found.y[:, -1]
            self.seen |= {(p, phase, self.senses[p]) for p, phase in enumerate(self.phases) if phase == SLIDES}
            if found.status != 1:
                return y
            _, _, plane, following = margins[next(k for k, times in enumerate(found.t_events) if len(times))]
            if following == "slip":
                self.change_slip(plane, y)
            elif following == "strike":
                y = self.strike(plane, y)
            else:
                self.contacts += self.phases[plane] == AWAY
                self.phases[plane] = following
                self.senses[plane] = 1 if self.slip(plane, y) > 0.0 else -1
        raise RuntimeError(f"events without end at t = {time}")
