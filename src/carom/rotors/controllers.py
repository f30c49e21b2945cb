"""Controllers of magnetic bearings, as their users have them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import Field
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.rotors.state_spaces import StateSpace, of_polynomials

PID_FIELDS: Mapping[str, Field] = by_name(
    Field("proportional", "P", "proportional gain", "a gain", "A/m", 1e-9, 1e15, '"5000 A/m"', True),
    Field("integral", "I", "integral gain", "a gain", "A/m/s", 1e-9, 1e15, '"1500 A/m/s"', True),
    Field("derivative", "D", "derivative gain", "a gain", "A s/m", 1e-12, 1e12, '"5 A s/m"', True),
    Field(
        "filter_time",
        "T",
        "time of the filter of the derivative",
        "a time",
        "s",
        1e-9,
        1e3,
        '"0.1 ms"',
        usual="ms",
        usual_size=1e-3,
    ),
)
_ALLOWED = "a PID, a TransferFunction, a StateSpace, or a system in continuous time of SciPy or python-control: with A, B, C, D, or num, den"


@dataclass(frozen=True)
class PID:
    """``P + I/s + D s/(1 + T s)``: current by displacement, which it opposes.

    Every value is a number in the SI unit below, or text with a unit.

    Parameters
    ----------
    proportional : float or str
        ``P``, A/m.
    integral : float or str, optional
        ``I``, A/(m s).
    derivative : float or str, optional
        ``D``, A s/m.
    filter_time : float or str, optional
        ``T``, s: of the derivative, which without a filter would be no system that can be built.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, or there is a derivative without a filter.
    """

    proportional: float
    integral: float = 0.0
    derivative: float = 0.0
    filter_time: float | None = None

    def __post_init__(self) -> None:
        read_entries(self, PID_FIELDS)
        if self.derivative and self.filter_time is None:
            raise InputError("filter_time", None, "a derivative needs the time of its filter, such as '0.1 ms'")

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        matrix, into, out, straight = [], [], [], self.proportional
        if self.integral:
            matrix, into, out = [0.0], [self.integral], [1.0]
        if self.derivative and self.filter_time:
            rate = 1.0 / self.filter_time
            matrix, into, out = [*matrix, -rate], [*into, self.derivative * rate], [*out, -rate]
            straight += self.derivative * rate
        return StateSpace(np.diag(matrix), np.array(into), np.array(out), straight).balanced()


@dataclass(frozen=True)
class TransferFunction:
    """A quotient of polynomials of ``s``, in 1/s: current by displacement, A/m, which it opposes.

    Parameters
    ----------
    numerator, denominator : sequence of float
        Coefficients from the highest power on.

    Raises
    ------
    InputError
        The numerator has the higher degree, the denominator is zero, or a coefficient is no finite number.
    """

    numerator: Sequence[float]
    denominator: Sequence[float]

    def __post_init__(self) -> None:
        of_polynomials(self.numerator, self.denominator)  # which refuses what is none

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        return of_polynomials(self.numerator, self.denominator)


def state_space_of(controller: Any) -> StateSpace:
    """Matrices of a controller, whatever library has made it.

    Raises
    ------
    InputError
        It is no such system, in discrete time, improper, or has several inputs or outputs.
    """
    if isinstance(controller, StateSpace):
        return controller.balanced()
    if isinstance(controller, PID | TransferFunction):
        return controller.state_space
    if getattr(controller, "dt", None):
        raise InputError("controller", f"a system with a time step of {shown(controller.dt)}", _ALLOWED)
    if all(hasattr(controller, name) for name in "ABCD"):
        return StateSpace(controller.A, controller.B, controller.C, controller.D).balanced()
    if all(hasattr(controller, name) for name in ("num", "den")):
        return of_polynomials(_alone(controller.num), _alone(controller.den))
    if all(hasattr(controller, name) for name in ("zeros", "poles", "gain")):
        return of_polynomials(controller.gain * np.atleast_1d(np.poly(controller.zeros)), np.poly(controller.poles))
    raise InputError("controller", shown(controller), _ALLOWED)


def _alone(polynomials: Any) -> Any:
    """The only polynomial: python-control keeps one for each output and input."""
    if np.ndim(polynomials[0]) == 0:
        return polynomials
    if len(polynomials) != 1 or len(polynomials[0]) != 1:
        raise InputError("controller", "several inputs or outputs", "one input and one output")
    return polynomials[0][0]
