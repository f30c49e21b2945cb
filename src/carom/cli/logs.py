"""Contact logs: as rows, and as files that are written completely or not at all."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from importlib.metadata import version
from io import StringIO
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.base.files import try_place, write_whole
from carom.base.outcome import InputError, Phase

if TYPE_CHECKING:
    import xarray

    from carom.motions.kinematics import LastingContact
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Case


def check_file(option: str, path: str) -> None:
    """Refuse early a path that cannot become a file."""
    target, allowed = Path(path), "must be the path of a file to write, in a directory that exists"
    try:
        named = path.strip() and "\0" not in path and target.parent.is_dir()
        fits = named and (target.is_file() or not target.exists())  # what is there is replaced as a whole
    except OSError as problem:
        raise InputError(option, path, f"{allowed} ({problem.strerror})") from None
    if not fits:
        raise InputError(option, path, allowed)
    with _refusals(option, path):
        try_place(target)


def history_writer(
    case: Case, file: str | None, every: str | None, nodes: str | None
) -> Callable[[Trajectory], None] | None:
    """Read ``--history`` with its options, and return what writes the histories of a motion; ``None`` without it."""
    from carom.cli.starts import read_positive, refuse
    from carom.motions.channels import FORMATS

    if file is None:
        refuse("allowed only with --history FILE", every=every, nodes=nodes)
        return None
    check_file("--history", file)
    if Path(file).suffix.lower() not in FORMATS:
        raise InputError("--history", file, f"must end in {', '.join(FORMATS)}")
    numbers = [each.strip() for each in nodes.split(",")] if nodes else []
    if not all(map(str.isdecimal, numbers)):
        raise InputError("--nodes", nodes, "must be numbers of nodes with commas between them, such as 0,5,11")
    step = None if every is None else read_positive("--every", every, "time", case.parameters.scales)

    def write(motion: Trajectory) -> None:
        from carom.motions import write_channels

        with _refusals("--history", file):
            write_channels(motion.channels(step, [int(each) for each in numbers], case), file)

    return write


def contact_rows(parts: Sequence[Trajectory]) -> tuple[dict[str, str], list[dict[str, object]]]:
    """Units of the columns of a log by their names, and a row for each contact, impacts among them, of some stages in order of time.

    Numbers are in SI units if the machine is known.  A stretch of lasting contact at a rigid touchdown bearing fills only ``kind``, ``phase``,
    ``time``, ``end`` and ``touchdown_bearing``.
    """
    log, scale = _log(parts), _time_scale(parts[-1])
    units = {str(name): values.attrs.get("units", "1") for name, values in log.items()}
    rows = [
        dict(zip(units, row, strict=True)) for row in zip(*(each.values.tolist() for each in log.values()), strict=True)
    ]
    rows = [row | {"kind": "impact" if math.isnan(row["peak_force"]) else Phase(row["phase"]).label} for row in rows]
    for bearing, each in _lasting(parts):
        if not parts[-1].at_each[bearing - 1].is_compliant:
            kind = {"kind": f"{each.kind} ({each.phase.label})", "phase": each.phase, "touchdown_bearing": bearing}
            rows.append(kind | {"time": each.start * scale, "end": each.end * scale})
    return units, sorted(rows, key=itemgetter("time"))


def write_csv(motion: Trajectory, path: str) -> None:
    """Write contacts at all touchdown bearings as CSV, by :func:`contact_rows`."""
    units, rows = contact_rows(motion.parts)
    names = [name for name in units if name != "phase"]
    text = StringIO(newline="")
    csv.writer(text).writerow(["kind", *(f"{name} [{units[name]}]" for name in names)])
    csv.DictWriter(text, ["kind", *names], restval="", extrasaction="ignore").writerows(rows)
    with _refusals("--csv", path):
        write_whole(Path(path), text.getvalue().encode())


def _log(parts: Sequence[Trajectory]) -> xarray.Dataset:
    """Contacts of some stages and at all touchdown bearings, in order of time from the beginning."""
    import xarray

    logs = []
    for part in parts:
        for seen in part.at_each:
            log = seen.contacts.to_dataset()
            for name in ("time", "end", "peak_time"):
                log[name].values += part.begins * _time_scale(part)
            logs.append(log)
    whole = xarray.concat(logs, "contact") if len(logs) > 1 else logs[0]
    return whole.isel(contact=np.argsort(whole["time"].values, kind="stable"))


def _time_scale(motion: Trajectory) -> float:
    """Seconds of the unit of time, if known."""
    return motion.rotor.scales.time if motion.rotor.scales else 1.0


def _lasting(parts: Sequence[Trajectory]) -> list[tuple[int, LastingContact]]:
    """Lasting contacts of some stages, each with its touchdown bearing from 1, with times from the beginning."""
    return [
        (seen.plane + 1, replace(contact, start=part.begins + contact.start, end=part.begins + contact.end))
        for part in parts
        for seen in part.at_each
        for contact in seen.lasting_contacts
    ]


def write_netcdf(motion: Trajectory, path: str) -> None:
    """Write contacts and stretches of lasting contact as netCDF, in SI units if the machine is known."""
    content = bytes(_dataset(motion).to_netcdf(engine="h5netcdf"))  # in memory: HDF5 crashes when the disk is full
    with _refusals("--netcdf", path):
        write_whole(Path(path), content)


def _dataset(motion: Trajectory) -> xarray.Dataset:
    from carom.motions.tables import NUMBERED, in_units, phase_flags

    scales, numbers = motion.rotor.scales, motion.rotor.numbers
    dataset, contacts = _log(motion.parts), _lasting(motion.parts)
    for name in ("start", "end"):
        times = np.array([getattr(contact, name) for _, contact in contacts], float)
        dataset[f"lasting_{name}"] = in_units("lasting", times, "time", f"{name} of lasting contact", scales)
    flags = phase_flags(phase for phase in Phase if phase is not Phase.FLIGHT)
    phases = np.array([contact.phase for _, contact in contacts], np.int8)
    bearings = np.array([bearing for bearing, _ in contacts], np.int64)
    dataset["lasting_touchdown_bearing"] = in_units("lasting", bearings, "1", NUMBERED, None)
    dataset["lasting_phase"] = ("lasting", phases, {"long_name": "kind of lasting contact", **flags})
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
