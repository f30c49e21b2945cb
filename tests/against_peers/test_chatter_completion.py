"""What completing a chatter costs: against every bounce in 70 digits, by a prediction, and in the package's own loop."""

from dataclasses import dataclass
from functools import cached_property

import mpmath as mp
import numpy as np
import pytest
from machines import PAPER

from carom.base.outcome import Phase
from carom.core.advance import CHATTER_HEIGHT
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.parameters import Parameters

from .exact_chatter import DIGITS, ExactRotor, Rebound

HEIGHTS = sorted({CHATTER_HEIGHT, *(10.0**-power for power in range(5, 14))}, reverse=True)
LOWEST = 1e-32
AFTER = 1.0 / 64.0
"""Time after the end of the chatter at which states are compared."""
ROUNDING = 1e-14


@dataclass(frozen=True)
class Chatter:
    """A machine and a start on its wall, just after an impact, whose bounces accumulate."""

    parameters: Parameters
    angle: float
    rebound: float
    rate: float

    @property
    def start(self) -> State:
        position = complex(np.exp(1j * self.angle))
        return State(position, position * complex(-self.rebound, self.rate))

    @cached_property
    def rotor(self) -> ExactRotor:
        with mp.workdps(DIGITS):
            return ExactRotor(self.parameters)

    @cached_property
    def rebounds(self) -> list[Rebound]:
        """The first rebounds below each of the heights, and one that is as good as the end."""
        with mp.workdps(DIGITS):
            position, velocity = mp.mpc(self.start.position), mp.mpc(self.start.velocity)
            heights = [mp.mpf(height) for height in [*HEIGHTS, LOWEST]]
            return self.rotor.chatter(position / abs(position), velocity, heights)

    @property
    def until(self) -> float:
        return float(self.rebounds[-1].time) + AFTER

    def state(self, rebound: Rebound) -> tuple[complex, complex]:
        """Position and velocity at ``until`` of a chatter completed at a rebound, to double precision."""
        with mp.workdps(DIGITS):
            angle, rate = self.rotor.completed(rebound, mp.mpf(self.until))
            return complex(mp.expj(angle)), complex(1j * rate * mp.expj(angle))


SLIPPING = {d: Chatter(PAPER.replace(gamma=0.2, d=d), 0.5, 0.05, 0.3) for d in (0.3, 0.9, 0.95)}
GRIPPY = Parameters(gamma=0.2, omega=0.5, rho=3 / 7, phi=0.21, mu=0.6, d=0.3, radius_ratio=0.1)
STICKING = {
    0.3: Chatter(GRIPPY, 0.31, 5e-3, -1.097),
    0.7: Chatter(GRIPPY.replace(d=0.7), 0.31, 2e-3, -1.097),
    0.9: Chatter(GRIPPY.replace(d=0.9), 0.27, 5e-4, -1.099),
}
ALL = [*SLIPPING.values(), *STICKING.values()]
NAMES = [*(f"slipping, d = {d}" for d in SLIPPING), *(f"sticking, d = {d}" for d in STICKING)]


@pytest.mark.parametrize("chatter", ALL, ids=NAMES)
def test_completion_leaves_out_what_theory_says(chatter):
    """Slipping: height to the power 3/2.  Sticking: height.  Both with the factor that :mod:`exact_chatter` derives."""
    sticking = chatter in STICKING.values()
    with mp.workdps(DIGITS):
        end = chatter.rebounds[-1].time
        exact, exact_rate = chatter.rotor.completed(chatter.rebounds[-1], end)
        considered = [rebound for rebound in chatter.rebounds[:-1] if rebound.sticks == sticking]
        assert len(considered) >= 7
        ratios, orders = [], []
        for rebound in considered:
            angle, rate = chatter.rotor.completed(rebound, end)
            ratios.append(float((exact - angle) / chatter.rotor.predicted_error(rebound)))
            orders.append(float(abs(exact_rate - rate) / rebound.height ** mp.mpf(1.5)))
    assert ratios[-1] == pytest.approx(1.0, abs=1e-3)
    # What remains is of a higher order: ten times nearer with a hundredth of the height.
    distances = np.abs(np.array(ratios) - 1.0)
    heights = np.array([float(rebound.height) for rebound in considered])
    assert np.all(distances[-3:] < 3.0 * distances[0] * np.sqrt(heights[-3:] / heights[0]))
    if not sticking:
        assert orders[-1] == pytest.approx(orders[-3], rel=0.02)


@pytest.mark.parametrize("chatter", ALL, ids=NAMES)
def test_compiled_loop_ends_where_every_bounce_does(chatter):
    trajectory = simulate(jeffcott(chatter.parameters), chatter.start, chatter.until)
    kinds = {contact.phase for contact in trajectory.lasting_contacts}
    last = chatter.rebounds[-1]
    assert kinds == {Phase.ROLLING if last.sticks else Phase.FORWARD_SLIP}
    completed = next(rebound for rebound in chatter.rebounds if rebound.height <= CHATTER_HEIGHT)
    allowed = ROUNDING + 1.2 * abs(float(chatter.rotor.predicted_error(completed)))
    remaining = 2.0 * completed.speed / (completed.push * (1.0 - chatter.rotor.d))
    assert float(last.time) - trajectory.lasting_contacts[0].start == pytest.approx(float(remaining), rel=1e-3)
    position, velocity = chatter.state(last)
    assert abs(trajectory.final.position - position) < allowed
    assert abs(trajectory.final.velocity - velocity) < 2.0 * allowed
