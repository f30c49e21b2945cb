"""Disturbances followed to where they end, many at once, of one machine or of several."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from carom.base.outcome import InputError, Outcome
from carom.disturbances.coordinates import Starts
from carom.disturbances.model import Disturbance
from carom.models import Rotor
from carom.motions.ensembles import Endings, settle
from carom.motions.starts import State

NO_START = -1
"""Outcome of a disturbance without a start: it lies outside the wall, or the rotor could not levitate before."""


def follow(
    machine: Rotor | Sequence[Rotor], starts: Starts, *, which: np.ndarray | None = None, **limits: Any
) -> Endings:
    """Follow all starts that exist and from which a motion goes on.

    With several machines ``which`` has the index of the machine of each start; starts after a disturbance that changes the machine have their own.  Limits and endings are those of
    :func:`~carom.motions.ensembles.settle`; endings have the shape of the starts.  The outcome is ``NO_START`` where there
    is no start, and that which has ended the motion during the disturbance where one has; all other numbers are zero there.
    """
    chosen = starts.exists & (starts.ended == Outcome.CLEAR)
    machines = None if which is None else which[chosen]
    begins = starts.begins[chosen]
    if starts.after is not None:
        machine, machines = _distinct(starts.after[chosen])
    found = settle(
        machine, State(starts.positions[chosen], starts.velocities[chosen], time=begins), which=machines, **limits
    )
    whole = {}
    for name, values in vars(found).items():
        whole[name] = np.zeros(chosen.shape + values.shape[1:], values.dtype)
        whole[name][chosen] = values
    over = starts.ended != Outcome.CLEAR
    whole["outcomes"][over] = starts.ended[over]
    whole["outcomes"][~starts.exists] = NO_START
    return Endings(**whole)


def _distinct(after: np.ndarray) -> tuple[list[Rotor], np.ndarray]:
    """Machines without repetition, and which of them each is."""
    places: dict[int, int] = {}
    which = np.array([places.setdefault(id(each), len(places)) for each in after], np.int64)
    return [after[place] for place in np.unique(which, return_index=True)[1]], which


def follow_machines(machines: Iterable[tuple[Rotor, Starts]], chunk: int, **limits: object) -> Iterator[Endings]:
    """Follow the disturbances of one machine after another; yield the endings of each, as :func:`follow` returns them.

    About ``chunk`` starts are followed together and held in memory.
    """
    waiting: list[tuple[Rotor, Starts]] = []
    for machine in machines:
        waiting.append(machine)
        if sum(starts.exists.size for _, starts in waiting) >= chunk:
            yield from _together(waiting, limits)
            waiting = []
    if waiting:
        yield from _together(waiting, limits)


def _together(machines: list[tuple[Rotor, Starts]], limits: dict[str, object]) -> Iterator[Endings]:
    rotors, sets = zip(*machines, strict=True)
    sizes = [starts.exists.size for starts in sets]
    found = follow(rotors, Starts.joined(sets), which=np.repeat(np.arange(len(sets)), sizes), **limits)
    for starts, end, size in zip(sets, np.cumsum(sizes), sizes, strict=True):
        yield found[end - size : end].reshaped(*starts.exists.shape)


def require_start(rotor: Rotor, starts: Starts) -> None:
    """Refuse a set of disturbances if none is possible."""
    if not starts.exists.any():
        raise InputError(
            "disturbance",
            f"levitation up to {rotor.system.rest_radius:.6g} clearances from the centre"
            if rotor.system.forced is not None
            else f"|U*| = {rotor.system.rest_radius:.6g}",
            "one that is possible: out of levitation inside the wall (|U*| < 1, with the static sag), or a start inside the wall",
        )


def refuse_another_machine(disturbances: object) -> None:
    """Refuse a kind of disturbance, or a plan of one, that changes the machine."""
    model = getattr(disturbances, "model", disturbances)
    if isinstance(model, Disturbance) and model.changes_machine:
        allowed = "one that leaves the machine as it is; carom.map_basins follows this one"
        raise InputError("disturbances", model.kind, allowed)
