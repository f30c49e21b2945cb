"""Linear systems as matrices: controllers, filters, delays, sampled systems with their hold, and one after the other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import block_diag, schur  # type: ignore[import-untyped]

from carom.base.outcome import InputError, shown
from carom.parameters import Field, read_quantity

LARGEST = 1e100
"""Largest number of a controller: products of two still are numbers."""
SWEEPS, SETTLED = 50, 1e-12
"""Most sweeps of balancing, and the relative change of the units at which it ends; a few sweeps do."""
PADE = 3
"""Order of the approximation of a delay ``T``: its phase is right to 0.1° up to a frequency of 2/T, in rad/s.  It is odd, so that integrators of sampled systems have one."""
SINGULAR = 1e12
"""Condition of the matrix of a system above which it integrates."""
NO_CONJUGATES = 1e-12
"""What a system of both axes makes of conjugates, relative to the rest, that is rounding."""
HIDDEN = 1e-6
"""Relative distance up to which an exponent is that of a hidden state, and its output."""
SMALL = 1e-9
"""Share of the largest size of a system below which errors are compared with that share."""
SAMPLE_TIME = Field("sample_time", "", "time between samples of a controller whose numbers are those of z", "a time", "s", 1e-9, 10.0, '"50 us"', usual="ms", usual_size=1e-3)  # fmt: skip


class ComplexSystem(NamedTuple):
    """``ẋ = Ax + By``, ``u = Cx + Dy + R ẏ`` with complex numbers: of displacements ``x + iy``, or of their conjugates."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    rate: np.ndarray

    @property
    def states(self) -> int:
        """Number of states."""
        return len(self.A)

    def at(self, exponent: complex) -> np.ndarray:
        """Outputs over inputs at an exponent ``s``, 1/s, shape (p, m)."""
        inner = np.linalg.solve(exponent * np.eye(self.states) - self.A, self.B)
        return np.asarray(self.C @ inner + self.D + exponent * self.rate)


