"""Forces on a rotor whose modes are found once, and whose amplitudes are set: those of a base that moves in sections."""

from __future__ import annotations

import cmath
import dataclasses
from collections.abc import Sequence
from copy import copy
from typing import NamedTuple

import numpy as np

from carom.models.forcing import Force
from carom.models.mode_arrays import EQUAL
from carom.models.rotor import Rotor


class ForcingModes(NamedTuple):
    """A rotor under forces of one, the places of their modes, and the amplitudes of these at time zero.

    The values of a section of their course are its factors in the fixed frame at its beginning: one of all forces, or of each force that grows its rate
    and its value.
    """

    rotor: Rotor
    forces: tuple[Force, ...]
    places: np.ndarray
    units: np.ndarray

    @classmethod
    def of(cls, rotor: Rotor, forces: tuple[Force, ...]) -> ForcingModes:
        """Those of a rotor under these forces: all of them grow, or none does."""
        moved = rotor.under(*forces)
        system = moved.system
        if forces[0].rates is None:
            apart = np.abs(system.arrays["exponents"][:, None] - [force.exponent for force in forces]).min(axis=1)
            own = (apart <= EQUAL * (1.0 + abs(forces[0].exponent))) & (system.outer != 0.0)
        else:
            ramps = system.arrays["driven"].astype(bool) & ~system.free
            own = ramps | np.roll(ramps, -1)
        places = np.flatnonzero(own)
        for name in ("basis", "exponents", "table"):  # found once, for all sections
            getattr(system, name)
        return cls(moved, forces, places, system.outer[places])

    def at(self, values: np.ndarray, time: float) -> Rotor:
        """The rotor in a section with these values, which begins at a time; it shares all arrays but the amplitudes."""
        system = self.rotor.system
        if self.forces[0].rates is None:
            factors = values * np.exp(-(1j + system.arrays["exponents"][self.places]) * time)
            acting = [
                force._replace(accelerations=force.accelerations * values[0] * cmath.exp(-(1j + force.exponent) * time))
                for force in self.forces
            ]
        else:
            slopes, starts = values[::2], values[1::2] - values[::2] * time
            factors = np.stack([slopes, starts], axis=1).ravel()
            acting = [
                force._replace(accelerations=force.accelerations * start, rates=force.accelerations * slope)
                for force, start, slope in zip(self.forces, starts, slopes, strict=True)
            ]
        return self._with(acting, self.units * factors)

    def _with(self, acting: Sequence[Force], amplitudes: np.ndarray) -> Rotor:
        """The rotor under these forces, which have the same modes with these amplitudes at time zero."""
        before = self.rotor.forces[: -len(acting)]
        system, rotor = copy(self.rotor.system), dataclasses.replace(self.rotor, forces=(*before, *acting))
        forced = system.forced_at(0.0)
        forced[self.places] = amplitudes
        for name in ("outer", "nodes"):
            vars(system).pop(name, None)
        vars(system)["forced"], vars(rotor)["system"] = forced, system
        return rotor

    def set_in(self, motions: np.ndarray, values: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Amplitudes (m, N) of the same states at times (m,) where a section with values (m, F) begins."""
        system, change = self.rotor.system, np.zeros_like(motions)
        change[:, self.places] = self.units * values * np.exp(-1j * times)[:, None] - motions[:, self.places]
        away = -np.einsum("nk,mk->mn", system.basis, change)
        found: np.ndarray = motions + change + np.einsum("nk,mk->mn", system.to_modes, away)
        if system.conjugate_modes is not None:
            turned = np.einsum("nk,mk->mn", system.conjugate_modes, away.conj())
            found += turned * motions[:, system.arrays["anisotropy"]]
        return found
