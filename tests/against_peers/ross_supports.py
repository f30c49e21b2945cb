"""Write ``ross_supports.json``: what ROSS 2.3.0 computes for its first example on anisotropic bearings.

It is run by hand, in an environment of its own (``pip install ross-rotordynamics==2.3.0 "plotly<7"``), never by the tests:

    python tests/against_peers/ross_supports.py
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
SUPPORTS = (
    {"kxx": 1e7, "kyy": 4e6, "kxy": 5e5, "kyx": -1e5, "cxx": 500.0, "cyy": 900.0, "cxy": 60.0, "cyx": -30.0},
    {"kxx": 6e6, "kyy": 9e6, "kxy": -2e5, "kyx": 3e5, "cxx": 800.0, "cyy": 400.0, "cxy": 0.0, "cyx": 20.0},
)
SPEEDS = (200.0, 900.0)
FREQUENCIES = (50.0, 300.0, 1100.0)


def main():
    sys.path.insert(0, str(HERE))
    import ross
    from ross_imports import lateral, pairs

    shipped = ross.rotor_example()
    nodes = [each.n for each in shipped.bearing_elements]
    bearings = [ross.BearingElement(node, **numbers) for node, numbers in zip(nodes, SUPPORTS, strict=True)]
    rotor = ross.Rotor(shipped.shaft_elements, shipped.disk_elements, bearings)
    disc = rotor.disk_elements[0].n
    answers = rotor.run_unbalance_response(disc, 1.0, 0.0, np.array(FREQUENCIES)).forced_resp
    found = {
        "supports": [{"node": node, **numbers} for node, numbers in zip(nodes, SUPPORTS, strict=True)],
        "eigenvalues": [{"speed": speed, "values": pairs(lateral(rotor, speed))} for speed in SPEEDS],
        "unbalance": {
            "node": disc,
            "speeds": FREQUENCIES,
            "at_nodes": nodes,
            "x": [pairs(answers[6 * node]) for node in nodes],
            "y": [pairs(answers[6 * node + 1]) for node in nodes],
        },
    }
    (HERE / "ross_supports.json").write_text(json.dumps(found) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
