"""A linear rotor as arrays for the kernels, and the conversion between states, nodes of orbits and mode amplitudes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Self

import numpy as np

from carom.base.outcome import InputError
from carom.core.records import copy_of
from carom.models.mode_arrays import EQUAL, ModeArrays
from carom.models.turning import Race, ShaftModes
from carom.parameters import Scales


class Nodes(NamedTuple):
    """How nodes follow from mode amplitudes, and these from nodes: what the kernels of orbits take.

    A node is a state, the coordinates and then their rates.  Weight and other forces that are constant in the fixed frame turn with
    ``e^{−it}`` in that of the rotor; under these this number is one more entry.

    Attributes
    ----------
    basis : ndarray of complex, shape (S, N)
        Node per amplitude.
    to_modes : ndarray of complex, shape (N, S)
        Amplitudes per node.
    rest : ndarray of complex, shape (S,)
        Node whose amplitudes are zero.
    """

    basis: np.ndarray
    to_modes: np.ndarray
    rest: np.ndarray

    @classmethod
    def under(cls, forced: np.ndarray | None, basis: np.ndarray, to_modes: np.ndarray, rest: np.ndarray) -> Self:
        """Nodes of a rotor with given conversions of its states, and amplitudes (N,) of the forcing modes at time zero, if it has any."""
        if forced is None:
            return cls(basis, np.ascontiguousarray(to_modes), rest)
        leading = int(np.abs(forced).argmax())
        reads = np.zeros((1, len(forced)), complex)
        reads[0, leading] = 1.0 / forced[leading]
        # A state is that at rest, which follows the force, and what free modes add.
        follows = forced - to_modes @ (basis @ forced)
        whole = np.concatenate([to_modes, follows[:, None]], axis=1)
        return cls(np.concatenate([basis, reads]), whole, np.append(rest, 0.0))

    def of(self, amplitudes: np.ndarray) -> np.ndarray:
        """Nodes (m, S) of mode amplitudes (m, N)."""
        found: np.ndarray = np.einsum("nk,mk->mn", self.basis, amplitudes) + self.rest
        return found

    def amplitudes(self, nodes: np.ndarray) -> np.ndarray:
        """Mode amplitudes (m, N) of nodes (m, S)."""
        found: np.ndarray = np.einsum("nk,mk->mn", self.to_modes, nodes - self.rest)
        return found


ROUNDING = 1e-12
"""Share of the sum of moduli below which the sum counts as zero."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class BesideModes:
    """What a rotor has beside its modes, whatever forces act on it.

    Attributes
    ----------
    translation : ndarray of complex, shape (n,), optional
        Change of the coordinates when the rotor as a whole is displaced by one; ones by default.
    races : tuple of Race or None, optional
        The race at each plane, where one turns.  Their modes are not free, but friction changes them.
    shaft : ShaftModes, optional
        Those of a shaft whose speed changes.  The frame turns at its nominal speed.
    clearances : tuple of float, optional
        Clearance of each plane in the unit of length of the rotor's scales; ones by default.
    growth : float
        Rate, in ``Ω``, at which a motion grows that the modes leave out; 0, the default, if none does.
    magnets : ndarray of complex, shape (G, n), optional
        Displacement at each magnet, in its air gap, per coordinate, where the gap is known.
    """

    translation: np.ndarray | None = None
    races: tuple[Race | None, ...] | None = None
    shaft: ShaftModes | None = None
    clearances: tuple[float, ...] | None = None
    growth: float = 0.0
    magnets: np.ndarray | None = None


