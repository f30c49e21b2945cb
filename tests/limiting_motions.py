"""Starts, and what motions keep, for machines whose parameters go to a limit.

``U`` is the position in the co-rotating frame, ``Z = Ue^{it}`` that in the fixed one, ``W = 1 + θ̇`` the whirl speed there.
"""

import cmath
import math

import numpy as np
from compilation import sized

from carom.motions import State, Trajectory
from carom.parameters import Parameters

EPSILON = 2.0**-52
LONG = sized(2_000, 60, 10_000)
"""Thousands of impacts, if the compiler is on."""
MANY = sized(40, 3)
EVENTS = sized(20_000, 20)
START = State(0.3 + 0.1j, 0.9 - 0.4j)


def starts(seed: int, count: int = MANY):
    """Starts spread over the clearance, at up to three clearances per ``1/Ω``."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        turns = np.exp(2j * math.pi * random.random(2))
        yield State(complex(math.sqrt(random.random()) * turns[0]), complex(3.0 * random.random() * turns[1]))


def on_wall(angle: float, whirl: float, radial: float = 0.0) -> State:
    """On the wall at an angle, with the whirl speed ``W`` and an outward speed."""
    position = cmath.rect(1.0, angle)
    return State(position, complex(radial, whirl - 1.0) * position)


def segment_states(motion: Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """States at the start of each segment."""
    return motion.rotor.system.state(motion.segment_amplitudes)


def jacobi_integral(parameters: Parameters, position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """``J = |U̇|²/2 + (ω² − 1)|U|²/2 − ρ Re(Ūe^{iφ})``.

    Multiplying ``Ü + (γ + 2i)U̇ + (ω² − 1 + iγ)U = ρe^{iφ}`` by the conjugate of ``U̇`` and taking real parts, the term
    ``2i|U̇|²`` drops out, so ``J' = −γ Re(Ū̇(U̇ + iU))``: without damping ``J`` stays.  In an impact only ``|U̇|²`` changes.
    """
    pull = (position.conj() * cmath.exp(1j * parameters.phi)).real
    return (
        0.5 * np.abs(velocity) ** 2 + 0.5 * (parameters.omega**2 - 1.0) * np.abs(position) ** 2 - parameters.rho * pull
    )


def angular_momentum(position: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """``Im(Z̄Ż) = Im(Ū(U̇ + iU))`` about the centre of the bearing in the fixed frame."""
    return (position.conj() * (velocity + 1j * position)).imag
