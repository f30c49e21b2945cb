"""Rubs at rest in the co-rotating frame, for any modes and contact planes: the forces that balance there.

At rest a contact force ``−(1 + iμ_q) N_q y_q`` at plane ``q`` (slip is forward: ``s + 1 > 0``) acts through the static
receptance ``H = −W M⁻¹ B``, so with ``h_pq = H_pq (1 + iμ_q)`` and the contact-free displacements ``y*``

    y_p + Σ_q h_pq N_q y_q = y*_p,      |y_p| = 1 at each plane in contact.

*One plane* gives ``|h|²N² + 2 Re(h) N + 1 − |y*|² = 0``: both roots.  *Two planes*: by Cramer's rule, with

    D = 1 + h₁₁N₁ + h₂₂N₂ + (h₁₁h₂₂ − h₁₂h₂₁) N₁N₂,
    y₁D = y*₁ + (h₂₂y*₁ − h₁₂y*₂) N₂,      y₂D = y*₂ + (h₁₁y*₂ − h₂₁y*₁) N₁,

the conditions ``|y₁D|² = |y₂D|²`` and ``|y₂D|² = |D|²`` are quadratic in ``N₂`` with coefficients quadratic in ``N₁``; their
resultant is a polynomial of degree eight in ``N₁``, whose roots are all there are.  *More planes* are searched by Newton's
method from many starts, which proves nothing about their number; only those with pushing forces are kept.

*Compliant walls* hold a plane at ``y_p = (1 + δ_p) n_p`` with ``|n_p| = 1`` and the force ``N_p = κ_p δ_p^e``.  With a linear spring
``δ_p = N_p/κ_p``, and all of the above holds for ``n_p`` with ``h_pp + 1/κ_p`` in place of ``h_pp``.  Otherwise, at one plane, with
``h' = κh``,

    |1 + δ + h'δᵉ|² − |y*|² = (1 − |y*|²) + 2δ + 2 Re(h') δᵉ + δ² + 2 Re(h') δᵉ⁺¹ + |h'|² δ²ᵉ

is a sum of powers, all of whose positive roots are found (:func:`positive_roots`); rubs at several planes, one of them such a wall,
are not searched.

*A race that turns* is driven by friction up to the speed ``q = gμN/|λ|`` of its surface (:mod:`carom.core.surfaces`).  The contact slips at rest
only while that is less than the speed of the rotor's surface; a race without drag always catches up.  Rubs without slip, in which the race
turns along, are not searched.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import combinations, pairwise

import numpy as np
from numpy.polynomial import Polynomial

from carom.base.roots import bracketed_root
from carom.core.wall import Wall
from carom.models import System

LARGEST_ROOT = 1e6
"""Number up to which roots are searched: no wall is that many clearances deep."""


def positive_roots(terms: Iterable[tuple[float, float]]) -> list[float]:
    """All positive roots of ``Σ a xᵉ``, in ascending order, from pairs ``(e, a)``.

    Divided by its lowest power, the sum has a constant term, and its derivative a term less.  Between neighbouring roots of
    the derivative, which are found in the same way, it is monotone and has at most one root (Rolle).  Two roots that meet are
    found or missed by rounding.
    """
    return _roots(_gathered(terms))


def _gathered(terms: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Terms by growing power, each power once, without zeros."""
    total: dict[float, float] = {}
    for power, factor in terms:
        total[power] = total.get(power, 0.0) + factor
    return [(power, total[power]) for power in sorted(total) if total[power] != 0.0]


def _roots(terms: list[tuple[float, float]]) -> list[float]:
    """:func:`positive_roots` of terms that are gathered."""
    if len(terms) < 2:
        return []
    lowest = terms[0][0]
    terms = [(power - lowest, factor) for power, factor in terms]

    def total(x: float) -> float:
        return math.fsum(factor * x**power for power, factor in terms)

    turns = _roots([(power - 1.0, factor * power) for power, factor in terms[1:]])
    ends = [0.0, *turns, _beyond(terms)]
    found = [turn for turn in turns if total(turn) == 0.0]
    found += [
        bracketed_root(total, *between) for between in pairwise(ends) if total(between[0]) * total(between[1]) < 0.0
    ]
    return sorted(found)


