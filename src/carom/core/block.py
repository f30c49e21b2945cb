"""One block of flight, by the tables of :mod:`carom.core.table`: possible roots of ``f = |y|² − 1``, state at a time.

The flight starts from ``work.current``.  What these functions load into the workspace stays there until the next block.
"""

from __future__ import annotations

from carom.core.compiling.decorators import inlined
from carom.core.flow import chain_start, squared_modulus
from carom.core.layout import DEGREE, NODES, TERMS


@inlined
def load_products(rotor, station, origin, work):
    """Write the real products of amplitudes in which ``f`` is linear."""
    modes = work.current.shape[0]
    basis_amplitudes(rotor, station, work.current, work.amplitudes)
    row = 0
    for k in range(modes):
        linear = origin.conjugate() * work.amplitudes[k]
        work.products[row] = linear.real
        work.products[row + 1] = linear.imag
        row += 2
    for j in range(modes):
        first = work.amplitudes[j]
        work.products[row] = squared_modulus(first)
        row += 1
        for k in range(j + 1, modes):
            pair = first * work.amplitudes[k].conjugate()
            work.products[row] = pair.real
            work.products[row + 1] = pair.imag
            row += 2


@inlined
def basis_amplitudes(rotor, station, amplitudes, out):
    """Write the factors ``α`` of the basis functions of :mod:`carom.core.table` in the motion of a station."""
    modes = amplitudes.shape[0]
    for k in range(modes):
        out[k] = rotor.rows[station, k] * amplitudes[k]
        if rotor.driven[k]:
            out[k] += rotor.rows[station, k - 1] * amplitudes[k - 1]
            out[k - 1] = (rotor.rows[station, k] - rotor.gaps[k] * rotor.rows[station, k - 1]) * amplitudes[k - 1]
            if k > 1 and rotor.driven[k - 1]:
                _chain_amplitudes(rotor, station, amplitudes, k, out)


@inlined
def _chain_amplitudes(rotor, station, amplitudes, last, out):
    """:func:`basis_amplitudes` of a chain of equal exponents up to a mode: ``tʲ/j! e^{λt}`` appears in the ``j`` last ones."""
    first = chain_start(rotor, last)
    for j in range(last - first + 1):
        total = 0j
        for k in range(first + j, last + 1):
            total += rotor.rows[station, k] * amplitudes[k - j]
        out[first + j - 1 if j > 0 else last] = total


@inlined
def load_polynomial(table, depth, level, work):
    """Write the Bernstein coefficients of ``f`` on a block of this depth; return their error bound at its end."""
    remainder = 0.0
    for i in range(table.errors.shape[1]):
        remainder += abs(work.products[i]) * table.errors[depth, i]
    # One coefficient after the other: stored once each.
    for j in range(DEGREE):
        value = level
        for i in range(table.errors.shape[1]):
            value += work.products[i] * table.coefficients[depth, i, j]
        work.polynomial[j] = value
    return remainder


@inlined
def sign_changes(polynomial, level, floor, remainder):
    """Whether ``f`` may cross zero on the block: 0 (no), 1 (perhaps), 2 (undecided); and where it may do so first.

    The test uses the polynomial plus the bound of its error.  This bound is ``floor``, the rounding of ``f``, at the
    start and grows by ``remainder`` up to the end.  If no coefficient of the sum is positive, it has no root.  If the
    positive ones are consecutive, it has at most two roots, the first of them upward.  The second result is the index
    of the first positive coefficient.
    """
    share = remainder / DEGREE
    first, last, number = DEGREE, -1, 0
    for j in range(DEGREE):
        if polynomial[j] + (floor + share * (j + 1)) >= 0.0:
            first = min(first, j)
            last = j
            number += 1
    if -floor <= level != 0.0 or (first == 0 and level == 0.0) or last - first + 1 > number:
        return 2, first
    return (1 if number > 0 else 0), first


@inlined
def rough_root(polynomial, level, after):
    """Approximate root of the polynomial in 0 … 1, from the coefficients on both sides of its sign change.

    In a flight that starts on the wall, a root in the first half may lie close to the root at the start.  The latter is
    divided out: ``b_j n/j`` are the coefficients of ``f/t``.
    """
    before, there, first, degree = level, polynomial[after], float(after), float(DEGREE)
    if after > 0:
        before = polynomial[after - 1]
    if level == 0.0 and 0 < after <= DEGREE // 2:
        before, there, first, degree = before * (after + 1.0), there * after, after - 1.0, DEGREE - 1.0
    rise = there - before
    # One division, since all that follows waits for it.
    return (first * rise + min(rise, -before)) / (rise * degree) if rise > 0.0 else (first + 0.5) / degree


