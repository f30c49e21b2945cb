"""Constants of a block of flight that the certified crossing search needs; they depend on the exponents only.

On a block, a flight that starts at ``y₀`` moves as ``y(τ) = y₀ + Σ_k α_k ψ_k(τ)`` with basis functions that vanish at
``τ = 0``: ``e^{λτ} − 1`` for a free-standing mode and the last of a chain, the divided difference ``φ`` (see
:mod:`carom.core.flow`) in place of the first of a pair, and ``τʲ/j! e^{λτ}`` in place of mode ``j`` of a longer chain, whose
exponents are one number.  Then

    |y|² − 1 = |y₀|² − 1 + Σ_k 2 Re(ȳ₀ α_k ψ_k) + Σ_k |α_k|² |ψ_k|² + Σ_{j<k} 2 Re(α_j ᾱ_k ψ_j ψ̄_k)

is linear in ``2N + N²`` real products, and so are its Bernstein coefficients.  They follow by one fixed matrix,
computed here for the block and for LEVELS − 1 shorter ones, where polynomials approximate more closely.

The state at a time is computed from the nearest of NODES + 1 nodes, at which the basis functions are tabulated, by a
power series.  Half a spacing is so short that TERMS terms are exact to rounding.  Lanes use LANE_NODES nodes and
LANE_TERMS terms.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from carom.core.layout import DEGREE, LANE_NODES, LANE_TERMS, LEVELS, MOST_IN_POLYNOMIALS, NODES, OCTET
from carom.core.records import record

LONGEST_BLOCK = 3.0
"""Longest time of a block.

This and the next two, like DEGREE and LEVELS, were chosen by the sweep in ``docs/decisions/crossings.md``.
"""
LARGEST_PHASE = 5.3
"""Largest ``|λ|`` times the length of a block."""
SHORTENING = 4.0
"""Ratio of the lengths of successive blocks."""
SAMPLES = 48
"""Chebyshev points at which the basis is sampled.

With ``|λ|T ≤ 5.3`` the sampled functions are entire of exponential type at most 10.6 per block, so their Chebyshev
coefficients of order 48 and above are below 1e-30 and the computed tail is the whole tail.
"""

ROUNDED = 6e-14
"""Bound of the rounding of the coefficients, relative to the sum of the series; the largest observed is 4.3e-14."""


def flight_table(exponents: np.ndarray, driven: np.ndarray) -> np.record:
    """Table of a rotor with these exponents.

    Parameters
    ----------
    exponents : ndarray of complex, shape (N,)
    driven : ndarray of bool, shape (N,)

    Returns
    -------
    numpy.record
        With the fields

        spacing : float
            Time between nodes.
        durations : ndarray, shape (LEVELS,)
            Lengths of the blocks, the longest first; its length is NODES times ``spacing``.
        coefficients : ndarray, shape (LEVELS, Q, DEGREE), Q = 2N + N²
            Bernstein coefficients 1 … DEGREE of the products of basis functions; Q = 0 for more than MOST_IN_POLYNOMIALS modes.
        errors : ndarray, shape (LEVELS, Q)
            Bound of the approximation error at the end of the block, per row of ``coefficients``.
        lane_durations, lane_coefficients, lane_errors : ndarray
            The same with the block as last axis, so that each lane can choose its own; the errors are per modulus of a
            product and per unit time.  Their shapes are (OCTET,), (DEGREE, Q, OCTET) and (N + N (N + 1)/2, OCTET).
        basis : ndarray of complex, shape (NODES + 1, 4, N)
            Basis functions and their first three derivatives at the nodes.
        growth : ndarray of complex, shape (NODES + 1, N)
            ``e^{λτ} − 1`` at the nodes.
        basis_series, growth_series : ndarray of complex, shape (LANE_TERMS, N)
            Coefficients 1 … LANE_TERMS of the power series of both; single motions, whose nodes are closer, use TERMS of
            them.
        lane_spacing : float
            Time between nodes for lanes.
        lane_basis : ndarray, shape (N, 2, LANE_NODES)
            Real and imaginary parts of basis functions at the nodes for lanes.
        bounds : ndarray, shape (3, N)
            Largest modulus on the longest block of the first three derivatives of the basis functions.

        and ``pace`` (nodes per unit time), ``degree`` (DEGREE) and ``terms`` (LANE_TERMS).  Loops in the kernels for lanes take
        their length from the last two: the compiler would unroll a loop of known length, and the unrolled loop needs more vectors
        than there are registers.
    """
    fastest = np.abs(exponents).max()
    spacing = _short_number(
        min(LONGEST_BLOCK, LARGEST_PHASE / fastest) / NODES if fastest > 0 else LONGEST_BLOCK / NODES
    )
    durations = spacing * NODES / SHORTENING ** np.arange(LEVELS)
    with_polynomials = len(exponents) <= MOST_IN_POLYNOMIALS
    coefficients, errors = _polynomials(exponents, driven, durations) if with_polynomials else _no_polynomials()
    times = spacing * np.arange(NODES + 1)
    lane_spacing = _short_number(durations[0] / (LANE_NODES - 1))
    lane_times = lane_spacing * np.arange(LANE_NODES)
    growth_series, basis_series = _power_series(exponents, driven)
    return record(
        degree=np.asarray(DEGREE, np.int64),
        terms=np.asarray(LANE_TERMS, np.int64),
        spacing=np.asarray(spacing),
        pace=np.asarray(1.0 / spacing),
        durations=durations,
        coefficients=coefficients,
        errors=errors,
        lane_durations=_blocks_last(durations),
        lane_coefficients=_blocks_last(coefficients.transpose(0, 2, 1)),
        lane_errors=_blocks_last(
            _errors_of_moduli(errors / durations[:, None], len(exponents)) if with_polynomials else errors
        ),
        basis=_derivatives(exponents, driven, times),
        growth=_expm1(np.outer(times, exponents)),
        basis_series=basis_series,
        growth_series=growth_series,
        lane_spacing=np.asarray(lane_spacing),
        lane_basis=_parts(np.array(_basis(exponents, driven, lane_times))),
        bounds=_derivative_bounds(exponents, driven, durations[0]),
    )


def _parts(values: np.ndarray) -> np.ndarray:
    """Real and imaginary parts of functions of shape (N, M), shape (N, 2, M)."""
    return np.stack((values.real, values.imag), axis=1)


def _short_number(value: float) -> float:
    """The value rounded down to 24 binary digits: the times of all nodes are then exact."""
    fraction, exponent = math.frexp(value)
    return math.ldexp(math.floor(math.ldexp(fraction, 24)), exponent - 24)


def _polynomials(exponents: np.ndarray, driven: np.ndarray, durations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bernstein coefficients of the products on each block and the bounds of their error.

    Their shapes are (LEVELS, Q, DEGREE) and (LEVELS, Q).
    """
    points = np.concatenate([_chebyshev_points(DEGREE), _chebyshev_points(SAMPLES)])
    rows = _rows(exponents, driven, np.outer(durations, points).ravel()).reshape(-1, *durations.shape, len(points))
    at_points = rows.transpose(1, 0, 2) * durations[:, None, None]
    coefficients = at_points[..., :DEGREE] @ _bernstein_from_nodes().T * (np.arange(1, DEGREE + 1) / DEGREE)
    series = np.abs(at_points[..., DEGREE:] @ _chebyshev_transform().T)
    # The error of interpolation at DEGREE Chebyshev points is at most twice the tail of the series.
    errors = 2.0 * series[..., DEGREE:].sum(axis=-1) + ROUNDED * series.sum(axis=-1)
    return coefficients, errors


