"""Parameters to vary: any named parameter of any model, ranges of it, and intervals in which something holds, with what happens at their ends."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.models.rotor import Rotor
from carom.models.subjects import Subject, rotor_of
from carom.parameters import Field, field_to_vary, read_quantity
from carom.parameters.terms import no_such_parameter


@dataclass(frozen=True)
class Edge:
    """End of an interval of a parameter.

    Attributes
    ----------
    value : float
        Value of the parameter; 0 and infinity are possible.
    kind : str
        What happens there: ``"boundary-equilibrium"``, ``"rub-fold"``, ``"rolling-limit"`` or ``"simulated"``; for
        orbits a kind of :class:`~carom.bifurcations.Bifurcation`, or ``"vanishing-period"``.  Empty if nothing happens
        there, at the end of the axis or of a search.
    period, radial_speed : float or None
        Of the orbit that appears, vanishes or changes there: its period in ``1/Ω`` and radial speed in ``c_r Ω``.
    name : str
        Name of this orbit; empty if there is none.
    motion : MotionName or None
        For the kind ``"simulated"``: the motion in which a disturbance ended beyond the edge.
    """

    value: float
    kind: str = ""
    period: float | None = None
    radial_speed: float | None = None
    name: str = ""
    motion: str | None = None


@dataclass(frozen=True)
class Span:
    """An interval of a parameter, by its ends; ``value in span`` says whether it holds a value."""

    low: Edge
    high: Edge

    def __iter__(self) -> Iterator[Edge]:
        return iter((self.low, self.high))

    def __contains__(self, value: float) -> bool:
        return self.low.value <= value <= self.high.value

    def document(self) -> list[float]:
        """Its ends, as plain data for JSON."""
        return [self.low.value, self.high.value]


def spans_where(edges: Iterable[Edge], there: Callable[[float], bool]) -> tuple[Span, ...]:
    """The spans between edges in which something holds, by whether it does in the middle between neighbours.

    Of edges with one value the first counts.
    """
    first = {edge.value: edge for edge in reversed(list(edges))}
    ordered = [first[value] for value in sorted(first)]
    sides = [False, *(there(0.5 * (one.value + other.value)) for one, other in pairwise(ordered)), False]
    return paired([edge for edge, (below, above) in zip(ordered, pairwise(sides), strict=True) if below != above])


def paired(ends: Sequence[Edge]) -> tuple[Span, ...]:
    """The spans whose ends these are, in ascending order."""
    return tuple(Span(*pair) for pair in zip(ends[::2], ends[1::2], strict=True))


Ends = tuple[float | str, float | str]
"""Both ends of a range: numbers, in SI units if the parameter is physical, or text such as ``"300 N s/m"``."""
USUAL_RANGE = (0.5, 2.0)
"""Usual range of a parameter, in multiples of its present value."""


@dataclass(frozen=True)
class Axis:
    """A parameter to vary.

    Attributes
    ----------
    field : Field
        Name, words, symbol, unit and range of the parameter.
    """

    field: Field

    @property
    def name(self) -> str:
        """Name of the parameter."""
        return self.field.name

    @property
    def heading(self) -> str:
        """Name of the parameter, with the unit in which people usually say it."""
        return f"{self.name} ({self.field.usual_unit})" if self.field.usual_unit else self.name

    @checked
    def value(self, model: Rotor) -> float:
        """Its value in a model, in SI units if it is physical."""
        return model.value(self.name)

    def move(self, model: Rotor, value: float) -> Rotor:
        """Return the model with another value of it; what depends on it changes too.

        Raises
        ------
        InputError
            The value is out of range, or makes another parameter leave its range.
        """
        return model.replace(**{self.name: value})


@checked
def axis(machine: Subject, name: str) -> Axis:
    """Parameter of this name, of a model.

    Raises
    ------
    InputError
        The model has no parameter of this name, or a physical one while mass, clearance and speed are not known.

    See Also
    --------
    carom.models.Axis : what it returns

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> cm.models.axis(cm.models.rotor_of(machine), "damping").field.unit
    'N s/m'
    """
    model = rotor_of(machine)
    varied = model.varied
    if name in varied:
        return Axis(varied[name])
    raise no_such_parameter(name, None, varied, model.scales is not None)


def read_interval(parameter: str | Axis, given: Ends) -> tuple[float, float]:
    """Read a range of a parameter; refuse an unknown parameter, a value that it cannot have, and an empty range."""
    field = field_to_vary(parameter) if isinstance(parameter, str) else parameter.field
    low, high = (read_quantity(field, end) for end in given)
    if not low < high:
        raise InputError(field.name, f"{low:g} to {high:g}", "a range of two finite values in ascending order")
    return low, high


def usual_range(
    along: Axis, present: float, option: str, multiples: tuple[float, float] = USUAL_RANGE
) -> tuple[float, float]:
    """A range around the present value of a parameter, in multiples of it; ``option`` is what must be given where it is not above 0."""
    if not present > 0.0:
        raise InputError(option, None, f"needed: {along.name} = {present:g} gives no range around it")
    return multiples[0] * present, min(multiples[1] * present, along.field.highest)


def interval_around(along: Axis, value: float, given: Ends) -> tuple[float, tuple[float, float]]:
    """Present value of a parameter, and a range that must contain it up to rounding."""
    low, high = read_interval(along, given)
    nearest = min(max(value, low), high)
    if not abs(value - nearest) <= 1e-12 * max(abs(low), abs(high)):
        raise InputError(
            along.name, f"{low:g} to {high:g}", f"an interval that holds the motion's own value {value:.6g}"
        )
    return nearest, (low, high)
