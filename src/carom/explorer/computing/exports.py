"""The machine on the page as a machine file, as options of the command line, and as a program."""

from __future__ import annotations

import hashlib
import json
import shlex
from collections.abc import Mapping
from dataclasses import dataclass

from carom.explorer.computing.controls import Control, controls_of, unit_of, with_unit
from carom.explorer.computing.kicks import Rest
from carom.parameters import DIMENSIONLESS_FIELDS, MACHINE_FIELDS, Case
from carom.parameters.terms import set_by


@dataclass(frozen=True)
class Kick:
    """The kick shown: its parts and the largest one of the picture, in ``c_r Ω``."""

    radial: float
    tangential: float
    fastest: float


@dataclass(frozen=True)
class Origin:
    """Where the machine of the page comes from.

    Attributes
    ----------
    path : str
        Its file, as it was given.
    settings : tuple of str
        What ``--set`` has changed.
    case : Case
        The machine with these settings.
    """

    path: str
    settings: tuple[str, ...]
    case: Case

    @property
    def mark(self) -> str:
        """Text that differs from machine to machine: what is set on a page is not meant for another one."""
        return hashlib.sha256(f"{self.case.name}\n{as_toml(self.case)}".encode()).hexdigest()[:10]

    def all_settings(self, changes: Mapping[str, str]) -> tuple[str, ...]:
        """``name=value`` for every parameter that differs from the file, those changed on the page last."""
        units = {control.name: control.unit for control in controls_of(self.case)}
        moved = {set_by(name) for name in changes}
        kept = [
            self._in_si(setting) if changes else setting
            for setting in self.settings
            if set_by(_name(setting)) not in moved
        ]
        return (*kept, *(f"{name}={with_unit(units[name], text)}" for name, text in changes.items()))

    def _in_si(self, setting: str) -> str:
        """A setting of a dimensionless number or of a term as one of the field that it sets.

        Only such settings mean the same whatever else is set.
        """
        name, machine = _name(setting), self.case.machine
        if machine is None or name == set_by(name):
            return setting
        field = MACHINE_FIELDS[set_by(name)]
        return f"{field.name}={getattr(machine, field.name)!r} {field.unit}".strip()


def _name(setting: str) -> str:
    return setting.partition("=")[0].strip()


def as_options(origin: Origin, changes: Mapping[str, str]) -> str:
    """The options ``--set`` that lead from the file to the machine on the page."""
    return " ".join(f"--set {shlex.quote(setting)}" for setting in origin.all_settings(changes))


def as_toml(case: Case) -> str:
    """A machine file that is read as the machine on the page, bit for bit."""
    zones = f"\n[zones]\nlimits = {list(case.zones.limits)}\n"
    if case.machine is not None:
        return f"{case.machine.to_toml()}{zones}\n{case.limits.to_toml()}\n{case.requirement.to_toml()}"
    lines = [
        f"{name} = {getattr(case.parameters, name)!r}  # {field.symbol}: {field.words}"
        for name, field in DIMENSIONLESS_FIELDS.items()
    ]
    return "\n".join(["[dimensionless]", *lines]) + f"\n{zones}\n{case.requirement.to_toml(has_scales=False)}"


def as_python(origin: Origin, changes: Mapping[str, str], rest: Rest, kick: Kick, along: Control) -> str:
    """A program that computes what the page shows: basin, motion, orbits and the diagram along a parameter."""
    settings = json.dumps(list(origin.all_settings(changes)), ensure_ascii=False)
    unit = unit_of(along.name)
    low, high = (float(f"{unit * end:.12g}") for end in (along.low, along.high))
    state = rest.kicked(kick.radial, kick.tangential)
    if rest.levitates:
        module, kicks = "carom.disturbances", f"KickPlane({kick.fastest!r})"
    else:
        module, kicks = "carom.explorer.computing.kicks", f"RestKick({kick.fastest!r}, {rest.position!r})"
    return f"""import carom as cm
from {module} import {kicks.partition("(")[0]}

machine = cm.load({json.dumps(origin.path, ensure_ascii=False)}, {settings})

basin = cm.map_basins(machine, cm.Grid({kicks}, (120, 120)))
print(basin.share_recovered.words)
{"basin.plot()" if rest.levitates else "print(basin.fractions)"}

motion = cm.simulate(machine, cm.State({state.position!r}, {state.velocity!r}), settle=True)
print(motion.outcome.meaning)
motion.plot()

orbits = cm.find_orbits(machine)
print(orbits)

diagram = cm.find_bifurcations(machine, {json.dumps(along.name)}, ({low!r}, {high!r}))
diagram.plot()
"""
