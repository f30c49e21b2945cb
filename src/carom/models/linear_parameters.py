"""Named parameters of a linear rotor: the numbers of the planar rotor, for any matrices.

With the direction ``t`` in which the rotor moves as a whole, ``⟨A⟩ = tᴴ A t``, and ``M``, ``D``, ``K`` and ``F`` of the fixed
frame (:meth:`~carom.models.LinearEquations.in_fixed_frame`),

    γ = ⟨D⟩/⟨M⟩,      ω² = ⟨K⟩/⟨M⟩,      ρ e^{iφ} = tᴴF/⟨M⟩,

which for one coordinate are the numbers of the planar rotor.  Another value of ``γ``, ``ω`` or ``ρ`` multiplies all of
``D``, ``K`` or ``F`` by one factor; ``φ`` turns ``F``.  The friction ``μ``, the restitution ``d`` and the radius ratio (the
surface speed minus one) are set at all planes, or at one of several by ``mu_1``, ``mu_2`` and so on.  The speed ``Ω`` changes ``D``
with ``1/Ω``, ``K`` with ``1/Ω²`` and the numbers of the walls as they are in these units; masses, gyroscopic matrix and unbalance do not change in these units.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, WALL_FIELDS, Field, Numbers, read_quantity
from carom.parameters.terms import no_such_parameter

if TYPE_CHECKING:
    from carom.models.linear import LinearEquations

PLANAR_NAMES = {"friction": "mu", "restitution": "d", "unbalance_phase": "phi"}
"""Entries of a machine file that are dimensionless, and the parameter that each is."""


def fields(rotor: LinearEquations) -> dict[str, Field]:
    """Fields of all parameters by name."""
    own = {**DIMENSIONLESS_FIELDS, **WALL_FIELDS}
    absent = own.keys() & {"mu", "d", "radius_ratio", *WALL_FIELDS} - set(_at_planes(rotor))
    if not rotor.has_mass.all():
        absent |= {"gamma", "omega"}  # matrices that hold a controller are no multiple of a damping or a stiffness
    if rotor.conjugate is not None:
        absent |= {"gamma", "omega"}  # there is none that is alike in both directions
    found = {name: field for name, field in own.items() if name not in absent}
    found |= {name: MACHINE_FIELDS[name] for name, same in PLANAR_NAMES.items() if same not in absent}
    if rotor.scales is not None:
        found["speed"] = MACHINE_FIELDS["speed"]
    for name, (parameter, plane) in _planes(rotor).items():
        field = own[parameter]
        words = f"{field.words} at touchdown bearing {plane + 1}"
        found[name] = replace(field, name=name, symbol=f"{field.symbol}_{plane + 1}", words=words)
    return found


def _at_planes(rotor: LinearEquations) -> list[str]:
    """Names of the parameters that all planes have."""
    return [
        name for name in rotor.touchdowns[0].parameters if all(name in each.parameters for each in rotor.touchdowns)
    ]


def _planes(rotor: LinearEquations) -> dict[str, tuple[str, int]]:
    """Parameter and plane by name, for several planes."""
    if len(rotor.touchdowns) == 1:
        return {}
    each = enumerate(rotor.touchdowns)
    return {f"{name}_{plane + 1}": (name, plane) for plane, one in each for name in one.parameters}


def value_of(rotor: LinearEquations, name: str) -> float:
    """Present value of a parameter; refuse an unknown name, and one whose values differ between planes."""
    if name not in fields(rotor):
        raise no_such_parameter(name, None, fields(rotor), rotor.scales is not None)
    if name == "speed" and rotor.scales is not None:
        return rotor.scales.speed
    own, plane = _planes(rotor).get(name, (PLANAR_NAMES.get(name, name), None))
    if plane is not None or own in _at_planes(rotor):
        values = [each.value(own) for number, each in enumerate(rotor.touchdowns) if plane in (None, number)]
        if len(set(values)) > 1:
            names = ", ".join(f"{own}_{number + 1}" for number in range(len(values)))
            raise InputError(name, values, f"the same at all planes here; {names} are those of each plane")
        return values[0]
    return float(getattr(_numbers(rotor), own))


def _numbers(rotor: LinearEquations) -> Numbers:
    """Numbers of the rotor moving as a whole; those of the planes are left out."""
    inertia, damping, _, stiffness, _ = rotor.matrices
    mass = _whole(rotor, inertia)
    force = complex(np.vdot(np.asarray(rotor.translation), rotor.forcing)) / mass
    omega = math.sqrt(max(_whole(rotor, stiffness) / mass, 0.0))
    return Numbers(_whole(rotor, damping) / mass, omega, abs(force), cmath.phase(force), *(math.nan,) * 3)


def _whole(rotor: LinearEquations, matrix: np.ndarray) -> float:
    direction = np.asarray(rotor.translation)
    return float(np.einsum("i,ij,j->", direction.conj(), matrix, direction).real)


def moved(rotor: LinearEquations, name: str, given: float | str) -> LinearEquations:
    """The rotor with another value of a parameter; a physical one is in SI units, or text with a unit.

    A value out of range is refused, and a rotor without the damping, stiffness or unbalance that would be multiplied.
    """
    known = fields(rotor)
    if name not in known:
        raise no_such_parameter(name, given, known, rotor.scales is not None)
    value = read_quantity(known[name], given)
    own, plane = _planes(rotor).get(name, (PLANAR_NAMES.get(name, name), None))
    if plane is not None or own in _at_planes(rotor):
        changed = (each.replace(own, value) if plane in (None, k) else each for k, each in enumerate(rotor.touchdowns))
        return replace(rotor, touchdowns=tuple(changed))
    if own == "phi":
        return replace(rotor, forcing=rotor.forcing * cmath.exp(1j * (value - rotor.unbalance_phase)))
    _, damping, _, stiffness, _ = rotor.matrices
    if own == "speed" and rotor.scales is not None:
        slower = rotor.scales.speed / value
        more = (slower - 1.0) * damping
        stiffer = (slower * slower - 1.0) * stiffness
        return replace(
            rotor,
            damping=rotor.damping + more,
            stiffness=rotor.stiffness + stiffer + 1j * more,
            touchdowns=tuple(each.at_speed(1.0 / slower) for each in rotor.touchdowns),
            shaft=None if rotor.shaft is None else rotor.shaft.at_speed(1.0 / slower),
            unlevitated=_times(rotor.unlevitated, slower, slower * slower),
            conjugate=_times(rotor.conjugate, slower, slower * slower),
            conjugate_unlevitated=_times(rotor.conjugate_unlevitated, slower, slower * slower),
            scales=replace(rotor.scales, speed=value),
        )
    present = value_of(rotor, own)
    if not present:
        raise InputError(name, shown(value), f"cannot be set: {name} = 0 now, and only another value can be multiplied")
    factor = value / present
    if own == "rho":
        return replace(rotor, forcing=rotor.forcing * factor)
    if own == "omega":
        stiffer = rotor.stiffness + (factor * factor - 1.0) * stiffness
        return replace(rotor, stiffness=stiffer, unlevitated=_times(rotor.unlevitated, 1.0, factor * factor))
    more = (factor - 1.0) * damping
    multiplied = _times(rotor.unlevitated, factor, 1.0)
    return replace(rotor, damping=rotor.damping + more, stiffness=rotor.stiffness + 1j * more, unlevitated=multiplied)


def refuse_node(node: int | None) -> None:
    """Refuse a node of a rotor that is given by matrices or numbers."""
    if node is not None:
        raise InputError("node", node, "left out: only the shaft of a flexible machine has nodes")


def _times(pair: np.ndarray | None, damping: float, stiffness: float) -> np.ndarray | None:
    """Multiples of a pair of a damping and a stiffness."""
    return None if pair is None else np.stack([damping * pair[0], stiffness * pair[1]])
