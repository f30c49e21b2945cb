"""Endings of disturbances as a dataset with units, descriptions and provenance."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache, cached_property
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from carom.attractors import MotionName
from carom.base.arguments import checked
from carom.base.files import load_dataset, save_dataset
from carom.base.outcome import Outcome
from carom.base.results import Result, flags
from carom.disturbances import Disturbance, Grid, Plan, Sample, Starts
from carom.disturbances.coordinates import INSTANT
from carom.disturbances.following import NO_START
from carom.models import Rotor, exact_rotor_of, rotor_from
from carom.motions import Endings
from carom.parameters import Parameters, Scales

if TYPE_CHECKING:
    import xarray


def plan_of(document: Mapping[str, Any]) -> Plan:
    """Plan from its description in the attributes of a dataset; an unknown kind of disturbance is refused."""
    model = Disturbance.from_description(document["model"])
    if "cells" in document:
        return Grid(model, tuple(document["cells"]), document["instant"])
    return Sample(model, document["starts"], document["seed"])


@dataclass(frozen=True, eq=False, repr=False)
class Stored(Result):
    """Base of maps: a dataset whose attributes hold what is needed to repeat the computation."""

    needed: ClassVar[tuple[str, ...]] = ()

    dataset: xarray.Dataset

    @cached_property
    def rotor(self) -> Rotor:
        """Rotor of the machine."""
        return rotor_from(self.dataset.attrs)

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed, if known."""
        return self.rotor.scales

    @property
    def outcomes(self) -> np.ndarray:
        """Codes of :class:`~carom.base.outcome.Outcome`, −1 where there is no start."""
        return self.dataset["outcome"].values

    @property
    def exists(self) -> np.ndarray:
        """Which points have a start."""
        return self.outcomes != NO_START

    @cached_property
    def motions(self) -> tuple[MotionName, ...]:
        """Names of the motions on which they end, in the order of their index."""
        return tuple(map(MotionName.of, json.loads(self.dataset["motion"].attrs["motions"])))

    @property
    def parameters(self) -> Parameters:
        """Parameters of the machine, which must be a planar rotor; weight is none of them."""
        return self.rotor.planar or exact_rotor_of(self.rotor).parameters

    @checked
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a netCDF file atomically; see :func:`carom.base.files.save_dataset`."""
        save_dataset(self.dataset, path)

    @classmethod
    @checked
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a netCDF file written by :meth:`save`; refuse one that cannot be read or holds other results."""
        return cls(load_dataset(path, cls.needed))


class Mapped(Stored):
    """Base of basins and gain maps."""

    @cached_property
    def plan(self) -> Plan:
        """Disturbances that were tried, in units of this machine; with known scales they keep their size in SI units for others."""
        return plan_of(json.loads(self.dataset.attrs["disturbances"]))


def about(rotor: Rotor, title: str) -> dict[str, str]:
    """Attributes of a dataset about a rotor."""
    return {"Conventions": "CF-1.11", "title": title, "source": programs(), **rotor.attributes()}


def provenance(rotor: Rotor, plan: Plan) -> dict[str, str]:
    """Attributes that are needed to repeat the computation."""
    how: dict[str, object] = (
        {"cells": plan.shape, "instant": plan.instant}
        if isinstance(plan, Grid)
        else {"starts": plan.count, "seed": plan.seed}
    )
    tried = {"disturbances": json.dumps({"model": plan.model.describe(), **how})}
    return about(rotor, "Where disturbances of a rotor inside its touchdown bearing end") | tried


@cache
def programs() -> str:
    """What has made a dataset."""
    # Looking up a version takes milliseconds, as much as a small map.
    return f"carom {version('carom')}, numba {version('numba')}, numpy {version('numpy')}"


