"""Base motion from a record: the acceleration of the housing along two axes at samples, linear in between.

With the acceleration ``a(t)`` of all that the housing carries, coordinates relative to it feel ``−t a(t)`` (:mod:`carom.disturbances.shocks`).  Between two
samples ``a`` is a constant and a ramp, which are a chain of two modes (:class:`carom.models.Force`), so each interval is a stage that is followed exactly;
the only error is that of the straight lines between the samples.
"""

from __future__ import annotations

import cmath
import csv
import dataclasses
import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from carom.base.arguments import checked
from carom.base.outcome import InputError, printable, shown
from carom.disturbances.base_motion import BaseMotion
from carom.disturbances.coordinates import Coordinate, angle_coordinate
from carom.disturbances.response_spectra import BaseCourse
from carom.disturbances.single import Echo, Part, Single, read_part
from carom.parameters import Scales, read_size
from carom.parameters.formats import format_angle, format_quantity, number

if TYPE_CHECKING:
    from carom.models import Rotor

MOST_SAMPLES = 20_000
"""Samples of a record: each interval is a stage, which takes about a millisecond."""
_HEADING = re.compile(r"\s*(time|t|x|y)\s*[(\[]([^)\]]+)[)\]]\s*", re.IGNORECASE)
_SIZES = Part("peak", "PEAK", "acceleration"), Part("direction", "ANGLE", "angle")
_ALLOWED = "a CSV file with a heading such as 'time (s),x (m/s^2),y (g)', of which x or y may be left out, and a row for each sample"


@dataclass(frozen=True)
class BaseRecord(BaseMotion):
    """The housing and its bearings move as recorded, from levitation; when the record ends the housing moves at constant velocity.

    Attributes
    ----------
    times : tuple of float
        Of the samples, in ``1/Ω``, increasing from 0.
    x, y : tuple of float
        Accelerations of the housing along the axes of the fixed frame, in ``c_r Ω²``.
    name : str
        What it is called.
    largest : float
        Largest peak acceleration to which it is scaled, in ``c_r Ω²``; by default, 0, that of the record.

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
    largest: float = 0.0
    kind: ClassVar[str] = "base-record"
    noun: ClassVar[str] = "recorded base motions"
    example: ClassVar = "quake.csv"
    turns_with_shaft: ClassVar[bool] = False

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
        if not self.peak > 0.0:
            raise InputError("x, y", "zeros", "some acceleration")
        object.__setattr__(self, "largest", self.largest or self.peak)

    @classmethod
    def single_of(cls, text: str, scales: Scales | None, option: str) -> Single:
        """The motion of a file for a machine in SI units, by its path, perhaps with the peak acceleration to which it is scaled and the angle by which it is turned.

        The file has a heading of names and units, such as ``time (s),x (m/s^2),y (g)``; times count from the first sample.

        Raises
        ------
        InputError
            The file cannot be used, or the text is none of this kind.
        """
        path, *sizes = [text] if Path(text).exists() else map(str.strip, text.split(","))
        found = _read(path, scales, option)
        if len(sizes) > len(_SIZES):
            raise InputError(option, printable(text), "must be FILE.csv[,PEAK[,ANGLE]] such as 'quake.csv,2 g,30 deg'")
        stated = [read_part(option, part, each, scales) for part, each in zip(_SIZES, sizes, strict=False)]
        peak, angle = (*stated, *(found.peak, 0.0)[len(stated) :])
        if not peak > 0.0:
            raise InputError(option, printable(text), "must have a peak above 0")
        return Single(dataclasses.replace(found, largest=peak), (peak, angle))

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Peak acceleration to which it is scaled, and angle by which it is turned."""
        size = Coordinate("peak_acceleration", "peak acceleration of the base", 0.0, self.largest, "acceleration", True)
        return size, angle_coordinate("direction", "angle by which the record is turned")

    @property
    def accelerations(self) -> np.ndarray:
        """Of the samples, complex: along x and, as imaginary part, y."""
        return np.array(self.x) + 1j * np.array(self.y)

    @property
    def peak(self) -> float:
        """Largest acceleration of the samples, in ``c_r Ω²``."""
        return float(np.abs(self.accelerations).max())

    def scaled(self, factor: float) -> Self:
        """Return the same with its accelerations multiplied by a factor."""
        x, y = (tuple(factor * each for each in axis) for axis in (self.x, self.y))
        return dataclasses.replace(self, x=x, y=y, largest=factor * self.largest)

    @checked
    def rescaled(self, before: Scales | None, after: Scales | None, names: Collection[str] | None = None) -> Self:
        """See :meth:`carom.disturbances.Disturbance.rescaled`: all of it stays the same in SI units."""
        if before is None or after is None or before == after:
            return self
        times = tuple((np.array(self.times) * (before.time / after.time)).tolist())
        return dataclasses.replace(self, times=times).scaled(before.acceleration / after.acceleration)

    def course(self, size: float, angle: float = 0.0, begun: float = 0.0) -> BaseCourse:
        """See ``BaseMotion.course``; angles are those of the fixed frame."""
        durations, values = np.diff(self.times), self.accelerations * cmath.rect(size / self.peak, angle)
        return BaseCourse(durations, values[:-1], np.diff(values) / durations, np.zeros(len(durations)))

    def echo(self, rotor: Rotor, *values: float) -> Echo:
        """See :meth:`carom.disturbances.Disturbance.echo`."""
        (peak, angle), scales = values, rotor.scales
        turned = f", turned by {format_angle(angle)}" if angle else ""
        scaled = "" if peak == self.peak else f" ({number(peak / self.peak)} times the record)"
        words = (
            f"Base motion {printable(self.name)}: {len(self.times)} samples over {format_quantity(self.times[-1], 'time', scales)}, linear in "
            f"between, at most {format_quantity(peak, 'acceleration', scales)}{scaled}{turned}, along axes of the fixed frame; times count from its first sample"
        )
        sizes = {"peak": (peak, "acceleration"), "duration": (self.times[-1], "time"), "angle": (angle, "")}
        return Echo(self.kind, words, sizes | {"factor": (peak / self.peak, "")})

    def up_to_words(self, before: float | None, scales: Scales | None) -> str:
        """See :meth:`carom.disturbances.Disturbance.up_to_words`."""
        return f"{super().up_to_words(before, scales)} ({printable(self.name)}, {format_quantity(self.peak, 'acceleration', scales)} as recorded)"


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
    kinds = dict.fromkeys("xy", "acceleration") | {"time": "time"}
    units = [
        read_size(f"{option} {name}", f"1 {each[2].strip()}", kinds[name], scales, bare=False).own(scales)
        for name, each in zip(names, found, strict=True)
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
