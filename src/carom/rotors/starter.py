"""A machine file to start from, for a rotor that has been imported."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from carom.rotors.ross_import import ImportedRotor

MAGNETIC = "MagneticBearingElement"
ASSUMED = "# ASSUMED"
_GAINS = ("proportional", "integral", "derivative", "filter_time", "numerator", "denominator")
_UNITS = {"proportional": "A/m", "integral": "A/m/s", "derivative": "A s/m", "filter_time": "s"}
DAMPING_RATIO = 0.3
"""Damping ratio of the whole rotor on assumed controllers."""


def starter_text(found: ImportedRotor, source: str) -> str:
    """Text of a machine file, which loads as it is; what the source does not state is marked ``ASSUMED``.

    Parameters
    ----------
    found : ImportedRotor
    source : str
        Name of the file of matrices, beside which the machine file will lie.
    """
    rotor = found.rotor
    speed = f'speed = "{found.speed:.10g} rad/s"' if found.speed else f'speed = "3000 rpm"                 {ASSUMED}'
    damping = (
        []
        if found.is_damped
        else [f"damping_ratio = 0.005              {ASSUMED}: measure it; of solid shafts 0.001 to 0.01"]
    )
    ends = f"Nodes: 0 to {len(rotor.nodes) - 1}, {1e3 * rotor.nodes[0]:.6g} to {1e3 * rotor.nodes[-1]:.6g} mm; mass {rotor.mass:.6g} kg."
    lines = [
        "# A machine file to start from; all entries: carom template flexible.",
        f"# {ends}",
        *(f"# {remark}" for remark in found.remarks),
        *_not_taken(found.bearings),
        "",
        "[rotor]",
        f'source = "{source}"               # beside this file',
        speed,
        *damping,
    ]
    held = _held(found)
    supports = [each for each in found.bearings if _is_support(each)]
    nodes = list(dict.fromkeys(each["node"] for each in held or supports))
    for each in held:
        lines += ["", "[[magnetic_bearing]]", *_magnetic(each, len(held), rotor.mass)]
    for each in supports:
        lines += ["", *_support(each)]
    for node in nodes:
        lines += ["", *_touchdown(node)]
    middle = min(range(len(rotor.nodes)), key=lambda node: abs(rotor.nodes[node] - rotor.centre))
    lines += [
        "",
        f"[[unbalance]]                      {ASSUMED}",
        f"node = {middle}",
        f'size = "{1e6 * 2e-6 * rotor.mass:.3g} g mm"',
        "",
        "[gravity]",
        "",
    ]
    return "\n".join(lines)


def _held(found: ImportedRotor) -> list[Mapping[str, Any]]:
    """Bearings that become magnetic bearings: those of the source, or assumed ones in place of its springs, or at both ends if nothing else holds it."""
    stated = [each for each in found.bearings if each["kind"] == MAGNETIC]
    springs = [each for each in found.bearings if each["kind"] != MAGNETIC and not _is_support(each)]
    held = any(_is_support(each) and "Seal" not in each["kind"] for each in found.bearings)
    ends = [{"node": node, "kind": "none"} for node in (0, len(found.rotor.nodes) - 1)]
    chosen: Sequence[Mapping[str, Any]] = stated or springs or ([] if held else ends)
    return list({each["node"]: each for each in chosen}.values())


def _is_support(bearing: Mapping[str, Any]) -> bool:
    """Whether a bearing is taken over as it is: a seal, or one that acts differently in two directions."""
    return "coefficients" in bearing and ("Seal" in bearing["kind"] or not bearing["alike"])


def _support(bearing: Mapping[str, Any]) -> list[str]:
    return [
        f"[[support]]                        # {bearing['tag']}, a {bearing['kind']}",
        f"node = {bearing['node']}",
        *(
            f'{name} = "{value!r} {"N/m" if name.startswith("k") else "N s/m"}"'
            for name, value in bearing["coefficients"].items()
            if value or name in ("kxx", "kyy")
        ),
    ]


def _not_taken(bearings: Sequence[Mapping[str, Any]]) -> list[str]:
    """What is said of bearings that are not magnetic."""
    return [
        f"# {each['tag']}, a {each['kind']} at node {each['node']} (kxx = {each['stiffness']:.4g} N/m, cxx = {each['damping']:.4g} N s/m): not taken over."
        for each in bearings
        if each["kind"] != MAGNETIC and not _is_support(each)
    ]


def _magnetic(bearing: Mapping[str, Any], count: int, mass: float) -> list[str]:
    node = f"node = {bearing['node']}"
    gains = {name: bearing[name] for name in _GAINS if name in bearing}
    if gains:
        return [
            node,
            f'ki = "{bearing["ki"]!r} N/A"',
            f'ks = "{bearing["ks"]!r} N/m"',
            *(_entry(*each) for each in gains.items()),
        ]
    stiffness = bearing.get("stiffness") or 1e5 * mass / count
    ki, ks = bearing.get("ki", 100.0), bearing.get("ks", 0.0)
    damping = bearing.get("damping") or 2.0 * DAMPING_RATIO * (stiffness * mass / count) ** 0.5
    lost = (
        "the gains are not in the saved file"
        if bearing["kind"] == MAGNETIC
        else "as stiff as the bearing of the source"
    )
    return [
        f"{node}                           {ASSUMED}, all of it: {lost if 'stiffness' in bearing or 'ki' in bearing else 'there is no bearing in the source'}",
        f'ki = "{ki:.6g} N/A"',
        f'ks = "{ks:.6g} N/m"',
        f'proportional = "{(stiffness - ks) / ki:.4g} A/m"',
        f'derivative = "{damping / ki:.4g} A s/m"',
        'filter_time = "0.1 ms"',
    ]


def _entry(name: str, value: Any) -> str:
    return f'{name} = "{value!r} {_UNITS[name]}"' if name in _UNITS else f"{name} = {value!r}"


def _touchdown(node: int) -> list[str]:
    return [
        f"[[touchdown]]                      {ASSUMED}, all of it",
        f"node = {node}",
        'clearance = "0.25 mm"',
        'rotor_radius = "20 mm"',
        "friction = 0.15",
        'law = "hunt-crossley"',
        'stiffness = "5e7 N/m"',
        'dissipation = "1 s/m"',
    ]