@dataclass(frozen=True, eq=False)
class StateSpace:
    """``ẋ = Ax + By``, ``u = Cx + Dy``, with real numbers and time in s; or with a sample time ``x⁺ = Ax + By`` from sample to sample.

    Attributes
    ----------
    A : array_like, shape (s, s)
    B : array_like, shape (s, m) or (s,)
    C : array_like, shape (p, s) or (s,)
    D : array_like, shape (p, m), or float
    sample_time : float or str, optional
        s; by default it is in continuous time.
    rate : array_like, shape (p, m), or float
        What ``u`` has of ``ẏ`` beside: an ideal derivative; 0 by default.

    Raises
    ------
    InputError
        A matrix has another shape, or holds what is no finite real number.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    sample_time: float | None = None
    rate: Any = 0.0

    def __post_init__(self) -> None:
        matrices = {name: real_numbers(f"controller {name}", getattr(self, name)) for name in "ABCD"}
        straight = np.atleast_2d(matrices["D"])
        size = matrices["A"].shape[0] if matrices["A"].ndim == 2 else -1
        size = 0 if not matrices["A"].size else size
        shapes = {
            "A": (size, size),
            "B": (size, straight.shape[1]),
            "C": (straight.shape[0], size),
            "D": straight.shape,
        }
        for name, shape in shapes.items():
            given = matrices[name]
            if (
                given.size != shape[0] * shape[1]
                or given.ndim > 2
                or (given.ndim == 2 and given.size and given.shape != shape)
            ):
                words = {"A": "a square matrix", "D": "one number for each output and input"}
                allowed = words.get(
                    name,
                    f"{size} numbers, one for each state, for each {'input' if name == 'B' else 'output'} that D has",
                )
                raise InputError(f"controller {name}", f"an array of shape {given.shape}", allowed)
            object.__setattr__(self, name, given.reshape(shape))
        rate = real_numbers("controller rate", self.rate)
        object.__setattr__(self, "rate", np.zeros_like(straight) if not rate.any() else rate.reshape(straight.shape))
        if self.sample_time is not None:
            object.__setattr__(self, "sample_time", read_quantity(SAMPLE_TIME, self.sample_time))

    @classmethod
    def constant(cls, factors: np.ndarray | float) -> StateSpace:
        """A factor, or a matrix of them, shape (p, m)."""
        straight = np.atleast_2d(np.asarray(factors, float))
        return cls(np.zeros((0, 0)), np.zeros((0, straight.shape[1])), np.zeros((straight.shape[0], 0)), straight)

    @property
    def state_space(self) -> StateSpace:
        """It is one."""
        return self

    @property
    def states(self) -> int:
        """Number of states."""
        return len(self.B)

    @property
    def is_single(self) -> bool:
        """Whether it has one input and one output."""
        return self.D.shape == (1, 1)

    def at(self, exponents: np.ndarray) -> np.ndarray:
        """Output over input at exponents ``s``, 1/s, shape (...), or at ``z``; with several inputs or outputs of shape (..., p, m)."""
        unit, listed = np.eye(self.states), np.ravel(exponents)
        inner = [self.C @ np.linalg.solve(each * unit - self.A, self.B) + self.D + each * self.rate for each in listed]
        shape = np.shape(exponents)
        return np.array(inner).reshape(shape if self.is_single else (*shape, *self.D.shape))

    def then(self, other: StateSpace) -> StateSpace:
        """Series connection: `self` followed by `other`."""
        if (other.rate @ self.rate).any():
            raise InputError(
                "controller", "two ideal derivatives, one after the other", "a filter_time for one of them"
            )
        corner = np.zeros((self.states, other.states))
        # States of the other are counted from what the ideal derivative has moved them by, B R y.
        moved = other.B @ self.rate
        return StateSpace(
            A=np.block([[self.A, corner], [other.B @ self.C, other.A]]),
            B=np.concatenate([self.B, other.B @ self.D + other.A @ moved]),
            C=np.concatenate([other.D @ self.C + other.rate @ self.C @ self.A, other.C], axis=1),
            D=other.D @ self.D + other.C @ moved + other.rate @ self.C @ self.B,
            rate=other.D @ self.rate + other.rate @ self.D,
        )

    def balanced(self, axes: int = 1) -> StateSpace:
        """The same with states in units in which they are of one size (Osborne, Journal of the ACM 7, 1960).

        What a controller is written down with, such as coefficients of polynomials, has numbers many powers of ten apart.  Of both axes in turn the states
        of each pair have one unit.
        """
        whole = np.block([[self.A, self.B], [self.C, np.zeros_like(self.D)]])
        pairs, (rows, columns) = self.states // axes, whole.shape
        whole = np.linalg.norm(whole.reshape(rows // axes, axes, columns // axes, axes), axis=(1, 3))
        np.einsum("ii->i", whole[:pairs, :pairs])[:] = 0.0
        sizes = np.ones(pairs)
        for _ in range(SWEEPS):
            before = sizes.copy()
            for state in range(pairs):
                row, column = np.linalg.norm(whole[state]), np.linalg.norm(whole[:, state])
                if row > 0.0 and column > 0.0:
                    # No power of two, at which the units would jump while a parameter changes.
                    factor = math.sqrt(row / column)
                    whole[state] /= factor
                    whole[:, state] *= factor
                    sizes[state] *= factor
            if np.allclose(before, sizes, rtol=SETTLED, atol=0.0):
                break
        sizes = np.repeat(sizes, axes)
        return StateSpace(
            self.A * sizes / sizes[:, None],
            self.B / sizes[:, None],
            self.C * sizes,
            self.D,
            self.sample_time,
            self.rate,
        )

    def beside(self, second: StateSpace) -> StateSpace:
        """Both axes, of which it is the first: states, inputs and outputs are those of one and of the other in turn."""
        size = max(self.states, second.states)
        both = zip((self._filled(size), second._filled(size)), np.eye(2), strict=True)
        parts = [[np.kron(getattr(one, name), np.diag(axis)) for name in ComplexSystem._fields] for one, axis in both]
        A, B, C, D, rate = map(np.add, *parts)
        return StateSpace(A, B, C, D, rate=rate)

    def _filled(self, size: int) -> StateSpace:
        """The same with so many states, of which the first stay at zero."""
        more = size - self.states
        own = max(float(np.abs(self.A).max(initial=0.0)), 1.0)
        none = StateSpace.constant(np.zeros((0, 0)))
        return side_by_side([replace(none, A=-own * np.eye(more), B=np.zeros((more, 0)), C=np.zeros((0, more))), self])

    def in_pairs(self) -> StateSpace:
        """A system of both axes with its states in turn too: as they are, or first those of one axis, whichever makes less of conjugates."""
        even = self._filled(self.states + self.states % 2)
        order = np.arange(even.states).reshape(2, -1).T.ravel()
        turned = replace(even, A=even.A[np.ix_(order, order)], B=even.B[order], C=even.C[:, order])
        return min(even, turned, key=lambda each: sum(np.abs(part).sum() for part in each.complex_parts()[1]))

    def complex_parts(self) -> tuple[ComplexSystem, ComplexSystem]:
        """What a system of both axes in turn makes of ``x + iy``, and of the conjugates: zeros where its axes are alike, coupled or not."""
        parts = [
            [getattr(self, name)[row::2, column::2] for row in (0, 1) for column in (0, 1)]
            for name in ComplexSystem._fields
        ]
        alike = ComplexSystem(*(0.5 * (xx + yy + 1j * (yx - xy)) for xx, xy, yx, yy in parts))
        across = ComplexSystem(*(0.5 * (xx - yy + 1j * (yx + xy)) for xx, xy, yx, yy in parts))
        if all(
            np.linalg.norm(one) <= NO_CONJUGATES * np.linalg.norm(own) for one, own in zip(across, alike, strict=True)
        ):
            across = ComplexSystem(*map(np.zeros_like, across))
        return alike, across

    @property
    def held(self) -> StateSpace:
        """A sampled system with the hold of its output, in continuous time: each shift of a sample time ``T`` by Padé's approximation.

        The hold is ``(1 − e^{−sT})/(sT)``.  Poles inside the unit circle become poles left of the imaginary axis.  What sampling adds above half its frequency is left out.
        """
        if self.sample_time is None:
            return self
        shift = delay(self.sample_time, PADE)
        unit, through = np.eye(self.states), float(shift.D[0, 0])
        out, into = np.kron(unit, shift.C), np.kron(unit, shift.B)
        if self.states and np.linalg.cond(unit - through * self.A) > SINGULAR:
            raise InputError("controller", "a pole at z = -1", "none there, at half the sampling rate")
        next_states = np.linalg.solve(unit - through * self.A, np.concatenate([self.A @ out, self.B], axis=1))
        by_states, by_input = np.split(next_states, [PADE * self.states], axis=1)
        inner = StateSpace(
            np.kron(unit, shift.A) + into @ by_states,
            into @ by_input,
            self.C @ (out + through * by_states),
            self.D + through * self.C @ by_input,
        )
        time = self.sample_time
        hold = of_polynomials([time**2 / 60.0, 0.0, 1.0], [time**3 / 120.0, time**2 / 10.0, time / 2.0, 1.0])
        return inner.then(side_by_side([hold] * len(self.D))).balanced()._without_hidden(math.sqrt(60.0) / time)

    def _without_hidden(self, frequency: float) -> StateSpace:
        """The same without undamped states at a frequency, rad/s, that no output shows: an integrator is one there too, as Padé's shift turns once, and the hold is zero there."""
        at = np.array([1j, -1j]) * frequency
        form, turned, count = schur(
            self.A, sort=lambda real, turn: np.abs(complex(real, turn) - at).min() < HIDDEN * frequency
        )
        out = self.C @ turned
        if not count or np.abs(out[:, :count]).max() > HIDDEN * np.abs(out).max():
            return self
        kept = StateSpace(form[count:, count:], (turned.T @ self.B)[count:], out[:, count:], self.D, rate=self.rate)
        return kept.balanced()

    @property
    def highest(self) -> float:
        """A quarter of the sampling frequency, rad/s, up to which :attr:`held` is asked for its error."""
        return 0.5 * math.pi / (self.sample_time or math.inf)

    def sampling_error(self, frequency: float) -> float:
        """Largest error of :attr:`held` up to a frequency, rad/s, over the size of the system at each; 0 in continuous time."""
        if self.sample_time is None:
            return 0.0
        steps = 1j * np.linspace(1e-3, 1.0, 200) * frequency * self.sample_time
        hold = -np.expm1(-steps) / steps
        exact = self.at(np.exp(steps)) * hold.reshape(-1, *(1,) * (0 if self.is_single else 2))
        found = self.held.at(steps / self.sample_time)
        return float((np.abs(found - exact) / np.abs(exact).clip(min=SMALL * np.abs(exact).max())).max())


