"""Base motion from a record: the acceleration of the housing along two axes at samples, linear in between.

With the acceleration ``a(t)`` of all that the housing carries, coordinates relative to it feel ``−t a(t)`` (:mod:`carom.disturbances.shocks`).  Between two
samples ``a`` is a constant and a ramp, which are a chain of two modes (:class:`carom.models.Force`), so each interval is a stage that is followed exactly;
the only error is that of the straight lines between the samples.
"""

from __future__ import annotations

import csv
import dataclasses
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from carom.base.outcome import InputError, printable, shown
from carom.disturbances.coordinates import Coordinate, Starts
from carom.disturbances.model import Disturbance
from carom.disturbances.single import Echo, Single
from carom.parameters import read_size
from carom.parameters.formats import format_quantity

if TYPE_CHECKING:
    from carom.models import Rotor, Subject
    from carom.motions.starts import State
    from carom.parameters import Scales

MOST_SAMPLES = 20_000
"""Samples of a record: each interval is a stage, which takes about a millisecond."""
_HEADING = re.compile(r"\s*(time|t|x|y)\s*[(\[]([^)\]]+)[)\]]\s*", re.IGNORECASE)
_ALLOWED = "a CSV file with a heading such as 'time (s),x (m/s^2),y (g)', of which x or y may be left out, and a row for each sample"


@dataclass(frozen=True)
class BaseRecord(Disturbance):
    """The housing and its bearings move as recorded, from levitation; when the record ends the housing moves at constant velocity.

    Attributes
    ----------
    times : tuple of float
        Of the samples, in ``1/Ω``, increasing from 0.
    x, y : tuple of float
        Accelerations of the housing along the axes of the fixed frame, in ``c_r Ω²``.
    name : str
        What it is called.

    See Also
    --------
    carom.BaseShock : a half-sine pulse

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> quake = cm.disturbances.BaseRecord((0.0, 1.0, 2.0), x=(0.0, 0.03, 0.0), y=(0.0, 0.01, 0.0))
    >>> motion = cm.simulate(*quake.apply(machine))
    >>> len(motion.parts), motion.outcome.label
    (3, 'levitated')
    """

    times: tuple[float, ...]
    x: tuple[float, ...]
    y: tuple[float, ...]
    name: str = "record"
    kind: ClassVar[str] = "base-record"
    noun: ClassVar[str] = "recorded base motions"
    many: ClassVar[bool] = False
    example: ClassVar = "quake.csv"

    def __post_init__(self) -> None:
        super().__post_init__()
        columns = [np.asarray(each, float) for each in (self.times, self.x, self.y)]
        for name, values in zip(("times", "x", "y"), columns, strict=True):
            object.__setattr__(self, name, tuple(values.tolist()))
        if not 2 <= len(self.times) == len(self.x) == len(self.y) <= MOST_SAMPLES:
            allowed = f"from 2 to {MOST_SAMPLES}, and as many of x and y"
            raise InputError("times", f"{len(self.times)} samples", allowed)
        if self.times[0] != 0.0 or not (np.diff(columns[0]) > 0.0).all() or not np.isfinite(columns).all():
            raise InputError("times", shown(self.times[:3]), "finite numbers that increase from 0")

    @classmethod
    def read_csv(cls, path: str | Path, machine: Subject) -> BaseRecord:
        """Read a record from a file with a heading of names and units, such as ``time (s),x (m/s^2),y (g)``, for a machine in SI units.

        Times count from the first sample.

        Raises
        ------
        InputError
            The file cannot be used.
        """
        from carom.models import rotor_of

        return _read(path, rotor_of(machine).scales, cls.kind)

    @classmethod
    def single_of(cls, text: str, scales: Scales | None, option: str) -> Single:
        """The motion of a file, by its path."""
        return Single(_read(text, scales, option), ())

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """None: all of it is stated."""
        return ()

    @property
    def accelerations(self) -> np.ndarray:
        """Of the samples, complex: along x and, as imaginary part, y."""
        return np.array(self.x) + 1j * np.array(self.y)

    def scaled(self, factor: float) -> BaseRecord:
        """Return the same with its accelerations multiplied by a factor."""
        x, y = (tuple(factor * each for each in axis) for axis in (self.x, self.y))
        return dataclasses.replace(self, x=x, y=y)

    def starts(self, rotor: Rotor, *values: np.ndarray, instant: np.ndarray | float = 0.0) -> Starts:
        """A record is followed by :func:`carom.simulate` alone."""
        raise InputError("disturbance", self.kind, "followed by carom.simulate")

    def apply(self, machine: Subject, *values: float | str, instant: float | str = 0.0) -> tuple[Rotor, State]:
        """Return the machine in a stage for each interval of the record and then without, and its start at levitation.

        Parameters
        ----------
        instant : float or str
            Angle by which the shaft has turned when the record begins, rad, since the frame that turns with it coincided with the fixed one.

        Raises
        ------
        InputError
            The rotor cannot levitate inside the wall.
        """
        from carom.models import Stage, Trigger, in_stages, rotor_of
        from carom.models.stages import stages_of
        from carom.motions.starts import State

        further = stages_of(rotor_of(machine))
        rotor = further[0].rotor
        rotor.system.require_levitation()
        (begun,) = self.whole(values, instant, rotor.scales)
        intervals = zip(self._moving(rotor, begun), np.diff(self.times).tolist(), strict=True)
        stages = [Stage(moved, Trigger(time=duration)) for moved, duration in intervals]
        return in_stages((*stages, *further)), State.of(*_first(rotor, begun), time=begun)

    def _moving(self, rotor: Rotor, begun: float) -> list[Rotor]:
        """The rotor in each interval."""
        from carom.models import Force
        from carom.models.mode_arrays import STEADY

        times, values = np.array(self.times), self.accelerations
        parts: tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]
        slopes, along = np.diff(values) / np.diff(times), -rotor.carried_by_housing
        # At time zero, as that of all forces.
        starts = values[:-1] - slopes * (begun + times[:-1])
        if rotor.is_anisotropic:  # whose conjugates are no multiples by complex numbers: one force along each axis
            parts = ((starts.real, slopes.real, along), (starts.imag, slopes.imag, 1j * along))
        else:
            parts = ((starts, slopes, along),)
        found = []
        for place in range(len(slopes)):
            acting = [Force(STEADY, a[place] * v, b[place] * v) for a, b, v in parts if a[place] or b[place]]
            found.append(rotor.under(*acting) if acting else rotor)
        return found

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """See :meth:`carom.disturbances.Disturbance.echo`."""
        peak, scales = float(np.abs(self.accelerations).max()), rotor.scales
        words = (
            f"Base motion {printable(self.name)}: {len(self.times)} samples over {format_quantity(self.times[-1], 'time', scales)}, linear in "
            f"between, at most {format_quantity(peak, 'acceleration', scales)} along axes of the fixed frame; times count from its first sample"
        )
        return Echo(self.kind, words, {"peak": (peak, "acceleration"), "duration": (self.times[-1], "time")})


