"""What a rotor asks of its magnetic bearings beyond their limits (:mod:`carom.models.limits`), and what that changes."""

from __future__ import annotations

import numpy as np

from carom.models.system import System


def saturation_of(system: System, amplitudes: np.ndarray, times: np.ndarray) -> np.ndarray:
    """What is asked for beyond each limit, complex, shape (..., L), in the frame of the rotor, in states (..., N) at times (...)."""
    arrays, turn = system.arrays, np.exp(1j * np.asarray(times))[..., None]
    found = np.zeros((*turn.shape[:-1], system.limits), complex)
    for each, bound in enumerate(arrays["limit_bounds"].tolist()):
        asked = amplitudes @ arrays["limit_rows"][each] + arrays["limit_offsets"][each]
        asked = (asked + found @ arrays["limit_couplings"][each]) * turn[..., 0]
        given = np.clip(asked.real, -bound, bound) + 1j * np.clip(asked.imag, -bound, bound)
        found[..., each] = (asked - given) / turn[..., 0]
    return found


def saturation_accelerations(system: System) -> np.ndarray:
    """Accelerations of the coordinates per unit of what is asked for beyond each limit, shape (n, L)."""
    found: np.ndarray = system.rates @ system.arrays["limit_columns"]
    return found


def saturates(system: System, amplitudes: np.ndarray, forced: np.ndarray | None = None) -> bool:
    """Whether a whirl with the shaft about a place that stays asks for more than a limit along an axis.

    Amplitudes (N,) are those of the whirl, at rest in the frame of the rotor, and those of weight at time zero.
    """
    rows, bounds = system.arrays["limit_rows"], system.arrays["limit_bounds"]
    whirl, sag = np.abs(rows @ amplitudes + system.arrays["limit_offsets"]), np.zeros(system.limits, complex)
    if forced is not None:
        # Anisotropic bearings stretch the whirl.
        whirl += np.abs(rows[:, system.arrays["anisotropy"]]).sum(axis=1)
        sag = rows @ forced
    return bool((np.maximum(np.abs(sag.real), np.abs(sag.imag)) + whirl >= bounds).any())
