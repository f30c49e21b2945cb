"""Contact logs as files, written completely or not at all."""

from __future__ import annotations

import csv
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.files import try_place, write_whole
from carom.outcome import InputError, Phase

if TYPE_CHECKING:
    import xarray

    from carom.motions.contacts import LastingContact
    from carom.motions.trajectories import Trajectory


def check_file(option: str, path: str) -> None:
    """Refuse early a path that cannot become a file."""
    target = Path(path)
    if not path.strip() or "\0" in path:
        raise InputError(option, path, "must be the path of a file to write")
    try:
        directory, special = target.is_dir(), target.exists() and not target.is_file()
        homeless = not target.parent.is_dir()
    except OSError as problem:
        raise InputError(option, path, f"must be the path of a file to write ({problem.strerror})") from None
    if directory:
        raise InputError(option, path, "must be the path of a file to write, not a directory")
    if homeless:
        raise InputError(option, path, "must lie in a directory that exists")
    if special:
        raise InputError(option, path, "must be a regular file: what is there is replaced as a whole")
    with _refusals(option, path):
        try_place(target)


def write_csv(motion: Trajectory, path: str) -> None:
    """Write impacts and lasting contacts at all touchdown bearings as CSV in order of time, in SI units if the machine is known.

    A lasting contact fills only ``kind``, ``time``, ``end`` and ``touchdown_bearing``.  Of walls that give way each contact is a row of its own
    table.
    """
    from carom.motions.contacts import yields

    table = _touches if yields(motion.rotor.system, motion.plane) else _impacts
    text = StringIO(newline="")
    writer = csv.writer(text)
    header, rows = table(motion)
    writer.writerow(header)
    writer.writerows(rows)
    with _refusals("--csv", path):
        write_whole(Path(path), text.getvalue().encode())


def _impacts(motion: Trajectory) -> tuple[list[str], list[list[object]]]:
    """Heading and rows of impacts and lasting contacts."""
    log = _log(motion)
    time_unit = log["time"].attrs["units"]
    rest = [column for name, column in log.items() if name != "time"]
    header = ["kind", f"time [{time_unit}]", f"end [{time_unit}]"]
    header += [f"{column.name} [{column.attrs['units']}]" for column in rest]
    rows: list[tuple[float, list[object]]] = []
    for time, *values in zip(log["time"].values.tolist(), *(column.values.tolist() for column in rest), strict=True):
        rows.append((time, ["impact", time, "", *values]))
    scale = _time_scale(motion)
    for bearing, contact in _lasting(motion):
        start, end = contact.start * scale, contact.end * scale
        # The bearing is the first column of the table of impacts after the time.
        row = [f"{contact.kind} ({contact.phase.label})", start, end, bearing, *[""] * (len(rest) - 1)]
        rows.append((start, row))

    return header, [row for _, row in sorted(rows, key=lambda entry: entry[0])]


def _touches(motion: Trajectory) -> tuple[list[str], list[list[object]]]:
    """Heading and rows of contacts with walls that give way."""
    table = _log(motion)
    rest = [column for name, column in table.items() if name != "phase"]
    header = ["kind", *(f"{column.name} [{column.attrs['units']}]" for column in rest)]
    kinds = [Phase(phase).label for phase in table["phase"].values.tolist()]
    return header, [[*row] for row in zip(kinds, *(column.values.tolist() for column in rest), strict=True)]


def _log(motion: Trajectory) -> xarray.Dataset:
    """Impacts, or contacts with walls that give way, of all stages and at all touchdown bearings, in order of time from the beginning."""
    import xarray

    logs = []
    for part in motion.parts:
        for seen in part.at_each:
            log = seen.log.to_dataset()
            for name in {"time", "start", "end", "peak_time"}.intersection(log):
                log[name].values += part.begins * _time_scale(part)
            logs.append(log)
    (dimension,) = logs[0].dims
    whole = xarray.concat(logs, dimension) if len(logs) > 1 else logs[0]
    order = np.argsort(whole["time" if "time" in whole else "start"].values, kind="stable")
    return whole.isel({dimension: order})


def _time_scale(motion: Trajectory) -> float:
    """Seconds of the unit of time, if known."""
    return motion.rotor.scales.time if motion.rotor.scales else 1.0


def _lasting(motion: Trajectory) -> list[tuple[int, LastingContact]]:
    """Lasting contacts of all stages, each with its touchdown bearing from 1, with times from the beginning."""
    return [
        (seen.plane + 1, replace(contact, start=part.begins + contact.start, end=part.begins + contact.end))
        for part in motion.parts
        for seen in part.at_each
        for contact in seen.lasting_contacts
    ]


def write_netcdf(motion: Trajectory, path: str) -> None:
    """Write impacts and lasting contacts as netCDF, in SI units if the machine is known."""
    content = bytes(_dataset(motion).to_netcdf(engine="h5netcdf"))  # in memory: HDF5 crashes when the disk is full
    with _refusals("--netcdf", path):
        write_whole(Path(path), content)


def _dataset(motion: Trajectory) -> xarray.Dataset:
    from carom.motions.contacts import NUMBERED, in_units, phase_flags

    scales, numbers = motion.rotor.scales, motion.rotor.numbers
    dataset, contacts = _log(motion), _lasting(motion)
    for name in ("start", "end"):
        times = np.array([getattr(contact, name) for _, contact in contacts], float)
        dataset[f"contact_{name}"] = in_units("contact", times, "time", f"{name} of lasting contact", scales)
    flags = phase_flags(phase for phase in Phase if phase is not Phase.FLIGHT)
    phases = np.array([contact.phase for _, contact in contacts], np.int8)
    bearings = np.array([bearing for bearing, _ in contacts], np.int64)
    dataset["contact_touchdown_bearing"] = in_units("contact", bearings, "1", NUMBERED, None)
    dataset["contact_phase"] = ("contact", phases, {"long_name": "kind of lasting contact", **flags})
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": "Contacts of a rotor with its touchdown bearings",
        "source": f"carom {version('carom')}",
        "outcome": motion.outcome.label,
        "comment": motion.outcome.meaning,
        "end_time": (motion.begins + motion.time) * _time_scale(motion),
        **(numbers or motion.rotor.attributes()),
    }
    return dataset


@contextmanager
def _refusals(option: str, path: str) -> Iterator[None]:
    """Turn errors of writing into errors of the option."""
    try:
        yield
    except OSError as problem:
        reason = os.strerror(problem.errno) if problem.errno else "this file system refuses"
        raise InputError(option, path, f"cannot be written ({reason}); give another path") from None
