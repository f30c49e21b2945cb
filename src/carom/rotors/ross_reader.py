"""Read a rotor of ROSS in a process of its own: ``python ross_reader.py SOURCE NAME FOLDER``.

Importing ROSS takes seconds, and it may live in another environment, so this program imports nothing of carom.  It writes ``rotor.npz`` and
``rotor.json`` to the folder.  Matrices are those of the shaft with its discs and point masses, free in space; of bearings their numbers are stated.
"""

from __future__ import annotations

import json
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np

SHAFTS = ("MultiRotor", "CoAxialRotor")
"""Rotors of several shafts."""
COORDINATES = ("x", "y", "z", "alpha", "beta", "theta")
COEFFICIENTS = ("kxx", "kxy", "kyx", "kyy", "cxx", "cxy", "cyx", "cyy")


class RefusedError(Exception):
    """Field, value and what is allowed."""


def main(source: str, name: str, folder: str) -> None:
    """Read the rotor and write both files; what is refused is written too."""
    # Modules beside this file are none of the script's.
    sys.path[0] = str(Path(source).resolve().parent)
    try:
        shown = read(source, name, Path(folder))
    except RefusedError as problem:
        shown = {"refused": problem.args}
    (Path(folder) / "rotor.json").write_text(json.dumps(shown), encoding="utf-8")


def read(source: str, name: str, folder: Path) -> dict[str, object]:
    """Write the matrices of a rotor, and return what else is known of it."""
    try:
        import ross
    except ImportError as problem:
        allowed = (
            "an installed ROSS: pip install 'carom[ross]', or --python with the Python of an environment that has it"
        )
        raise RefusedError("ross", str(problem), allowed) from None
    rotor = ross.Rotor.load(source) if Path(source).suffix != ".py" else of_script(source, name, ross.Rotor)
    kind = type(rotor).__name__
    if kind in SHAFTS:
        raise RefusedError("rotor", kind, "a rotor of one shaft")
    last = max(rotor.nodes)
    beyond = [each for each in rotor.point_mass_elements if each.n not in rotor.nodes]
    masses = [each for each in rotor.point_mass_elements if each.n in rotor.nodes]
    free = ross.Rotor(rotor.shaft_elements, rotor.disk_elements, [], masses)
    if free.number_dof != len(COORDINATES):
        allowed = f"{len(COORDINATES)} coordinates for each node, as ROSS 2 has them"
        raise RefusedError("ROSS", f"{ross.__version__}, with {free.number_dof}", allowed)
    arrays = {"M": free.M(0.0), "K": free.K(0.0), "G": free.G(), "nodes": np.array(free.nodes_pos)}
    damping = free.C(0.0)
    if damping.any():
        arrays["D"] = damping
    np.savez(folder / "rotor.npz", **arrays, coordinates=np.array(COORDINATES), names=np.array(names_of(rotor)))
    remarks = [f"{each.tag}: left out, it is no part of the shaft, which ends at node {last}" for each in beyond]
    bearings = [bearing_of(each, rotor.rated_w) for each in rotor.bearing_elements]
    remarks += [
        f"{each['tag']}: its coefficients depend on the speed; {each['taken']}" for each in bearings if "taken" in each
    ]
    return {"version": ross.__version__, "bearings": bearings, "remarks": remarks, "speed": rotor.rated_w}


def of_script(source: str, name: str, kind: type) -> Any:
    """The rotor that a Python file makes: the only one, or the one with this name, which may be a function."""
    found = runpy.run_path(source)
    if name:
        if name not in found:
            raise RefusedError("name", name, f"the name of a rotor, or of a function that returns one, in {source}")
        made = found[name]() if callable(found[name]) else found[name]
        if not isinstance(made, kind):
            raise RefusedError("name", f"{name}, a {type(made).__name__}", "a rotor of ROSS")
        return made
    rotors = {id(value): (key, value) for key, value in found.items() if isinstance(value, kind)}
    if len(rotors) != 1:
        shown = ", ".join(key for key, _ in rotors.values()) or "none"
        raise RefusedError(
            "rotors", shown, f"one rotor of ROSS in {source}, or --name of one, or of a function that returns it"
        )
    return next(iter(rotors.values()))[1]


def names_of(rotor: Any) -> list[str]:
    """A name for each node at which one bearing or disc sits."""
    names = []
    for node in rotor.nodes:
        tags = [each.tag for each in (*rotor.bearing_elements, *rotor.disk_elements) if each.n == node and each.tag]
        names.append(tags[0] if tags and tags[0] not in names else "")
    return names


def bearing_of(element: Any, speed: float | None) -> dict[str, object]:
    """Node, kind and numbers of a bearing, at a speed, rad/s, if they depend on it."""
    kind = type(element).__name__
    shown: dict[str, Any] = {"node": int(element.n), "tag": element.tag, "kind": kind}
    if kind != "MagneticBearingElement":
        numbers = coefficients_of(element, speed)
        if any(np.ptp(np.ravel(getattr(element, name))) for name in COEFFICIENTS):
            shown["taken"] = f"taken are those at {speed:.10g} rad/s" if speed else "taken are the first"
        alike = all(numbers[f"{of}xx"] == numbers[f"{of}yy"] for of in "kc")
        alike &= not any(numbers[f"{of}{axes}"] for of in "kc" for axes in ("xy", "yx"))
        usual = {"stiffness": numbers["kxx"], "damping": numbers["cxx"]}
        return {**shown, **usual, "alike": alike, "coefficients": numbers}
    gains = [
        np.unique(np.asarray(values, float)) for values in (element.ki, element.ks, element.k_amp, element.k_sense)
    ]
    if any(len(each) != 1 for each in gains):
        raise RefusedError(f"{element.tag}", "other numbers in x and y", "isotropic magnets and amplifiers")
    ki, ks, amplifier, sensor = (float(each[0]) for each in gains)
    shown |= {"ki": ki, "ks": ks}
    factor, numerator = amplifier * sensor, element.controller_transfer_function_num
    if numerator is not None:
        above, below = (
            np.ravel(each).astype(float).tolist() for each in (numerator, element.controller_transfer_function_den)
        )
        return {**shown, "numerator": [factor * each for each in above], "denominator": below}
    pid = {"proportional": element.kp_pid, "integral": element.ki_pid, "derivative": element.kd_pid}
    if any(pid.values()):
        shown |= {name: factor * float(value) for name, value in pid.items() if value}
        shown["filter_time"] = 1.0 / float(element.n_f)
    return shown


def coefficients_of(element: Any, speed: float | None) -> dict[str, float]:
    """The eight coefficients of a bearing, N/m and N s/m: the first of several, or between those at the speeds around a speed."""
    found = {}
    for name in COEFFICIENTS:
        values = np.ravel(getattr(element, name)).astype(float)
        found[name] = float(values[0])
        if speed and len(values) > 1 and np.size(element.frequency) == len(values):
            found[name] = float(np.interp(speed, element.frequency, values))
    return found


if __name__ == "__main__":
    main(*sys.argv[1:])
