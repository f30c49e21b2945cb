"""A machine file to start from, for a rotor that has been imported."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from carom.rotors.part_tables import PARTS
from carom.rotors.ross_import import ImportedRotor

MAGNETIC = "MagneticBearingElement"
ASSUMED = "ASSUMED"
_HEAD = "A machine file to start from; all entries: carom template flexible."
_GAINS = ("proportional", "integral", "derivative", "filter_time", "numerator", "denominator")
_TOUCHDOWN = {"clearance": "0.25 mm", "rotor_radius": "20 mm", "friction": 0.15, "law": "hunt-crossley"}
_TOUCHDOWN |= {"stiffness": "5e7 N/m", "dissipation": "1 s/m"}
DAMPING_RATIO = 0.3
"""Damping ratio of the whole rotor on assumed controllers."""


def starter_text(found: ImportedRotor, source: str) -> str:
    """A machine file for an imported rotor, whose matrices are in the file ``source`` beside it."""
    rotor, held = found.rotor, _held(found)
    supports = [each for each in found.bearings if _is_support(each)]
    speed = f'"{found.speed:.10g} rad/s"' if found.speed else f'"3000 rpm"  # {ASSUMED}'
    damping = (
        "" if found.is_damped else f"damping_ratio = 0.005  # {ASSUMED}: measure it; of solid shafts 0.001 to 0.01\n"
    )
    remarks = [*found.remarks, *map(_not_taken, _springs(found))]
    ends = f"Nodes: 0 to {len(rotor.nodes) - 1}, {1e3 * rotor.nodes[0]:.6g} to {1e3 * rotor.nodes[-1]:.6g} mm; mass {rotor.mass:.6g} kg."
    head = "".join(f"# {remark}\n" for remark in (_HEAD, ends, *remarks))
    tables = [_magnetic(each, len(held), rotor.mass) for each in held]
    for each in supports:
        numbers = {name: value for name, value in each["coefficients"].items() if value or name in ("kxx", "kyy")}
        tables.append(_table("support", f"{each['tag']}, a {each['kind']}", node=each["node"], **numbers))
    nodes = dict.fromkeys(each["node"] for each in held or supports)
    tables += [_table("touchdown", f"{ASSUMED}, all of it", node=node, **_TOUCHDOWN) for node in nodes]
    middle = min(range(len(rotor.nodes)), key=lambda node: abs(rotor.nodes[node] - rotor.centre))
    tables.append(_table("unbalance", ASSUMED, node=middle, size=f"{2.0 * rotor.mass:.3g} g mm"))
    rotor_table = f'[rotor]\nsource = "{source}"  # beside this file\nspeed = {speed}\n{damping}'
    return "\n".join([head, rotor_table, *tables, "[gravity]\n"])


def _held(found: ImportedRotor) -> list[Mapping[str, Any]]:
    """Bearings that become magnetic bearings: those of the source, or assumed ones in place of its springs, or at both ends if nothing else holds it."""
    stated = [each for each in found.bearings if each["kind"] == MAGNETIC]
    springs = [{**each, "assumed": "as stiff as the bearing of the source"} for each in _springs(found)]
    held = any(_is_support(each) and "Seal" not in each["kind"] for each in found.bearings)
    ends = [{"node": node, "assumed": "there is no bearing in the source"} for node in (0, len(found.rotor.nodes) - 1)]
    chosen: Sequence[Mapping[str, Any]] = stated or springs or ([] if held else ends)
    return list({each["node"]: each for each in chosen}.values())


def _springs(found: ImportedRotor) -> list[Mapping[str, object]]:
    return [each for each in found.bearings if each["kind"] != MAGNETIC and not _is_support(each)]


def _is_support(bearing: Mapping[str, Any]) -> bool:
    """Whether a bearing is taken over as it is: a seal, or an anisotropic one."""
    return "coefficients" in bearing and ("Seal" in bearing["kind"] or not bearing["alike"])


def _not_taken(bearing: Mapping[str, object]) -> str:
    """What is said of a bearing that is a spring."""
    numbers = f"kxx = {bearing['stiffness']:.4g} N/m, cxx = {bearing['damping']:.4g} N s/m"
    return f"{bearing['tag']}, a {bearing['kind']} at node {bearing['node']} ({numbers}): not taken over."


def _magnetic(bearing: Mapping[str, Any], count: int, mass: float) -> str:
    """A magnetic bearing with the gains of the source, or with such that hold the rotor."""
    if gains := {name: bearing[name] for name in _GAINS if name in bearing}:
        return _table("magnetic_bearing", "", node=bearing["node"], ki=bearing["ki"], ks=bearing["ks"], **gains)
    stiffness = bearing.get("stiffness") or 1e5 * mass / count
    ki, ks = bearing.get("ki", 100.0), bearing.get("ks", 0.0)
    damping = bearing.get("damping") or 2.0 * DAMPING_RATIO * (stiffness * mass / count) ** 0.5
    gains = {"ki": ki, "ks": ks, "proportional": (stiffness - ks) / ki, "derivative": damping / ki, "filter_time": 1e-4}
    rounded = {name: float(f"{value:.6g}") for name, value in gains.items()}
    why = bearing.get("assumed", "the gains are not in the saved file")
    return _table("magnetic_bearing", f"{ASSUMED}, all of it: {why}", node=bearing["node"], **rounded)


def _table(kind: str, remark: str, **entries: Any) -> str:
    """A table of the file, numbers with their units."""
    lines = [f"[[{kind}]]  # {remark}".removesuffix("  # ")]
    for name, value in entries.items():
        unit = getattr(PARTS[kind].entries[name], "unit", "")
        has_unit = unit and not isinstance(value, str)
        lines.append(f"{name} = " + (f'"{value!r} {unit}"' if has_unit else json.dumps(value)))
    return "\n".join(lines) + "\n"
