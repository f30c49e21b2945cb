"""Rotors whose bearings are anisotropic, as systems of twice as many modes (:mod:`carom.core.anisotropy`).

In the fixed frame, with matrices ``D′`` and ``K′`` of what depends on the direction,

    M Z̈ + (D − iG) Ż + K Z + D′ Z̄˙ + K′ Z̄ = F e^{it} + f.

Together with its conjugate this is a linear rotor of the coordinates ``(Z, Z̄)``.  Seen in the frame that turns with the shaft, as ``U = Ze^{−it}`` and
``V = Z̄e^{−it}``, its coefficients are constant.  A state says ``U`` and ``U̇``; with ``τ = e^{−2it}`` those of ``V`` follow from

    V = Ūτ,      V̇ = (Ū˙ − 2iŪ)τ.

Unbalance lets the rotor go round an ellipse, ``U = p + qτ`` with ``V = q̄ + p̄τ``: of the constant forces ``(F, 0)`` the answer is ``(p, q̄)``.  The
turn ``τ`` is a forcing mode, which moves the coordinates by ``q``.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from carom.base.outcome import InputError
from carom.core.wall import Wall
from carom.models.from_modes import modal_system
from carom.models.matrices import is_singular
from carom.models.system import System

if TYPE_CHECKING:
    from carom.models.linear import LinearEquations

TURN = -2j
"""Exponent of ``τ``."""


def anisotropic_system(given: LinearEquations, conjugate: np.ndarray) -> System:
    """System of the coordinates ``U`` from that of both; what acts on conjugates, damping and stiffness, is that of the fixed frame."""
    doubled = _doubled(given, conjugate)
    n, free, arrays = len(given.mass), doubled.free, doubled.arrays
    modes = int(free.sum())
    forward, backward = np.split(doubled.rest, 2)
    ellipse = backward.conj()
    inverse = np.append(doubled.to_modes[free], np.zeros((1, 4 * n)), axis=0)
    by_position, by_conjugate, by_rate, by_conjugate_rate = np.split(inverse, 4, axis=1)
    planes = doubled.planes[:, :n]
    pushes = given.accelerations(given.planes.conj().T) * arrays["masses"]

    def turned(values: np.ndarray, by_turn: np.ndarray) -> np.ndarray:
        return np.append(values[:, free], by_turn[:, None], axis=1)

    own = {
        "exponents": np.append(doubled.exponents, TURN),
        "driven": np.append(arrays["driven"][free], False),
        "free": np.append(np.ones(modes, bool), False),
        "rows": turned(arrays["rows"], planes @ ellipse),
        "columns": np.append(arrays["columns"][free], np.zeros((1, len(planes))), axis=0),
        "anisotropy": np.array([modes]),
        "conjugate_columns": by_conjugate_rate @ pushes.conj(),
    }
    return modal_system(
        rest=forward,
        shapes=turned(doubled.shapes[:n], ellipse),
        inverse=np.concatenate([by_position, by_rate], axis=1),
        arrays=own | {name: arrays[name] for name in ("offsets", "masses", *Wall._fields)},
        forced=np.append(np.zeros(modes), 1.0).astype(complex),
        conjugate_modes=np.concatenate([by_conjugate - 2j * by_conjugate_rate, by_conjugate_rate], axis=1),
        **given.system_fields,
    )


def _doubled(given: LinearEquations, conjugate: np.ndarray) -> System:
    """System of the coordinates ``(U, V)``, as that of a rotor of ``2n``; its planes see ``U`` alone."""
    from carom.models.linear import LinearEquations  # which are defined with their system

    mass, (across, stiffer) = given.mass, conjugate
    spin = given.damping - 2j * mass
    fixed, none = given.stiffness + mass - 1j * spin, np.zeros(len(mass))
    both = np.block([[mass, np.zeros_like(mass)], [np.zeros_like(mass), mass.conj()]])
    spins = np.block([[spin, across], [across.conj(), spin.conj()]])
    springs = np.block([[fixed, stiffer], [stiffer.conj(), fixed.conj()]])
    damping, stiffness = spins + 2j * both, springs - both + 1j * spins
    if is_singular(stiffness, both, damping, stiffness) and given.forcing.any():
        raise InputError("forcing", given.forcing.tolist(), "none in undamped resonance with it")
    planes = [dataclasses.replace(each, plane=np.append(each.plane, none), race=None) for each in given.touchdowns]
    return LinearEquations(both, damping, stiffness, np.append(given.forcing, none), planes).system
