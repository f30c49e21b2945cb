"""Write ``ross_rotors.json``: rotors that ROSS 2.3.0 ships, and what it computes for them.

It is run by hand, in an environment of its own (``pip install ross-rotordynamics==2.3.0 "plotly<7"``), never by the tests:

    python tests/against_peers/ross_rotors.py

The rotors are those of three examples of ROSS without the damping of their materials (which in ROSS acts on the shaft and not on the discs) and, so that both
planes are alike, with the x stiffness and damping of their bearings in both directions.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

SPEEDS = (0.0, 200.0, 900.0)
SPRING = 1e7, 500.0
"""N/m and N s/m in place of magnetic bearings."""
LOWEST = 12
"""Eigenvalues of both planes that are kept."""


def examples(ross):
    """Name to rotor, with the bearings as (node, stiffness, damping)."""
    found = {}
    for name in ("rotor_example", "rotor_example_with_damping", "rotor_amb_example"):
        shipped = getattr(ross, name)()
        steel = shipped.shaft_elements[0].material
        shaft = [
            ross.ShaftElement(each.L, each.idl, each.odl, material=steel, n=each.n) for each in shipped.shaft_elements
        ]
        discs = [ross.DiskElement(each.n, each.m, each.Id, each.Ip) for each in shipped.disk_elements]
        springs = [
            (each.n, float(each.kxx[0]), float(each.cxx[0])) if name != "rotor_amb_example" else (each.n, *SPRING)
            for each in shipped.bearing_elements
        ]
        bearings = [ross.BearingElement(node, kxx=stiffness, cxx=damping) for node, stiffness, damping in springs]
        found[name] = ross.Rotor(shaft, discs, bearings), springs
    return found


def of_rotor(rotor, springs):
    """The parts of a rotor, the eigenvalues of its matrices and its response to an unbalance by ``run_unbalance_response``."""
    steel = rotor.shaft_elements[0].material
    unbalanced = rotor.disk_elements[0].n
    frequencies = np.array([50.0, 300.0, 1100.0])
    # One kg m: the response is linear.
    response = rotor.run_unbalance_response(unbalanced, 1.0, 0.0, frequencies)
    rows = [6 * node for node in (unbalanced, *(node for node, _, _ in springs))]
    magnetic = {"magnetic": on_magnets(rotor, springs)} if (springs[0][1], springs[0][2]) == SPRING else {}
    return {
        **magnetic,
        "material": [steel.E, steel.rho, steel.Poisson],
        "sections": [[each.L, each.odl, each.idl] for each in rotor.shaft_elements],
        "discs": [[each.n, each.m, each.Id, each.Ip] for each in rotor.disk_elements],
        "springs": springs,
        "mass": rotor.m,
        "eigenvalues": [{"speed": speed, "values": pairs(lateral(rotor, speed))} for speed in SPEEDS],
        "unbalance": {
            "node": unbalanced,
            "speeds": frequencies.tolist(),
            "at_nodes": [unbalanced, *(node for node, _, _ in springs)],
            "x": [pairs(response.forced_resp[row]) for row in rows],
        },
    }


def on_magnets(rotor, springs):
    """The same on magnetic bearings of ``rotor_amb_example``, by the stiffness and damping that ROSS gives them at the frequencies asked for.

    Each frequency has bearings of its own: between frequencies ROSS fits a curve that misses even the given ones by up to 0.8 %.
    """
    import ross

    frequencies = np.array([40.0, 120.0, 200.0, 330.0, 500.0, 800.0])
    gains = {"kp_pid": 1000.0, "kd_pid": 5.0, "ki_pid": 300.0, "n_f": 1e4}
    magnets = [
        ross.MagneticBearingElement(
            n=node, g0=1e-3, i0=1.0, ag=1e-4, nw=200, alpha=0.392, frequency=frequencies.tolist(), **gains
        )
        for node, _, _ in springs
    ]
    unbalanced = rotor.disk_elements[0].n
    nodes, found = [unbalanced, *(node for node, _, _ in springs)], []
    for at, frequency in enumerate(frequencies):
        held = [ross.BearingElement(each.n, kxx=float(each.kxx[at]), cxx=float(each.cxx[at])) for each in magnets]
        levitated = ross.Rotor(rotor.shaft_elements, rotor.disk_elements, held)
        found.append(levitated.run_unbalance_response(unbalanced, 1.0, 0.0, np.array([frequency])).forced_resp[:, 0])
    return {
        "ki": float(magnets[0].ki),
        "ks": float(magnets[0].ks),
        **gains,
        "node": unbalanced,
        "speeds": frequencies.tolist(),
        "at_nodes": nodes,
        "x": [pairs([response[6 * node] for response in found]) for node in nodes],
    }


def lateral(rotor, speed):
    """The lowest eigenvalues of lateral motion, in 1/s, with positive imaginary part: those of ``run_modal`` in double precision, which rounds more."""
    keep = [6 * node + at for node in range(len(rotor.nodes)) for at in (0, 1, 3, 4)]
    mass, stiffness, damping, gyroscopic = (
        matrix[np.ix_(keep, keep)] for matrix in (rotor.M(speed), rotor.K(speed), rotor.C(speed), rotor.G())
    )
    n = len(mass)
    generator = np.block(
        [
            [np.zeros((n, n)), np.eye(n)],
            [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping + speed * gyroscopic)],
        ]
    )
    values = np.linalg.eigvals(generator)
    values = values[values.imag > 1.0]
    return values[np.argsort(values.imag)][:LOWEST]


def pairs(values):
    return [[float(value.real), float(value.imag)] for value in np.asarray(values, complex)]


def main():
    import ross

    table = {name: of_rotor(*parts) for name, parts in examples(ross).items()}
    place = Path(__file__).with_suffix(".json")
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(rotor)}" for name, rotor in table.items())
    place.write_text(f"{{{lines}}}\n")


if __name__ == "__main__":
    main()