def dataset_of(
    rotor: Rotor,
    plan: Plan,
    starts: Starts,
    endings: Endings,
    motions: np.ndarray,
    names: tuple[MotionName, ...],
    attributes: Mapping[str, str],
) -> xarray.Dataset:
    """Endings as variables over the coordinates of their disturbances, each with unit and description."""
    import xarray

    axes, dimensions = _axes(rotor, plan)
    reached: dict[str, object] = {
        "long_name": "motion on which it ends",
        "flag_values": np.arange(len(names), dtype=np.int16),
        "flag_meanings": " ".join(name.replace(" ", "_") for name in names),
        "motions": json.dumps([asdict(name) for name in names]),
    }
    times = np.where(starts.exists, endings.times, np.nan)
    weights = np.where(starts.exists, plan.weights().reshape(starts.exists.shape), 0.0)
    multiplicities = endings.multiplicities.astype(np.int32)
    numbers = {
        "time": ("1/Omega", "time until it was known where the motion ends", times),
        "impacts": ("1", "impacts until then", endings.impacts),
        "touched": ("1", "1 where the rotor met the wall, else 0", _touched(starts, endings).astype(np.int8)),
        "multiplicity": ("1", "impacts in a period of bouncing; 0 otherwise (of bouncing: irregular)", multiplicities),
        "weight": ("1", "weight in shares: area of the cell, one on average over all cells", weights),
        "start_x": ("c_r", "position at the start, Re U", starts.positions.real),
        "start_y": ("c_r", "position at the start, Im U", starts.positions.imag),
        "start_vx": ("c_r Omega", "velocity at the start, Re dU/dt", starts.velocities.real),
        "start_vy": ("c_r Omega", "velocity at the start, Im dU/dt", starts.velocities.imag),
    }
    variables: dict[str, tuple[np.ndarray, dict[str, object]]] = {
        "outcome": (endings.outcomes, outcome_flags()),
        "motion": (motions, reached),
        **{name: (values, {"units": unit, "long_name": words}) for name, (unit, words, values) in numbers.items()},
    }
    if rotor.scales:
        variables["time"][1].update(si_units="s", si_factor=rotor.scales.time)
    if rotor.depends_on_instant:
        noted: dict[str, object] = {"units": INSTANT.units[0], "long_name": INSTANT.words}
        variables[INSTANT.name] = plan.instants().reshape(starts.exists.shape), noted
    # The starts of a rotor of several coordinates have one axis more.
    several = (*dimensions, "coordinate")
    return xarray.Dataset(
        {
            name: (several[: values.ndim], np.ascontiguousarray(values), notes)
            for name, (values, notes) in variables.items()
        },
        coords=axes,
        attrs=dict(attributes),
    )


def outcome_flags() -> dict[str, object]:
    """Attributes of outcomes of motions."""
    seen = [outcome for outcome in Outcome if outcome >= Outcome.TIME_REACHED or outcome == Outcome.GRAZING]
    codes, meanings = np.array([NO_START, *seen], np.int8), ["no_start", *(outcome.label for outcome in seen)]
    return {"long_name": "where the motion ends", **flags(codes, meanings)}


def _touched(starts: Starts, endings: Endings) -> np.ndarray:
    """Motions in which the rotor met the wall; one that settles there without an impact slides or rolls."""
    stays = endings.outcomes > Outcome.LEVITATED
    return starts.exists & (starts.touched | (endings.impacts > 0) | stays)


def _axes(rotor: Rotor, plan: Plan) -> tuple[dict[str, object], tuple[str, ...]]:
    """Coordinates of a dataset, including those in SI units, and its dimensions."""
    coordinates = plan.model.coordinates
    grid = isinstance(plan, Grid)
    axes: dict[str, object] = {}
    for coordinate, values in zip(coordinates, plan.values(), strict=True):
        along = (coordinate.name,) if grid else ("start",)
        unit, si = coordinate.units
        axes[coordinate.name] = (along, values, {"units": unit, "long_name": coordinate.words})
        if rotor.scales and coordinate.scale:
            notes = {"units": si, "long_name": coordinate.words}
            axes[f"{coordinate.name}_si"] = (along, values * coordinate.si(rotor.scales), notes)
    return axes, tuple(coordinate.name for coordinate in coordinates) if grid else ("start",)
