"""Sizes of disturbances up to which contact is impossible, for any linear rotor whose springs and dampers only store and take energy.

In the fixed frame the deviation ``u`` from the levitation whirl obeys ``M ü + (D − iG) u̇ + K u = 0``.  With Hermitian ``M`` and
``K`` above zero and ``D`` not below it, its energy ``u̇ᴴMu̇ + uᴴKu = E`` does not grow, as gyroscopic forces do no work.  So the
displacement ``w u`` of a contact plane is never above ``√(E w K⁻¹ wᴴ)``, and contact is impossible while it is below the distance
of levitation from the wall there.  After a kick of speed ``v`` along the translation ``t`` the energy is ``v² tᴴMt``.

Controllers and gyroscopic dampers may have no such energy.  Where none is known but every free mode decays, the moduli of the modes serve: mode ``k`` with the amplitude
``a_k`` moves a plane by no more than ``|w v_k||a_k|`` at any time, so contact is impossible while their sum is below that distance.  ``carom prove`` shows the same in ball arithmetic.

A limit of the magnetic bearings is like a wall: what is asked for, ``Q = d u + v u̇``, is never above ``√(E (d K⁻¹ dᴴ + v M⁻¹ vᴴ))``, and while that
is below the bound less what levitation asks for, the rotor is linear.

Of the planar rotor the largest deviation after a kick is known (:func:`~carom.closed_forms.thresholds.largest_response`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom.base.arguments import Positive, Whole, checked
from carom.closed_forms.exact_results import exact_results
from carom.models import Rotor, Subject, rotor_of
from carom.models.mode_arrays import STEADY
from carom.models.stages import stages_of

MARGIN = 1e-9
"""Share of the distance from the wall that is left for rounding."""
ROUNDING = 1e-12
"""Size of numbers that count as zero, relative to the terms that they are a difference of."""


class _Levitation(NamedTuple):
    """Levitation next to which energy does not grow; what is watched are the displacements of P planes and what is asked of L limits."""

    rooms: np.ndarray
    """Distance of each contact plane from its wall, and of what is asked for from each limit, less the margin, shape (P + L,)."""
    reaches: np.ndarray
    """``√(d K⁻¹ dᴴ + v M⁻¹ vᴴ)`` of each: its largest change per root of the energy, shape (P + L,)."""
    has_energy: bool = True

    def reach(self, model: Rotor, position: np.ndarray, velocity: np.ndarray, moving: np.ndarray) -> np.ndarray:
        """Largest change of each, shape (P + L,), after a deviation of the coordinates and their rates: ``moving`` are those of the fixed frame."""
        if self.has_energy:
            energy = _energy(model.matrices.stiffness, position) + _energy(model.matrices.mass, moving)
            return np.asarray(self.reaches * math.sqrt(energy))
        arrays = model.system.arrays
        seen = np.abs(np.concatenate([arrays["rows"], arrays["limit_rows"]]))
        return np.asarray(seen @ np.abs(model.system.amplitude_change(position, velocity)))


def _levitation(model: Rotor) -> _Levitation | None:
    """Levitation of a model; ``None`` where it lies outside a wall or can grow.  Under weight it is a circle about the sag."""
    if len(stages_of(model)) > 1 or model.system.rest_radius >= 1.0 or _is_shaken(model):
        return None
    mass, _, _, stiffness, _ = model.matrices
    energy = _has_energy(model)
    if not (energy or _fades_by_modes(model)):
        return None
    system = model.system
    # The unbalance of a shaft whose speed can change has modes of its own; without contact it turns as it did.
    parts = system.outer, system.forced_at(0.0) - system.outer
    sags, whirls = (np.abs(system.arrays["rows"] @ part).tolist() for part in parts)
    whirls = [abs(place) + whirl for place, whirl in zip(system.arrays["offsets"].tolist(), whirls, strict=True)]
    rooms = np.array([1.0 - whirl - sag for whirl, sag in zip(whirls, sags, strict=True)])
    rooms = np.concatenate([rooms, _rooms_of_limits(model)]) * (1.0 - MARGIN)
    if (rooms <= 0.0).any():
        return None
    if not energy:
        return _Levitation(rooms, np.empty(0), has_energy=False)
    shown, rates = _watched(model)
    reaches = np.einsum("pn,np->p", shown, np.linalg.solve(stiffness, shown.conj().T)).real
    reaches += np.einsum("pn,np->p", rates, np.linalg.solve(mass, rates.conj().T)).real
    return _Levitation(rooms, np.sqrt(reaches))


def _has_energy(model: Rotor) -> bool:
    """Whether the matrices have an energy that does not grow."""
    mass, damping, _, stiffness, _ = model.matrices
    for matrix, zero in ((mass, False), (damping, True), (stiffness, False)):
        size, least = np.linalg.norm(matrix), np.linalg.eigvalsh(matrix)[0]
        skew = np.linalg.norm(matrix - matrix.conj().T)
        if skew > ROUNDING * size or least < (-ROUNDING if zero else ROUNDING) * size:
            return False
    return True


def _fades_by_modes(model: Rotor) -> bool:
    """Whether every free mode decays by itself, without another that drives it."""
    system = model.system
    driven = bool(system.arrays["driven"][system.free].any())
    return system.decay > 0.0 and not driven


def _rooms_of_limits(model: Rotor) -> np.ndarray:
    """What is left of each limit of the magnetic bearings while the rotor levitates, whatever the directions of the axes, shape (L,)."""
    if not model.system.limits:
        return np.empty(0)
    arrays = model.system.arrays
    asked = np.abs(arrays["limit_offsets"]) + np.abs(arrays["limit_rows"] @ model.system.forced_at(0.0))
    return np.asarray(arrays["limit_bounds"] - asked)


def _watched(model: Rotor) -> tuple[np.ndarray, np.ndarray]:
    """Displacements of the planes, then what is asked of each limit, per coordinate and per rate in the fixed frame, each (P + L, n)."""
    planes = model.system.planes
    limits = model.listed_limits
    shown = np.concatenate([planes, *(np.atleast_2d(each.displacement) for each in limits)])
    return shown, np.concatenate([0.0 * planes, *(np.atleast_2d(each.velocity) for each in limits)])


def _is_shaken(model: Rotor) -> bool:
    """Whether forces act that are not constant in the fixed frame, and may go on growing, or bearings are anisotropic."""
    constant = np.abs(model.system.arrays["exponents"] - STEADY) <= ROUNDING
    return model.system.is_anisotropic or bool((model.system.outer[~constant] != 0.0).any())


@checked
def contact_free_kick(machine: Subject) -> float:
    """Speed up to which a kick out of levitation provably never reaches the wall, in ``c_r Ω``.

    For the planar rotor this is the largest such speed; for other models it follows from a bound by energy, or by modes, and is smaller.  Zero
    where the rotor cannot levitate inside the wall, its levitation is unstable, or neither an energy is known that does not grow nor every mode decays.
    Where magnetic bearings have limits, no such kick brings them there either.

    See Also
    --------
    carom.basins.smallest_unrecovered : search for the smallest kick that is lost

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> print(f"{cm.closed_forms.contact_free_kick(machine):.6f}")
    0.039821
    """
    model = rotor_of(machine)
    return _contact_free_push(model, model.system.translated)


@checked
def contact_free_shock(machine: Subject, duration: Positive) -> float:
    """Peak acceleration up to which a half-sine shock of the base provably never brings the rotor to the wall.

    The deviation is the convolution of the shock with the response to a kick.  So it is no larger than the largest deviation after a
    kick (:func:`contact_free_kick`; of mounts too, which are shaken) by the change of velocity over the pulse, ``2âT/π``.  For the planar rotor this bound, in ``c_r Ω²``,
    is sharp for short pulses.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
    duration : float
        ``T``, in ``1/Ω``.
    """
    model = rotor_of(machine)
    return _contact_free_push(model, model.carried_by_housing) * math.pi / (2.0 * duration)


def _contact_free_push(model: Rotor, along: np.ndarray) -> float:
    """Change of the velocities of all coordinates, in proportion to these, up to which the wall is not reached."""
    levitation, known = _levitation(model), exact_results(model.unforced).response
    if levitation is None:
        return 0.0
    if known is not None and np.array_equal(along, model.system.translated):
        return float((levitation.rooms / known).min())
    return float((levitation.rooms / levitation.reach(model, 0.0 * along, along, along)).min())


@checked
def contact_free_blade_loss(machine: Subject, node: Whole | None = None) -> float:
    """Change of the unbalance up to which the loss of a blade provably never brings the rotor to the wall, at any phase.

    A change ``Δ`` shifts the levitation whirl by ``u₀ = Δ/(ω² − 1 + iγ)`` in the co-rotating frame, or by what the matrices give.
    This is the deviation at the loss; its velocity in the fixed frame is ``iu₀``.  So the deviation of the planar rotor from the whirl after
    the loss stays below ``|u₀|√(1 + 1/ω²)``, and that whirl is displaced from the one before by ``u₀``.  This bound is not sharp.
    The change, in ``c_r``, is the modulus of that of the complex eccentricity, at a node of a flexible machine; zero as for :func:`contact_free_kick`.
    """
    model = rotor_of(machine)
    levitation = _levitation(model)
    if levitation is None:
        return 0.0
    shift, deviation = _after_step(model, levitation, model.definition.unbalance_push(node))
    return float((levitation.rooms / (shift + deviation)).min())


def shift_by_unbalance(model: Rotor, node: int | None = None) -> np.ndarray:
    """Displacement (n,) of levitation per change of the unbalance, in the frame that turns."""
    return _shift(model, model.definition.unbalance_push(node))


def _shift(model: Rotor, push: np.ndarray) -> np.ndarray:
    """Displacement of the levitating rotor by a force in the frame that turns."""
    mass, damping, gyroscopic, stiffness, _ = model.matrices
    return np.linalg.solve(stiffness - mass + 1j * damping + gyroscopic, push)


def _after_step(model: Rotor, levitation: _Levitation, push: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Shift of levitation at each plane and limit by a change of the unbalance force, and the largest deviation from it after that step."""
    shift = _shift(model, push)
    shown, rates = _watched(model)
    return np.abs((shown + 1j * rates) @ shift), levitation.reach(model, shift, 0.0 * shift, shift)


def _energy(matrix: np.ndarray, state: np.ndarray) -> float:
    """Twice the energy of a state."""
    return float(np.einsum("i,ij,j->", np.conj(state), matrix, state).real)
