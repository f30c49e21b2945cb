"""Motions in files: their segments, exact to the last bit."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.base.files import load_dataset, save_dataset
from carom.base.outcome import InputError, Outcome, Phase
from carom.models import rotor_from
from carom.motions.starts import State
from carom.motions.tables import phase_flags
from carom.motions.trajectories import SEGMENTS, Trajectory

if TYPE_CHECKING:
    import xarray

COMPLEX = ("segment_amplitudes", "event_amplitudes")
ATTRIBUTES = {"segment_starts": {"units": "1/Omega"}, "segment_phases": phase_flags(Phase)}
NUMBERS = {"time": float, "multiplicity": int, "plane": int, "begins": float}


def save_trajectory(motion: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write a motion as netCDF, completely or not at all, so that :func:`load_trajectory` gives the same motion.

    Each of its stages has dimensions, variables and attributes of its own, those after the first with its number.
    """
    import xarray

    columns: dict[str, object] = {}
    attributes: dict[str, object] = {"parts": len(motion.parts)}
    for number, part in enumerate(motion.parts):
        mark = _mark(number)
        for name, dimensions in SEGMENTS.items():
            values, own = getattr(part, name), [f"{each}{mark}" for each in dimensions.split()]
            if name in COMPLEX:  # netCDF has no complex numbers
                values, own = np.stack([values.real, values.imag], axis=-1), [*own, "part"]
            columns[f"{name}{mark}"] = own, values, ATTRIBUTES.get(name, {})
        shown = provenance(part) | {name: getattr(part, name) for name in NUMBERS}
        shown |= {name: json.dumps(_numbers(getattr(part, name))) for name in ("start", "final")}
        attributes |= {f"{name}{mark}": value for name, value in shown.items()}
    save_dataset(xarray.Dataset(columns, attrs=attributes), path)


def _mark(number: int) -> str:
    """What names of a stage end with."""
    return f"_{number + 1}" if number else ""


def load_trajectory(path: str | os.PathLike[str]) -> Trajectory:
    """Read a motion that :func:`save_trajectory` has written; refuse a file that is damaged or holds no motion."""
    dataset = load_dataset(path, tuple(SEGMENTS))
    try:
        parts = tuple(_stage(dataset, _mark(number)) for number in range(int(dataset.attrs["parts"])))
    except (KeyError, TypeError, ValueError) as problem:
        raise InputError("file", str(path), f"must hold a motion that carom has written ({problem})") from None
    return replace(parts[-1], earlier=parts[:-1])


def _stage(dataset: xarray.Dataset, mark: str) -> Trajectory:
    """One stage of a motion, whose names end with a mark."""
    shown = {name.removesuffix(mark): value for name, value in dataset.attrs.items() if name.endswith(mark)}
    fields: dict[str, Any] = {name: dataset[f"{name}{mark}"].values for name in SEGMENTS}
    fields |= {name: fields[name][..., 0] + 1j * fields[name][..., 1] for name in COMPLEX}
    fields |= {name: kind(shown[name]) for name, kind in NUMBERS.items()}
    fields |= {name: _state(shown[name]) for name in ("start", "final")}
    return Trajectory(rotor=rotor_from(shown), outcome=Outcome[shown["outcome"]], **fields)


def provenance(motion: Trajectory) -> dict[str, object]:
    """Where a dataset of a motion comes from, and how it ended."""
    return {
        "Conventions": "CF-1.11",
        "title": "Motion of a rotor inside its touchdown bearing",
        "source": f"carom {version('carom')}",
        "outcome": motion.outcome.name,
        "comment": motion.outcome.meaning,
        **motion.rotor.attributes(),
    }


def _numbers(state: State) -> list[object]:
    parts = state.position, state.velocity
    numbers = ([np.asarray(part).real.tolist(), np.asarray(part).imag.tolist()] for part in parts)
    return [*numbers, list(state.races), list(state.shaft), state.time]


def _state(text: str) -> State:
    *parts, races, shaft, time = json.loads(text)
    position, velocity = (np.array(real) + 1j * np.array(imaginary) for real, imaginary in parts)
    return State.of(position, velocity, tuple(races), tuple(shaft), time)
