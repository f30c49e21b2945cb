"""Follow disturbances to where they end."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.attractors import document_of, follow_out
from carom.basins.motions import name_motions
from carom.basins.shares import Share
from carom.disturbances import (
    MODELS,
    Coordinate,
    Grid,
    Plan,
    Sample,
    Starts,
    StateSlice,
)
from carom.ensembles import MOST_EVENTS, Endings, settle_all
from carom.outcome import InputError, Outcome
from carom.parameters import Parameters, Scales
from carom.rotors import Rotor, jeffcott
from carom.settling import PATIENCE, longest_time

if TYPE_CHECKING:
    import os

    import xarray

__all__ = ["NO_START", "Basin", "basins", "follow", "plan_of", "provenance"]

NO_START = -1
"""Flag of a grid point that is no start: outside the wall, or where the rotor could not levitate before."""
CRITERIA = (
    "levitated: the moduli of the modes leave no later flight room to reach the wall (proof). "
    "forward_rub: slides in a neighbourhood of the synchronous rub where all sliding goes over to that rub (proof), or "
    "within 1e-9 of the rub, or forward by the next criterion. "
    "rolling: whirls backward faster than the speed from which it surely goes over to rolling (proof), or by the next "
    "criterion. backward_whirl: after a turn along the wall without flight the state has changed by less than 1e-9. "
    "bouncing, mixed: the state at an impact recurs to within 1e-9 twice in a row (multiplicity: impacts a period), or "
    "has not recurred in {patience} impacts (multiplicity 0: irregular; where such motion was seen to end, it was followed on). "
    "grazing: double precision cannot decide. time_reached, event_limit: not settled by {until:g}/Omega or {events} "
    "events. Criteria not called a proof are evidence."
)


@dataclass(frozen=True, eq=False)
class Basin:
    """Where each of many disturbances ends.

    Attributes
    ----------
    dataset : xarray.Dataset
        Dimensions are the coordinates of a grid, or ``start``.  Variables: ``outcome``
        (:class:`~carom.outcome.Outcome`, −1 where there is no start), ``motion`` (index of the name of the motion),
        ``time`` until that was known, ``impacts`` until then, ``touched`` (whether the rotor met the wall, if only
        during a shock or because it started there), ``multiplicity`` (impacts a period), and the starts
        ``start_x``, ``start_y``, ``start_vx``, ``start_vy`` in the co-rotating frame.  Lengths in ``c_r``, times in
        ``1/Ω``; coordinates ending in ``_si`` are there where the machine is known.  Attributes hold what it takes to
        do it again: parameters, disturbance, seed, criteria, versions.
    """

    dataset: xarray.Dataset

    @cached_property
    def parameters(self) -> Parameters:
        """Of the machine."""
        numbers = json.loads(self.dataset.attrs["parameters"])
        scales = json.loads(self.dataset.attrs["scales"])
        return Parameters(**numbers, scales=Scales(**scales) if scales else None)

    @cached_property
    def rotor(self) -> Rotor:
        """The machine."""
        return jeffcott(self.parameters)

    @cached_property
    def plan(self) -> Plan:
        """Disturbances that were tried."""
        return plan_of(json.loads(self.dataset.attrs["disturbances"]))

    @property
    def scales(self) -> Scales | None:
        """Mass, clearance and speed, if known."""
        return self.parameters.scales

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """What the disturbances vary with."""
        return self.plan.model.coordinates

    @property
    def outcomes(self) -> np.ndarray:
        """Codes of :class:`~carom.outcome.Outcome`, −1 where there is no start."""
        outcomes: np.ndarray = self.dataset["outcome"].values
        return outcomes

    @property
    def exists(self) -> np.ndarray:
        """Which points of the plan are starts."""
        exists: np.ndarray = self.outcomes != NO_START
        return exists

    @property
    def recovered(self) -> np.ndarray:
        """Which come back to levitation for good."""
        recovered: np.ndarray = self.outcomes == Outcome.LEVITATED
        return recovered

    @property
    def touched(self) -> np.ndarray:
        """In which of them the rotor met the wall."""
        touched: np.ndarray = self.dataset["touched"].values > 0
        return touched

    @property
    def resolved(self) -> np.ndarray:
        """Of which it is known where they end."""
        resolved: np.ndarray = self.outcomes >= Outcome.LEVITATED
        return resolved

    @property
    def irregular(self) -> dict[str, Any] | None:
        """How long irregular bouncing lasts that was met, as in JSON; ``None`` if none of the starts came to any."""
        found: dict[str, Any] | None = json.loads(self.dataset.attrs["irregular"])
        return found

    @property
    def starts(self) -> int:
        """How many starts were followed."""
        return int(self.exists.sum())

    @property
    def unresolved(self) -> int:
        """Starts that were given up."""
        return int((self.exists & ~self.resolved).sum())

    @property
    def motions(self) -> tuple[str, ...]:
        """Names of the motions, in the order of their index."""
        return tuple(json.loads(self.dataset["motion"].attrs["names"]))

    @property
    def fractions(self) -> dict[str, float]:
        """Share of the starts that end on each motion, the largest first; unresolved ones last."""
        index = self.dataset["motion"].values
        shares = {name: float((index == place).sum()) / self.starts for place, name in enumerate(self.motions)}
        order = sorted(shares, key=lambda name: (name.startswith("unresolved"), -shares[name]))
        return {name: shares[name] for name in order}

    @property
    def share_recovered(self) -> Share:
        """Share that comes back to levitation; starts given up count as lost."""
        return Share.of(int(self.recovered.sum()), self.starts, drawn=isinstance(self.plan, Sample))

    def share_of(self, motion: str) -> Share:
        """Share of the starts that end on a motion.

        Raises
        ------
        InputError
            No start does.
        """
        if motion not in self.motions:
            raise InputError("motion", motion, f"one of: {', '.join(self.motions)}")
        count = int((self.dataset["motion"].values == self.motions.index(motion)).sum())
        return Share.of(count, self.starts, drawn=isinstance(self.plan, Sample))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a netCDF file, whole or not at all; see :func:`carom.basins.store.save`."""
        from carom.basins.store import save

        save(self.dataset, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Basin:
        """Read a netCDF file written by :meth:`save`.

        Raises
        ------
        InputError
            It cannot be read, or holds no basin.
        """
        from carom.basins.store import load

        return cls(load(path, ("outcome", "motion", "time", "touched")))


def basins(
    rotor: Rotor,
    disturbances: Plan,
    *,
    until: float | None = None,
    patience: int = PATIENCE,
    max_events: int = MOST_EVENTS,
    threads: int | None = None,
    source: Mapping[str, str] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Basin:
    """Follow disturbances to where they end.

    Parameters
    ----------
    rotor : Rotor
    disturbances : Grid or Sample
        Of a model of :mod:`carom.disturbances`.
    until : float
        Time after which a motion that has not settled is given up, in ``1/Ω``; by default
        :func:`~carom.settling.longest_time`.
    patience : int
        Impacts without recurrence after which bouncing counts as irregular.
    max_events : int
        Impacts and steps of lasting contact after which a motion is given up.
    threads : int, optional
        By default as many as there are cores; the result does not depend on it.
    source : mapping of str to str, optional
        More to note about where the machine comes from, such as its file; becomes attributes of the dataset.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    Basin
        The same, bit for bit, for the same arguments.

    Raises
    ------
    InputError
        None of the disturbances is possible: a rotor that cannot levitate cannot be kicked out of levitation.
    """
    starts = disturbances.starts(rotor)
    until = longest_time(rotor) if until is None else until
    endings = follow(
        rotor,
        starts,
        until=until,
        patience=patience,
        max_events=max_events,
        threads=threads,
        progress=progress,
    )
    endings, survival = follow_out(rotor, endings, impacts=patience, threads=threads)
    outcomes = np.where(starts.undecided, Outcome.GRAZING, endings.outcomes)
    outcomes = np.where(starts.exists, outcomes, NO_START).astype(np.int8)
    motions, names = name_motions(rotor, outcomes, endings)
    attributes = {
        **(source or {}),
        **provenance(rotor, disturbances),
        "irregular": json.dumps(document_of(survival) if survival else None),
        "criteria": CRITERIA.format(patience=patience, until=until, events=max_events),
    }
    return Basin(_dataset(rotor, disturbances, starts, endings, outcomes, motions, names, attributes))


def follow(rotor: Rotor, starts: Starts, **limits: Any) -> Endings:
    """Where all starts end; those that do not exist, or are undecided, are not followed and have zeros everywhere.

    Raises
    ------
    InputError
        None of them exists.
    """
    if not starts.exists.any():
        raise InputError(
            "disturbance",
            f"|U*| = {abs(rotor.equilibrium):.6g}",
            "one that is possible: out of levitation inside the wall (|U*| < 1), or a start inside the wall",
        )
    chosen = starts.exists & ~starts.undecided
    found = settle_all(rotor, starts.positions[chosen], starts.velocities[chosen], **limits)
    whole = {}
    for name, values in vars(found).items():
        whole[name] = np.zeros(chosen.shape, values.dtype)
        whole[name][chosen] = values
    return Endings(**whole)


def plan_of(document: Mapping[str, Any]) -> Plan:
    """Plan from its description in the attributes of a dataset.

    Raises
    ------
    InputError
        A kind of disturbance that does not exist.
    """
    numbers = dict(document["model"])
    kind = numbers.pop("kind")
    if kind not in MODELS:
        raise InputError("disturbance", kind, f"one of: {', '.join(MODELS)}")
    if kind == StateSlice.kind:
        numbers["velocity"] = complex(*numbers["velocity"])
    model = MODELS[kind](**numbers)
    if "cells" in document:
        return Grid(model, tuple(document["cells"]))
    return Sample(model, document["starts"], document["seed"])


def provenance(rotor: Rotor, plan: Plan) -> dict[str, str]:
    """What it takes to do it again."""
    scales = rotor.scales
    how: dict[str, object] = (
        {"cells": plan.shape} if isinstance(plan, Grid) else {"starts": plan.count, "seed": plan.seed}
    )
    return {
        "Conventions": "CF-1.11",
        "title": "Where disturbances of a rotor inside its touchdown bearing end",
        "source": f"carom {version('carom')}, numba {version('numba')}, numpy {version('numpy')}",
        "parameters": json.dumps(rotor.parameters.as_dict()),
        "scales": json.dumps(
            {name: getattr(scales, name) for name in ("mass", "clearance", "speed")} if scales else None
        ),
        "disturbances": json.dumps({"model": plan.model.describe(), **how}),
    }


def _dataset(
    rotor: Rotor,
    plan: Plan,
    starts: Starts,
    endings: Endings,
    outcomes: np.ndarray,
    motions: np.ndarray,
    names: tuple[str, ...],
    attributes: Mapping[str, str],
) -> xarray.Dataset:
    import xarray

    codes = [
        NO_START,
        *(outcome for outcome in Outcome if outcome >= Outcome.TIME_REACHED or outcome == Outcome.GRAZING),
    ]
    meanings = ["no_start", *(Outcome(code).label.replace("-", "_") for code in codes[1:])]
    axes, dimensions = _axes(rotor, plan)
    time: dict[str, object] = {"units": "1/Omega", "long_name": "time until it was known where the motion ends"}
    if rotor.scales:
        time |= {"si_units": "s", "si_factor": rotor.scales.time}
    length, speed = {"units": "c_r"}, {"units": "c_r Omega"}
    variables = {
        "outcome": (
            outcomes,
            {
                "long_name": "where the motion ends",
                "flag_values": np.array(codes, np.int8),
                "flag_meanings": " ".join(meanings),
            },
        ),
        "motion": (
            motions,
            {
                "long_name": "motion on which it ends",
                "flag_values": np.arange(len(names), dtype=np.int16),
                "flag_meanings": " ".join(name.replace(" ", "_") for name in names),
                "names": json.dumps(names),
            },
        ),
        "time": (np.where(starts.exists, endings.times, np.nan), time),
        "impacts": (endings.impacts, {"units": "1", "long_name": "impacts until then"}),
        "touched": (
            _touched(starts, endings, outcomes).astype(np.int8),
            {"units": "1", "long_name": "1 where the rotor met the wall, else 0"},
        ),
        "multiplicity": (
            endings.multiplicities.astype(np.int32),
            {"units": "1", "long_name": "impacts in a period of bouncing; 0 otherwise (of bouncing: irregular)"},
        ),
        "start_x": (starts.positions.real, {**length, "long_name": "position at the start, Re U"}),
        "start_y": (starts.positions.imag, {**length, "long_name": "position at the start, Im U"}),
        "start_vx": (starts.velocities.real, {**speed, "long_name": "velocity at the start, Re dU/dt"}),
        "start_vy": (starts.velocities.imag, {**speed, "long_name": "velocity at the start, Im dU/dt"}),
    }
    return xarray.Dataset(
        {name: (dimensions, np.ascontiguousarray(values), notes) for name, (values, notes) in variables.items()},
        coords=axes,
        attrs=dict(attributes),
    )


def _touched(starts: Starts, endings: Endings, outcomes: np.ndarray) -> np.ndarray:
    """In which motions the rotor met the wall; what settles there without an impact slides or rolls there."""
    stays = outcomes > Outcome.LEVITATED
    touched: np.ndarray = starts.exists & (starts.touched | (endings.impacts > 0) | stays)
    return touched


def _axes(rotor: Rotor, plan: Plan) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Coordinates of a dataset, those in SI too, and its dimensions."""
    coordinates = plan.model.coordinates
    grid = isinstance(plan, Grid)
    axes: dict[str, Any] = {}
    for coordinate, values in zip(coordinates, plan.values(), strict=True):
        along = (coordinate.name,) if grid else ("start",)
        unit = _UNITS[coordinate.scale]
        axes[coordinate.name] = (along, values, {"units": unit, "long_name": coordinate.words})
        if rotor.scales and coordinate.scale:
            notes = {"units": coordinate.unit, "long_name": coordinate.words}
            axes[f"{coordinate.name}_si"] = (along, values * coordinate.si(rotor.scales), notes)
    return axes, tuple(coordinate.name for coordinate in coordinates) if grid else ("start",)


_UNITS = {"": "rad", "velocity": "c_r Omega", "length": "c_r", "acceleration": "c_r Omega^2", "time": "1/Omega"}
