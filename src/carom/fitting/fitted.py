"""Fit parameters of a machine to displacements measured over time, through contact, and say how far the values are known."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib.metadata import version

import numpy as np
from scipy.special import chdtrc, stdtrit  # type: ignore[import-untyped]

from carom.base.arguments import Count, checked
from carom.base.outcome import CaromError, InputError
from carom.base.progress import Reporter, ShowProgress, shows_progress
from carom.base.results import Column, Members, keys_of, record
from carom.fitting.records import Record
from carom.fitting.shooting import OUTLIER, Shooting, Solved, Unknowns
from carom.fitting.starts import FlightFit, cut
from carom.models import Axis, Rotor, Subject, axis, rotor_of
from carom.parameters import Field
from carom.parameters.formats import format_entry, number

CONFIDENCE = 0.95
SIGNIFICANT = 0.01
"""Probability below which the residuals are no noise, and the model is not good enough."""
LAGS = 10
"""Lags over which residuals are compared with themselves."""
UNDETERMINED, ENTANGLED = 0.5, 0.99
"""Relative error from which a record does not determine a parameter, and correlation from which it determines two of them together only."""
MOST_COORDINATES = 6
"""Coordinates of a rotor of which a state is found from the sensors."""
LARGEST = 300.0
"""Logarithm of the largest factor of an interval."""
SPREAD, SEED = 0.4, 20
"""Scatter of the logarithms of further starts, and the seed of their random numbers."""
SPEED_ERROR = 0.01
"""Difference of the speed by a key-phasor from that of the machine, relative."""


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter.

    Attributes
    ----------
    field : Field
    start, value : float
        Before and after the fit, SI units.
    low, high : float
        Interval that holds the true value with 95 % probability if the model is right, SI units.
    error : float
        Standard deviation of its logarithm, or of itself where it may be zero.
    is_determined : bool
        Whether the record determines it.
    """

    field: Field
    start: float
    value: float
    low: float
    high: float
    error: float
    is_determined: bool

    @property
    def name(self) -> str:
        """Name of the parameter."""
        return self.field.name

    @property
    def words(self) -> str:
        """Value and interval in the unit of people."""
        if not self.is_determined:
            return f"not determined by this record (about {format_entry(self.field, self.value)})"
        return f"{format_entry(self.field, self.value)}, 95 %: {self.interval}"

    @property
    def interval(self) -> str:
        """The interval in words."""
        return f"{format_entry(self.field, self.low)} to {format_entry(self.field, self.high)}"


ESTIMATE = (
    Column("name", "parameter"),
    Column("start", "before", lambda each, _: format_entry(each.field, each.start)),
    Column("value", "fitted", lambda each, _: format_entry(each.field, each.value)),
    Column("low", "", None),
    Column(
        "high",
        "95 % interval",
        lambda each, _: each.interval if each.is_determined else "not determined by this record",
    ),
    Column("is_determined"),
)
"""Columns of fitted parameters."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit(Members[Estimate]):
    """Parameters fitted to a record; the estimates are its members, by name.

    Attributes
    ----------
    record : Record
    rotor : Rotor
        With the fitted parameters.
    members : tuple of Estimate
    correlation : array, shape (p, p)
        Of the errors of the parameters.
    noise : float
        Standard deviation of the residuals, m.
    residuals : array, shape (m, c)
        Motion minus record, m, of the samples from ``first`` on.
    first : int
        First sample that is fitted.
    contacts : int
        Contacts of the fitted motion.
    probability : float
        Of residuals so far from independent noise if the model were right.
    angle : float
        Angle by which the shaft has turned at the time zero of the record, rad.
    offsets : array, shape (c,)
        Offsets of the channels, m.
    """

    called = "parameter"
    figure = "fit"

    record: Record
    rotor: Rotor
    members: tuple[Estimate, ...]
    correlation: np.ndarray
    noise: float
    residuals: np.ndarray
    first: int
    contacts: int
    probability: float
    angle: float
    offsets: np.ndarray

    @property
    def is_good_enough(self) -> bool:
        """Whether the residuals are independent noise as far as the record shows."""
        return self.probability >= SIGNIFICANT

    @property
    def values(self) -> dict[str, float]:
        """Fitted values of the parameters that the record determines, by name, SI units."""
        return {each.name: each.value for each in self.members if each.is_determined}

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the fit says: noise, whether the model is good enough, and what the record does not determine."""
        said = [
            f"{len(self.residuals)} samples of {len(self.record.channels)} channels, {self.contacts} contacts; residuals of {number(1e6 * self.noise, 3)} um (standard deviation)."
        ]
        if self.is_good_enough:
            said.append(
                "The residuals are independent noise as far as this record shows: the model is good enough for it."
            )
        else:
            said.append(
                "The residuals are not noise: this model does not explain the record, and the intervals are too narrow."
            )
        names = [each.name for each in self.members]
        said += [f"This record does not determine {each.name}." for each in self.members if not each.is_determined]
        for row, column in zip(*np.triu_indices(len(names), 1), strict=True):
            both = self.members[row].is_determined and self.members[column].is_determined
            if both and abs(self.correlation[row, column]) >= ENTANGLED:
                said.append(
                    f"It hardly separates {names[row]} and {names[column]} (correlation {self.correlation[row, column]:.3f})."
                )
        return tuple(said)

    def to_dict(self) -> dict[str, object]:
        """Return the fit as ``carom fit --json`` prints it, in SI units."""
        return {
            "carom": version("carom"),
            "record": self.record.name,
            "parameters": [record(each, keys_of(ESTIMATE)) for each in self.members],
            "correlation": self.correlation.tolist(),
            "noise_si": self.noise,
            "samples": len(self.residuals),
            "contacts": self.contacts,
            "is_good_enough": self.is_good_enough,
            "probability": self.probability,
            "angle": self.angle,
            "offsets_si": self.offsets.tolist(),
            "words": list(self.sentences),
        }

    def rows(self) -> list[tuple[str, str]]:
        """The parameters, and what the fit says."""
        return [(each.name, each.words) for each in self.members] + [("", each) for each in self.sentences]


