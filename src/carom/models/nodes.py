"""Nodes of orbits: states, and under weight its direction, so that a motion depends on nodes and durations alone."""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np


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
