"""Histories of a motion as sensors would record them: evenly sampled over all stages, in SI units and in the fixed frame, and their files."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.base.arguments import checked
from carom.base.files import write_whole
from carom.base.outcome import InputError
from carom.models import Subject, rotor_of
from carom.motions.kinematics import race_speed, shaft_speed
from carom.motions.starts import Until
from carom.motions.storage import provenance
from carom.motions.tables import in_units
from carom.motions.trajectories import TOGETHER, Trajectory
from carom.parameters import own_time

if TYPE_CHECKING:
    import xarray

    from carom.parameters import Scales

PER_TURN = 100
"""Samples in a turn of the shaft, where no interval is given."""
MOST = 5_000_000
"""Most samples: more would be a typing error."""
FORMATS = (".csv", ".mat", ".nc")


def channels_of(
    motion: Trajectory, every: Until | None = None, nodes: Sequence[int] = (), machine: Subject | None = None
) -> xarray.Dataset:
    """Sample a motion over all its stages, as sensors would.

    Displacements at a touchdown bearing are relative to it (and to its mount), others are those of the shaft; ``x`` and ``y`` are those of the fixed
    frame.  The normal force on the shaft is positive inward, friction in the sense of rotation.  Control currents are those that their limits leave, without the bias currents that
    carry the weight; while levitation is lost they are ``nan``.

    Parameters
    ----------
    motion : Trajectory
    every : float or str, optional
        Interval, in ``1/Ω`` or text with a unit such as ``"50 us"``; by default a hundredth of a turn.
    nodes : sequence of int, optional
        Nodes of a flexible shaft, or stations of a rigid rotor, whose displacements are asked for.
    machine : Machine, Case or model, optional
        The machine of a drop: what falls does not know its magnetic bearings, sensors and nodes.

    Returns
    -------
    xarray.Dataset
        With the dimension ``time``, from the beginning; units as attributes, SI units where the machine is known, else those of the equations.

    Raises
    ------
    InputError
        The interval is no time, or makes too many samples; a node is not there.
    """
    import xarray

    rotor = motion.rotor if machine is None else rotor_of(machine)
    step = 2.0 * math.pi / PER_TURN if every is None else own_time("every", every, motion.rotor.scales)
    count = math.floor((motion.begins + motion.time) / step * (1.0 + 1e-12)) + 1
    if count > MOST:
        raise InputError("every", every, f"must make at most {MOST} samples; this one makes {count}")
    if nodes and rotor.finite_elements is None:
        raise InputError("nodes", nodes[0], "must be left out: this rotor has no nodes, or only its machine knows them")
    places = {} if rotor.finite_elements is None else rotor.finite_elements.places(nodes)
    if rotor.planar is not None and len(motion.rotor.system.rest) > 1:  # on a mount
        places = {"rotor": np.array([1.0, 0.0])}
    weight = rotor.acting.whole_weight if rotor.carried_by_bias else None
    currents = None if rotor.finite_elements is None else partial(rotor.finite_elements.currents, weight=weight)
    times, found = step * np.arange(count), list["xarray.Dataset"]()
    which = np.searchsorted([part.begins for part in motion.parts], times, side="right") - 1
    for number, part in enumerate(motion.parts):
        own = np.minimum(times[which == number] - part.begins, part.time)
        for first in range(0, len(own), TOGETHER):
            found.append(_sampled(part, own[first : first + TOGETHER], places, currents))
    time = in_units("time", times, "time", "time from the beginning", motion.rotor.scales)
    attributes = provenance(motion) | {
        "title": "Channels of a motion",
        "frame": "fixed",
        "interval": float(time[1][-1]) / max(count - 1, 1),
    }
    return xarray.concat(found, "time").assign_coords(time=time).assign_attrs(attributes)


def _sampled(
    part: Trajectory,
    times: np.ndarray,
    places: dict[str, np.ndarray],
    currents: Callable[[np.ndarray, np.ndarray], np.ndarray] | None,
) -> xarray.Dataset:
    """Channels of a stage at times (n,) of it."""
    import xarray

    system, whole, columns = part.rotor.system, part.rotor.scales, dict[str, object]()
    amplitudes, phases = part.amplitudes_at(times)
    turn = np.exp(1j * (part.begins + times))

    def add(name: str, values: np.ndarray, kind: str, words: str, scales: Scales | None = whole) -> None:
        columns[name] = in_units("time", values, kind, words, scales)

    def along_axes(name: str, both: np.ndarray, kind: str, words: str, scales: Scales | None = whole) -> None:
        for axis, values in (("x", both.real), ("y", both.imag)):
            add(f"{name}_{axis}", values, kind, f"{words}, along {axis}", scales)

    for seen in part.at_each:
        name, words = f"touchdown_{seen.plane + 1}", f"touchdown bearing {seen.plane + 1}"
        place = turn * system.at_plane(amplitudes, seen.plane)[0]
        along_axes(name, place, "length", f"displacement in {words}", seen.scales)
        for kind, force in zip(("normal", "friction"), seen.forces_of(amplitudes, phases, times), strict=True):
            add(f"{name}_{kind}_force", force, "force", f"{kind} force in {words}", seen.scales)
        if (race := part.rotor.races[seen.plane]) is not None:
            speed = race_speed(system, seen.plane, amplitudes) / race.radius
            add(f"{name}_race_speed", speed, "speed", f"speed of the race of {words}")
    add("shaft_speed", shaft_speed(system, amplitudes), "speed", "speed of the shaft")
    position, rate = (np.reshape(each, (len(times), -1)) * turn[:, None] for each in system.state(amplitudes))
    for name, row in places.items():
        along_axes(name, position @ row, "length", f"displacement at {name.replace('_', ' ')}")
    if currents is not None:
        known = currents(position, rate + 1j * position)
        if part.rotor.finite_elements is None:  # levitation is lost
            known = np.full_like(known, complex(np.nan, np.nan))
        for number, current in enumerate(known.T, start=1):
            words = f"control current of magnetic bearing {number}"
            along_axes(f"magnetic_bearing_{number}_current", current, "A", words)
    return xarray.Dataset(columns)


@checked
def write_channels(dataset: xarray.Dataset, path: str) -> None:
    """Write channels as CSV (``name [unit]`` in the headings), as MAT (with a structure ``units``) or as netCDF, by the ending of the path; completely or not at all.

    Raises
    ------
    InputError
        Another ending.
    OSError
        The file cannot be written.
    """
    names, buffer = ["time", *map(str, dataset.data_vars)], BytesIO()
    units = {name: str(dataset[name].attrs["units"]) for name in names}
    ending = Path(path).suffix.lower()
    if ending == ".csv":
        heading = ",".join(f"{name} [{unit}]" for name, unit in units.items())
        np.savetxt(
            buffer, np.column_stack([dataset[name] for name in names]), "%.12g", ",", header=heading, comments=""
        )
    elif ending == ".mat":
        from scipy.io import savemat  # type: ignore[import-untyped]

        savemat(buffer, {**{name: dataset[name].values for name in names}, "units": units}, oned_as="column")
    elif ending == ".nc":
        buffer.write(bytes(dataset.to_netcdf(engine="h5netcdf")))  # in memory: HDF5 crashes when the disk is full
    else:
        raise InputError("path", path, f"a file that ends in {', '.join(FORMATS)}")
    write_whole(Path(path), buffer.getvalue())