@checked
@shows_progress
def fit(
    machine: Subject,
    record: Record,
    free: Iterable[str],
    *,
    dropped: bool = False,
    starts: Count = 5,
    progress: ShowProgress = None,
) -> Fit:
    """Fit parameters of a machine to a record of displacements, through all contacts in it.

    The rotor may be anywhere at the beginning, levitated and in flight or in contact.  Beside the parameters, offsets of the channels are fitted,
    and without a key-phasor the angle of the shaft at time zero.

    Parameters
    ----------
    machine : Machine, Case or model
        In SI units; its values of the parameters are where the fit starts.
    record : Record
        Of :func:`carom.fitting.read_record`.
    free : iterable of str
        Parameters to fit, such as ``("friction", "restitution", "damping")``.
    dropped : bool
        Whether levitation is lost all along the record.
    starts : int
        Most starts, from values that scatter around those of the machine; the fit ends with the first after which the residuals are noise.

    Returns
    -------
    Fit

    Raises
    ------
    InputError
        A parameter is unknown, or the record cannot be of this machine.
    CaromError
        No motion of this machine fits the record.
    """
    tell = Reporter.of(progress, "fitting")
    rotor = _levitated(machine, dropped)
    if len(rotor.system.rest) > MOST_COORDINATES:
        allowed = f"up to {MOST_COORDINATES} of them: sensors do not show the state of more in a flight"
        raise InputError("machine", f"{len(rotor.system.rest)} coordinates", allowed)
    axes = [axis(rotor, name) for name in dict.fromkeys(free)]
    if not axes:
        raise InputError("free", "none", "at least one parameter, such as friction")
    if record.marks is None and any(each.name in ("unbalance_phase", "phi") for each in axes):
        raise InputError(
            "free", "unbalance_phase", "a record with a keyphasor: without one the angle of the shaft is fitted"
        )
    task = _Task.of(rotor, record, axes)
    best: Solved | None = None
    for number_of_start in range(starts):
        tell(number_of_start / starts)
        found = task.solved(number_of_start)
        if found is not None and (best is None or found.variance < best.variance):
            best = found
        if best is not None and _probability(best) >= SIGNIFICANT:
            break
    if best is None:
        raise CaromError("no motion of this machine fits the record: is it of this machine, and at this speed?")
    tell(1.0)
    return _result(best, axes, record)


def _levitated(machine: Subject, dropped: bool) -> Rotor:
    """The rotor of the record: levitated, or without levitation under its weight."""
    if not dropped:
        return rotor_of(machine)
    from carom.disturbances import drop

    found, _ = drop().stages(machine)
    return found


