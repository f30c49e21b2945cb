"""A shaft by its exact solution: the transfer matrix of Timoshenko's beam, no finite elements."""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

STATE = 4
"""Displacement ``w``, tilt ``φ``, moment ``EIφ'`` and shear force ``κGA(w' − φ)``."""


def transfer(section, length, frequency, speed=0.0):
    """State at the end of a piece of a section per state at its beginning, at ``e^{iωt}`` of either sense."""
    material = section.material
    bending = material.elastic_modulus * section.second_moment
    shear = section.shear_coefficient * material.shear * section.area
    line, rotary = material.density * section.area, material.density * section.second_moment
    matrix = np.zeros((STATE, STATE))
    matrix[0, 1], matrix[0, 3] = 1.0, 1.0 / shear
    matrix[1, 2] = 1.0 / bending
    # EIφ'' = −κGA(w' − φ) − (ρI ω² − 2ρI Ω ω) φ
    matrix[2, 1], matrix[2, 3] = -rotary * (frequency**2 - 2.0 * speed * frequency), -1.0
    matrix[3, 0] = -line * frequency**2
    return expm(matrix * length)


def at_disc(disc, frequency, speed=0.0):
    """State behind a disc per state before it."""
    matrix = np.eye(STATE)
    matrix[2, 1] = -(disc.diametral_inertia * frequency**2 - disc.polar_inertia * speed * frequency)
    matrix[3, 0] = -disc.mass * frequency**2
    return matrix


def along(rotor, frequency, speed=0.0):
    """State at the end of a rotor per state at its beginning."""
    whole = np.eye(STATE)
    for node, section in enumerate((*rotor.sections, None)):
        for disc in rotor.discs:
            if disc.node == node:
                whole = at_disc(disc, frequency, speed) @ whole
        if section is not None:
            whole = transfer(section, section.length, frequency, speed) @ whole
    return whole


ENDS = {"free": (2, 3), "pinned": (0, 2), "clamped": (0, 1)}
"""Which parts of the state vanish at an end."""


def frequencies(rotor, begin, end, guesses, speed=0.0):
    """Frequencies of whirl near guesses, rad/s: zeros of the determinant of the conditions at both ends."""
    free = [part for part in range(STATE) if part not in ENDS[begin]]

    def determinant(frequency):
        return np.linalg.det(along(rotor, frequency, speed)[np.ix_(ENDS[end], free)])

    return np.array([brentq(determinant, 0.99 * guess, 1.01 * guess, xtol=1e-12 * abs(guess)) for guess in guesses])