@dataclass(frozen=True, eq=False, repr=False)
class System(ModeArrays, BesideModes):
    """Modes, contact planes and contact law of a rotor, as arrays for the kernels.

    A state is a view of the amplitudes: the ``n`` coordinates of the rotor and their rates; for a rotor with one coordinate they
    are plain numbers.  Lengths are in clearances ``c_r``, times in ``1/Ω``, in the frame that turns with the shaft.

    Free modes are those that a disturbance can change.  Forcing modes keep a course of their own, from the amplitudes
    ``forced`` at time zero: the rotor is at rest where its free modes are.  Modes that only fill the room of the arrays are at zero.

    Attributes
    ----------
    arrays : numpy.record
        Of :func:`~carom.core.layout.rotor_record`, with ``N`` modes, ``2n`` of them free, and ``P`` contact planes.  Its fields as
        attributes take four times as long as in brackets.
    rest : ndarray of complex, shape (n,)
        Coordinates at rest without forcing modes: the contact-free equilibrium.
    shapes : ndarray of complex, shape (n, N)
        Coordinates per amplitude.
    to_modes : ndarray of complex, shape (N, 2n)
        Amplitudes per coordinate, then per rate of a coordinate; zeros for modes that are not free.
    forced : ndarray of complex, shape (N,), optional
        Amplitudes of the forcing modes at time zero, zeros elsewhere; all zeros by default.
    conjugate_modes, conjugate_basis : ndarray of complex, shapes (N, 2n) and (2n, N), optional
        Where bearings are anisotropic (:mod:`carom.models.linear_system`) amplitudes per conjugate of a coordinate, then of a rate, times ``e^{−2it}``;
        and conjugates, then their rates, in the frame that turns, per amplitude, without forces.
    """

    rest: np.ndarray
    shapes: np.ndarray
    to_modes: np.ndarray
    forced: np.ndarray | None = None
    conjugate_modes: np.ndarray | None = None
    conjugate_basis: np.ndarray | None = None

    @property
    def decay(self) -> float:
        """Rate at which the slowest free motion decays, in ``Ω``; negative if one grows."""
        return min(super().decay, -self.growth) if self.growth else super().decay

    def own_records(self) -> tuple[np.record, np.record]:
        """The arrays and the table as :func:`carom.core.advance.advance` takes them: copies where it sets entries of them."""
        if self.shaft is None:
            return self.arrays, self.table
        return copy_of(self.arrays), copy_of(self.table)

    @property
    def is_anisotropic(self) -> bool:
        """Whether bearings are anisotropic."""
        return self.conjugate_modes is not None

    @property
    def why_not_stationary(self) -> tuple[str, str] | None:
        """What keeps levitation from being a whirl about a place that stays, and what is allowed instead; ``None`` if nothing does."""
        if self.shaft is not None:
            never = "a shaft whose speed changes, so that no motion repeats itself"
            return never, "leave out [drive], or simulate its motions"
        if self.is_externally_forced:
            return "forces that change in the fixed frame", "forces that turn with the shaft, or weight"
        return None

    @property
    def is_externally_forced(self) -> bool:
        """Whether forces act that change in the fixed frame too."""
        return bool(self.outer[~self._steady].any())

    def refuse_non_stationary(self) -> None:
        """Refuse a rotor that does not levitate in a whirl about a place that stays."""
        if self.why_not_stationary is not None:
            raise InputError("machine", *self.why_not_stationary)

    @property
    def is_time_dependent(self) -> bool:
        """Whether it matters when a motion begins: something stands in the fixed frame, past which the unbalance turns."""
        return bool(self.outer.any() or self.limits or self.is_anisotropic)

    @property
    def whirl(self) -> np.ndarray:
        """Coordinates (n,) of the response to the unbalance, which turns with the shaft at its nominal speed."""
        return self.rest + self.shapes @ self._unbalanced if self.shaft is not None else self.rest

    @property
    def backward_whirl(self) -> np.ndarray:
        """Coordinates (n,) of what turns with ``e^{−2it}`` in the contact-free motion: its whirl is an ellipse in the fixed frame."""
        return self.shapes @ (self._turn if self.is_anisotropic else np.zeros(self.modes))

    @cached_property
    def _turn(self) -> np.ndarray:
        """The turn of anisotropic bearings at time zero, zeros elsewhere; shape (N,)."""
        turn = np.zeros(self.modes, complex)
        turn[self.arrays["anisotropy"]] = 1.0
        return turn

    @property
    def rates(self) -> np.ndarray:
        """Rates of the coordinates per amplitude, shape (n, N)."""
        return self.basis[len(self.rest) :]

    @cached_property
    def basis(self) -> np.ndarray:
        """Coordinates, then their rates, per amplitude, shape (2n, N)."""
        n = len(self.rest)
        basis = np.empty((2 * n, self.shapes.shape[1]), complex)
        basis[:n], basis[n:] = self.shapes, self.shapes * self.arrays["exponents"]
        basis[n:, :-1] += self.shapes[:, 1:] * self.arrays["driven"][1:]
        return basis

    @cached_property
    def _whole_rest(self) -> np.ndarray:
        """Coordinates and rates at rest without forcing modes, shape (2n,)."""
        whole = np.zeros(2 * len(self.rest), complex)
        whole[: len(self.rest)] = self.rest
        return whole

    @property
    def race_modes(self) -> np.ndarray:
        """The modes of the races that turn, in the order of their planes; each has the speed of its surface as real amplitude."""
        modes: np.ndarray = self.arrays["race"]
        return modes[modes >= 0]

    @cached_property
    def outer(self) -> np.ndarray:
        """Amplitudes at time zero of the modes of outer forces, such as weight, zeros elsewhere; shape (N,)."""
        outer = np.zeros(self.modes, complex) if self.forced is None else self.forced.copy()
        outer[self.race_modes] = 0.0
        for place in self.arrays["shaft"].tolist():
            outer[place : place + 2] = 0.0
        outer[self.arrays["anisotropy"]] = 0.0
        return outer

    @cached_property
    def nodes(self) -> Nodes:
        """How nodes of orbits follow from amplitudes, of a rotor that :meth:`refuse_non_stationary` lets pass."""
        return Nodes.under(self.forced, self.basis, self.to_modes, self._whole_rest)

    def forced_at(self, time: float) -> np.ndarray:
        """Amplitudes at rest at a time: those of the forcing modes, and zeros; shape (N,)."""
        if self.forced is None:
            return np.zeros(self.modes, complex)
        ramps = self.arrays["driven"].astype(bool) & ~self.free  # of a force that grows, each after its rate
        forced = self.forced + ramps * np.roll(self.outer, 1) * time
        # Other modes may grow beyond all numbers by then.
        return forced * np.exp(np.where(forced, self.arrays["exponents"], 0.0) * time)

    def amplitudes_of(self, states: np.ndarray, time: float = 0.0) -> np.ndarray:
        """Mode amplitudes of states (m, 2n) at a time, each the coordinates and then their rates; shape (m, N)."""
        if self.forced is None:
            found: np.ndarray = np.einsum("nk,mk->mn", self.to_modes, states - self._whole_rest)
            return found
        forced = self.forced_at(time)
        away = states - self.states_of(forced[None])
        found = np.einsum("nk,mk->mn", self.to_modes, away) + forced
        if self.conjugate_modes is not None:
            found += np.einsum("nk,mk->mn", self.conjugate_modes, away.conj()) * forced[self.arrays["anisotropy"]]
        return found

    def states_of(self, amplitudes: np.ndarray) -> np.ndarray:
        """States of mode amplitudes, the inverse of :meth:`amplitudes_of`."""
        found: np.ndarray = np.einsum("nk,mk->mn", self.basis, amplitudes) + self._whole_rest
        return found

    def amplitudes(
        self, position: complex | np.ndarray, velocity: complex | np.ndarray, time: float = 0.0
    ) -> np.ndarray:
        """Mode amplitudes of a state at a time, shape (N,).

        Parameters
        ----------
        position, velocity : complex, or ndarray of complex, shape (n,)
            Coordinates and their rates.
        """
        amplitudes: np.ndarray = self.amplitudes_of(np.array([position, velocity]).reshape(1, -1), time)[0]
        return amplitudes

    def amplitude_change(
        self, position_change: complex | np.ndarray, velocity_change: complex | np.ndarray
    ) -> np.ndarray:
        """Change of the mode amplitudes, shape (N,), that corresponds to a change of state of any size."""
        change = np.array([position_change, velocity_change]).ravel()
        # Not a matrix product: the threads of the linear algebra library cost far more than these few numbers.
        changes: np.ndarray = np.einsum("nk,k->n", self.to_modes, change)
        return changes

    def state(self, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position and velocity for mode amplitudes of shape (..., N), each of shape (..., n); (...) if ``n = 1``."""
        position = np.einsum("...k,nk->...n", amplitudes, self.shapes) + self.rest
        velocity = np.einsum("...k,nk->...n", amplitudes, self.rates)
        return (position, velocity) if len(self.rest) > 1 else (position[..., 0], velocity[..., 0])

    def kicked(self, push: complex | np.ndarray, time: float | np.ndarray = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and their rates, both (..., n), just after the rotor, levitating at a time, gets velocities (...) as a whole."""
        velocities = np.multiply.outer(push, self.translated)
        if self.forced is None:
            return np.broadcast_to(self.rest, velocities.shape), velocities
        position, velocity = np.split(self._levitation(time), 2, axis=-1)
        return np.broadcast_to(position, velocities.shape), velocities + velocity

    def _levitation(self, time: float | np.ndarray) -> np.ndarray:
        """States (..., 2n) of the levitating rotor at times (...)."""
        if not np.any(time):
            return self.states_of((self.forced_at(0.0) + self._unbalanced)[None])[0]
        # Mode by mode, of parts: the last bit of a complex product, and of one of matrices, depends on the place in the array.
        still = self.states_of(self._unbalanced[None])[0]
        parts = np.multiply.outer(np.ones(np.shape(time)), np.array([still.real, still.imag]))
        forced = self.forced_at(0.0)
        for mode in np.flatnonzero(forced).tolist():
            exponent, along = complex(self.arrays["exponents"][mode]), self.basis[:, mode] * forced[mode]
            angle = exponent.imag * np.asarray(time)
            size = np.exp(exponent.real * np.asarray(time))
            cosine, sine = (np.asarray(size * turned)[..., None] for turned in (np.cos(angle), np.sin(angle)))
            parts[..., 0, :] += along.real * cosine - along.imag * sine
            parts[..., 1, :] += along.imag * cosine + along.real * sine
        states: np.ndarray = parts[..., 0, :] + 1j * parts[..., 1, :]
        return states

    def translation_velocity(self, velocities: np.ndarray, time: float | np.ndarray = 0.0) -> np.ndarray:
        """Velocities (...) of the rotor as a whole from the rates (..., n) of the coordinates: the inverse of :meth:`kicked`."""
        if self.forced is not None:
            _, levitating = self.kicked(np.zeros(np.shape(time)), time)
            velocities = velocities - (levitating if len(self.rest) > 1 else levitating[..., 0])
        if self.translation is None:
            return velocities
        moves = self.translation if len(self.rest) > 1 else self.translation[0]
        pushes: np.ndarray = np.dot(velocities, moves.conj()) / np.vdot(moves, moves)
        return pushes

    def race_speeds(self, amplitudes: np.ndarray) -> tuple[float, ...]:
        """Speeds of the surfaces of the races that turn, in the order of their planes, in ``c_r Ω`` in the fixed frame."""
        return tuple(amplitudes[self.race_modes].real.tolist())

    def shaft_turn(self, amplitudes: np.ndarray) -> tuple[float, ...]:
        """Speed of a shaft whose speed changes, in ``Ω``, and the angle by which it is ahead of the frame; empty without one."""
        if self.shaft is None:
            return ()
        direction, speed = amplitudes[self.arrays["shaft"][0] :][:2]
        return float(speed.real), float(np.angle(direction))

    @cached_property
    def _unbalanced(self) -> np.ndarray:
        """Amplitudes of the response to the unbalance of such a shaft at the nominal speed, shape (N,); zeros without one."""
        response = np.zeros(self.modes, complex)
        if self.shaft is not None:
            generator = self.generator[np.ix_(self.free, self.free)]
            response[self.free] = np.linalg.solve(generator, -self.arrays["unbalance"][self.free])
        return response

    @property
    def translated(self) -> np.ndarray:
        """Coordinates when the rotor as a whole is displaced by one, shape (n,)."""
        return np.ones(len(self.rest)) if self.translation is None else self.translation

    @cached_property
    def planes(self) -> np.ndarray:
        """Displacement of each contact plane per coordinate, shape (P, n)."""
        planes: np.ndarray = self.arrays["rows"] @ self.to_modes[:, : len(self.rest)]
        return planes

    @property
    def rest_radius(self) -> float:
        """Largest distance of a contact plane from its centre at rest: there is levitation below 1.  Under forces of several frequencies a bound.

        Infinite where forcing drives a free mode without bound.
        """
        arrays = self.arrays
        if self.forced is None:
            return float(np.abs(arrays["offsets"]).max())
        if (arrays["driven"][1:] * ~self.free[:-1] * (self.forced[:-1] != 0.0)).any():
            return math.inf
        offsets, steady = arrays["offsets"] + arrays["rows"] @ self._unbalanced, self._steady
        sags, others = np.abs(arrays["rows"] @ (self.forced * steady)), np.abs(arrays["rows"] * self.forced * ~steady)
        return float((np.abs(offsets) + sags + others.sum(axis=1)).max())

    @property
    def levitates(self) -> bool:
        """Whether there is levitation to return to: at rest, or in its circle, the rotor is inside the wall, and no free motion grows."""
        return self.rest_radius < 1.0 and self.decay >= -EQUAL

    def require_levitation(self) -> None:
        """Refuse it where its whirl about the static sag reaches the wall, or nothing holds it."""
        if (reach := self.rest_radius) >= 1.0:
            held = (
                "none, nothing holds the rotor"
                if reach == math.inf
                else f"up to {reach:.4g} clearances from the centre"
            )
            raise InputError("levitation", held, "static sag and whirl must stay inside the wall: below 1")

    @cached_property
    def planes_translated(self) -> np.ndarray:
        """Distance by which each contact plane moves when the rotor as a whole is displaced by one, shape (P,)."""
        distances: np.ndarray = np.abs(self.planes @ self.translated)
        distances[distances <= ROUNDING * (np.abs(self.planes) @ np.abs(self.translated))] = 0.0
        return distances

    def scales_at(self, plane: int, scales: Scales | None) -> Scales | None:
        """Scales of what is stated of a contact plane: its own clearance is the unit of length, the unit of energy is that of the rotor."""
        wide = float(self.widths[plane])
        if scales is None or wide == 1.0:
            return scales
        return Scales(scales.mass / wide**2, scales.clearance * wide, scales.speed)

    @cached_property
    def widths(self) -> np.ndarray:
        """Clearance of each plane in the unit of length of the rotor's scales, shape (P,): a force at a plane is so many times smaller in its own unit."""
        return np.ones(len(self.arrays["offsets"])) if self.clearances is None else np.array(self.clearances)