def side_by_side(systems: Sequence[StateSpace]) -> StateSpace:
    """Systems each with inputs and outputs of its own, as one."""
    A, B, C, D, rate = (block_diag(*(getattr(each, name) for each in systems)) for name in ComplexSystem._fields)
    return StateSpace(A, B, C, D, rate=rate)


def in_series(systems: Sequence[StateSpace]) -> StateSpace:
    """Systems one after the other."""
    return reduce(StateSpace.then, systems)


def of_polynomials(numerator: object, denominator: object) -> StateSpace:
    """System of a transfer function, with coefficients from the highest power of ``s`` on; one whose numerator has the higher degree is refused."""
    above, below = (
        np.trim_zeros(real_numbers(f"controller {name}", given).ravel(), "f")
        for name, given in (("numerator", numerator), ("denominator", denominator))
    )
    if not len(below):
        raise InputError("controller denominator", shown(denominator), "a polynomial that is not zero")
    if len(above) > len(below):
        allowed = f"a proper transfer function, degree of the numerator at most {len(below) - 1}: filter its derivative"
        raise InputError("controller numerator", f"a polynomial of degree {len(above) - 1}", allowed)
    order = len(below) - 1
    # In a time in which the coefficients of the denominator have one size.
    scale = (abs(below[-1] / below[0])) ** (1.0 / order) if order and below[-1] else 1.0
    powers = scale ** -np.arange(len(below), dtype=float)
    above = np.concatenate([np.zeros(len(below) - len(above)), above]) * powers / below[0]
    below = below * powers / below[0]
    matrix = np.eye(order, k=1)
    matrix[-1:] = -below[:0:-1]
    straight = above[0]
    output = (above[1:] - straight * below[1:])[::-1]
    return StateSpace(matrix * scale, np.eye(order)[-1:].ravel() * scale, output, straight).balanced()


