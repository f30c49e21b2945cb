"""Plans of small sweeps, and tasks that are quick, slow, fail or die: importable, so that other processes know them."""

import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from carom.disturbances import Sample, VelocityKick
from carom.parameters import Case, Parameters, Zones
from carom.sweeps.axes import GridAxis
from carom.sweeps.basins import BasinsTask
from carom.sweeps.plan import SweepPlan, cut
from carom.sweeps.variables import Variable

DAMPED = Parameters(gamma=0.6, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
"""The machine of the source paper with so much damping that motions settle soon."""


@dataclass(frozen=True)
class Drawn:
    """Stores the parameter that varies and a random number."""

    seconds_taken: float = 0.0
    kind: ClassVar[str] = "drawn"
    starts: ClassVar[int] = 0
    seconds: ClassVar[float] = 1.0
    variables: ClassVar[tuple] = (Variable("value", "what varies"), Variable("draw", "a random number", "count"))

    def describe(self):
        return {"kind": self.kind}

    def evaluate(self, case, seed):
        time.sleep(self.seconds_taken)
        return {"value": case.parameters.gamma, "draw": int(seed.generate_state(1)[0])}


@dataclass(frozen=True)
class Failing(Drawn):
    """Fails where the damping is above a limit, until a file is there."""

    above: float = 0.5
    mended: str = "never"

    def evaluate(self, case, seed):
        if case.parameters.gamma > self.above and not Path(self.mended).exists():
            raise ZeroDivisionError("damping\nis too large")
        return super().evaluate(case, seed)


@dataclass(frozen=True)
class Deadly(Drawn):
    """Kills its process where the damping is above a limit; only once if it can leave a trace."""

    above: float = 0.5
    trace: str = ""

    def evaluate(self, case, seed):
        if case.parameters.gamma > self.above and not (self.trace and Path(self.trace).exists()):
            if self.trace:
                Path(self.trace).touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return super().evaluate(case, seed)


def plan_of(task, count=10, chunk=2, seed=5):
    """A sweep along the damping from 0.1 to 1."""
    axes = (GridAxis("gamma", "linear", (0.1, 1.0), count),)
    case = Case("paper", DAMPED, None, Zones())
    return SweepPlan(case, axes, task, cut((count,), task, chunk), seed)


def basins_plan(starts=12, chunk=2, shape=(4, 5), damping=(0.5, 0.9)):
    """Basins over damping and friction, quick ones; the last chunk of each row is half full."""
    axes = (GridAxis("gamma", "linear", damping, shape[0]), GridAxis("mu", "log", (0.05, 0.2), shape[1]))
    task = BasinsTask(Sample(VelocityKick(2.0), starts))
    return SweepPlan(Case("paper", DAMPED, None, Zones()), axes, task, cut(shape, task, chunk), 7)


def stored_bytes(store):
    """Every file of a store that follows from its plan and the processors: numbers, records, kinds of processors."""
    store = Path(store)
    files = [*store.glob("*/c/**/*"), *store.glob("records/*")]
    return {str(file.relative_to(store)): file.read_bytes() for file in sorted(files) if file.is_file()}
