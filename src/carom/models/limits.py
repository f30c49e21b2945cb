"""Limits of magnetic bearings, along each of two perpendicular axes of the fixed frame, in the motion (:mod:`carom.core.limits`), and what a rotor asks for beyond them."""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from carom.base.outcome import InputError, shown
from carom.core.layout import rotor_record
from carom.models.mode_arrays import EQUAL, STEADY
from carom.models.system import System
from carom.parameters import ControlLimit, Parameters, Scales

if TYPE_CHECKING:
    from carom.models.definition import Definition


_VECTORS = ("displacement", "velocity", "accelerations", "rates")


@dataclass(frozen=True, eq=False)
class Limit:
    """A quantity of a controller, such as a control current, that has a largest size along each of two perpendicular axes.

    In the fixed frame, with the coordinates ``Z`` and their rates, it is ``displacement·Z + velocity·Ż``, of which along each axis no
    more than the bound is given.  What is asked for beyond the bound acts back: it changes the accelerations of the coordinates, and the rates of those
    without mass, such as the states of a controller.

    Attributes
    ----------
    bound : float
        Above 0.
    displacement, velocity : array_like, shape (n,)
        The quantity per coordinate and per rate of a coordinate.
    accelerations : array_like, shape (n,)
        Accelerations of the coordinates per unit of what is not given; zero for those without mass.
    rates : array_like, shape (n,), optional
        Rates of the coordinates without mass per unit of that; zeros by default.
    angle : float
        Of the first axis in the fixed frame, rad.
    follows : tuple of float
        What is not given of the limits before it in a list adds to this quantity by these factors; those left out are zero.
    one_axis : bool
        Whether it is a real quantity, ``Re(displacement·Z + velocity·Ż)``, of one axis alone; of anisotropic rotors.  What is not given then is real too, and
        has its direction by the complex accelerations and rates.
    """

    bound: float
    displacement: np.ndarray
    velocity: np.ndarray
    accelerations: np.ndarray
    rates: np.ndarray | None = None
    angle: float = 0.0
    follows: tuple[float, ...] = ()
    one_axis: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.bound < np.inf:
            raise InputError("bound", shown(self.bound), "a finite number above 0")
        if self.rates is None:
            object.__setattr__(self, "rates", np.zeros(np.shape(self.displacement)))
        for name in _VECTORS:
            given = getattr(self, name)
            values = np.array(given, complex if np.iscomplexobj(given) else float)
            if values.ndim != 1 or not np.isfinite(values).all():
                raise InputError(name, shown(given), "finite numbers, one for each coordinate")
            object.__setattr__(self, name, values)

    def at_speed(self, slower: float) -> Limit:
        """Return the same where the unit of time, the inverse of the nominal speed, is shorter by a factor."""
        return replace(
            self,
            velocity=self.velocity / slower,
            accelerations=self.accelerations * slower**2,
            rates=np.asarray(self.rates) * slower,
        )


def checked_limits(given: object, definition: Definition) -> ControlLimit | tuple[Limit, ...]:
    """Limits of the rotor of a definition: of a force in SI units, or in units of its equations; refuse what is none."""
    if isinstance(given, ControlLimit):
        if definition.planar is None or definition.scales is None:
            raise InputError("rotor", shown(definition), "the planar rotor with mass, clearance and speed")
        bearing = definition.bearing_at(0)
        if bearing is not None and definition.pull:
            allowed = "0 where the magnetic bearings have limits, whose force is counted from the place of levitation"
            raise InputError("touchdown_offset", bearing.offset, allowed)
        return given
    listed = tuple(given) if isinstance(given, Iterable) else ()
    if not listed or not all(isinstance(each, Limit) for each in listed):
        raise InputError("limits", shown(given), "carom.models.Limit, one or more")
    return listed