def _beyond(terms: list[tuple[float, float]]) -> float:
    """A number beyond all roots: there the last term exceeds each of the others as many times as there are."""
    *others, (highest, factor) = terms
    rooms = (math.log(len(others) * abs(other / factor)) / (highest - power) for power, other in others)
    return 2.0 * math.exp(min(max(rooms), math.log(LARGEST_ROOT)))


COUNTED = 2
"""Most planes in contact for which all rubs are found."""
NEARLY_REAL = 0.1
"""Imaginary part, relative to the modulus, up to which a root starts Newton's method; coarse, as Newton's method decides."""
STEPS, CONVERGED, SAME_ROOT_RTOL = 60, 1e-11, 1e-7
FARTHEST = 1e6
"""Force, per stiffness of the plane, beyond which Newton's method has diverged."""
SMALLEST = 1e-9
"""Static receptance of a plane, relative to the largest, below which its coupling to the others counts instead."""
STARTS = 200


def rub_forces(system: System) -> list[tuple[tuple[int, ...], np.ndarray, np.ndarray]]:
    """Planes in contact, normal forces and directions ``y/|y|`` there of rubs at rest, wherever the other planes are.

    Rubs that are not isolated, such as those of a balanced rotor, are left out.
    """
    receptance = -system.arrays["rows"] @ _statically(system, system.arrays["columns"])
    lever = receptance * (1.0 + 1j * system.arrays["friction"])
    walls = [contact.wall for contact in system.contacts]
    curved = np.array([exponent_of(wall) for wall in walls]) != 1.0
    for plane, wall in enumerate(walls):
        if wall.stiffness and not curved[plane]:
            lever[plane, plane] += 1.0 / wall.stiffness
    found = []
    for count in range(1, len(lever) + 1):
        for planes in combinations(range(len(lever)), count):
            rest, h = system.arrays["offsets"][list(planes)], lever[np.ix_(planes, planes)]
            if curved[list(planes)].any():
                pairs = _in_curved_wall(complex(h[0, 0]), complex(rest[0]), walls[planes[0]]) if count == 1 else []
            elif count == 1:
                pairs = _one_plane(complex(h[0, 0]), complex(rest[0]))
            else:
                # In units of the stiffness of each plane the coefficients are of one size.
                units = 1.0 / np.maximum(np.abs(h.diagonal()), SMALLEST * np.abs(h).max() or 1.0)
                scaled = h * units
                starts = _two_planes(scaled, rest) if count == COUNTED else _anywhere(count)
                pairs = [(units * forces, places) for forces, places in _balanced(scaled, rest, starts)]
            found += [
                (planes, *pair)
                for pair in pairs
                if (count <= COUNTED or pair[0].min() > 0.0)
                and (depths(system, planes, pair[0]) > -1.0).all()
                and _slips(system, planes, pair[0])
            ]
    return found


def _statically(system: System, pushes: np.ndarray) -> np.ndarray:
    """Amplitudes ``M⁻¹ p`` of pushes (N, m) or (N,), of the free modes alone: a race moves no plane, and its decay may be zero."""
    amplitudes, free = np.zeros(pushes.shape, complex), system.free
    amplitudes[free] = np.linalg.solve(system.generator[np.ix_(free, free)], pushes[free])
    return amplitudes


def _slips(system: System, planes: tuple[int, ...], forces: np.ndarray) -> bool:
    """Whether the races at planes in contact stay slower than the rotor's surface there."""
    if system.races is None:
        return True
    arrays, chosen = system.arrays, list(planes)
    decays = np.array([0.0 if race is None else -race.exponent for race in system.races])
    driven = arrays["race_gain"][chosen] * arrays["friction"][chosen] * np.abs(forces)
    surface = arrays["surface_speed"][chosen] + depths(system, planes, forces)
    slips = (arrays["race"][chosen] < 0) | (driven < surface * decays[chosen])
    return bool(slips.all())