def _no_polynomials() -> tuple[np.ndarray, np.ndarray]:
    return np.empty((LEVELS, 0, DEGREE)), np.empty((LEVELS, 0))


def _blocks_last(values: np.ndarray) -> np.ndarray:
    """Reshape numbers of shape (LEVELS, …) to (…, OCTET), with zeros where there is no block."""
    room = np.zeros((*values.shape[1:], OCTET))
    room[..., :LEVELS] = np.moveaxis(values, 0, -1)
    return room


def _errors_of_moduli(errors: np.ndarray, modes: int) -> np.ndarray:
    """Bounds of ``|Re z| e₁ + |Im z| e₂`` per ``|z|``, for the products ``z`` in the order of ``_rows``."""
    merged, row = [], 0
    for mode in range(2 * modes):
        for alone in [False] if mode < modes else [True] + [False] * (2 * modes - 1 - mode):
            merged.append(errors[:, row] if alone else np.hypot(errors[:, row], errors[:, row + 1]))
            row += 1 if alone else 2
    return np.stack(merged, axis=1)


def _rows(exponents: np.ndarray, driven: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Real factors of the products in ``(|y|² − |y₀|²)/τ``, shape (2N + N², len(times))."""
    basis = np.array(_basis(exponents, driven, times))
    modes = len(basis)
    rows = np.empty((2 * modes + modes**2, len(times)))
    rows[0 : 2 * modes : 2], rows[1 : 2 * modes : 2] = 2.0 * basis.real, -2.0 * basis.imag
    row = 2 * modes
    for j, values in enumerate(basis):
        products = 2.0 * values * basis[j + 1 :].conj()
        after = row + 1 + 2 * len(products)
        rows[row], rows[row + 1 : after : 2], rows[row + 2 : after : 2] = (
            np.abs(values) ** 2,
            products.real,
            -products.imag,
        )
        row = after
    return rows / times


def _basis(exponents: np.ndarray, driven: np.ndarray, times: np.ndarray) -> list[np.ndarray]:
    basis = []
    for exponent, gap, order in _functions(exponents, driven):
        if not order:
            basis.append(_expm1(exponent * times))
            continue
        response = times**order / math.factorial(order) if gap == 0 else -_expm1(-gap * times) / gap
        basis.append(np.exp((exponent + gap) * times) * response)
    return basis


def _functions(exponents: np.ndarray, driven: np.ndarray) -> list[tuple[complex, complex, int]]:
    """Exponent of each mode, and its gap to the next and its number ``j ≥ 1`` from the start of its chain, zeros for the last."""
    found, number = [], 0
    for exponent, after, drives in zip(exponents, np.append(exponents[1:], 0.0), _drives(driven), strict=True):
        number = number + 1 if drives else 0
        found.append((exponent, after - exponent if drives else 0j, number))
    return found


def _derivatives(exponents: np.ndarray, driven: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Basis functions and their first three derivatives, shape (len(times), 4, N).

    ``φ' = λ₋φ + e^{λ₊τ}``, and in a longer chain ``β_j' = λβ_j + β_{j−1}``.
    """
    functions = _functions(exponents, driven)
    values = np.empty((len(times), 4, len(exponents)), complex)
    values[:, 0] = np.transpose(_basis(exponents, driven, times))
    for n in range(3):
        values[:, n + 1] = exponents * values[:, n]
        if n == 0:
            values[:, 1] += np.where(_drives(driven), 0.0, exponents)
        for k, (_, _, number) in enumerate(functions):
            if number == 1:
                last = k + 1 + next(i for i, function in enumerate(functions[k + 1 :]) if not function[2])
                values[:, n + 1, k] += exponents[last] ** n * (1.0 + values[:, 0, last])
            elif number:
                values[:, n + 1, k] += values[:, n, k - 1]
    return values


def _power_series(exponents: np.ndarray, driven: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of the power series of all ``e^{λτ} − 1`` and of all basis functions, each of shape (LANE_TERMS, N).

    Neither has a constant term.  That of ``φ`` has the coefficients ``Σ_i λ₊ⁱ λ₋ⁿ⁻¹⁻ⁱ/n!``, that of ``τʲ/j! e^{λτ}`` has
    ``λⁿ⁻ʲ/((n − j)! j!)``.
    """
    orders = np.arange(1, LANE_TERMS + 1)
    factorials = np.array([float(math.factorial(n)) for n in orders])[:, None]
    growth = exponents ** orders[:, None] / factorials
    basis = growth.copy()
    for k, (exponent, gap, number) in enumerate(_functions(exponents, driven)):
        difference = 0.0
        for n in orders[: None if number else 0]:
            if number == 1:
                difference = (exponent + gap) * difference + exponent ** (n - 1)
            else:
                difference = math.comb(n, number) * exponent ** max(n - number, 0)
            basis[n - 1, k] = difference / factorials[n - 1, 0]
    return growth, basis


def _drives(driven: np.ndarray) -> np.ndarray:
    """Which modes drive the next one."""
    return np.append(np.asarray(driven, bool)[1:], False)


def _expm1(z: np.ndarray) -> np.ndarray:
    sine = np.sin(0.5 * z.imag)
    growth = np.expm1(z.real)
    return growth - 2.0 * sine**2 * (1.0 + growth) + 2j * (1.0 + growth) * sine * np.cos(0.5 * z.imag)


def _derivative_bounds(exponents: np.ndarray, driven: np.ndarray, duration: float) -> np.ndarray:
    """Bounds of ``|ψ⁽ⁿ⁾|``, shape (3, N).

    They are ``|λ|ⁿ g`` for an exponential, ``(T|λ|ⁿ + n|λ|ⁿ⁻¹) g`` for ``φ = t ∫₀¹ e^{λ_s t} ds``, and by Leibniz's rule
    ``Σ_i (n over i) |λ|ⁿ⁻ⁱ T^{j−i}/(j − i)! g`` for ``tʲ/j! e^{λt}``.  Here ``g`` is the growth of the fastest growing exponential
    over the block, and ``λ_s`` varies between the pair's exponents.
    """
    bounds = np.empty((3, len(exponents)))
    for k, (exponent, gap, number) in enumerate(_functions(exponents, driven)):
        largest = max(abs(exponent), abs(exponent + gap))
        growth = np.exp(max(0.0, exponent.real * duration, (exponent + gap).real * duration))
        for n in (1, 2, 3):
            terms = [
                math.comb(n, i) * largest ** (n - i) * duration ** (number - i) / math.factorial(number - i)
                for i in range(min(n, number) + 1)
            ]
            bounds[n - 1, k] = sum(terms) * growth
    return bounds


@cache
def _chebyshev_points(count: int) -> np.ndarray:
    return 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)


@cache
def _bernstein_from_nodes() -> np.ndarray:
    """Matrix from values at DEGREE Chebyshev points to Bernstein coefficients of degree DEGREE − 1."""
    x = _chebyshev_points(DEGREE)[:, None]
    j = np.arange(DEGREE)
    binomials = np.array([math.comb(DEGREE - 1, i) for i in j])
    return np.linalg.inv(binomials * x**j * (1.0 - x) ** (DEGREE - 1 - j))


@cache
def _chebyshev_transform() -> np.ndarray:
    order = np.arange(SAMPLES)[:, None]
    angles = np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES
    transform = np.cos(order * (np.pi - angles)) * 2.0 / SAMPLES
    transform[0] *= 0.5
    return transform
