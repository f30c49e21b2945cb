"""Rotors with compliant walls, and what their contacts do, by the reference of :mod:`compliant_reference`.

The reference gives the phases and the states between them; here impulses and works are integrated beside the equations.
"""

from dataclasses import dataclass, field

import compliant_reference as reference
import numpy as np
from linear_rotors import FixedFrame
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

from carom.models import HuntCrossley, KelvinVoigt, Rotor, Touchdown, from_matrices

SAMPLES = 41


def with_walls(rotor: FixedFrame, law: KelvinVoigt | HuntCrossley, scales=None, race=None) -> Rotor:
    """The rotor with walls of this law at all planes."""
    touchdowns = [Touchdown(tuple(row), law, rotor.friction, rotor.radius_ratio + 1.0, race) for row in rotor.planes]
    return from_matrices(
        mass=rotor.mass,
        damping=rotor.damping,
        stiffness=rotor.stiffness,
        gyroscopic=rotor.gyroscopic,
        forcing=rotor.forcing,
        touchdowns=touchdowns,
        translation=rotor.translation,
        scales=scales,
    )


def free_mass(law: KelvinVoigt | HuntCrossley) -> Rotor:
    """A mass on which nothing acts but its wall."""
    nothing = np.zeros((1, 1))
    walls = [Touchdown((1.0,), law, 0.0, 20.0)]
    return from_matrices(mass=np.eye(1), damping=nothing, stiffness=nothing, forcing=np.zeros(1), touchdowns=walls)


@dataclass
class Touch:
    """A contact by the reference, with forces of the felt mass."""

    plane: int
    time: float
    radial_speed: float
    phases: list[str] = field(default_factory=list)
    end: float = np.nan
    radial_speed_after: float = np.nan
    normal_impulse: float = 0.0
    friction_impulse: float = 0.0
    heat: float = 0.0
    drive_work: float = 0.0
    normal_loss: float = 0.0
    peak_force: float = 0.0
    deepest: float = 0.0


SUMS = ("normal_impulse", "friction_impulse", "heat", "drive_work", "normal_loss")


def contacts_of(model: Rotor, position: np.ndarray, velocity: np.ndarray, until: float) -> list[Touch]:
    """All contacts of a motion that are over at its end."""
    rotor = _by_reference(model)
    events = reference.follow(rotor, position, velocity, until).events
    times, phases = [event.time for event in events] + [until], [reference.AWAY] * len(rotor.planes)
    masses, going, over = model.system.arrays.masses, {}, []
    for event, end in zip(events, times[1:], strict=True):
        plane, before = event.plane, phases[event.plane]
        at = rotor.contact(event.time, event.position, event.velocity, phases)
        depth, rate = float(at.depth[plane]), float(at.rate[plane])
        phases[plane] = event.phase
        if before == reference.AWAY:
            going[plane] = Touch(plane, event.time, rate)
        elif event.phase == reference.AWAY:
            touch = going.pop(plane)
            touch.end, touch.radial_speed_after = event.time, rate
            over.append(touch)
        if plane in going:
            held = masses[plane] * _spring(rotor.planes[plane].law, depth)
            going[plane].phases.append(event.phase)
            going[plane].normal_loss += held * ((event.phase == reference.SEPARATED) - (before == reference.SEPARATED))
        if going and end > event.time:
            _integrate(rotor, masses, event, end, phases, going)
    return over


def _by_reference(model: Rotor) -> reference.Rotor:
    planes = []
    for touchdown, mass in zip(model.equations.touchdowns, model.system.arrays.masses, strict=True):
        law = touchdown.law
        if isinstance(law, KelvinVoigt):
            wall = reference.KelvinVoigt(law.stiffness / mass, law.damping / mass)
        else:
            wall = reference.HuntCrossley(law.stiffness / mass, law.dissipation, law.exponent)
        planes.append(reference.Plane(touchdown.plane, wall, touchdown.friction, touchdown.surface_speed))
    return reference.Rotor(
        model.equations.mass, model.equations.damping, model.equations.stiffness, model.equations.forcing, planes
    )


def _spring(law, depth: float) -> float:
    exponent = getattr(law, "exponent", 1.0)
    return law.stiffness * max(depth, 0.0) ** (exponent + 1.0) / (exponent + 1.0)


def _integrate(rotor, masses, event, end, phases, going) -> None:
    """Add to the contacts what they do until the next event."""
    n, count = len(event.position), len(rotor.planes)

    def rates(time, state):
        at = rotor.contact(time, state[:n], state[n : 2 * n], phases)
        springs = [plane.law.push(depth, 0.0) for plane, depth in zip(rotor.planes, at.depth, strict=True)]
        lost = np.where(at.push > 0.0, (at.push - springs) * at.rate, 0.0)
        slip, surfaces = at.friction * at.slip, np.array([plane.surface_speed for plane in rotor.planes])
        sums = at.push, at.friction, -slip, -at.friction * (surfaces - 1.0), lost
        return np.concatenate([state[n : 2 * n], at.acceleration, *(masses * part for part in sums)])

    start = np.concatenate([event.position, event.velocity, np.zeros(len(SUMS) * count)]).astype(complex)
    found = solve_ivp(rates, (event.time, end), start, "DOP853", rtol=1e-12, atol=1e-14, dense_output=True)
    gained = found.y[2 * n :, -1].real.reshape(len(SUMS), count)
    for plane, touch in going.items():
        for name, values in zip(SUMS, gained, strict=True):
            setattr(touch, name, getattr(touch, name) + values[plane])
        for name, value in (("deepest", "depth"), ("peak_force", "push")):

            def size(time, value=value, plane=plane):
                state = found.sol(time)
                return float(getattr(rotor.contact(time, state[:n], state[n : 2 * n], phases), value)[plane])

            largest = _largest(size, event.time, end) * (masses[plane] if value == "push" else 1.0)
            setattr(touch, name, max(getattr(touch, name), largest))


def _largest(value, start: float, end: float) -> float:
    times = np.linspace(start, end, SAMPLES)
    best = int(np.argmax([value(time) for time in times]))
    span = times[max(best - 1, 0)], times[min(best + 1, SAMPLES - 1)]
    found = minimize_scalar(lambda time: -value(time), bounds=span, options={"xatol": 1e-12})
    return max(-found.fun, value(start), value(end))
