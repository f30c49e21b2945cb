"""The machine on the page as a machine file, as options, as a command, and as a program."""

from __future__ import annotations

import cmath
import hashlib
import json
import math
import shlex
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from carom.closed_forms.exact_results import exact_results
from carom.explorer.computing.controls import Control, in_options, unit_of
from carom.explorer.computing.planes import DisturbancePlane
from carom.explorer.computing.rest import Rest
from carom.models import Rotor, rotor_of
from carom.motions import State
from carom.parameters import MACHINE_FIELDS, Case
from carom.parameters.terms import set_by


@dataclass(frozen=True)
class Kick:
    """The disturbance shown: its kind, its components and the largest one of the picture, in units of the equations."""

    plane: DisturbancePlane
    rest: Rest
    first: float
    second: float
    largest: float

    @property
    def state(self) -> State:
        """The rotor just after a kick."""
        return self.rest.kicked(self.first, self.second)

    def texts(self, rotor: Rotor) -> tuple[str, str]:
        """Size and angle as ``simulate`` reads them."""
        vector = self.plane.vector(self.rest, self.first, self.second)
        factor, unit = self.plane.shown(rotor.scales)
        size = f"{factor * abs(vector):.9g}" + (f" {unit}" if rotor.scales else "")
        if self.plane.name == "shock":
            lasting = self.plane.lasting(rotor)
            size += f",{1e3 * lasting * rotor.scales.time:.9g} ms" if rotor.scales else f",{lasting:.9g}"
        return size, f"{math.degrees(cmath.phase(vector)) % 360.0:.9g} deg"


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

    def all_settings(self, changes: Mapping[str, str]) -> tuple[str, ...]:
        """``name=value`` for every parameter that differs from the file, those changed on the page last."""
        moved = {set_by(name) for name in changes}
        kept = [
            self._in_si(setting) if changes else setting
            for setting in self.settings
            if set_by(_name(setting)) not in moved
        ]
        return (*kept, *(f"{name}={text}" for name, text in in_options(self.case, changes).items()))

    def _in_si(self, setting: str) -> str:
        """A setting of a dimensionless number or of a term as one of the field that it sets.

        Only such settings mean the same whatever else is set.
        """
        name, entry = _name(setting), set_by(_name(setting))
        if name == entry or entry not in self.case.si:
            return setting
        return f"{entry}={self.case.si[entry]!r} {MACHINE_FIELDS[entry].unit}".strip()


def mark_of(case: Case) -> str:
    """Text that differs from machine to machine, by name and all numbers: what is set on a page is not meant for another one."""
    text = case.to_toml() or json.dumps(rotor_of(case).attributes(), sort_keys=True)
    return hashlib.sha256(f"{case.name}\n{text}".encode()).hexdigest()[:10]


def _name(setting: str) -> str:
    return setting.partition("=")[0].strip()


def as_options(origin: Origin, changes: Mapping[str, str]) -> str:
    """The options ``--set`` that lead from the file to the machine on the page."""
    return " ".join(f"--set {shlex.quote(setting)}" for setting in origin.all_settings(changes))


def as_command(origin: Origin, changes: Mapping[str, str], rotor: Rotor, kick: Kick) -> str:
    """The command that follows the disturbance shown; the rotor is that of the machine on the page.

    Empty where no option says that start: a rub on a bearing with a mount.
    """
    if kick.plane.name != "kick" or kick.rest.levitates:
        start = f"--{kick.plane.name} {shlex.quote(','.join(kick.texts(rotor)))}"
    elif kick.rest.among:
        return ""
    else:
        position, velocity = complex(kick.state.position), complex(kick.state.velocity)
        start = f"--start={position.real!r},{position.imag!r},{velocity.real!r},{velocity.imag!r}"
    return " ".join(filter(None, ("carom simulate", shlex.quote(origin.path), as_options(origin, changes), start)))


def as_python(origin: Origin, changes: Mapping[str, str], rotor: Rotor, kick: Kick, along: Control) -> str:
    """A program that computes what the page shows, and draws it: basin, motion, response, orbits and the diagram along a parameter."""
    module, model, grid, start = _disturbance(rotor, kick)
    settings = "".join(f"\n    {json.dumps(each, ensure_ascii=False)}," for each in origin.all_settings(changes))
    response = """
response = cm.studies.unbalance_response(machine)
print(response)
response.plot().savefig("response.png")
"""
    return f"""import carom as cm
from {module} import {model.partition("(")[0]}

machine = cm.load({json.dumps(origin.path, ensure_ascii=False)}, [{settings}{chr(10) if settings else ""}])

basin = cm.map_basins(machine, cm.Grid({model}, {grid}))
print(basin.share_recovered.words)
{'basin.plot().savefig("basin.png")' if kick.rest.levitates else "print(basin.fractions)"}

motion = cm.simulate({start}, settle=True)
print(motion.outcome.meaning)
motion.plot().savefig("motion.png")
{response if rotor.scales else ""}{_orbits(rotor, along)}"""


def _orbits(rotor: Rotor, along: Control) -> str:
    """The part of a program that finds orbits; none of a shaft that slows down, or of several touchdown bearings, where it takes long."""
    if rotor.system.shaft is not None or rotor.planar is None:
        return ""
    searched = "" if exact_results(rotor).orbits else ", impacts=1"
    unit = unit_of(along.name)
    low, high = (float(f"{unit * end:.12g}") for end in (along.low, along.high))
    return f"""
orbits = cm.find_orbits(machine{searched})
print(orbits)

diagram = cm.find_bifurcations(machine, {json.dumps(along.name)}, ({low!r}, {high!r}))
diagram.plot().savefig("diagram.png")
"""


def _disturbance(rotor: Rotor, kick: Kick) -> tuple[str, str, str, str]:
    """Module, model, shape of its grid, and arguments of the motion in a program."""
    size, angle = math.hypot(kick.first, kick.second), math.atan2(kick.second, kick.first)
    grid, rings, phases = ("(120, 120)", "(60, 120)", "(360,)") if rotor.planar else ("(24, 24)", "(12, 24)", "(72,)")
    if kick.plane.name == "shock":
        lasting = kick.plane.lasting(rotor)
        start = f"machine, BaseShock({size!r}, {lasting!r}).release(machine, {angle!r})"
        return "carom.disturbances", f"BaseShock({kick.largest!r}, {lasting!r})", rings, start
    if kick.plane.name == "blade-loss":
        start = f"*BladeLoss({size!r}).apply(machine, {angle!r})"
        return "carom.disturbances", f"BladeLoss({size!r})", phases, start
    if not kick.rest.levitates:
        among = f", {kick.rest.among!r}" if kick.rest.among else ""
        model = f"RestKick({kick.largest!r}, {kick.rest.place!r}{among})"
        start = f"machine, cm.State({_numbers(kick.state.position)}, {_numbers(kick.state.velocity)})"
        return "carom.explorer.computing.rest", model, grid, start
    stated, turned = kick.texts(rotor)
    stated = json.dumps(stated) if rotor.scales else stated
    return (
        "carom.disturbances",
        f"KickPlane({kick.largest!r})",
        grid,
        f"machine, cm.kick({stated}, {json.dumps(turned)})",
    )


def _numbers(given: complex | np.ndarray) -> str:
    """A complex number, or an array of them, in a program."""
    return repr(given.tolist() if isinstance(given, np.ndarray) else given)
