"""A law enters by one file: a spring that hardens with the cube of the depth, against SciPy."""

import os
import subprocess
import sys

LAW = """
from dataclasses import dataclass
from carom.core.compiling.decorators import formula
from carom.core.laws.compliant import no_impulse
from carom.core.laws.hunt_crossley import press_coefficient, press_rounding
from carom.core.laws.kelvin_voigt import edge
from carom.core.laws.law import Law
impulse = impulse_by_speed = impulse_by_restitution = no_impulse
@formula
def force(depth, rate, wall):
    return wall.stiffness * (depth + wall.law_number * depth**3)
@formula
def force_coefficient(k, depth, rate, power, wall):
    power[k] = 0.0
    for i in range(k + 1):
        for j in range(k + 1 - i):
            power[k] += depth[i] * depth[j] * depth[k - i - j]
    return wall.stiffness * (depth[k] + wall.law_number * power[k])
@formula
def force_rounding(of_depth, of_rate, wall):
    return wall.stiffness * (1.0 + 3.0 * wall.law_number) * of_depth
@dataclass(frozen=True)
class Cubic(Law):
    stiffness: float
    hardening: float
    law = "cubic"
    def numbers(self, mass):
        return {"stiffness": self.stiffness / mass, "law_number": self.hardening}
    def at_speed(self, factor):
        return Cubic(self.stiffness / factor**2, self.hardening)
"""
USE = """
import sys, numpy as np, carom as cm
from carom.core import laws
laws.__path__.append(sys.argv[1])
from carom.core.laws.cubic import Cubic
from carom.models import from_matrices, Touchdown
from scipy.integrate import solve_ivp
wall = Touchdown((1.0,), Cubic(500.0, 40.0), friction=0.0, surface_speed=3.0)
rotor = from_matrices(mass=[[1.0]], damping=[[0.2]], stiffness=[[0.5]], forcing=[0.0], touchdowns=[wall])
motion = cm.simulate(rotor, cm.State(0.5, 1.3 + 0.4j), 1.4)
def rates(_, state):
    depth = max(abs(state[0]) - 1.0, 0.0)
    return [state[1], -0.2 * state[1] - 0.5 * state[0] - 500.0 * (depth + 40.0 * depth**3) * state[0] / abs(state[0])]
end = solve_ivp(rates, (0.0, 1.4), [0.5 + 0j, 1.3 + 0.9j], method="DOP853", rtol=1e-12, atol=1e-13, max_step=1e-3).y[0, -1]
apart = abs(end * np.exp(-1.4j) - motion.at(1.4)[0])
assert len(motion.event_amplitudes) > 1 and apart < 1e-9, apart
"""


def test_a_law_of_one_file_is_found_and_followed(tmp_path):
    (tmp_path / "cubic.py").write_text(LAW)
    command = [sys.executable, "-c", USE, str(tmp_path)]
    subprocess.run(command, check=True, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, timeout=300)
