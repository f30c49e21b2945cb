"""Forces that change with time in the frame of a rotor, such as weight or those of a shaken housing: how they are given, and as modes of their own.

With the amplitudes ``c`` of the free modes and a force of amplitude ``f`` and exponent ``σ``,

    ċ = Mc + b f,      ḟ = σ f,

``c − (σ − M)⁻¹ b f`` moves as without the force.  So the force is one more mode, which adds ``(σ − M)⁻¹ b`` times itself to the
others, and which no impulse changes.  In resonance, where ``σ`` is nearly an exponent of ``M``, the force stands before the mode
it drives and forms a chain with it: weight, velocity and displacement in free fall.

Where bearings are anisotropic (:mod:`carom.models.linear_system`), a force ``f e^{σt}`` is also a force ``f̄ e^{σ̄t − 2it}`` on
conjugates; of one that is constant in the fixed frame both exponents are one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from carom.base.arguments import kind_of_numbers
from carom.base.outcome import InputError, shown
from carom.core.wall import Wall
from carom.models.from_modes import modal_system
from carom.models.mode_arrays import EQUAL, STEADY, TURN
from carom.models.system import System
from carom.parameters import Scales

RESONANT = 1e-3
"""Distance of exponents, relative to one plus their size, below which a force drives a mode instead of adding to it."""
APART = 1e-4
"""The same where otherwise modes would nearly coincide: twelve of sixteen digits are left."""
FADING = 1e-7
"""Rate, relative to the same, at which a mode fades beside a force: from there on it has settled to the force, not been driven away."""
NO_TURN = -1
"""Instead of the mode of a turn."""
ONE = 1e-7
"""Gap of a pair, relative to one plus the size of its exponents, whose square is lost in rounding."""


_KEPT = ("offsets", "masses", *Wall._fields, "limit_offsets", "limit_bounds", "limit_couplings")
"""Arrays that forces do not change."""


class Force(NamedTuple):
    """A force on a rotor that changes with time in its frame.

    Attributes
    ----------
    exponent : complex
        ``σ``, in units of the shaft speed: weight turns with ``−i`` in the co-rotating frame.
    accelerations : ndarray of complex, shape (n,)
        Of the coordinates, at time zero; of those without mass their rates.
    rates : ndarray of complex, shape (n,), optional
        Of a force ``(a + ḃt) e^{σt}``, such as that of a base between two samples of its acceleration, how fast it grows; it is a chain of two modes.
    """

    exponent: complex
    accelerations: np.ndarray
    rates: np.ndarray | None = None

    def at(self, times: np.ndarray) -> np.ndarray:
        """Accelerations (..., n) at times (...)."""
        turned = np.exp(self.exponent * times)[..., None]
        grown = 0.0 if self.rates is None else np.multiply.outer(times, self.rates)
        accelerations: np.ndarray = turned * (self.accelerations + grown)
        return accelerations


def with_forces(system: System, forces: Sequence[Force]) -> System:
    """The system with these forces.  It starts, at time zero, wherever its state says; at rest it follows the forces.

    Raises
    ------
    InputError
        A force is nearly in resonance with two modes that nearly coincide, or with a mode that another force drives.
    """
    n, planes, arrays = system.shapes.shape[0], len(system.arrays["rows"]), system.arrays
    first = planes + system.limits
    modes, last = _Modes.of(system), first + 2 * n
    growing = [force for force in forces if force.rates is not None]
    forces = [force for force in forces if force.rates is None]
    rates, conjugates = slice(first + n, last), None
    pushes = [(force.exponent, force.accelerations, rates) for force in forces]
    if system.is_anisotropic:
        conjugates = slice(last + first + n, None)  # amplitudes by rates of conjugates come last
        pushes += [(np.conj(force.exponent) + TURN, np.conj(force.accelerations), conjugates) for force in forces]
    for exponent, together in _merged(pushes):
        push = np.sum([_by_rates(modes.left, place, n) @ values for values, place in together], axis=0)
        modes = modes.driven_by(exponent, push)
    for force in growing:
        modes = modes.ramped_by(force, rates, conjugates)
    turns = modes.turn > NO_TURN
    moved = {
        "exponents": modes.exponents,
        "driven": modes.driven,
        "free": modes.free,
        "rows": modes.right[:planes],
        "columns": modes.left[:, :planes],
        "limit_rows": modes.right[planes:first],
        "limit_columns": modes.left[:, planes:first],
        "limit_conjugates": modes.left[:, last + planes : last + first],
        "anisotropy": np.array([modes.turn] if turns else [], int),
        "conjugate_columns": modes.left[:, last : last + planes],
    }
    return modal_system(
        rest=system.rest,
        shapes=modes.right[first:],
        inverse=modes.left[:, first:last],
        forced=modes.forced,
        conjugate_modes=modes.left[:, last + first :] if turns else None,
        arrays=moved | {name: arrays[name] for name in _KEPT},
        beside=system,
    )


def _by_rates(left: np.ndarray, rates: slice, n: int) -> np.ndarray:
    """What changes the amplitudes by the rates of ``n`` coordinates; of those without mass, whose rates are no part of a state, by themselves."""
    columns = left[:, rates]
    return np.where(columns.any(axis=0), columns, left[:, rates.start - n : rates.start])


def _merged(
    pushes: Sequence[tuple[complex, np.ndarray, slice]],
) -> list[tuple[complex, list[tuple[np.ndarray, slice]]]]:
    """What pushes with one exponent, together: accelerations, and which columns say what they change."""
    merged: list[tuple[complex, list[tuple[np.ndarray, slice]]]] = []
    for exponent, values, place in pushes:
        for other, together in merged:
            if abs(exponent - other) <= EQUAL * (1.0 + abs(exponent)):
                together.append((values, place))
                break
        else:
            merged.append((complex(exponent), [(values, place)]))
    return merged


@dataclass(frozen=True)
class _Modes:
    """Modes of a system: what each adds to displacements and coordinates (right), and what changes it (left)."""

    exponents: np.ndarray
    driven: np.ndarray
    free: np.ndarray
    forced: np.ndarray
    right: np.ndarray
    left: np.ndarray
    turn: int
    """Which is the turn of anisotropic bearings; NO_TURN where there is none."""

    @classmethod
    def of(cls, system: System) -> _Modes:
        """Modes of a system without those that only fill its arrays."""
        arrays, forced = system.arrays, system.forced_at(0.0)
        kept = system.free | (forced != 0.0)
        kept[system.race_modes] = False
        for place in arrays["shaft"].tolist():
            kept[place : place + 2] = False
        right = np.concatenate([arrays["rows"], arrays["limit_rows"], system.shapes])
        left = np.concatenate([arrays["columns"], arrays["limit_columns"], system.to_modes], axis=1)
        turn = NO_TURN
        if system.is_anisotropic:
            acting = arrays["conjugate_columns"], arrays["limit_conjugates"], system.conjugate_modes
            left = np.concatenate([left, *acting], axis=1)
            turn = int(kept[: arrays["anisotropy"][0]].sum())
        return cls(
            exponents=arrays["exponents"][kept],
            driven=arrays["driven"].astype(bool)[kept],
            free=system.free[kept],
            forced=forced[kept],
            right=right[:, kept],
            left=left[kept],
            turn=turn,
        )

    def driven_by(self, exponent: complex, push: np.ndarray) -> _Modes:
        """With one more force, which changes the rates of the amplitudes by ``push``."""
        try:
            return self._driven_by(exponent, push, RESONANT)
        except InputError:  # modes that nearly coincide, as those of a thin shaft that tilts about one support
            return self._driven_by(exponent, push, APART)

    def ramped_by(self, force: Force, rates_at: slice, conjugates: slice | None) -> _Modes:
        """With a force ``(a + ḃt) e^{σt}``: with ``ṡ = σs + q`` and ``q̇ = σq`` it adds ``(σ − M)⁻¹ b`` and ``−(σ − M)⁻² b``.

        What is in resonance follows ``q`` and ``s`` in one chain: velocity and displacement in free fall are its third and fourth.
        """
        exponent, rates = force.exponent, np.asarray(force.rates)
        along = rates if rates.any() else force.accelerations
        push = self.left[:, rates_at] @ along
        if conjugates is not None:  # of a force that is constant in the fixed frame both exponents are one
            push = push + self.left[:, conjugates] @ np.conj(along)
        moved, left = self.free & (np.abs(push) > EQUAL * np.abs(push).max(initial=0.0)), len(push)
        near = self.free & (np.abs(self.exponents - exponent) <= ONE * (1.0 + abs(exponent)))
        for last, gap in self._pairs():
            if near[last] and gap != 0.0:
                return self._as_one(push, last, gap)[0].ramped_by(force, rates_at, conjugates)
        place, size = left, 1.0 + 0j
        if (pushed := np.flatnonzero(near & moved)).size:
            place, size = int(pushed[0]), complex(push[pushed[0]])
            if len(pushed) == 2 and self.driven[place + 1] and pushed[1] == place + 1:
                alone, _ = self._with_share(push, place, place + 1, push[place + 1] / size)
                return alone.ramped_by(force, rates_at, conjugates)
            if len(pushed) > 1 or self.driven[place]:
                raise InputError(
                    "base", "a recorded motion", "a rotor on which nothing else drives what is in free fall"
                )
        whole = exponent * np.eye(left) - np.diag(self.exponents) - np.diag(self.driven[1:].astype(complex), -1)
        others, solved, again = np.flatnonzero(self.free & ~near), np.zeros(left, complex), np.zeros(left, complex)
        solved[others] = np.linalg.solve(whole[np.ix_(others, others)], push[others])
        again[others] = np.linalg.solve(whole[np.ix_(others, others)], solved[others])
        start, growth = (np.vdot(along, each) / np.vdot(along, along) for each in (force.accelerations, rates))
        found = self._added(place, exponent, solved / size, start * size)
        return found._added(place, exponent, np.insert(-again / size, place, 0.0), growth * size)

    def _driven_by(self, exponent: complex, push: np.ndarray, resonant: float) -> _Modes:
        """The same; modes farther than ``resonant`` from a force, relative to one plus its size, are none that it drives."""
        size = 1.0 + abs(exponent)
        close = self.free & (np.abs(self.exponents - exponent) <= resonant * size)
        close &= exponent.real - self.exponents.real <= FADING * size
        near = close & self._pushed(push)
        # Modes that a force drives already, and those after them in their chains.
        taken = self.driven & self.free
        for place in np.flatnonzero(taken).tolist():
            taken[place] = not self.free[place - 1] or taken[place - 1]
        if (np.abs(push[near & taken]) > EQUAL * np.abs(push).max(initial=0.0)).any():
            raise InputError("force", exponent, "an exponent not so near to that of a mode that another force drives")
        for last, gap in self._pairs():
            touched = near[last] or near[last - 1]
            if touched and abs(gap) > resonant * size:
                modes, push = self._parted(push, last, gap)
                return modes._driven_by(exponent, push, resonant)
            if touched and EQUAL * size < abs(gap) <= ONE * size:
                modes, push = self._as_one(push, last, gap)
                return modes._driven_by(exponent, push, resonant)
            near[last - 1 : last + 1] |= touched
        others = np.flatnonzero(self.free & ~near & ~close)
        matrix = np.diag(self.exponents) + np.diag(self.driven[1:].astype(complex), -1)
        shares = np.zeros(len(push), complex)
        shares[others] = np.linalg.solve(exponent * np.eye(len(others)) - matrix[np.ix_(others, others)], push[others])
        return self._resonant(exponent, push, near, shares)

    def _pushed(self, push: np.ndarray) -> np.ndarray:
        """Which modes a force changes, those of a pair together."""
        pushed = np.abs(push) > EQUAL * np.abs(push).max(initial=0.0)
        for last, _ in self._pairs():
            pushed[last - 1 : last + 1] |= pushed[last - 1 : last + 1].any()
        return pushed

    def _pairs(self) -> list[tuple[int, complex]]:
        """The last of each pair of free modes, and by how much its exponent differs from that of the first."""
        lasts = np.flatnonzero(self.driven & np.insert(self.free[:-1], 0, False))
        return list(zip(lasts.tolist(), self.exponents[lasts] - self.exponents[lasts - 1], strict=True))

    def _resonant(self, exponent: complex, push: np.ndarray, near: np.ndarray, shares: np.ndarray) -> _Modes:
        """With one more force that drives the mode it is in resonance with, if there is one."""
        firsts = np.flatnonzero(near & ~self.driven)
        pairs = [last - 1 for last, _ in self._pairs() if near[last - 1] and not self.driven[last - 1]]
        for first in pairs:
            shares[first] = -push[first + 1]
        driven = firsts[np.abs(push[firsts]) > EQUAL * np.abs(push).max(initial=0.0)]
        if not len(driven):
            return self._added(len(push), exponent, shares, 1.0)
        main = int(driven[np.abs(push[driven]).argmax()])
        apart = np.abs(self.exponents - exponent)
        # Exponents that are one number come out of an eigenvalue problem apart by its rounding over their distance from the others.
        distance = apart[self.free & ~near & (apart > APART)].min(initial=1.0)
        rounding = 8.0 * np.finfo(float).eps * np.abs(self.exponents).max() / distance
        if len(driven) + len(pairs) > 1 and apart[near].max() > max(rounding, EQUAL * (1.0 + abs(exponent))):
            raise InputError("force", exponent, "an exponent not so near to two that nearly coincide")
        if len(driven) > 1:
            if len({first in pairs for first in driven.tolist()}) > 1:
                raise InputError("force", exponent, "an exponent that is not that of modes of different kinds")
            other = next(first for first in driven.tolist() if first != main)
            ratio, modes = push[other] / push[main], self
            for step in range(2 if main in pairs else 1):
                modes, push = modes._with_share(push, main + step, other + step, ratio)
            return modes._resonant(exponent, push, near, shares)
        return self._added(main, exponent, shares / push[main], push[main])

    def _with_share(self, push: np.ndarray, main: int, other: int, ratio: complex) -> tuple[_Modes, np.ndarray]:
        """With this share of a mode in the main one, so that what drives both by this ratio drives the main one alone; and the push on these modes."""
        right, left, push = self.right.copy(), self.left.copy(), push.copy()
        right[:, main] += ratio * right[:, other]
        for driving in (left, push):
            driving[other] -= ratio * driving[main]
        return replace(self, right=right, left=left), push

    def _parted(self, push: np.ndarray, last: int, gap: complex) -> tuple[_Modes, np.ndarray]:
        """With the pair that ends with a mode as two free-standing ones: their exponents are well apart."""
        driven = self.driven.copy()
        driven[last] = False
        return replace(self, driven=driven)._with_share(push, last - 1, last, -1.0 / gap)

    def _as_one(self, push: np.ndarray, last: int, gap: complex) -> tuple[_Modes, np.ndarray]:
        """With the pair that ends with a mode as one of equal exponents, by an error of the square of the gap."""
        exponents = self.exponents.copy()
        exponents[last - 1 : last + 1] = exponents[last - 1 : last + 1].mean()
        return replace(self, exponents=exponents)._with_share(push, last, last - 1, -gap / 2.0)

    def _added(self, place: int, exponent: complex, shares: np.ndarray, amplitude: complex) -> _Modes:
        """With a forcing mode at a place, which adds these shares to the others and drives the one after it, if there is one."""
        driven, exponents = self.driven.copy(), self.exponents
        if place < len(driven):
            driven[place] = True
        if place + 1 < len(driven) and driven[place + 1]:
            exponents = np.where(np.isin(np.arange(len(driven)), (place, place + 1)), exponent, exponents)
        return _Modes(
            np.insert(exponents, place, exponent),
            np.insert(driven, place, False),
            np.insert(self.free, place, False),
            np.insert(self.forced, place, amplitude),
            np.insert(self.right, place, self.right @ shares, axis=1),
            np.insert(self.left, place, 0.0, axis=0),
            self.turn + (self.turn > NO_TURN and self.turn >= place),
        )


WITHOUT_FORCES = "needs a rotor without gravity or other forces that change with time in its frame; a setting gravity=0 leaves weight out"
ISOTROPIC_ALONE = (
    "isotropic bearings; without these carom.simulate, carom.settle, carom.drop, carom.study, carom.find_attractors, "
    "carom.find_orbits with impacts and carom.map_basins work"
)
"""What is asked for where forces that change with time, and anisotropic bearings, are refused."""


def checked_forces(given: object, shape: tuple[int, ...]) -> tuple[Force, ...]:
    """Forces on a rotor with coordinates of this shape; refuse what is none."""
    listed = tuple(given) if isinstance(given, Sequence) and not isinstance(given, Force) else ()
    if not listed or not all(isinstance(each, Force) for each in listed):
        raise InputError("forces", shown(given), "carom.models.Force, one or more")
    return tuple(_checked_force(each, shape) for each in listed)


def _checked_force(force: Force, shape: tuple[int, ...]) -> Force:
    """The force as complex numbers; refuse those that are none, or not as many as there are coordinates."""
    exponent, accelerations = complex_numbers(force.exponent), complex_numbers(force.accelerations)
    if exponent is None or exponent.shape:
        raise InputError("exponent", shown(force.exponent), "a finite number")
    if accelerations is None or accelerations.shape != shape:
        raise InputError("accelerations", shown(force.accelerations), f"finite numbers of shape {shape}")
    return force._replace(exponent=complex(exponent), accelerations=accelerations)


def complex_numbers(given: object) -> np.ndarray | None:
    """Array of finite numbers, a copy; ``None`` if they are no such numbers."""
    return None if kind_of_numbers(given) == "-" else np.array(given, complex)


def gravity_among(forces: Sequence[Force], along: np.ndarray, scales: Scales | None) -> tuple[int, float] | None:
    """Which of these forces is weight, which pulls all masses alike, and its acceleration in m/s²; ``None`` without scales or weight."""
    for place, force in enumerate(forces if scales else ()):
        pull = np.vdot(along, force.accelerations) / np.vdot(along, along)
        alike = np.abs(force.accelerations - pull * along).max() <= EQUAL * abs(pull)
        if scales and pull and alike and abs(force.exponent - STEADY) <= EQUAL:
            return place, float(abs(pull)) * scales.acceleration
    return None


def in_scales(force: Force, before: Scales | None, after: Scales | None) -> Force:
    """The same force, seen from the fixed frame, in other units of the equations."""
    if before is None or after is None or before == after:
        return force
    exponent = (force.exponent + 1j) * (before.speed / after.speed) - 1j
    slower = before.acceleration / after.acceleration
    rates = None if force.rates is None else force.rates * (slower * before.speed / after.speed)
    return Force(exponent, force.accelerations * slower, rates)
