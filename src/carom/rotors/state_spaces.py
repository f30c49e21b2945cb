"""Linear systems with one input and one output, as matrices: controllers, filters, delays, and one after the other."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.base.outcome import InputError, shown

LARGEST = 1e100
"""Largest number of a controller: products of two still are numbers."""
SWEEPS, SETTLED = 50, 1e-12
"""Most sweeps of balancing, and the relative change of the units at which it ends; a few sweeps do."""


@dataclass(frozen=True, eq=False)
class StateSpace:
    """``ẋ = Ax + By``, ``u = Cx + Dy``, with real numbers and time in s.

    Attributes
    ----------
    A : array_like, shape (s, s)
    B : array_like, shape (s, 1) or (s,)
    C : array_like, shape (1, s) or (s,)
    D : array_like, shape (1, 1), or float

    Raises
    ------
    InputError
        A matrix has another shape, or holds what is no finite real number.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float

    def __post_init__(self) -> None:
        matrices = {name: real_numbers(f"controller {name}", getattr(self, name)) for name in "ABCD"}
        size = matrices["A"].shape[0] if matrices["A"].ndim == 2 else -1
        size = 0 if not matrices["A"].size else size
        for name, count in {"A": size * size, "B": size, "C": size, "D": 1}.items():
            if matrices[name].size != count:
                words = {"A": "a square matrix", "D": "one number: one input and one output"}
                allowed = words.get(name, f"{size} numbers, one for each state: one input and one output")
                raise InputError(f"controller {name}", f"an array of shape {matrices[name].shape}", allowed)
        object.__setattr__(self, "A", matrices["A"].reshape(size, size))
        object.__setattr__(self, "B", matrices["B"].reshape(size))
        object.__setattr__(self, "C", matrices["C"].reshape(size))
        object.__setattr__(self, "D", float(matrices["D"].reshape(())))

    @property
    def states(self) -> int:
        """Number of states."""
        return len(self.B)

    def at(self, exponents: np.ndarray) -> np.ndarray:
        """Output over input at exponents ``s``, 1/s, shape (m,)."""
        unit = np.eye(self.states)
        inner = [self.C @ np.linalg.solve(each * unit - self.A, self.B) for each in np.ravel(exponents)]
        return np.array(inner).reshape(np.shape(exponents)) + self.D

    def then(self, other: StateSpace) -> StateSpace:
        """Series connection: `self` followed by `other`."""
        corner = np.zeros((self.states, other.states))
        return StateSpace(
            A=np.block([[self.A, corner], [np.outer(other.B, self.C), other.A]]),
            B=np.append(self.B, other.B * self.D),
            C=np.append(other.D * self.C, other.C),
            D=self.D * other.D,
        )

    def balanced(self) -> StateSpace:
        """The same with states in units in which they are of one size (Osborne, Journal of the ACM 7, 1960).

        What a controller is written down with, such as coefficients of polynomials, has numbers many powers of ten apart.
        """
        whole = np.block([[self.A, self.B[:, None]], [self.C[None], np.zeros((1, 1))]])
        np.fill_diagonal(whole, 0.0)
        sizes = np.ones(self.states)
        for _ in range(SWEEPS):
            before = sizes.copy()
            for state in range(self.states):
                row, column = np.linalg.norm(whole[state]), np.linalg.norm(whole[:, state])
                if row > 0.0 and column > 0.0:
                    # No power of two, at which the units would jump while a parameter changes.
                    factor = math.sqrt(row / column)
                    whole[state] /= factor
                    whole[:, state] *= factor
                    sizes[state] *= factor
            if np.allclose(before, sizes, rtol=SETTLED, atol=0.0):
                break
        return StateSpace(self.A * sizes / sizes[:, None], self.B / sizes, self.C * sizes, self.D)


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
    return StateSpace(np.array([[-bandwidth]]), np.array([bandwidth]), np.array([1.0]), 0.0)


def real_numbers(name: str, given: Any) -> np.ndarray:
    """Finite real numbers; of a complex type too, as those of a library."""
    try:
        values = np.array(given, dtype=complex if np.iscomplexobj(given) else float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(name, shown(given), "finite real numbers") from None
    if not (np.abs(values) <= LARGEST).all() or np.abs(values.imag).any():
        raise InputError(name, shown(given), f"finite real numbers, up to {LARGEST:g}")
    return np.asarray(values.real, float)