def _first(rotor: Rotor, begun: float) -> tuple[np.ndarray, np.ndarray]:
    """Levitation at an instant, as numbers of a rotor of one coordinate."""
    position, velocity = rotor.system.kicked(0j, begun)
    return (position[0], velocity[0]) if len(position) == 1 else (position, velocity)


def _read(path: str | Path, scales: Scales | None, option: str) -> BaseRecord:
    """The record of a file; errors name the option and where the file is wrong."""

    def wrong(allowed: str) -> InputError:
        return InputError(option, printable(str(path)), allowed)

    if scales is None:
        raise wrong("allowed for a machine with mass, clearance and speed alone: accelerations have units")
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            heading, *rows = (row for row in csv.reader(file) if any(map(str.strip, row)))
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None)
        raise wrong(f"must be {_ALLOWED}{f' ({reason})' if reason else ''}") from None
    found = [_HEADING.fullmatch(each) for each in heading]
    names = ["time" if each and each[1].lower() == "t" else each[1].lower() if each else "" for each in found]
    if "" in names or len(set(names)) < len(names) or not {"time"} < set(names):
        raise wrong(f"must be {_ALLOWED}; its heading is {shown(','.join(heading))}")
    kinds = ["time" if name == "time" else "acceleration" for name in names]
    units = [
        read_size(f"{option} {name}", f"1 {each[2].strip()}", kind, scales, bare=False).own(scales)
        for name, each, kind in zip(names, found, kinds, strict=True)
        if each
    ]
    if not 2 <= len(rows) <= MOST_SAMPLES:
        raise wrong(f"must have from 2 to {MOST_SAMPLES} samples, not {len(rows)}")
    numbers = np.empty((len(rows), len(names)))
    for place, row in enumerate(rows):
        try:
            numbers[place] = [float(each) for each in row]
        except ValueError:
            raise wrong(f"must have {len(names)} numbers in sample {place + 1}, not {shown(','.join(row))}") from None
    late = np.flatnonzero(~(np.diff(numbers[:, names.index("time")]) > 0.0))
    if len(late) or not np.isfinite(numbers).all():
        bad = late[0] + 2 if len(late) else np.flatnonzero(~np.isfinite(numbers).all(axis=1))[0] + 1
        raise wrong(f"must have finite numbers and times that increase: sample {bad} has {','.join(rows[bad - 1])}")
    columns = dict(zip(names, (numbers * units).T, strict=True))
    times = columns["time"] - columns["time"][0]
    x, y = (tuple(columns.get(name, np.zeros(len(rows))).tolist()) for name in "xy")
    return BaseRecord(tuple(times.tolist()), x, y, Path(path).name)
