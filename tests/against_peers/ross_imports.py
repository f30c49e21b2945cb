"""Write ``ross_imports``: rotors that ROSS 2.3.0 ships as ``carom import-rotor`` reads them, and what ROSS computes for them.

It is run by hand, in an environment of its own (``pip install ross-rotordynamics==2.3.0 "plotly<7"``), never by the tests:

    python tests/against_peers/ross_imports.py

The rotors have all that is in the examples, with the damping of their materials; their bearings are springs alike in both directions, or magnets whose
numbers ROSS gives at each frequency, because between frequencies it fits a curve that misses even the given ones (python-control takes two frequencies for limits, so there are three).
"""

from __future__ import annotations

import importlib.util
import json
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
READER = HERE.parents[1] / "src" / "carom" / "rotors" / "ross_reader.py"
EXAMPLES = ("rotor_example", "rotor_example_with_damping", "rotor_amb_example")
SPEEDS = (0.0, 200.0, 900.0)
FREQUENCIES = (50.0, 300.0, 1100.0)
SPRING = 1e7, 500.0
"""N/m and N s/m in place of magnetic bearings."""


def imported(name: str, folder: Path):
    """What the reader of carom tells of an example."""
    spec = importlib.util.spec_from_file_location("ross_reader", READER)
    reader = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(reader)
    program = folder / f"{name}.py"
    program.write_text(f"import ross\n\nrotor = ross.{name}()\n")
    return reader.read(str(program), "", folder)


def computed(ross, name):
    """Eigenvalues and responses to an unbalance of one kg m at the first disc."""
    shipped = getattr(ross, name)()
    springs = [
        SPRING if isinstance(each, ross.MagneticBearingElement) else (float(each.kxx[0]), float(each.cxx[0]))
        for each in shipped.bearing_elements
    ]
    nodes = [each.n for each in shipped.bearing_elements]
    rotor = held(ross, shipped, nodes, springs)
    disc = rotor.disk_elements[0].n
    found = {
        "springs": [[node, *spring] for node, spring in zip(nodes, springs, strict=True)],
        "mass": rotor.m,
        "eigenvalues": [{"speed": speed, "values": pairs(lateral(rotor, speed))} for speed in SPEEDS],
        "unbalance": response(rotor, disc, [disc, *nodes], FREQUENCIES),
    }
    if isinstance(shipped.bearing_elements[0], ross.MagneticBearingElement):
        found["magnetic"] = [on_magnets(ross, shipped, nodes, disc, frequency) for frequency in FREQUENCIES]
    return found


def on_magnets(ross, shipped, nodes, disc, frequency):
    """The response at a frequency with the stiffness and damping that the magnets of an example have there."""
    numbers = ("n_f", "kp_pid", "kd_pid", "ki_pid", "g0", "i0", "ag", "nw", "alpha")
    magnets = [
        ross.MagneticBearingElement(
            n=each.n,
            frequency=[frequency, 2.0 * frequency, 3.0 * frequency],
            **{name: float(np.ravel(getattr(each, name))[0]) for name in numbers},
        )
        for each in shipped.bearing_elements
    ]
    springs = [(float(each.kxx[0]), float(each.cxx[0])) for each in magnets]
    return response(held(ross, shipped, nodes, springs), disc, [disc, *nodes], [frequency])


def held(ross, shipped, nodes, springs):
    bearings = [
        ross.BearingElement(node, kxx=stiffness, cxx=damping)
        for node, (stiffness, damping) in zip(nodes, springs, strict=True)
    ]
    return ross.Rotor(shipped.shaft_elements, shipped.disk_elements, bearings)


def response(rotor, disc, nodes, frequencies):
    found = rotor.run_unbalance_response(disc, 1.0, 0.0, np.array(frequencies)).forced_resp
    return {
        "node": disc,
        "speeds": list(frequencies),
        "at_nodes": nodes,
        "x": [pairs(found[6 * node]) for node in nodes],
    }


def lateral(rotor, speed):
    """The lowest eigenvalues of lateral motion, in 1/s, with positive imaginary part."""
    keep = [6 * node + at for node in range(len(rotor.nodes)) for at in (0, 1, 3, 4)]
    mass, stiffness, damping, gyroscopic = (
        matrix[np.ix_(keep, keep)] for matrix in (rotor.M(speed), rotor.K(speed), rotor.C(speed), rotor.G())
    )
    n = len(mass)
    forces = np.concatenate([stiffness, damping + speed * gyroscopic], axis=1)
    values = np.linalg.eigvals(np.concatenate([np.eye(n, 2 * n, n), -np.linalg.solve(mass, forces)]))
    values = values[values.imag > 1.0]
    return values[np.argsort(values.imag)][:12]


def pairs(values):
    return [[float(value.real), float(value.imag)] for value in np.asarray(values, complex)]


def main():
    import ross

    place = HERE / "ross_imports"
    place.mkdir(exist_ok=True)
    sys.path[0] = ""
    table = {}
    for name in EXAMPLES:
        with tempfile.TemporaryDirectory() as folder:
            shown = imported(name, Path(folder))
            with np.load(Path(folder) / "rotor.npz") as arrays:
                np.savez_compressed(place / f"{name}.npz", **arrays)
        table[name] = {"bearings": shown["bearings"], **computed(ross, name)}
        shutil.rmtree(place / "__pycache__", ignore_errors=True)
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(found)}" for name, found in table.items())
    (place / "computed.json").write_text(f"{{{lines}}}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
