"""The least damping above which the disturbances tried come back."""

import numpy as np
import pytest
from scipy.stats import binom

from carom.attractors import DisturbanceSet, find_attractors
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.whirl import rolling, runaway_speed
from carom.models import Jeffcott
from carom.motions.ensembles import settle
from carom.outcome import InputError, Outcome
from carom.parameters import Parameters, Scales
from carom.studies.safety import least_safe_damping
from carom.studies.safety.losses import SLOW, Losses

pytestmark = pytest.mark.jit_only

SOURCE = Parameters(
    gamma=0.1,
    omega=0.76,
    rho=3 / 7,
    phi=0.21,
    mu=0.15,
    d=0.95,
    radius_ratio=400 / 7,
    scales=Scales(mass=50.0, clearance=0.7e-3, speed=184.2),
)
SLIVERS = Parameters(
    gamma=0.3, omega=0.557251, rho=0.137942, phi=-0.797449, mu=0.472273, d=0.363411, radius_ratio=1.882414
)
"""What is lost to rolling shrinks to 1 in 1,000 of the disturbances long before it is gone."""


@pytest.fixture(scope="module")
def safe():
    return least_safe_damping(SOURCE, count=600, highest=2.0)


def lost(parameters, gamma, count, seed, fastest=2.0):
    rotor = Jeffcott(parameters.replace(gamma=gamma))
    return count - settle(rotor, *DisturbanceSet(count, seed, fastest).starts(rotor)[:2]).count(Outcome.LEVITATED)


def test_synchronous_rub_sets_the_damping_of_the_source_machine(safe):
    limit = safe.within_reach

    assert (limit.motion, limit.evidence) == ("synchronous rub", "closed form")
    assert limit.gamma == limit.above == pytest.approx(0.3700060, abs=5e-8)
    assert limit.gamma * SOURCE.scales.damping == pytest.approx(3408.0, abs=0.5)


def test_simulation_agrees_with_the_closed_form(safe):
    assert safe.simulated.motion == "synchronous rub"
    assert safe.simulated.gamma < safe.rub.gamma < safe.simulated.above
    assert safe.simulated.above == safe.checks[0].gamma == pytest.approx(1.01 * safe.rub.above)


def test_orbits_end_at_their_fold(safe):
    assert (safe.orbits.motion, safe.orbits.evidence) == ("B1,d", "search")
    assert safe.orbits.gamma == pytest.approx(0.1780277257, rel=2e-9)


def test_rolling_counts_only_for_starts_fast_enough(safe):
    roll = rolling(Jeffcott(SOURCE))

    assert safe.at_all == safe.rolling
    assert (safe.rolling.gamma, safe.rolling.above) == (roll.largest_damping, roll.damping_bound)
    assert safe.runaway.certain == runaway_speed(Jeffcott(SOURCE.replace(gamma=safe.within_reach.gamma))).certain


def test_fresh_disturbances_come_back_where_the_share_lost_is_said_to_be_small():
    """Of 20,000 at 1.2 times a limit bisected with 200 disturbances 29 are lost."""
    safe = least_safe_damping(SLIVERS, count=4000)
    limit = safe.within_reach

    assert (limit.motion, limit.evidence) == ("rolling backward whirl", "simulation")
    assert lost(SLIVERS, limit.gamma * 0.8, 20_000, seed=5) > 10
    for times in (1.0, 1.05, 1.2):
        assert lost(SLIVERS, times * limit.above, 20_000, seed=6) <= binom.ppf(0.999, 20_000, safe.share_below)
    # What no share of disturbances shows: the end, 40 % above that of the sample.
    assert lost(SLIVERS, 1.2 * limit.above, 20_000, seed=7) == 0
    assert limit.gamma < limit.above < 1.1 * limit.gamma


@pytest.mark.deep
@pytest.mark.parametrize("block", range(6))
def test_stated_confidence_holds_for_random_machines(block):
    """At any of the dampings tried a share above that stated is lost for 5 % of the machines at most."""
    contradicted = []
    for number in range(5 * block, 5 * block + 5):
        random = np.random.default_rng([11, number])
        parameters = Parameters(
            gamma=0.1,
            omega=random.uniform(0.3, 2.0),
            rho=10.0 ** random.uniform(-1.5, -0.05),
            phi=random.uniform(-3.0, 3.0),
            mu=random.uniform(0.02, 0.5),
            d=random.uniform(0.3, 0.98),
            radius_ratio=10.0 ** random.uniform(0.15, 2.0),
        )
        safe = least_safe_damping(parameters)
        limit = safe.checks[0].gamma
        for times in (1.0, 1.02, 1.05, 1.1, 1.2, 1.35, 1.5, 1.75, 2.0):
            if times * limit <= safe.highest:
                seen = lost(parameters, times * limit, 20_000, seed=1000 + number)
                if seen > binom.ppf(0.999, 20_000, safe.share_below):
                    contradicted.append((number, times, seen))
    assert not contradicted


def test_every_check_can_be_done_again(safe):
    share = safe.share_below

    assert len(safe.checks) > 10
    assert [check.gamma for check in safe.checks] == sorted(check.gamma for check in safe.checks)
    assert safe.checks[-1].gamma == safe.highest
    for check in safe.checks[::5]:
        assert (check.lost, check.sample.count, check.sample.fastest) == (0, 600, 2.0)
        assert lost(SOURCE, check.gamma, 600, check.sample.seed) == 0
    assert len({check.sample.seed for check in safe.checks}) == len(safe.checks)
    # So large a share is missed by one sample with a probability of 5 % over the number a search may take.
    assert (1.0 - share) ** 600 == pytest.approx(0.05 / 120)


