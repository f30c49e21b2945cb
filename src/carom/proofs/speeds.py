"""The largest speed that a theorem is about, exactly as it was given."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

from flint import arb

from carom.outcome import InputError
from carom.parameters import MACHINE_FIELDS, Field
from carom.parameters.exact import read_exact
from carom.proofs.balls import ball_of, rational
from carom.proofs.hypotheses import Hypotheses


@dataclass(frozen=True)
class LargestSpeed:
    """A largest speed in the fixed frame.

    Attributes
    ----------
    hypotheses : Hypotheses
    text : str
        With a unit for a machine, in ``c_r Ω`` for a dimensionless one.
    field : Field
        What it is called, in ``m/s``.

    Raises
    ------
    InputError
        It is no speed.
    """

    hypotheses: Hypotheses
    text: str
    field: Field

    def __post_init__(self) -> None:
        self.exact  # noqa: B018  (raises if it is no speed)

    @property
    def physical(self) -> bool:
        """Whether it has a unit."""
        return self.hypotheses.table == "machine"

    @cached_property
    def exact(self) -> tuple[Fraction, int]:
        """It in m/s, or in ``c_r Ω``: a rational number, times π to a power."""
        field = replace(self.field, needs_unit=True) if self.physical else replace(self.field, unit="", kind="a number")
        number = read_exact(field, self.text)
        if number.low != number.high:
            raise InputError(self.field.name, self.text, "must be one speed")
        return number.low, number.turns

    def share(self, share: Fraction) -> Any:
        """Ball of a share of it, in ``c_r Ω``."""
        return rational(self.exact[0] * share) * arb.pi() ** self.exact[1] / self.unit

    @cached_property
    def unit(self) -> Any:
        """``c_r Ω`` in m/s as a ball, or 1 for a dimensionless machine."""
        if not self.physical:
            return arb(1)
        clearance, speed = (
            ball_of(read_exact(MACHINE_FIELDS[name], self.hypotheses.values[name])) for name in ("clearance", "speed")
        )
        return clearance * speed
