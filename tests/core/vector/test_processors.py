"""A processor without wide registers and without fused multiplication and addition finds the same motions."""

import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from machines import PAPER

from carom import State, settle
from carom.core.layout import LANE_NODES, LANES, LEVELS, OCTET
from carom.models import jeffcott

pytestmark = [
    pytest.mark.deep,  # it compiles all that flies in lanes anew
    pytest.mark.jit_only,
    pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="there is no plainer one of this kind"),
]

PLAINEST = {"NUMBA_CPU_NAME": "x86-64", "NUMBA_CPU_FEATURES": ""}
COUNT = 50
SHORT, STRONGLY_DAMPED = "0.1 20.0", "0.3 200000.0"
"""Damping and time: a horizon before rounding has grown by much, and motions that end apart from it."""
SCRIPT = f"""
import sys
import numpy as np
from carom import State, settle
from carom.models import jeffcott
from carom.core.ensemble import follow_each
from carom.core.layout import LANES, WIDTH
from lane_programs import program
from machines import PAPER

given, found = np.load(sys.argv[1]), {{}}
for case in ({SHORT!r}, {STRONGLY_DAMPED!r}):
    damping, until = map(float, case.split())
    rotor = jeffcott(PAPER.replace(gamma=damping))
    endings = settle(rotor, State(given["positions"], given["velocities"]), until=until, threads=1)
    found |= {{f"{{case}} {{name}}": values for name, values in vars(endings).items()}}
look_up = program("row, few, places, levels, out, first", [
    "store(out[0], first, take(row, load(places, first)))", "store(out[1], first, choose(few, load(levels, first)))",
])
found["looked_up"] = np.empty((len(given["places"]), 2, LANES))
for place in range(len(given["places"])):
    for first in range(0, LANES, WIDTH):
        arguments = given["places"][place], given["levels"][place], found["looked_up"][place]
        look_up(given["row"], given["few"], *arguments, first)
np.savez(sys.argv[2], **found)
(code,) = follow_each.inspect_asm().values()
print(*(word for word in ("xmm", "ymm", "zmm", "vfmadd", "mulpd") if word in code))
"""


@pytest.fixture(scope="module")
def given():
    """Starts on the wall and inside, and places to look up."""
    random = np.random.default_rng(70)
    positions = np.sqrt(random.random(COUNT)) * np.exp(2j * np.pi * random.random(COUNT))
    positions[::7] /= np.abs(positions[::7])
    turns = np.arange(LANE_NODES)[:, np.newaxis]
    return {
        "positions": positions,
        "velocities": random.normal(size=COUNT) + 1j * random.normal(size=COUNT),
        "row": random.normal(size=LANE_NODES),
        "few": random.normal(size=OCTET),
        "places": (turns + 5.0 * np.arange(LANES)) % LANE_NODES,
        "levels": (turns + np.arange(LANES) ** 2.0) % LEVELS,
    }


@pytest.fixture(scope="module")
def found(given, tmp_path_factory):
    """What a process finds that makes no use of more than every processor of this architecture has."""
    directory = tmp_path_factory.mktemp("plainest")
    np.savez(directory / "given.npz", **given)
    places = {"CAROM_CACHE_DIR": str(directory), "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, directory / "given.npz", directory / "found.npz"],
        env={**os.environ, **places, **PLAINEST},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["xmm", "mulpd"]
    with np.load(directory / "found.npz") as stored:
        return dict(stored)


@pytest.mark.parametrize("case", [SHORT, STRONGLY_DAMPED])
def test_motions_are_the_same(given, found, case):
    damping, until = map(float, case.split())
    here = settle(jeffcott(PAPER.replace(gamma=damping)), State(given["positions"], given["velocities"]), until=until)
    for name in ("outcomes", "impacts", "multiplicities"):
        np.testing.assert_array_equal(found[f"{case} {name}"], getattr(here, name), err_msg=name)
    np.testing.assert_allclose(found[f"{case} times"], here.times, rtol=1e-9)
    for name in ("positions", "velocities"):
        np.testing.assert_allclose(found[f"{case} {name}"], getattr(here, name), rtol=0.0, atol=1e-8, err_msg=name)
    assert here.impacts.sum() > 5 * COUNT
    assert len(np.unique(here.outcomes)) > 1 or case == SHORT


def test_rows_are_looked_up(given, found):
    expected = [given["row"][given["places"].astype(int)], given["few"][given["levels"].astype(int)]]
    np.testing.assert_array_equal(found["looked_up"], np.stack(expected, axis=1))
