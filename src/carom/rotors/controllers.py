"""Controllers of magnetic bearings, as their users have them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from carom.base.outcome import InputError, shown
from carom.parameters import Field, read_quantity
from carom.parameters.fields import by_name
from carom.parameters.tables import read_entries
from carom.rotors.filters import LeadLag, LowPass, Notch
from carom.rotors.state_spaces import SAMPLE_TIME, StateSpace, in_series, of_polynomials, real_numbers

PID_FIELDS: Mapping[str, Field] = by_name(
    Field("proportional", "P", "proportional gain", "a gain", "A/m", 1e-9, 1e15, '"5000 A/m"', True),
    Field("integral", "I", "integral gain", "a gain", "A/m/s", 1e-9, 1e15, '"1500 A/m/s"', True),
    Field("derivative", "D", "derivative gain", "a gain", "A s/m", 1e-12, 1e12, '"5 A s/m"', True),
    Field("filter_time", "T", "time of the filter of the derivative; 0 for an ideal derivative", "a time", "s", 1e-9, 1e3, '"0.1 ms"', True, usual="ms", usual_size=1e-3),
)  # fmt: skip


def gains_in(proportional: str, integral: str, derivative: str, example: str) -> Mapping[str, Field]:
    """Fields of gains in other units."""
    units = {"proportional": proportional, "integral": integral, "derivative": derivative}
    return {
        name: replace(field, unit=units[name], example=example) if name in units else field
        for name, field in PID_FIELDS.items()
    }


RULES = {"backward-euler": 1.0, "tustin": 0.5}
"""Rules by which gains become a program, and the share of the newer one of two samples in an integral."""
CONJUGATE = 1e-9
"""Relative difference up to which two roots of a real polynomial are conjugates."""
_ALLOWED = "a controller of carom.rotors, or a system of SciPy or python-control: with A, B, C, D; num, den; or zeros, poles, gain"


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
        ``T``, s: of the derivative; 0 for an ideal one, which no controller is.
    sample_time : float or str, optional
        ``h``, s: it runs as a program, with ``s = (z − 1)/(h(θz + 1 − θ))`` and its hold; by default it is in continuous time.
    sampling : {"backward-euler", "tustin"}, optional
        Its rule, ``θ = 1`` by default, or ``1/2``.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, or there is a derivative without a filter, or Tustin's of an ideal one.
    """

    proportional: float
    integral: float = 0.0
    derivative: float = 0.0
    filter_time: float | None = None
    sample_time: float | None = None
    sampling: str | None = None

    fields: ClassVar[Mapping[str, Field]] = PID_FIELDS

    def __post_init__(self) -> None:
        read_entries(self, self.fields)
        if self.derivative and self.filter_time is None:
            raise InputError(
                "filter_time", None, "a derivative needs the time of its filter, such as '0.1 ms'; 0 for an ideal one"
            )
        if self.sampling not in (None, *RULES) or (self.sampling and self.sample_time is None):
            raise InputError("sampling", shown(self.sampling), f"one of {', '.join(RULES)}, beside sample_time")
        if self.sampling == "tustin" and self.derivative and not self.filter_time:
            raise InputError("filter_time", 0, "above 0 with Tustin's rule, by which an ideal derivative never settles")
        object.__setattr__(self, "sample_time", self.state_space.sample_time)

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        matrix, into, out, straight, rate = [], [], [], self.proportional, 0.0
        if self.sample_time is not None:
            return self._program(read_quantity(SAMPLE_TIME, self.sample_time))
        if self.integral:
            matrix, into, out = [0.0], [self.integral], [1.0]
        if self.derivative and self.filter_time:
            inverse = 1.0 / self.filter_time
            matrix, into, out = [*matrix, -inverse], [*into, self.derivative * inverse], [*out, -inverse]
            straight += self.derivative * inverse
        elif self.derivative:
            rate = self.derivative
        return StateSpace(np.diag(matrix), np.array(into), np.array(out), np.array(straight), rate=rate).balanced()

    def _program(self, step: float) -> StateSpace:
        """What it is from sample to sample."""
        new, late = RULES[self.sampling or "backward-euler"] * step, self.filter_time or 0.0
        pole, wide = (late + new - step) / (late + new), self.derivative / (late + new)
        into, out = np.array([step * self.integral, wide]), np.array([1.0, pole - 1.0])
        used, straight = into != 0.0, np.array(self.proportional + new * self.integral + wide)
        return StateSpace(np.diag([1.0, pole])[np.ix_(used, used)], into[used], out[used], straight, step).balanced()


