"""The system of any linear rotor, from its equations of motion."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from carom.base.outcome import InputError
from carom.models.anisotropic import anisotropic_system
from carom.models.forcing import Force, with_forces
from carom.models.from_modes import modal_system, second_order_system, walls_as_arrays
from carom.models.matrices import is_singular
from carom.models.modes import modes_of
from carom.models.shaft import ShaftModes
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
    turning = None if given.shaft is None else ShaftModes(given.shaft, given.accelerations(given.forcing))
    rests = turning is None and given.forcing.any()
    rest = np.linalg.solve(given.stiffness, given.forcing) if rests else np.zeros(n, complex)
    moved = given.accelerations(given.planes.conj().T)
    found = modes_of(_generator(given), given.mass if given.has_mass.all() else None)
    mobilities = np.einsum("pn,np->p", given.planes, moved)
    if not (mobilities.real > 0.0).all() or (np.abs(mobilities.imag) > 1e-9 * np.abs(mobilities)).any():
        raise InputError(
            "mass, planes", mobilities.tolist(), "positive mobilities W M⁻¹ Wᴴ: an impulse must move its plane"
        )
    races = [each.race for each in given.touchdowns]
    if n == 1 and given.planes.tolist() == [[1.0]] and races == [None] and turning is None and given.magnets is None:
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
    return modal_system(rest=rest, shapes=shapes, inverse=inverse, arrays=arrays, shaft=turning, **given.system_fields)


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