def test_faster_disturbances_are_counted_apart(safe):
    faster = safe.faster

    assert (faster.gamma, faster.sample.fastest, faster.sample.count) == (safe.checks[0].gamma, 4.0, 150)
    assert faster.lost == lost(SOURCE, faster.gamma, 150, faster.sample.seed, 4.0)
    # 187 of 8,000 just above the limit.
    assert lost(SOURCE, faster.gamma, 8000, 1, 4.0) / 8000 == pytest.approx(187 / 8000, rel=0.6)


@pytest.mark.parametrize("gamma", [0.38, 0.6, 1.5])
def test_above_the_limit_everything_tested_levitates(gamma):
    found = find_attractors(Jeffcott(SOURCE.replace(gamma=gamma)), count=60, known=False, seed=7)

    assert [member.name for member in found] == ["levitation"]


def test_own_damping_and_threads_do_not_matter(safe):
    other = least_safe_damping(SOURCE.replace(gamma=0.7), count=600, highest=2.0, threads=1)

    assert (other.rub, other.orbits, other.simulated, other.rolling, other.checks, other.faster) == (
        safe.rub,
        safe.orbits,
        safe.simulated,
        safe.rolling,
        safe.checks,
        safe.faster,
    )


@pytest.mark.deep
def test_faster_disturbances_reach_rolling():
    safe = least_safe_damping(SOURCE, count=600, highest=4.0, fastest=5.0)

    assert (safe.within_reach.motion, safe.within_reach.evidence) == ("rolling backward whirl", "simulation")
    assert safe.rub.gamma < safe.within_reach.gamma < rolling(Jeffcott(SOURCE)).largest_damping
    assert "ended in rolling backward whirl" in safe.words
    # Well below, disturbances roll; at the damping said to be safe none of another sample does.
    for gamma, rolls in ((0.8 * safe.simulated.gamma, True), (safe.simulated.above, False)):
        assert (lost(SOURCE, gamma, 4000, 9, 5.0) > 0) == rolls


def test_well_balanced_stiff_machine_is_safe_at_any_damping():
    stiff = SOURCE.replace(omega=2.0, rho=0.2, mu=0.05, d=0.5)
    safe = least_safe_damping(stiff, count=60, highest=2.0)

    assert len(find_equilibria(Jeffcott(stiff))) == 3
    assert safe.rub is safe.orbits is safe.simulated is safe.within_reach is None
    assert safe.at_all.motion == "rolling backward whirl"
    assert safe.words.startswith("None of 60 fresh disturbances ")


def test_without_friction_nothing_rolls():
    safe = least_safe_damping(SOURCE.replace(mu=0.0), count=60, highest=1.0)

    assert safe.rolling is None
    assert safe.at_all == safe.within_reach == safe.rub
    assert safe.rub.gamma == pytest.approx(3 / 7, rel=1e-15)
    assert safe.simulated.gamma < 3 / 7 < safe.simulated.above


def test_contact_at_the_highest_damping_is_said_so():
    safe = least_safe_damping(SOURCE, count=60, highest=0.2)

    assert safe.simulated.gamma == pytest.approx(0.2)
    assert safe.simulated.above == float("inf")
    assert safe.within_reach.above > safe.highest
    assert (safe.checks, safe.faster) == ((), None)
    assert safe.words.endswith("did not come back even at the largest damping tried (1,842 N s/m).")


def test_progress_grows_to_one():
    done = []
    least_safe_damping(SOURCE, count=60, highest=0.5, progress=lambda report: done.append(report.share))

    assert done == sorted(done)
    assert done[-1] == 1.0


def test_starts_on_motions_with_a_known_end_are_varied_just_above_it(monkeypatch):
    """Below that end the rub or the orbit still exists; above it nothing says where its starts go."""
    followed = []
    vary = Losses.vary

    def noted(losses, lost, gamma):
        followed.append((lost, gamma))
        return vary(losses, lost, gamma)

    monkeypatch.setattr(Losses, "vary", noted)
    safe = least_safe_damping(SOURCE, count=600, highest=2.0)
    ends = {Outcome.FORWARD_RUB: safe.rub.above, Outcome.BOUNCING: safe.orbits.above}
    known = 0
    for lost, gamma in followed:
        (code, *others) = np.unique(lost.endings.outcomes)
        if not others and code in ends and (code != Outcome.BOUNCING or lost.once.all()):
            known += 1
            assert lost.gamma < ends[code]
            assert gamma == ends[code] * (1.0 + SLOW)
    assert known >= 2
    assert len(followed) <= 8


def test_no_motion_with_a_known_end_is_left_just_above_it(safe):
    for end, gone in ((safe.orbits.above, Outcome.BOUNCING), (safe.rub.above, Outcome.FORWARD_RUB)):
        for gamma, count in ((end * (1.0 - SLOW), 1), (end * (1.0 + SLOW), 0)):
            rotor = Jeffcott(SOURCE.replace(gamma=gamma))
            endings = settle(rotor, *DisturbanceSet(400, 3, 2.0).starts(rotor)[:2])
            once = endings.multiplicities == 1 if gone is Outcome.BOUNCING else True
            assert ((endings.outcomes == gone) & once).any() == count


@pytest.mark.parametrize("highest", [0.01, float("nan"), float("inf")])
def test_useless_range_is_an_error(highest):
    with pytest.raises(InputError, match="highest"):
        least_safe_damping(SOURCE, highest=highest)


def test_no_disturbances_are_an_error():
    with pytest.raises(InputError, match="count"):
        least_safe_damping(SOURCE, count=0)
