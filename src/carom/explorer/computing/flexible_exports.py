"""A flexible machine on the page as options, as a command, and as a program."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Mapping

from carom.explorer.computing.controls import Control, with_unit
from carom.explorer.computing.exports import Origin


def settings_of(origin: Origin, controls: Mapping[str, Control], changes: Mapping[str, str]) -> tuple[str, ...]:
    """``name=value`` for every parameter that differs from the file, those changed on the page last."""
    kept = [each for each in origin.settings if each.partition("=")[0].strip() not in changes]
    return (*kept, *(f"{name}={_text(controls[name].unit, text)}" for name, text in changes.items()))


def _text(unit: str, text: str) -> str:
    """A value with its unit; that of a curved stiffness is none that can be read."""
    return text.removesuffix(unit).strip() if "^" in unit else with_unit(unit, text)


def as_set(settings: tuple[str, ...]) -> str:
    """The options ``--set`` that lead from the file to the machine on the page."""
    return " ".join(f"--set {shlex.quote(each)}" for each in settings)


def as_simulate(origin: Origin, settings: tuple[str, ...], right: float, up: float, unit: str) -> str:
    """The command that follows a kick."""
    kick = shlex.quote(",".join(_kick(right, up, unit)))
    return " ".join(filter(None, ("carom simulate", shlex.quote(origin.path), as_set(settings), f"--kick {kick}")))


def as_program(origin: Origin, settings: tuple[str, ...], right: float, up: float, unit: str, largest: float) -> str:
    """A program that computes what the page shows: levitation, the motion after a kick, and where kicks lead."""
    given = "".join(f"\n    {json.dumps(each, ensure_ascii=False)}," for each in settings)
    listed = f"[{given}\n]" if settings else "[]"
    return f"""import carom as cm
from carom.disturbances import VelocityKick

path, settings = {json.dumps(origin.path)}, {listed}

for whirl in cm.rotors.find_whirls(cm.rotors.load_machine(path, settings), count=10):
    print(f"{{whirl.frequency:.1f}} Hz, {{whirl.sense}}, damping ratio {{whirl.damping_ratio:.3g}}")

case = cm.load(path, settings)
motion = cm.simulate(case, cm.kick({", ".join(map(json.dumps, _kick(right, up, unit)))}), settle=True)
print(motion.outcome.meaning)
for plane in cm.motions.drop_loads(motion).planes:
    print(f"touchdown bearing {{plane.plane + 1}}: {{plane.contacts}} contacts, {{plane.loads.si()['force']:.0f}} N")

kicks = VelocityKick.of(case, "{largest:.9g} {unit}")
basin = cm.map_basins(case, cm.Grid(kicks, (12, 24)))
print(basin.share_recovered.words)
basin.plot().savefig("basin.png")
"""


def _kick(right: float, up: float, unit: str) -> tuple[str, str]:
    """Size and angle of a kick, as ``simulate`` reads them."""
    return f"{math.hypot(right, up):.9g} {unit}", f"{math.degrees(math.atan2(up, right)) % 360.0:.9g} deg"