def with_limits(system: System, limits: Sequence[Limit]) -> System:
    """The system with limits of its controllers.

    Raises
    ------
    InputError
        The speed of its shaft changes, or a limit is of another number of coordinates, or of one axis of a rotor that is not anisotropic.
    """
    n, arrays = len(system.rest), system.arrays
    if system.shaft is not None:
        raise InputError("limits", f"{len(limits)} limit(s)", "none where the speed of the shaft changes")
    for each in limits:
        if {len(getattr(each, name)) for name in _VECTORS} != {n}:
            raise InputError("limits", f"of {len(each.displacement)} coordinates", f"limits of {n} coordinates")
    turns = np.array([cmath.exp(-1j * each.angle) for each in limits])
    shown_by = np.array([each.displacement + 1j * each.velocity for each in limits]) * turns[:, None]
    rates = np.array([each.velocity for each in limits]) * turns[:, None]
    pushes = np.array([np.concatenate([each.rates, each.accelerations]) for each in limits]).T / turns
    couplings = np.zeros((len(limits), len(limits)), complex)
    for place, each in enumerate(limits):
        couplings[place, : len(each.follows)] = each.follows
    rows, offsets = shown_by @ system.shapes + rates @ system.rates, shown_by @ system.rest
    if alone := [place for place, each in enumerate(limits) if each.one_axis]:
        if system.conjugate_basis is None:
            raise InputError("limits", "of one axis", "those of both, unless bearings are anisotropic")
        places, moving = np.split(system.conjugate_basis, 2)
        by_rates = np.array([limits[place].velocity.conj() for place in alone])
        by_places = np.array([limits[place].displacement.conj() for place in alone]) + 1j * by_rates
        rows[alone] = 0.5 * (rows[alone] + by_places @ places + by_rates @ moving)
        offsets[alone] = 0.5 * (offsets[alone] + by_places @ system.backward_whirl.conj())
    own = {
        "limit_rows": rows,
        "limit_offsets": offsets,
        "limit_bounds": np.array([each.bound for each in limits], float),
        "limit_columns": system.to_modes @ pushes,
        "limit_couplings": couplings * turns[:, None] / turns,
    }
    if system.is_anisotropic:
        own["limit_conjugates"] = system.conjugate_modes @ pushes.conj()
    # Of the unbalance only a shaft has entries; what follows from limits is made anew.
    kept = {name: arrays[name] for name in arrays.dtype.names or () if name != "unbalance"}
    return replace(system, arrays=rotor_record(**kept | own))


def with_bias(system: System, limits: Sequence[Limit], asked: np.ndarray) -> System:
    """The system of which each limit is asked for this much besides, (L,), constant in the fixed frame: by a forcing mode that turns with it."""
    arrays, (place, *_) = (
        system.arrays,
        np.flatnonzero(system.outer * (np.abs(system.arrays["exponents"] - STEADY) <= EQUAL)),
    )
    rows = arrays["limit_rows"].copy()
    rows[:, place] += asked * np.array([cmath.exp(-1j * each.angle) for each in limits]) / system.outer[place]
    kept = {name: arrays[name] for name in arrays.dtype.names or () if name != "unbalance"}
    return replace(system, arrays=rotor_record(**kept | {"limit_rows": rows}))


def limits_by(control: ControlLimit, at: Parameters, scales: Scales, coordinates: int) -> tuple[Limit, ...]:
    """The limit of a force in SI units, in those of a planar rotor with these parameters."""
    along = np.eye(coordinates)[0]
    return (
        Limit(
            control.force / scales.force,
            (at.omega**2 + control.pull / scales.stiffness) * along,
            at.gamma * along,
            along,
        ),
    )


def saturation_of(system: System, amplitudes: np.ndarray, times: np.ndarray) -> np.ndarray:
    """What is asked for beyond each limit, complex, shape (..., L), in the frame of the rotor, in states (..., N) at times (...)."""
    arrays, turn = system.arrays, np.exp(1j * np.asarray(times))[..., None]
    found = np.zeros((*turn.shape[:-1], system.limits), complex)
    for each, bound in enumerate(arrays["limit_bounds"].tolist()):
        asked = amplitudes @ arrays["limit_rows"][each] + arrays["limit_offsets"][each]
        asked = (asked + found @ arrays["limit_couplings"][each]) * turn[..., 0]
        given = np.clip(asked.real, -bound, bound) + 1j * np.clip(asked.imag, -bound, bound)
        found[..., each] = (asked - given) / turn[..., 0]
    return found


def saturation_accelerations(system: System) -> np.ndarray:
    """Accelerations of the coordinates per unit of what is asked for beyond each limit, shape (n, L)."""
    found: np.ndarray = system.rates @ system.arrays["limit_columns"]
    return found


def saturates(system: System, amplitudes: np.ndarray, forced: np.ndarray | None = None) -> bool:
    """Whether a whirl with the shaft about a place that stays asks for more than a limit along an axis.

    Amplitudes (N,) are those of the whirl, at rest in the frame of the rotor, and those of weight at time zero.
    """
    rows, bounds = system.arrays["limit_rows"], system.arrays["limit_bounds"]
    whirl, sag = np.abs(rows @ amplitudes + system.arrays["limit_offsets"]), np.zeros(system.limits, complex)
    if forced is not None:
        # Anisotropic bearings stretch the whirl.
        whirl += np.abs(rows[:, system.arrays["anisotropy"]]).sum(axis=1)
        sag = rows @ forced
    return bool((np.maximum(np.abs(sag.real), np.abs(sag.imag)) + whirl >= bounds).any())