def delay(time: float, order: int) -> StateSpace:
    """Padé's approximation of a delay, s, with denominator and numerator of one degree."""
    weights = [
        math.comb(order, power) * math.factorial(2 * order - power) / math.factorial(2 * order)
        for power in range(order, -1, -1)
    ]
    signs = [(-1.0) ** power for power in range(order, -1, -1)]
    sized = [weight * time**power for weight, power in zip(weights, range(order, -1, -1), strict=True)]
    return of_polynomials([sign * each for sign, each in zip(signs, sized, strict=True)], sized)


def lag(bandwidth: float) -> StateSpace:
    """A low-pass filter of first order with this bandwidth, rad/s."""
    return StateSpace(np.array([[-bandwidth]]), np.array([bandwidth]), np.array([1.0]), np.zeros(()))


def real_numbers(name: str, given: Any) -> np.ndarray:
    """Finite real numbers; of a complex type too, as those of a library."""
    try:
        values = np.array(given, dtype=complex if np.iscomplexobj(given) else float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            name, shown(given), "finite real numbers, in a file as rows in brackets: [[1, 2], [3, 4]]"
        ) from None
    if not (np.abs(values) <= LARGEST).all() or np.abs(values.imag).any():
        raise InputError(name, shown(given), f"finite real numbers, up to {LARGEST:g}")
    return np.asarray(values.real, float)
