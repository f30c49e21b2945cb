"""No start hangs: every motion ends with a stated outcome after a bounded number of events, without NaN or penetration.

Bounded work means
- at most ``patience`` impacts, for then a motion counts as aperiodic,
- per stretch of contact a number of steps in proportion to the angle it covers and to the time it lasts in ``1/|λ|``,
- and stretches of contact in proportion to the impacts before them and the turns along the wall.
"""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from compilation import sized

from carom.base.outcome import Outcome, Phase
from carom.models import Rotor, jeffcott
from carom.motions import State, Trajectory, simulate
from carom.parameters import Parameters

MACHINES = 50
STARTS = sized(60, 1, 2000)
PATIENCE = sized(1000, 30)
MOST_EVENTS = 200_000
UNTIL = 1e6
STEPS_PER_ANGLE = 5.0
"""Steps of lasting contact per radian and per time ``1/|λ|``; measured: at most 3.4."""


def machine(random: np.random.Generator) -> Parameters:
    """Machines all over the range; a quarter of each law's coefficients at an end of its range."""

    def end_or(ends: tuple[float, ...], value: float) -> float:
        return float(random.choice(ends)) if random.random() < 0.25 else float(value)

    return Parameters(
        gamma=float(10 ** random.uniform(-3, math.log10(3))),
        omega=float(random.uniform(0.1, 2.5)),
        rho=end_or((0.0, 2.0), random.uniform(0.0, 2.0)),
        phi=float(random.uniform(-math.pi, math.pi)),
        mu=end_or((0.0, 1.0), random.uniform(0.0, 1.0)),
        d=end_or((0.0, 0.999, 1.0), random.uniform(0.0, 1.0)),
        radius_ratio=float(10 ** random.uniform(-2, 4)),
    )


def start(random: np.random.Generator, parameters: Parameters) -> State:
    """Inside and on the wall; there bouncing, sliding, rolling, without push, or at rest; fast and slow."""
    kind = random.integers(8)
    normal = complex(np.exp(1j * random.uniform(-math.pi, math.pi)))
    speed = float(10 ** random.uniform(-6, 1.5))
    velocity = complex(speed * np.exp(1j * random.uniform(-math.pi, math.pi)))
    position = normal
    if kind <= 2:
        position = math.sqrt(random.random()) * normal
    elif kind == 4:
        velocity = 1j * normal * speed * random.choice([-1, 1])
    elif kind == 5 and parameters.mu > 0.0:
        velocity = -1j * normal * (1.0 + parameters.radius_ratio)
    elif kind == 6:
        push = parameters.omega**2 - parameters.rho * math.cos(np.angle(normal) - parameters.phi)
        velocity = 1j * normal * (-1.0 + random.choice([-1, 1]) * math.sqrt(max(push, 0.0)))
    elif kind == 7:
        velocity = 0j
    return State(complex(position), complex(velocity))


@dataclass(frozen=True)
class Work:
    """What a motion took, and what it may take."""

    impacts: int
    steps: int
    stretches: int
    allowed_steps: float
    allowed_stretches: float


def work(rotor: Rotor, motion: Trajectory) -> Work:
    """Count the events of a motion."""
    phases = motion.segment_phases[:, 0]
    position = rotor.system.state(motion.segment_amplitudes)[0]
    rubbing = phases[:-1] != Phase.FLIGHT
    angles = np.abs(np.angle(position[1:] / position[:-1]))[rubbing].sum()
    lasts = np.diff(motion.segment_starts)[rubbing].sum() * np.abs(rotor.system.exponents).max()
    stretches = int((np.diff(phases) != 0).sum())
    impacts = int(motion.is_impact.sum())
    return Work(
        impacts,
        int(rubbing.sum()),
        stretches,
        10.0 + STEPS_PER_ANGLE * (angles + lasts) + 2.0 * stretches,
        10.0 + 4.0 * impacts + 4.0 * (angles + lasts),
    )


@pytest.mark.parametrize("seed", range(MACHINES))
def test_every_start_ends(seed):
    random = np.random.default_rng([21, seed])
    parameters = machine(random)
    rotor = jeffcott(parameters)
    for _ in range(STARTS):
        state = start(random, parameters)
        motion = simulate(rotor, state, UNTIL, settle=True, patience=PATIENCE, max_events=MOST_EVENTS)
        # Bounces off a nearly elastic wall that are too low to tell how they end have an end of their own.
        assert motion.outcome.settled or motion.outcome is Outcome.LOW_BOUNCES, (
            f"{motion.outcome.label} from {state} of {parameters}"
        )
        assert math.isfinite(motion.time)
        assert np.isfinite(motion.segment_amplitudes).all()
        position, _ = rotor.system.state(motion.segment_amplitudes)
        assert np.abs(position).max() <= 1.0 + 1e-12
        taken = work(rotor, motion)
        assert taken.impacts <= PATIENCE
        assert taken.steps <= taken.allowed_steps
        assert taken.stretches <= taken.allowed_stretches
