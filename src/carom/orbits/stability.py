"""Stability of periodic orbits from the derivative of a return map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.orbits.shooting import Links


@dataclass(frozen=True, eq=False, repr=False)
class Multipliers(Result):
    """Floquet multipliers of a periodic orbit on a section: the non-trivial ones.

    Attributes
    ----------
    values : ndarray of complex, shape (n,)
        Largest modulus first; of a conjugate pair the one with positive imaginary part first.
    """

    values: np.ndarray

    @property
    def spectral_radius(self) -> float:
        """Largest modulus."""
        return float(np.abs(self.values).max())

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return self.spectral_radius < 1.0

    @property
    def instability(self) -> str:
        """How small disturbances grow, in words; ``""`` if they do not."""
        if self.stable:
            return ""
        leader = self.values[0]
        if abs(leader.imag) > 1e-9 * abs(leader):
            return "in an oscillation from impact to impact"
        return "monotonically" if leader.real > 0 else "in alternation from impact to impact"


@checked
def multipliers(jacobian: np.ndarray) -> Multipliers:
    """Eigenvalues of the derivative of a return map.

    Parameters
    ----------
    jacobian : ndarray, shape (n, n)
    """
    if np.ndim(jacobian) != 2 or len(set(np.shape(jacobian))) != 1 or not np.size(jacobian):
        raise InputError("jacobian", np.shape(jacobian), "a square matrix")
    return multipliers_of_all([np.asarray(jacobian)])[0]


def multipliers_of_all(jacobians: Sequence[np.ndarray]) -> list[Multipliers]:
    """:func:`multipliers` of several return maps of the same size."""
    if not jacobians:
        return []
    # Conjugates are exact, so that their moduli are equal.
    found = np.linalg.eigvals(np.array(jacobians)).astype(complex).tolist()
    return [Multipliers(np.array(sorted(each, key=lambda value: (-abs(value), -value.imag)))) for each in found]


def multipliers_of(links: Links) -> Multipliers:
    """Non-trivial Floquet multipliers: those of the return map on the section at the first node."""
    return multipliers(on_section(links))


def on_section(links: Links) -> np.ndarray:
    """Derivative of the return map in an orthonormal basis of the section at the first node, shape (2N − 1, 2N − 1)."""
    monodromy = links.monodromy
    if not np.isfinite(monodromy).all():
        return np.full((len(monodromy) - 1,) * 2, np.inf)
    # Its range is the section: the last passage ends there.
    basis = np.linalg.svd(links.passages[-1])[0][:, :-1]
    return basis.T @ monodromy @ basis
