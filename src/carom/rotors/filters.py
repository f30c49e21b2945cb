"""Filters in series with the controllers of magnetic bearings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from carom.parameters import Field
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.rotors.state_spaces import StateSpace, of_polynomials


def _frequency(name: str, words: str) -> Field:
    return Field(name, "", words, "an angular frequency", "rad/s", 1e-3, 1e9, '"850 Hz"')


def _ratio(name: str, words: str, zero: bool = False) -> Field:
    return Field(name, "", words, "a number", "", 1e-6, 1e3, "0.3", zero)


NOTCH_FIELDS = by_name(
    _frequency("notch_frequency", "frequency of a notch filter"),
    _ratio("notch_damping", "damping ratio of the poles of a notch filter: half its width over its frequency"),
    _ratio("notch_floor", "gain of a notch filter at its frequency", True),
)
LEAD_FIELDS = by_name(
    _frequency("lead_zero", "corner frequency of the zero of a lead-lag filter"),
    _frequency("lead_pole", "corner frequency of the pole of a lead-lag filter"),
)
LOW_PASS_FIELDS = by_name(
    _frequency("low_pass_frequency", "natural frequency of a low-pass filter of second order"),
    _ratio("low_pass_damping", "damping ratio of a low-pass filter of second order"),
)


class _Filter:
    """A filter by its fields."""

    fields: ClassVar[Mapping[str, Field]]

    def __post_init__(self) -> None:
        read_entries(self, self.fields)


@dataclass(frozen=True)
class Notch(_Filter):
    """``(s² + 2 f ζ ω s + ω²)/(s² + 2 ζ ω s + ω²)``: a filter that takes one frequency out.

    Parameters
    ----------
    notch_frequency : float or str
        ``ω``, rad/s, or such as ``"850 Hz"``.
    notch_damping : float, optional
        ``ζ``.
    notch_floor : float, optional
        ``f``: gain at its frequency, 0 by default.
    """

    notch_frequency: float
    notch_damping: float = 0.3
    notch_floor: float = 0.0

    fields: ClassVar[Mapping[str, Field]] = NOTCH_FIELDS

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        at, wide = self.notch_frequency, 2.0 * self.notch_damping * self.notch_frequency
        return of_polynomials([1.0, self.notch_floor * wide, at**2], [1.0, wide, at**2])


@dataclass(frozen=True)
class LeadLag(_Filter):
    """``(1 + s/ω_z)/(1 + s/ω_p)``: a lead with the zero below the pole, a lag with the pole below the zero.

    Parameters
    ----------
    lead_zero, lead_pole : float or str
        ``ω_z`` and ``ω_p``, rad/s, or such as ``"80 Hz"``.
    """

    lead_zero: float
    lead_pole: float

    fields: ClassVar[Mapping[str, Field]] = LEAD_FIELDS

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        return of_polynomials([1.0 / self.lead_zero, 1.0], [1.0 / self.lead_pole, 1.0])


@dataclass(frozen=True)
class LowPass(_Filter):
    """``ω²/(s² + 2 ζ ω s + ω²)``.

    Parameters
    ----------
    low_pass_frequency : float or str
        ``ω``, rad/s, or such as ``"2 kHz"``.
    low_pass_damping : float, optional
        ``ζ``; by default that of Butterworth.
    """

    low_pass_frequency: float
    low_pass_damping: float = 0.5**0.5

    fields: ClassVar[Mapping[str, Field]] = LOW_PASS_FIELDS

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        at = self.low_pass_frequency
        return of_polynomials([at**2], [1.0, 2.0 * self.low_pass_damping * at, at**2])