class VoltagePID(PID):
    """A :class:`PID` between the voltage of sensors and that to the amplifier: ``P`` in V/V, ``I`` in 1/s, ``D`` in s.

    It belongs to a bearing with ``sensor_gain`` and ``amplifier_gain``.
    """

    fields = gains_in("", "1/s", "s", "2.5")


@dataclass(frozen=True)
class TransferFunction:
    """A quotient of polynomials of ``s``, in 1/s, or of ``z``: current by displacement, A/m, which it opposes.

    Parameters
    ----------
    numerator, denominator : sequence of float
        Coefficients from the highest power on.
    sample_time : float or str, optional
        s; with it the polynomials are those of ``z``.

    Raises
    ------
    InputError
        The numerator has the higher degree, the denominator is zero, or a coefficient is no finite number.
    """

    numerator: Sequence[float]
    denominator: Sequence[float]
    sample_time: float | None = None

    def __post_init__(self) -> None:
        of_polynomials(self.numerator, self.denominator)  # which refuses what is none
        for name in ("numerator", "denominator"):
            values = real_numbers(f"controller {name}", getattr(self, name))
            object.__setattr__(self, name, tuple(values.ravel().tolist()))
        object.__setattr__(self, "sample_time", self.state_space.sample_time)

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        return _sampled(of_polynomials(self.numerator, self.denominator), self.sample_time)

    @property
    def coefficients(self) -> Iterator[tuple[str, tuple[str | int, ...], str]]:
        """Names, places and descriptions of all coefficients."""
        letter = "s" if self.sample_time is None else "z"
        for part in ("numerator", "denominator"):
            values = getattr(self, part)
            for place in range(len(values)):
                power = len(values) - 1 - place
                yield f"{part}_{letter}{power}", (part, place), f"coefficient of {letter}^{power} of the {part}"


