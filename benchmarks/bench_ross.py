"""One second of a levitated rotor on magnetic bearings from rest: ROSS, and carom at better accuracy, in one run.

Set ``CAROM_ROSS_PYTHON`` to a Python that has ROSS; ``-s`` shows the table.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

PEERS = Path(__file__).parents[1] / "tests" / "against_peers"
PYTHON = os.environ.get("CAROM_ROSS_PYTHON")


@pytest.mark.skipif(not PYTHON, reason="CAROM_ROSS_PYTHON names no Python that has ROSS")
def test_one_second_of_levitation():
    sys.path.insert(0, str(PEERS))
    import test_ross_transient as peer

    import carom as cm

    exact, found = peer.exact("magnets", 22), {}
    model = peer.machine_of("magnets").reduce(0.2).linear
    nowhere = np.zeros(len(model.system.rest))
    times = np.linspace(0.0, peer.TABLE["speed"], 10001)
    for _ in range(2):  # the kernels are compiled in the first
        begun = time.perf_counter()
        motion = cm.simulate(model, cm.State(nowhere, nowhere), "1 s")
        _ = [motion.seen_at(plane).position(times, "fixed") for plane in range(3)]
        found["carom"] = time.perf_counter() - begun
    done = subprocess.run(
        [str(PYTHON), str(PEERS / "ross_transient.py"), "--time"], capture_output=True, text=True, check=True
    )
    lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"rotor"')]
    found["ROSS"] = next(line["seconds"] for line in lines if line["rotor"] == "magnets")
    own = peer.exact("magnets", model.reduced.modes)
    off = np.linalg.norm(own - exact) / np.linalg.norm(exact)
    print(f"\ncarom {found['carom']:.3f} s, error {off:.1e}, {model.reduced.modes} modes; ROSS {found['ROSS']:.1f} s")
    print(
        f"ROSS's errors with this step: {peer.errors('magnets', 'newmark', exact)[0]:.2g}, "
        f"and {peer.errors('magnets', 'newmark', peer.exact('magnets', 22, reverse=True))[0]:.2g} of the rotor that it follows"
    )
    print(f"ratio of times {found['ROSS'] / found['carom']:.0f}")
