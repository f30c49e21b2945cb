"""Measured displacements over time: read from a file, and refused where they are broken."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from carom.base.outcome import InputError, shown
from carom.base.results import Result
from carom.fitting.channels import IGNORED, KEYPHASOR, TIME, Channel
from carom.models import Rotor
from carom.parameters import Scales

FEWEST_SAMPLES, FEWEST_A_TURN = 20, 2.0
GAP = 1.5
"""Interval between samples, in usual ones, from which some are missing."""
CLIPPED = 4
"""Successive samples at the largest or smallest value from which a sensor is at its limit."""
FARTHEST, NEAREST = 30.0, 1e-3
"""Largest displacement of a record, in clearances, above and below which its unit is wrong."""
AGAINST = 3.0
"""Synchronous orbit against the turn of the shaft, in those with it, from which axes are swapped."""
_FORMATS = ".csv, .mat (MATLAB up to 7.2) or .nc"


@dataclass(frozen=True, eq=False, repr=False)
class Record(Result):
    """Displacements measured at equal intervals, in the fixed frame.

    Attributes
    ----------
    name : str
        Where it comes from.
    times : array, shape (m,)
        In s.
    values : array, shape (m, c)
        Displacements in m, along the direction of each channel.
    channels : tuple of Channel
        What the c columns are.
    marks : array, shape (k,), optional
        Times in s at which the mark of the shaft passed a key-phasor; ``None`` without one.
    """

    shown = ("name", "channels", "times", "values")

    name: str
    times: np.ndarray
    values: np.ndarray
    channels: tuple[Channel, ...]
    marks: np.ndarray | None = None

    def __post_init__(self) -> None:
        if not self.channels:
            raise InputError("columns", self.name, "at least one displacement, such as 'x [um]'")
        if len(self.times) < FEWEST_SAMPLES:
            raise InputError("samples", len(self.times), f"at least {FEWEST_SAMPLES}")
        whole = np.column_stack([self.times, self.values])
        if not np.isfinite(whole).all():
            row = int(np.flatnonzero(~np.isfinite(whole).all(axis=1))[0])
            raise InputError(
                "samples", f"no number in sample {row + 1}", "finite numbers; cut the record where it is complete"
            )
        steps = np.diff(self.times)
        usual = float(np.median(steps))
        if usual <= 0.0 or steps.min() <= 0.5 * usual:
            row = int(np.argmin(steps))
            raise InputError(
                "time",
                f"{self.times[row + 1]:.9g} s after {self.times[row]:.9g} s",
                "times that increase in equal steps; is the unit right?",
            )
        if steps.max() >= GAP * usual:
            row = int(np.argmax(steps))
            raise InputError(
                "time",
                f"gap from {self.times[row]:.9g} s to {self.times[row + 1]:.9g} s",
                f"steps of {usual:.6g} s; cut the record there",
            )
        for channel, column in zip(self.channels, self.values.T, strict=True):
            _refuse_clipped(channel, column)

    def check(self, rotor: Rotor) -> Scales:
        """The scales of a rotor; refuse a record that cannot be of a rotor: too few samples a turn, displacements far from the clearance, axes swapped."""
        scales = rotor.scales
        if scales is None:
            raise InputError("machine", shown(rotor), "a machine file in SI units, as records are in SI units")
        step, turn = float(np.median(np.diff(self.times))), 2.0 * np.pi / scales.speed
        if turn < FEWEST_A_TURN * step * (1.0 - 1e-9):
            raise InputError(
                "time",
                f"steps of {step:.4g} s",
                f"at least {FEWEST_A_TURN:g} samples a turn of the shaft, which takes {turn:.4g} s",
            )
        for channel, column in zip(self.channels, self.values.T, strict=True):
            size = float(np.abs(column - np.median(column)).max()) / scales.length
            if not NEAREST <= size <= FARTHEST:
                raise InputError(
                    channel.text,
                    f"up to {1e6 * size * scales.length:.4g} um",
                    f"{NEAREST:g} to {FARTHEST:g} of the clearance, {1e6 * scales.length:.4g} um; is the unit right?",
                )
        self._refuse_swapped(rotor, scales.speed)
        return scales

    def _refuse_swapped(self, rotor: Rotor, speed: float) -> None:
        """Refuse channels at a right angle whose synchronous orbit turns against the shaft, of a rotor whose does not."""
        if rotor.is_anisotropic:
            return
        for place in {(each.place, each.number) for each in self.channels}:
            chosen = [number for number, each in enumerate(self.channels) if (each.place, each.number) == place]
            if len(chosen) != 2:
                continue
            first, second = (self.channels[number].direction for number in chosen)
            if abs(np.cos(first - second)) > 0.5:
                continue
            orbit = np.linalg.solve(
                [[np.cos(each), np.sin(each)] for each in (first, second)], self.values[:, chosen].T
            )
            plane = orbit[0] + 1j * orbit[1]
            forward, backward, third = (abs(_component(self.times, plane, sign * speed)) for sign in (1.0, -1.0, 1.5))
            if backward > AGAINST * max(forward, third):
                texts = " and ".join(self.channels[number].text for number in chosen)
                raise InputError(
                    "columns",
                    texts,
                    "an orbit that turns with the shaft at its speed; they are swapped, or one has the wrong sign",
                )


def _component(times: np.ndarray, values: np.ndarray, speed: float) -> complex:
    """Amplitude of a component that turns at a speed, of values without their mean."""
    window = np.hanning(len(times))
    return complex((window * (values - values.mean()) * np.exp(-1j * speed * times)).sum() / window.sum())


def _refuse_clipped(channel: Channel, column: np.ndarray) -> None:
    """Refuse a channel that stays at its largest or smallest value for several samples, more than once."""
    if np.ptp(column) == 0.0:
        raise InputError(channel.text, f"{column[0]:.6g} m throughout", "a channel that changes")
    for limit in (column.max(), column.min()):
        at = np.flatnonzero(np.diff(np.concatenate([[0], column == limit, [0]])))
        if np.any(at[1::2] - at[::2] >= CLIPPED):
            raise InputError(
                channel.text,
                f"{limit:.6g} m for {CLIPPED} samples and more",
                "a sensor within its range; this one is clipped",
            )


def read_record(path: str | os.PathLike[str], columns: str | None = None) -> Record:
    """Read a record from a CSV, MATLAB or netCDF file.

    Parameters
    ----------
    path : str or path
        A CSV file with a heading, a MATLAB file of vectors of one length, or a netCDF file.
    columns : str, optional
        What the columns are, such as ``"time [s], x [um], y at bearing 2 [um]"``, in their order; by name where they have names,
        ``"t = time [s], probe1 = 45 deg [um]"``.  By default their names say so.

    Raises
    ------
    InputError
        The file cannot be read, or the record is broken: gaps, clipped sensors, too few samples.
    """
    source = Path(path)
    try:
        data = _columns_of(source)
    except (OSError, ValueError, KeyError, NotImplementedError) as problem:
        raise InputError("record", shown(str(source)), f"a file {_FORMATS} ({problem})") from None
    texts = _declared(data, columns)
    lengths = {len(data[name]) for name in texts}
    if len(lengths) > 1:
        raise InputError("record", shown(str(source)), f"columns of one length, not {sorted(lengths)}")
    channels = {name: Channel.read(text) for name, text in texts.items()}
    times = [channel.factor * data[name] for name, channel in channels.items() if channel.what == TIME]
    if len(times) != 1:
        raise InputError("columns", ", ".join(texts.values()), "one column of times, such as 'time [s]'")
    pulses = [data[name] for name, channel in channels.items() if channel.what == KEYPHASOR]
    shown_by = {name: each for name, each in channels.items() if each.what not in (TIME, KEYPHASOR, IGNORED)}
    values = np.array([shown_by[name].factor * data[name] for name in shown_by]).T.reshape(len(times[0]), -1)
    marks = _marks(times[0], pulses[0]) if pulses else None
    return Record(source.name, times[0], values, tuple(shown_by.values()), marks)


def _columns_of(source: Path) -> dict[str, np.ndarray]:
    """Columns of a file by their names."""
    if source.suffix == ".mat":
        from scipy.io import loadmat  # type: ignore[import-untyped]

        found = {name: np.squeeze(each) for name, each in loadmat(source).items() if not name.startswith("__")}
        plain = {
            name: each for name, each in found.items() if isinstance(each, np.ndarray) and each.dtype.kind in "iuf"
        }
        return {
            f"{name}_{number}" if each.ndim == 2 else name: np.asarray(column, float)
            for name, each in plain.items()
            for number, column in enumerate(each.T if each.ndim == 2 else [each], start=1)
        }
    if source.suffix == ".nc":
        import xarray

        with xarray.open_dataset(source) as opened:
            units = {name: str(each.attrs.get("units", "")) for name, each in opened.variables.items()}
            return {
                f"{name} [{units[name]}]" if units[name] else str(name): np.asarray(each.values, float)
                for name, each in opened.variables.items()
                if each.ndim == 1
            }
    if source.suffix != ".csv":
        raise ValueError(f"{source.suffix or 'no suffix'} is none of these")
    with source.open(encoding="utf-8-sig", newline="") as opened:
        lines = [line for line in csv.reader(opened) if line]
    heading, rows = [each.strip() for each in lines[0]], lines[1:]
    if any(len(row) != len(heading) for row in rows):
        number = next(n for n, row in enumerate(rows, start=2) if len(row) != len(heading))
        raise ValueError(f"line {number} has not {len(heading)} entries")
    return {name: np.array([float(row[n] or "nan") for row in rows]) for n, name in enumerate(heading)}


def _declared(data: Mapping[str, np.ndarray], columns: str | None) -> dict[str, str]:
    """What each used column of a file is, by its name."""
    if columns is None:
        return {name: name for name in data}
    given = [each.strip() for each in columns.split(",")]
    if all("=" in each for each in given):
        pairs = {name.strip(): text.strip() for name, text in (each.split("=", 1) for each in given)}
        if unknown := [name for name in pairs if name not in data]:
            raise InputError("columns", shown(unknown[0]), f"a column of the file: {', '.join(data)}")
        return pairs
    if len(given) != len(data):
        raise InputError(
            "columns", f"{len(given)} declared", f"one for each of the {len(data)} columns: {', '.join(data)}"
        )
    return dict(zip(data, given, strict=True))


def _marks(times: np.ndarray, pulses: np.ndarray) -> np.ndarray:
    """Times at which the pulses of a key-phasor rise through the middle of their range."""
    level = 0.5 * (pulses.min() + pulses.max())
    before = np.flatnonzero((pulses[:-1] < level) & (pulses[1:] >= level))
    share = (level - pulses[before]) / (pulses[before + 1] - pulses[before])
    found: np.ndarray = times[before] + share * (times[before + 1] - times[before])
    return found