def exponent_of(wall: Wall) -> float:
    """Power of the depth with which the static force of a compliant wall grows; 1 for others."""
    return wall.law_number if wall.stiffness and wall.law_number else 1.0


def depths(system: System, planes: tuple[int, ...], forces: np.ndarray) -> np.ndarray:
    """How deep planes are in their walls under normal forces, shape (C,); zero in rigid ones."""
    walls = [system.contacts[plane].wall for plane in planes]
    found = [
        np.copysign(abs(force / wall.stiffness) ** (1.0 / exponent_of(wall)), force) if wall.stiffness else 0.0
        for force, wall in zip(forces.tolist(), walls, strict=True)
    ]
    return np.array(found)


def all_found(system: System) -> bool:
    """Whether :func:`rub_forces` finds all rubs that are isolated."""
    if system.races is not None:
        return False
    curved = any(exponent_of(contact.wall) != 1.0 for contact in system.contacts)
    return len(system.contacts) <= (1 if curved else COUNTED)


def static_state(system: System, planes: tuple[int, ...], forces: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Amplitudes of the rotor at rest under contact forces at some planes in given directions, shape (N,)."""
    chosen = list(planes)
    pushes = (1.0 + 1j * system.arrays["friction"][chosen]) * forces * places
    return _statically(system, system.arrays["columns"][:, chosen] @ pushes)


def _one_plane(h: complex, rest: complex) -> list[tuple[np.ndarray, np.ndarray]]:
    reach = abs(h) * abs(rest)
    if reach < abs(h.imag) or reach == 0.0:
        return []
    # The square root of Re(h)² − |h|²(1 − |y*|²), and 1 + hN below, in forms that neither cancel nor underflow.
    distance = float(np.sqrt(reach - abs(h.imag)) * np.sqrt(reach + abs(h.imag)))
    pairs = []
    for root in (distance, -distance):
        place = rest * h.conjugate() / complex(root, -h.imag)
        pairs.append((np.array([float((root - h.real) / abs(h) ** 2)]), np.array([place / abs(place)])))
    return pairs


def rubs_in_wall(h: complex, rest: complex, stiffness: float, exponent: float) -> list[tuple[float, complex]]:
    """Depths of all rubs at one plane in a wall with the force ``κδᵉ``, and numbers in the direction of the displacement there.

    A balanced rotor has the balance at every angle or at none; none is given.

    Parameters
    ----------
    h : complex
        Static receptance of the plane, times ``1 + iμ``.
    rest : complex
        Contact-free displacement.
    """
    if rest == 0.0:
        return []
    lever = stiffness * h
    terms = [(0.0, (1.0 - abs(rest)) * (1.0 + abs(rest))), (1.0, 2.0), (2.0, 1.0)]
    terms += [(exponent, 2.0 * lever.real), (exponent + 1.0, 2.0 * lever.real), (2.0 * exponent, abs(lever) ** 2)]
    return [(depth, rest / (1.0 + depth + lever * depth**exponent)) for depth in positive_roots(terms)]


def _in_curved_wall(h: complex, rest: complex, wall: Wall) -> list[tuple[np.ndarray, np.ndarray]]:
    exponent = exponent_of(wall)
    rubs = rubs_in_wall(h, rest, wall.stiffness, exponent)
    return [(np.array([wall.stiffness * depth**exponent]), np.array([place / abs(place)])) for depth, place in rubs]


def _two_planes(h: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Starts of Newton's method near all pairs of forces, shape (m, 2)."""
    if not rest.any():
        return np.empty((0, 2))
    starts = []
    for order in (np.array([0, 1]), np.array([1, 0])):
        first, second = _conditions(h[np.ix_(order, order)], rest[order])
        for force in np.roots(_resultant(first, second).coef[::-1]):
            if abs(force.imag) > NEARLY_REAL * (1.0 + abs(force)):
                continue
            for condition in (first, second):
                quadratic = [part(force.real) for part in reversed(condition)]
                starts += [np.array([force.real, other.real])[order] for other in np.roots(quadratic)]
    return np.array(starts).reshape(-1, 2)


def _conditions(h: np.ndarray, rest: np.ndarray) -> tuple[list[Polynomial], list[Polynomial]]:
    """``|y₁D|² − |y₂D|²`` and ``|D|² − |y₂D|²``: coefficients of powers of ``N₂``, each a polynomial in ``N₁``."""
    second = Polynomial([rest[1], h[0, 0] * rest[1] - h[1, 0] * rest[0]])
    constant = Polynomial([1.0, h[0, 0]])
    linear = Polynomial([h[1, 1], h[0, 0] * h[1, 1] - h[0, 1] * h[1, 0]])
    lever, size = h[1, 1] * rest[0] - h[0, 1] * rest[1], _product(second, second)
    apart = Polynomial([abs(rest[0]) ** 2]) - size, 2.0 * (rest[0].conjugate() * lever).real, abs(lever) ** 2
    whole = _product(constant, constant) - size, 2.0 * _product(constant, linear), _product(linear, linear)
    return [apart[0], *(Polynomial([part]) for part in apart[1:])], list(whole)


def _product(one: Polynomial, other: Polynomial) -> Polynomial:
    """``Re(p̄ q)`` of two polynomials in a real variable."""
    return Polynomial((Polynomial(one.coef.conj()) * other).coef.real)


def _resultant(first: list[Polynomial], second: list[Polynomial]) -> Polynomial:
    """Resultant of two quadratics whose coefficients are polynomials."""

    def crossed(i: int, j: int) -> Polynomial:
        return first[i] * second[j] - first[j] * second[i]

    return crossed(2, 0) * crossed(2, 0) - crossed(2, 1) * crossed(1, 0)


def _anywhere(planes: int) -> np.ndarray:
    """Starts of Newton's method for three planes and more: pushing forces of all sizes that matter, shape (m, C)."""
    return 10.0 ** np.random.default_rng(0).uniform(-3.0, 1.0, (STARTS, planes))


def _balanced(h: np.ndarray, rest: np.ndarray, starts: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Forces and displacements to which Newton's method converges from starts (m, C), each once."""
    moved, unit = starts, np.eye(len(h))
    for step in range(STEPS + 1):
        forces = moved[np.abs(moved).max(axis=1) < FARTHEST]
        places, misses = _places(h, rest, forces)
        if step == STEPS or not len(forces):
            break
        slopes = np.linalg.solve(unit + h * forces[:, None, :], h * places[:, None, :])
        slopes = -2.0 * (places.conj()[..., None] * slopes).real
        moved = forces - (np.linalg.pinv(slopes) @ misses[..., None])[..., 0]
        if (np.abs(moved - forces).max(axis=1) <= 4e-16 * np.abs(forces).max(axis=1)).all():
            break
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for force, place, miss in zip(forces, places, misses, strict=True):
        alike = (np.abs(force - other).max() <= SAME_ROOT_RTOL * np.abs(force).max() for other, _ in found)
        if np.abs(miss).max() < CONVERGED and not any(alike):
            found.append((force, place / np.abs(place)))
    return found


def _places(h: np.ndarray, rest: np.ndarray, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Displacements at the planes under forces (m, C), and how far each is beyond its wall, squared."""
    places: np.ndarray = np.linalg.solve(
        np.eye(len(h)) + h * forces[:, None, :], np.broadcast_to(rest, forces.shape)[..., None]
    )[..., 0]
    return places, np.abs(places) ** 2 - 1.0
