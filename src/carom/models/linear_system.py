"""The system of any linear rotor, from its equations of motion.

Where bearings are anisotropic it has twice as many modes (:mod:`carom.core.anisotropy`).  In the fixed frame, with matrices ``D′`` and ``K′`` of
what depends on the direction,

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
from carom.models.definition import is_singular
from carom.models.forcing import ONE, Force, with_forces
from carom.models.from_modes import modal_system, modes_of, second_order_system, walls_as_arrays
from carom.models.mode_arrays import TURN
from carom.models.system import System

if TYPE_CHECKING:
    from carom.models.linear import LinearEquations


def system_of(given: LinearEquations) -> System:
    """Modes, contact planes and contact law of a rotor with these equations of motion."""
    n = len(given.mass)
    if given.conjugate is not None:
        return anisotropic_system(given, given.conjugate)
    _check_inverses(given)
    if is_singular(given.stiffness, given.mass, given.damping, given.stiffness) and given.forcing.any():
        # In undamped resonance with the unbalance, which then drives a mode, there is no rest.
        push = Force(0.0, given.accelerations(given.forcing))
        return with_forces(dataclasses.replace(given, forcing=np.zeros(n)).system, (push,))
    rests = given.shaft is None and given.forcing.any()
    rest = np.linalg.solve(given.stiffness, given.forcing) if rests else np.zeros(n, complex)
    moved = given.accelerations(given.planes.conj().T)
    found = modes_of(_generator(given), given.mass if given.has_mass.all() else None)
    mobilities = np.einsum("pn,np->p", given.planes, moved)
    if not (mobilities.real > 0.0).all() or (np.abs(mobilities.imag) > 1e-9 * np.abs(mobilities)).any():
        raise InputError(
            "mass, planes", mobilities.tolist(), "positive mobilities W M⁻¹ Wᴴ: an impulse must move its plane"
        )
    beside = given.beside_modes
    plain = beside.races == (None,) and given.shaft is None and given.magnets is None
    if n == 1 and given.planes.tolist() == [[1.0]] and plain:
        return _one_coordinate(given, found.exponents, complex(rest[0]))
    inverse, masses = np.zeros((len(found.basis), 2 * n), complex), 1.0 / mobilities.real
    inverse[:, np.append(np.ones(n, bool), given.has_mass)] = np.linalg.inv(found.basis)
    arrays = {
        "exponents": found.exponents,
        "driven": found.driven,
        "offsets": given.planes @ rest,
        "rows": given.planes @ found.basis[:n],
        "columns": inverse[:, n:] @ (moved / mobilities),
        "masses": masses,
        **walls_as_arrays([each.wall(mass) for each, mass in zip(given.touchdowns, masses, strict=True)]),
    }
    shapes = found.basis[:n]
    return modal_system(rest=rest, shapes=shapes, inverse=inverse, arrays=arrays, beside=beside)


def _check_inverses(given: LinearEquations) -> None:
    """Refuse masses that are singular, and coordinates without mass whose rates do not follow from the state."""
    has_mass, massless = (np.ix_(those, those) for those in (given.has_mass, ~given.has_mass))
    if not given.has_mass.any() or is_singular(given.mass[has_mass], given.mass):
        raise InputError("mass", "singular", "a matrix that can be inverted, but for rows and columns that are zero")
    if not given.has_mass.all() and is_singular(given.damping[massless], given.damping[massless]):
        raise InputError("damping", "singular", "a matrix that gives the rates of all coordinates without mass")


def _generator(given: LinearEquations) -> np.ndarray:
    """Rates of the coordinates, then accelerations of those with mass, per coordinate, then per rate of those with mass."""
    n, has_mass = len(given.mass), given.has_mass
    rates = np.zeros((n, n + has_mass.sum()), complex)
    rates[has_mass] = np.eye(has_mass.sum(), n + has_mass.sum(), n)
    if not has_mass.all():
        held = np.concatenate([given.stiffness[~has_mass], given.damping[np.ix_(~has_mass, has_mass)]], axis=1)
        rates[~has_mass] = -np.linalg.solve(given.damping[np.ix_(~has_mass, ~has_mass)], held)
    forces = np.concatenate([given.stiffness, np.zeros((n, has_mass.sum()))], axis=1) + given.damping @ rates
    return np.concatenate([rates, -given.accelerations(forces)[has_mass]])


def _one_coordinate(given: LinearEquations, exponents: np.ndarray, equilibrium: complex) -> System:
    """System of a rotor with one coordinate, which is its displacement at the only plane."""
    slow, fast = sorted((complex(value) for value in exponents), key=lambda value: -value.real)
    mass = float(given.mass[0, 0].real)
    system = second_order_system(
        exponents=(fast, slow), equilibrium=equilibrium, wall=given.touchdowns[0].wall(mass), mass=mass
    )
    return dataclasses.replace(system, translation=given.translation)


def anisotropic_system(given: LinearEquations, conjugate: np.ndarray) -> System:
    """System of the coordinates ``U`` from that of both; what acts on conjugates, damping and stiffness, is that of the fixed frame."""
    doubled = _doubled(given, conjugate)
    n, free, arrays = len(given.mass), doubled.free, doubled.arrays
    # Pairs of a free rotor are alike in U and in V, and so is what a constant force makes of them, where their coordinates are orthogonal.
    for last in np.flatnonzero(arrays["driven"]).tolist():
        ahead, behind = doubled.shapes[:, last - 1], doubled.shapes[:, last]
        gap = arrays["exponents"][last] - arrays["exponents"][last - 1]
        if abs(gap) <= ONE:
            share = np.vdot(behind, ahead) / np.vdot(behind, behind)
            for right in (doubled.shapes, arrays["rows"]):
                right[:, last - 1] -= share * right[:, last]
                right[:, last] *= 1.0 - share * gap
            for left in (doubled.to_modes, arrays["columns"]):
                left[last] = (left[last] + share * left[last - 1]) / (1.0 - share * gap)
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
    system = modal_system(
        rest=forward,
        shapes=turned(doubled.shapes[:n], ellipse),
        inverse=np.concatenate([by_position, by_rate], axis=1),
        arrays=own | {name: arrays[name] for name in ("offsets", "masses", *Wall._fields)},
        forced=np.append(np.zeros(modes), 1.0).astype(complex),
        conjugate_modes=np.concatenate([by_conjugate - 2j * by_conjugate_rate, by_conjugate_rate], axis=1),
        beside=given.beside_modes,
    )
    behind = np.append(forward.conj(), TURN * forward.conj())
    conjugates = turned(np.concatenate([doubled.shapes[n:], doubled.rates[n:]]), behind)
    filler = np.zeros((2 * n, system.modes - modes - 1))
    return dataclasses.replace(system, conjugate_basis=np.append(conjugates, filler, axis=1))


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