@inlined
def nearest_node(table, time):
    """Index of the node nearest to a time."""
    return min(max(int(time * table.pace + 0.5), 0), NODES)


@inlined
def look_at_node(table, node, origin, level, work):
    """``f`` and its first three derivatives at a node."""
    change, speed, force, jerk = 0j, 0j, 0j, 0j
    for k in range(work.amplitudes.shape[0]):
        amplitude = work.amplitudes[k]
        change += table.basis[node, 0, k] * amplitude
        speed += table.basis[node, 1, k] * amplitude
        force += table.basis[node, 2, k] * amplitude
        jerk += table.basis[node, 3, k] * amplitude
    return derivatives(origin, level, change, speed, force, jerk)


@inlined
def derivatives(origin, level, change, speed, force, jerk):
    """``f`` and its first three derivatives, from the change of ``y`` since the origin and the derivatives of ``y``."""
    value, slope, bend = two_derivatives(origin, level, change, speed, force)
    third = ((origin + change).conjugate() * jerk).real + 3.0 * (speed.conjugate() * force).real
    return value, slope, bend, 2.0 * third


@inlined
def two_derivatives(origin, level, change, speed, force):
    """``f`` and its first two derivatives, as in :func:`derivatives`."""
    position = origin + change
    value = level + (2.0 * (origin.conjugate() * change).real + squared_modulus(change))
    slope = (position.conjugate() * speed).real
    bend = (position.conjugate() * force).real + squared_modulus(speed)
    return value, 2.0 * slope, 2.0 * bend


@inlined
def move_to(rotor, table, time, work):
    """Write ``work.end`` and ``work.increments``, ``c(time) − c(0)``, by a power series from the nearest node."""
    node = nearest_node(table, time)
    rest = time - node * table.spacing
    modes = work.current.shape[0]
    for k in range(modes):
        increment = table.growth[node, k] * work.current[k]
        if k > 1 and rotor.driven[k] and rotor.driven[k - 1]:
            increment += _from_chain(rotor, table, node, k, work)
        elif rotor.driven[k]:
            increment += table.basis[node, 0, k - 1] * work.current[k - 1]
        work.increments[k] = increment
        work.at_node[k] = work.current[k] + increment
    for k in range(modes):
        increment = _power_series(table.growth_series, k, rest) * work.at_node[k]
        if k > 1 and rotor.driven[k] and rotor.driven[k - 1]:
            increment += _from_chain_at_node(rotor, table, k, rest, work)
        elif rotor.driven[k]:
            increment += _power_series(table.basis_series, k - 1, rest) * work.at_node[k - 1]
        increment += work.increments[k]
        work.increments[k] = increment
        work.end[k] = work.current[k] + increment


@inlined
def _from_chain(rotor, table, node, mode, work):
    """What the modes before it in its chain contribute to a mode at a node."""
    first, total = chain_start(rotor, mode), 0j
    for j in range(1, mode - first + 1):
        total += table.basis[node, 0, first + j - 1] * work.current[mode - j]
    return total


@inlined
def _from_chain_at_node(rotor, table, mode, rest, work):
    """What the modes before it in its chain, given at a node, contribute to a mode until a little later."""
    first, total = chain_start(rotor, mode), 0j
    for j in range(1, mode - first + 1):
        total += _power_series(table.basis_series, first + j - 1, rest) * work.at_node[mode - j]
    return total


@inlined
def _power_series(series, column, time):
    """Sum TERMS terms of a power series without constant term: odd and even powers in parallel by Horner's scheme."""
    square = time * time
    odd, even = series[TERMS - 2, column], series[TERMS - 1, column]
    odd_real, odd_imag, even_real, even_imag = odd.real, odd.imag, even.real, even.imag
    for n in range(TERMS - 4, -1, -2):
        odd, even = series[n, column], series[n + 1, column]
        odd_real, odd_imag = odd_real * square + odd.real, odd_imag * square + odd.imag
        even_real, even_imag = even_real * square + even.real, even_imag * square + even.imag
    return complex(time * odd_real + square * even_real, time * odd_imag + square * even_imag)