@dataclass(frozen=True)
class ZerosPolesGain:
    """``gain Π(s − z)/Π(s − p)``, in 1/s, or with ``z`` in place of ``s``: current by displacement, A/m, which it opposes.

    Parameters
    ----------
    zeros, poles : sequence of float, complex, or pairs (re, im)
        A complex one stands for itself and its conjugate, which may be listed too.
    gain : float
    sample_time : float or str, optional
        s; with it they are those of ``z``.

    Raises
    ------
    InputError
        There are more zeros than poles, or a number is not finite.
    """

    zeros: Sequence[tuple[float, float]]
    poles: Sequence[tuple[float, float]]
    gain: float
    sample_time: float | None = None

    def __post_init__(self) -> None:
        for name in ("zeros", "poles"):
            object.__setattr__(self, name, _roots(name, getattr(self, name)))
        object.__setattr__(self, "gain", float(real_numbers("controller gain", self.gain).reshape(())))
        if _degree(self.zeros) > _degree(self.poles):
            raise InputError(
                "controller zeros", f"{_degree(self.zeros)} zeros", f"at most as many as poles, {_degree(self.poles)}"
            )
        object.__setattr__(self, "sample_time", self.state_space.sample_time)

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices: sections of second order one after the other, which keep the digits of close poles."""
        above, below = _factors(self.zeros), _factors(self.poles)
        above = [np.ones(1)] * (len(below) - len(above)) + above
        sections = [of_polynomials(one, other) for one, other in zip(above, below, strict=True)]
        return _sampled(in_series([of_polynomials([self.gain], [1.0]), *sections]), self.sample_time)

    @property
    def coefficients(self) -> Iterator[tuple[str, tuple[str | int, ...], str]]:
        """Names, places and descriptions of all numbers."""
        yield "gain", ("gain",), "gain of a controller with zeros and poles"
        for kind in ("zeros", "poles"):
            for place, (_, turn) in enumerate(getattr(self, kind)):
                for part, words in enumerate(("real", "imaginary")[: 1 + bool(turn)]):
                    yield (
                        f"{kind[:-1]}{place + 1}_{words}",
                        (kind, place, part),
                        f"{words} part of {kind[:-1]} {place + 1}",
                    )


@dataclass(frozen=True)
class SecondOrderSections:
    """``Π (b0 s² + b1 s + b2)/(a0 s² + a1 s + a2)``, or with ``z`` in place of ``s``: rows of SciPy's ``sos``; current by displacement, A/m.

    Parameters
    ----------
    sos : array_like, shape (n, 6)
        ``b0, b1, b2, a0, a1, a2`` of each section.
    sample_time : float or str, optional
        s; with it, as SciPy's digital filters need it, sections are those of ``z``.

    Raises
    ------
    InputError
        The array has another shape, or a section a numerator of higher degree.
    """

    sos: Sequence[Sequence[float]]
    sample_time: float | None = None

    def __post_init__(self) -> None:
        rows = real_numbers("controller sos", self.sos)
        if rows.ndim != 2 or rows.shape[1] != 6 or not len(rows):
            raise InputError(
                "controller sos", f"an array of shape {rows.shape}", "rows of six numbers: b0, b1, b2, a0, a1, a2"
            )
        object.__setattr__(self, "sos", tuple(map(tuple, rows.tolist())))
        object.__setattr__(self, "sample_time", self.state_space.sample_time)

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        return _sampled(in_series([of_polynomials(row[:3], row[3:]) for row in self.sos]), self.sample_time)

    @property
    def coefficients(self) -> Iterator[tuple[str, tuple[str | int, ...], str]]:
        """Names, places and descriptions of all coefficients."""
        for row in range(len(self.sos)):
            for place, name in enumerate(("b0", "b1", "b2", "a0", "a1", "a2")):
                yield f"sos{row + 1}_{name}", ("sos", row, place), f"coefficient {name} of section {row + 1}"


@dataclass(frozen=True)
class Series:
    """A controller and filters, one after the other.

    Parameters
    ----------
    controller : a controller
    filters : sequence of Notch, LeadLag, LowPass, or controllers
        In continuous time, or sampled with the controller: then one hold is behind all of them that are.
    sample_time : float, optional
        In place of that of all that are sampled, s.
    """

    controller: Controller
    filters: Sequence[Controller]
    sample_time: float | None = None

    def __post_init__(self) -> None:
        parts: list[Any] = [controller_of(each) for each in (self.controller, *self.filters)]
        if self.sample_time is not None:
            given = {"sample_time": self.sample_time}
            parts = [replace(each, **given) if getattr(each, "sample_time", None) else each for each in parts]
        object.__setattr__(self, "controller", parts[0])
        object.__setattr__(self, "filters", tuple(parts[1:]))
        time = self.controller.state_space.sample_time
        object.__setattr__(self, "sample_time", time)
        for each in self.filters:
            if (own := each.state_space.sample_time) not in (None, time):
                allowed = "filters in continuous time"
                allowed += f", or with that of the controller, {time:g} s" if time else ""
                raise InputError("filter", f"with a sample time of {own:g} s", allowed)

    @property
    def analog(self) -> list[StateSpace]:
        """Filters that are not part of that program, behind it."""
        spaces, time = [each.state_space for each in self.filters], self.controller.state_space.sample_time
        return [each for each in spaces if each.sample_time != time]

    @property
    def sampled(self) -> StateSpace:
        """What of it runs as one program; the controller alone in continuous time."""
        spaces = [each.state_space for each in (self.controller, *self.filters)]
        time = spaces[0].sample_time
        return replace(
            in_series([replace(each, sample_time=None) for each in spaces if each.sample_time == time]),
            sample_time=time,
        )

    @property
    def state_space(self) -> StateSpace:
        """The same as matrices."""
        return in_series([self.sampled.held, *self.analog])


Controller = (
    PID | TransferFunction | ZerosPolesGain | SecondOrderSections | StateSpace | Notch | LeadLag | LowPass | Series
)


def controller_of(controller: Any) -> Controller:
    """A controller of one of the kinds above, whatever library has made it.

    Raises
    ------
    InputError
        It is no such system, improper, in discrete time without a time step, or a quotient with several inputs or outputs.
    """
    if isinstance(controller, Controller):
        return controller
    step = getattr(controller, "dt", None) or None
    if isinstance(step, bool):
        raise InputError("controller", "a system in discrete time without a time step", "one with its time step dt, s")
    if all(hasattr(controller, name) for name in "ABCD"):
        return StateSpace(controller.A, controller.B, controller.C, controller.D, step)
    if all(hasattr(controller, name) for name in ("num", "den")):
        return TransferFunction(_alone(controller.num), _alone(controller.den), step)
    if all(hasattr(controller, name) for name in ("zeros", "poles", "gain")):
        return ZerosPolesGain(controller.zeros, controller.poles, controller.gain, step)
    raise InputError("controller", shown(controller), _ALLOWED)


def state_space_of(controller: object) -> StateSpace:
    """Matrices in continuous time of a controller, whatever library has made it; see :func:`controller_of`."""
    return controller_of(controller).state_space.held.balanced()


def _sampled(system: StateSpace, sample_time: float | None) -> StateSpace:
    if sample_time is None:
        return system
    return replace(system, sample_time=read_quantity(SAMPLE_TIME, sample_time))


def _roots(name: str, given: Iterable[object]) -> tuple[tuple[float, float], ...]:
    """Real and imaginary parts of zeros or poles, of two conjugates those of the upper one."""
    allowed = "numbers, or pairs [re, im], each complex one for itself and its conjugate, or all with their conjugates"
    try:
        values = [complex(*np.atleast_1d(np.array(each)).tolist()) for each in given]
    except (TypeError, ValueError):
        raise InputError(f"controller {name}", shown(given), allowed) from None
    real_numbers(f"controller {name}", np.abs(values))
    upper, lower = (
        sorted((each for each in values if sign * each.imag > 0.0), key=lambda z: (z.real, abs(z.imag)))
        for sign in (1.0, -1.0)
    )
    if lower and not (len(lower) == len(upper) and np.allclose(np.conj(lower), upper, rtol=CONJUGATE, atol=0.0)):
        raise InputError(f"controller {name}", shown(given), allowed)
    return tuple((each.real, each.imag) for each in values if each.imag >= 0.0)


def _degree(roots: Sequence[tuple[float, float]]) -> int:
    return sum(1 + bool(turn) for _, turn in roots)


def _factors(roots: Sequence[tuple[float, float]]) -> list[np.ndarray]:
    """Real polynomials of second degree with these roots, and one of first degree at the beginning where their number is odd."""
    alone = [real for real, turn in roots if not turn]
    first, pairs = alone[: len(alone) % 2], alone[len(alone) % 2 :]
    found = [np.poly(pair) for pair in zip(pairs[::2], pairs[1::2], strict=True)]
    found += [np.array([1.0, -2.0 * real, real**2 + turn**2]) for real, turn in roots if turn]
    return [np.array([1.0, -root]) for root in first] + found


def _alone(polynomials: Any) -> Any:
    """The only polynomial: python-control keeps one for each output and input."""
    if np.ndim(polynomials[0]) == 0:
        return polynomials
    if len(polynomials) != 1 or len(polynomials[0]) != 1:
        raise InputError("controller", "several inputs or outputs", "one input and one output")
    return polynomials[0][0]
