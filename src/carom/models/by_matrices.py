"""Rotors from their matrices."""

from __future__ import annotations

from typing import Any

from carom.models.linear import LinearEquations
from carom.models.rotor import Rotor


def from_matrices(
    *, mass: Any, damping: Any, stiffness: Any, gyroscopic: Any = None, forcing: Any, touchdowns: Any, **others: Any
) -> Rotor:
    """Any linear rotor from its matrices in the fixed frame, ``M Z̈ + (D − iG) Ż + K Z = F e^{it}``.

    Parameters
    ----------
    mass, damping, stiffness, gyroscopic : array_like, shape (n, n)
        ``M``, ``D``, ``K`` and ``G`` (polar moments of inertia; zero by default), with ``Ω = 1``.
    forcing : array_like of complex, shape (n,)
        Unbalance ``F``.
    touchdowns : sequence of Touchdown
    **others
        Further attributes of :class:`LinearEquations`.

    Raises
    ------
    InputError
        See :class:`LinearEquations`.
    """
    given = {"mass": mass, "damping": damping, "stiffness": stiffness, "gyroscopic": gyroscopic}
    return Rotor(LinearEquations.in_fixed_frame(**given, forcing=forcing, touchdowns=touchdowns, **others))


def from_corotating_matrices(
    mass: Any, damping: Any, stiffness: Any, forcing: Any, touchdowns: Any, **others: Any
) -> Rotor:
    """The same from the matrices of the frame that turns with the shaft, ``M Ü + D U̇ + K U = F``; see :class:`LinearEquations`."""
    return Rotor(LinearEquations(mass, damping, stiffness, forcing, touchdowns, **others))
