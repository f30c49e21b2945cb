"""Write ``ross_transient.json``: transients of levitated rotors by ROSS 2.3.0, as fine as its time steps go.

It is run by hand, in an environment of its own (``pip install ross-rotordynamics==2.3.0 "plotly<7"``), never by the tests, which compare the numbers with
exact ones:

    python tests/against_peers/ross_transient.py
    python tests/against_peers/ross_transient.py --time     # only tells how long one second takes

The rotors start at rest in the centre, and an unbalance of 1e-5 kg m acts from then on.
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
import time
from pathlib import Path

import numpy as np

SPEED, UNBALANCE = 300.0, 1e-5
END, SAMPLES = 0.05, 50
"""Seconds, and how many equal parts of them are kept."""
STEPS = (1e-4, 5e-5, 2.5e-5)
SPRING = 1e6, 200.0
"""N/m and N s/m of springs in place of bearings."""
GAINS = {"kp_pid": 6000.0, "kd_pid": 10.0, "ki_pid": 0.0, "n_f": 1e4}
"""Of magnetic bearings that hold the rotor by their stiffness: those that ROSS ships have none, ``ki kp + ks = 0``."""


def on_springs(ross):
    """The rotor of an example with the same springs in both directions."""
    shipped = ross.rotor_example_with_damping()
    bearings = [ross.BearingElement(each.n, kxx=SPRING[0], cxx=SPRING[1]) for each in shipped.bearing_elements]
    return ross.Rotor(shipped.shaft_elements, shipped.disk_elements, bearings)


def on_magnets(ross):
    """The rotor of an example on magnetic bearings."""
    shipped = ross.rotor_amb_example()
    magnets = [
        ross.MagneticBearingElement(n=each.n, g0=1e-3, i0=1.0, ag=1e-4, nw=200, alpha=0.392, **GAINS)
        for each in shipped.bearing_elements
    ]
    return ross.Rotor(shipped.shaft_elements, shipped.disk_elements, magnets)


def transient(rotor, method, step, end=END):
    """Displacement ``x + iy`` at the first disc and the bearings, sampled, and the seconds it took."""
    count = round(end / step)
    times = step * np.arange(count + 1)
    unbalanced = rotor.disk_elements[0].n
    force = rotor.unbalance_force_over_time([unbalanced], [UNBALANCE], [0.0], SPEED, times).T
    begun = time.perf_counter()
    with contextlib.redirect_stdout(io.StringIO()):
        moved = rotor.run_time_response(SPEED, force, times, method=method).yout
    lasted = time.perf_counter() - begun
    kept = moved[:: count // SAMPLES] if end == END else moved[-1:]
    nodes = [unbalanced, *(each.n for each in rotor.bearing_elements)]
    return [[[float(row[6 * node]), float(row[6 * node + 1])] for node in nodes] for row in kept], lasted


def main():
    import ross

    rotors = {"springs": on_springs(ross), "magnets": on_magnets(ross)}
    if "--time" in sys.argv:
        for name, rotor in rotors.items():
            transient(rotor, "newmark", 1e-4, 1e-3)  # its kernels compile on first use
            lasted = transient(rotor, "newmark", STEPS[0], 1.0)[1]
            print(json.dumps({"rotor": name, "step": STEPS[0], "seconds": lasted}), flush=True)
        return
    magnet = rotors["magnets"].bearing_elements[0]
    table = {
        "speed": SPEED,
        "unbalance": UNBALANCE,
        "end": END,
        "spring": SPRING,
        "magnet": {"ki": float(magnet.ki), "ks": float(magnet.ks), **GAINS},
        "runs": [
            {"rotor": name, "method": method, "step": step, "x": transient(rotor, method, step)[0]}
            for name, rotor in rotors.items()
            for method in ("newmark", "default")
            for step in STEPS
        ],
    }
    place = Path(__file__).with_suffix(".json")
    runs = ",\n".join(map(json.dumps, table.pop("runs")))
    place.write_text(f'{json.dumps(table)[:-1]}, "runs": [\n{runs}]}}\n', encoding="utf-8")


if __name__ == "__main__":
    main()
