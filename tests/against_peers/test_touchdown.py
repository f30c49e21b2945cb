"""Whole touchdowns, from the first impact to rubbing or rolling, against peers that model contact in other ways.

The peers are a wall of springs, dashpots and Coulomb friction that grows stiff, and Siconos, whose time stepping solves a
contact problem with friction in every step.  Both converge, to the motion that carom gives and at the rate they should.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from machines import PAPER

from carom.base.outcome import Phase
from carom.models import jeffcott
from carom.motions import State, Trajectory, simulate
from carom.parameters import Parameters

from . import time_stepping

FORWARD, BACKWARD, ROLLING = Phase.FORWARD_SLIP, Phase.BACKWARD_SLIP, Phase.ROLLING

NO_COMPLIANT_WALL = "heyoka is not installed (it has no package for this platform)"


@dataclass(frozen=True)
class Touchdown:
    """A machine, a start in the fixed frame, the time to follow it and the contacts that must come."""

    parameters: Parameters
    position: complex
    velocity: complex
    until: float
    kinds: tuple[Phase, ...]

    def times(self, count: int) -> np.ndarray:
        return np.linspace(0.0, self.until, count + 1)[1:]

    def rigid(self, count: int) -> tuple[Trajectory, np.ndarray, np.ndarray]:
        """The motion carom gives, and its positions and velocities in the fixed frame at even times."""
        start = State(self.position, self.velocity - 1j * self.position)
        trajectory = simulate(jeffcott(self.parameters), start, self.until)
        times = self.times(count)
        position, velocity = trajectory.at(times)
        turn = np.exp(1j * times)
        assert [contact.phase for contact in trajectory.lasting_contacts] == list(self.kinds)
        return trajectory, position * turn, (velocity + 1j * position) * turn

    def with_restitution(self, restitution: float) -> "Touchdown":
        changed = self.parameters.replace(d=restitution)
        return Touchdown(changed, self.position, self.velocity, self.until, self.kinds)


CHATTER_TO_RUB = Touchdown(PAPER.replace(gamma=0.2, d=0.5), 0.2 + 0j, 1.0 + 0.3j, 12.0, (FORWARD,))
"""Bounces that accumulate, then sliding that swings into the stable synchronous rub."""
SLOW_WHIRL = Touchdown(
    PAPER.replace(gamma=0.02, mu=0.3, d=0.3, radius_ratio=2.0), 0.2 + 0j, 0.5 - 1.5j, 12.0, (FORWARD, ROLLING)
)
"""Chatter, a slide that friction drives into backward whirl, and rolling."""
FAST_WHIRL = Touchdown(PAPER.replace(gamma=0.05), 0.9 + 0j, 0.3 - 6.0j, 3.0, (FORWARD, ROLLING))
"""The machine of the source paper: 245 bounces, runaway, and rolling at 58 times the shaft speed."""
ALL_KINDS = Touchdown(
    PAPER.replace(mu=0.2, d=0.0, radius_ratio=1.2), -0.8 + 0j, 0.5 + 1.5j, 3.0, (BACKWARD, ROLLING, FORWARD)
)
"""An impact without rebound that reverses nothing: backward slip, rolling, forward slip, lift-off, flight."""


# ------------------------------------------------------------------------------------- a wall that grows stiff


@pytest.mark.parametrize(("touchdown", "nearest"), [(CHATTER_TO_RUB, 2e-4), (SLOW_WHIRL, 5e-4)], ids=["rub", "whirl"])
def test_stiff_wall_converges_with_the_root_of_its_stiffness(touchdown, nearest):
    pytest.importorskip("heyoka", reason=NO_COMPLIANT_WALL)
    from . import compliant_wall

    angle = 1.2
    case = touchdown.with_restitution(compliant_wall.restitution(angle))
    _, position, velocity = case.rigid(200)
    errors, ends = [], []
    for stiffness in (1e6, 1e7, 1e8):
        damping = compliant_wall.dashpot(angle, stiffness)
        soft = compliant_wall.follow(case.parameters, stiffness, damping, case.position, case.velocity, case.times(200))
        errors.append(np.abs(soft.position - position).max())
        ends.append(np.array([soft.position[-1] - position[-1], soft.velocity[-1] - velocity[-1]]))
    factors = np.divide(errors[:-1], errors[1:])
    # What is left of the next order falls by √10 too: at most 9.9 and 3.2 % were measured.
    assert (np.abs(factors / np.sqrt(10.0) - 1.0) < [0.11, 0.035]).all()
    assert errors[-1] < nearest
    # Without the term in 1/√k there remains one in 1/k.
    limits = [np.abs(np.sqrt(10.0) * fine - rough).max() / (np.sqrt(10.0) - 1.0) for rough, fine in pairwise(ends)]
    assert limits[0] / limits[1] == pytest.approx(10.0, rel=0.03)  # 2.1 % of the next order
    assert limits[1] < nearest / 10.0


def test_overdamped_wall_converges_where_nothing_rebounds():
    pytest.importorskip("heyoka", reason=NO_COMPLIANT_WALL)
    from . import compliant_wall

    _, position, _ = ALL_KINDS.rigid(200)
    errors = []
    for damping in (1e3, 1e4, 1e5):
        # Stiff enough to come back, damped enough that the contact stays closed: an impact takes the time 1/c.
        stiffness = 0.05 * damping**1.5
        soft = compliant_wall.follow(
            ALL_KINDS.parameters, stiffness, damping, ALL_KINDS.position, ALL_KINDS.velocity, ALL_KINDS.times(200)
        )
        errors.append(np.abs(soft.position - position).max())
        assert soft.phases[-2:] == [compliant_wall.RELEASED, compliant_wall.FLIGHT]
    # Of first order in 1/c, with a rest that falls from 38 to 8 %.
    assert (np.abs(np.divide(errors[:-1], errors[1:]) / 10.0 - 1.0) < [0.4, 0.09]).all()
    assert errors[-1] < 2e-5


# ------------------------------------------------------------------------------------------------- time stepping


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    if time_stepping.missing():
        pytest.skip(time_stepping.missing())
    directory = tmp_path_factory.mktemp("wall")
    time_stepping.compile_wall(directory)
    return directory


@pytest.mark.parametrize(
    ("touchdown", "nearest"),
    [(CHATTER_TO_RUB, 2e-4), (SLOW_WHIRL, 2e-3), (FAST_WHIRL, 0.2), (ALL_KINDS, 2e-4)],
    ids=["rub", "slow whirl", "fast whirl", "all kinds"],
)
def test_time_stepping_converges_with_its_step(wall, touchdown, nearest):
    _, position, _ = touchdown.rigid(100)
    steps = np.array([1e-3, 2.5e-4, 6.25e-5])
    errors = []
    for step in steps:
        stepped, _ = time_stepping.follow(
            touchdown.parameters,
            touchdown.position,
            touchdown.velocity,
            touchdown.until,
            round(touchdown.until / step),
            100,
            wall,
        )
        errors.append(np.abs(stepped - position).max())
    # Impacts fall anywhere within a step, so an error of the first order is its step times a number that wanders.
    rates = errors / steps
    assert rates.max() < 3.0 * rates.min()
    assert errors[-1] < nearest


def test_fast_whirl_chatters_runs_away_and_rolls():
    trajectory, _, _ = FAST_WHIRL.rigid(1)
    surface_speed = FAST_WHIRL.parameters.radius_ratio + 1.0
    assert len(trajectory.contacts) > 200
    assert abs(trajectory.final.velocity) == pytest.approx(surface_speed, rel=1e-12)
