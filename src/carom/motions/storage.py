"""Motions as datasets: their course at chosen times for people, and their segments in a file, exact to the last bit."""

from __future__ import annotations

import json
import os
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.files import netcdf
from carom.models import model_from
from carom.motions.contacts import in_units, phase_flags
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.outcome import InputError, Outcome, Phase

if TYPE_CHECKING:
    import xarray

COMPLEX = ("segment_amplitudes", "arrivals")
SEGMENTS = ("segment_starts", "segment_phases", "event_planes", *COMPLEX)


def trajectory_dataset(motion: Trajectory, times: np.ndarray | None = None) -> xarray.Dataset:
    """Course of a motion: position, velocity, phase and contact forces at given times.

    Times are in ``1/Ω``, by default those of :meth:`Trajectory.sample`.  The dataset is in SI units where the scales are known,
    in the co-rotating frame, and describes the first contact plane.
    """
    times = motion.sample() if times is None else np.asarray(times, float)
    dataset = motion.history(times).to_dataset()
    position, velocity = motion.at_plane(times)
    for name, values, quantity, what in (
        ("x", position.real, "length", "position"),
        ("y", position.imag, "length", "position"),
        ("velocity_x", velocity.real, "velocity", "velocity"),
        ("velocity_y", velocity.imag, "velocity", "velocity"),
    ):
        words = f"{what} along {name[-1]}, co-rotating frame"
        dataset[name] = in_units("time", values, quantity, words, motion.scales)
    return dataset.assign_coords(time=dataset["time"]).assign_attrs(_provenance(motion), begins=motion.begins)


def save_trajectory(motion: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write a motion as netCDF, completely or not at all, so that :func:`load_trajectory` gives the same motion."""
    import xarray

    if motion.earlier:
        raise InputError("motion", f"{len(motion.parts)} stages", "a motion of one stage: save each of motion.parts")
    columns: dict[str, Any] = {
        "segment_starts": ("segment", motion.segment_starts, {"units": "1/Omega"}),
        "segment_phases": (("segment", "plane"), motion.segment_phases, phase_flags(Phase)),
        "event_planes": ("event", motion.event_planes),
        "segment_amplitudes": (("segment", "mode", "part"), _parts(motion.segment_amplitudes)),
        "arrivals": (("event", "mode", "part"), _parts(motion.arrivals)),
    }
    attributes = _provenance(motion) | {
        "start": json.dumps(_numbers(motion.start)),
        "final": json.dumps(_numbers(motion.final)),
        "begins": motion.begins,
        "end_time": motion.time,
        "multiplicity": motion.multiplicity,
        "plane": motion.plane,
    }
    netcdf.save(xarray.Dataset(columns, attrs=attributes), path)


def load_trajectory(path: str | os.PathLike[str]) -> Trajectory:
    """Read a motion that :func:`save_trajectory` has written; refuse a file that is damaged or holds no motion."""
    dataset = netcdf.load(path, SEGMENTS)
    attributes = dataset.attrs
    try:
        rotor = model_from(attributes)
        start, final = (_state(json.loads(attributes[name])) for name in ("start", "final"))
        outcome = Outcome[attributes["outcome"]]
    except (KeyError, TypeError, ValueError) as problem:
        raise InputError("file", str(path), f"must hold a motion that carom has written ({problem})") from None
    amplitudes, arrivals = (dataset[name].values[..., 0] + 1j * dataset[name].values[..., 1] for name in COMPLEX)
    return Trajectory(
        rotor=rotor,
        start=start,
        outcome=outcome,
        time=float(attributes["end_time"]),
        final=final,
        multiplicity=int(attributes["multiplicity"]),
        segment_starts=dataset["segment_starts"].values,
        segment_phases=dataset["segment_phases"].values,
        event_planes=dataset["event_planes"].values,
        segment_amplitudes=amplitudes,
        arrivals=arrivals,
        plane=int(attributes["plane"]),
        begins=float(attributes["begins"]),
    )


def _provenance(motion: Trajectory) -> dict[str, Any]:
    return {
        "Conventions": "CF-1.11",
        "title": "Motion of a rotor inside its touchdown bearing",
        "source": f"carom {version('carom')}",
        "outcome": motion.outcome.name,
        "comment": motion.outcome.meaning,
        **motion.rotor.attributes(),
    }


def _parts(values: np.ndarray) -> np.ndarray:
    """Real and imaginary parts along a last axis: netCDF has no complex numbers."""
    return np.stack([values.real, values.imag], axis=-1)


def _numbers(state: State) -> list[Any]:
    parts = state.position, state.velocity
    numbers = ([np.asarray(part).real.tolist(), np.asarray(part).imag.tolist()] for part in parts)
    return [*numbers, list(state.races), list(state.shaft), state.time]


def _state(numbers: list[Any]) -> State:
    position, velocity = (np.array(real) + 1j * np.array(imaginary) for real, imaginary in numbers[:2])
    races, shaft, *time = numbers[2:]
    return State.of(position, velocity, tuple(races), tuple(shaft), *time)
