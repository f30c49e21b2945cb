"""The largest size that a theorem is about, exactly as it was given: numbers and units, and a speed by them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from flint import arb

from carom.base.outcome import InputError
from carom.parameters import MACHINE_FIELDS, Field
from carom.parameters.exact import ExactNumber, read_exact
from carom.proofs.balls import ball_of, rational
from carom.proofs.hypotheses import Hypotheses


def read_size(field: Field, text: str, hypotheses: Hypotheses, whole: str = "") -> ExactNumber:
    """One exact number: with a unit of a machine in SI units, a plain number of a dimensionless one."""
    of_machine = hypotheses.table == "machine"
    number = read_exact(
        replace(field, needs_unit=True) if of_machine else replace(field, unit="", kind="a number", example="0.2"), text
    )
    if number.low != number.high:
        raise InputError(field.name, whole or text, f"must be one {field.kind.split(maxsplit=1)[1]}, not an interval")
    return number


def unit_of(hypotheses: Hypotheses, *names: str) -> arb:
    """Product of numbers of a machine; 1 for a dimensionless one."""
    product = arb(1)
    if hypotheses.table == "machine":
        for name in names:
            product = product * ball_of(read_exact(MACHINE_FIELDS[name], hypotheses.values[name]))
    return product


class LargestSpeed:
    """A largest speed in the fixed frame.

    Parameters
    ----------
    hypotheses : Hypotheses
    text : str
        With a unit for a machine, in ``c_r Ω`` for a dimensionless one.
    field : Field
        What it is called, in ``m/s``.

    Attributes
    ----------
    exact : tuple of Fraction and int
        It in m/s, or in ``c_r Ω``: a rational number, times π to a power.
    physical : bool
        Whether it has a unit.

    Raises
    ------
    InputError
        It is no speed.
    """

    def __init__(self, hypotheses: Hypotheses, text: str, field: Field) -> None:
        number = read_size(field, text, hypotheses)
        self.text, self.exact, self.physical = text, (number.low, number.turns), hypotheses.table == "machine"
        self._hypotheses = hypotheses

    def share(self, share: Fraction) -> arb:
        """Ball of a share of it, in ``c_r Ω``."""
        return rational(self.exact[0] * share) * arb.pi() ** self.exact[1] / self.unit

    @property
    def unit(self) -> arb:
        """``c_r Ω`` in m/s as a ball, or 1 for a dimensionless machine."""
        return unit_of(self._hypotheses, "clearance", "speed")