@dataclass(frozen=True, eq=False)
class _Task:
    """What is fitted, before the record is cut."""

    shooting: Shooting

    @classmethod
    def of(cls, rotor: Rotor, record: Record, axes: list[Axis]) -> _Task:
        scales = record.check(rotor)
        start = np.array([each.value(rotor) for each in axes])
        logarithmic = np.array([each.field.lowest >= 0.0 for each in axes]) & (start > 0.0)
        states = 4 * len(rotor.system.rest) + len(rotor.races) - rotor.races.count(None)
        unknowns = Unknowns(
            tuple(each.name for each in axes), start, logarithmic, len(record.channels), 0, states, record.marks is None
        )
        angle = 0.0 if record.marks is None else _angle_of(record.marks, scales.speed)

        def changed(values: Mapping[str, float]) -> Rotor:
            return rotor.replace(**values)

        none = np.zeros((0, 2), int)
        return cls(Shooting(changed, record, none, unknowns, (scales.length, scales.speed), 1.0, angle))

    def solved(self, number_of_start: int) -> Solved | None:
        """The fit from one start: the machine's own values, or random ones around them."""
        shooting = self.shooting
        unknowns = shooting.unknowns
        vector = np.zeros(unknowns.common)
        if number_of_start:
            scatter = np.random.default_rng([SEED, number_of_start]).normal(size=len(unknowns.names))
            vector[: len(scatter)] = np.where(unknowns.logarithmic, SPREAD * scatter, 0.0)
        begun = FlightFit(shooting).solved(vector)
        observed = None if begun is None else shooting.observed(begun[0])
        if begun is None or observed is None:
            return None
        common, width = begun
        stretches, states, noise = cut(observed, width, shooting.unit[0] * unknowns.offsets(common))
        if not len(stretches):
            return None
        cutted = dataclasses.replace(
            shooting, unknowns=dataclasses.replace(unknowns, nodes=len(stretches)), stretches=stretches, noise=noise
        )
        return cutted.solved(np.concatenate([common, states.ravel()]))


def _angle_of(marks: np.ndarray, speed: float) -> float:
    """Angle of the shaft at time zero by a key-phasor, whose mark passes at the angle zero, rad."""
    if len(marks) < 2:
        raise InputError("keyphasor", f"{len(marks)} pulses", "at least two")
    measured = 2.0 * math.pi * (len(marks) - 1) / float(marks[-1] - marks[0])
    if abs(measured / speed - 1.0) > SPEED_ERROR:
        rpm = 30.0 / math.pi
        raise InputError(
            "keyphasor",
            f"{number(rpm * measured)} rpm",
            f"the speed of the machine, {number(rpm * speed)} rpm; set speed",
        )
    turns = np.arange(len(marks)) * 2.0 * math.pi
    return float(np.mean(turns - speed * marks))


def _probability(found: Solved) -> float:
    """Probability of residuals so unlike independent noise, by Ljung and Box's sum over lags, the least over the channels."""
    worst = 1.0
    residuals = np.clip(found.residuals, -OUTLIER, OUTLIER)
    for column in residuals.T:
        away, count = column - column.mean(), len(column)
        lags = range(1, min(LAGS, count // 5) + 1)
        shares = np.array([float(away[lag:] @ away[:-lag]) for lag in lags]) / float(away @ away)
        total = count * (count + 2) * float((shares**2 / (count - np.array(lags))).sum())
        worst = min(worst, float(chdtrc(len(lags), total)))
    return min(1.0, worst * residuals.shape[1])


def _result(found: Solved, axes: list[Axis], record: Record) -> Fit:
    """What a fit says of the parameters."""
    shooting = found.shooting
    unknowns, p = shooting.unknowns, len(axes)
    covariance = found.covariance[:p, :p]
    errors = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    wide = float(stdtrit(max(found.free, 1), 0.5 * (1.0 + CONFIDENCE))) * errors
    values, estimates = unknowns.values(found.vector), []
    for place, each in enumerate(axes):
        value, by_factor = float(values[place]), unknowns.logarithmic[place]
        low, high = (
            (value * math.exp(-min(wide[place], LARGEST)), value * math.exp(min(wide[place], LARGEST)))
            if by_factor
            else (value - wide[place], value + wide[place])
        )
        determined = bool(
            errors[place]
            <= (UNDETERMINED if by_factor else UNDETERMINED * max(abs(value), abs(unknowns.start[place]), 1e-300))
        )
        estimates.append(
            Estimate(each.field, float(unknowns.start[place]), value, low, high, float(errors[place]), determined)
        )
    return Fit(
        record,
        found.observed.rotor,
        tuple(estimates),
        covariance / np.outer(errors, errors),
        shooting.noise * math.sqrt(found.variance),
        shooting.noise * found.residuals,
        int(shooting.stretches[0, 0]),
        sum(each.contacts for each in found.stretches),
        _probability(found),
        found.observed.angle,
        shooting.unit[0] * unknowns.offsets(found.vector),
    )
