"""The least damping above which no contact motion survives."""

import pytest

from carom.attractors import find_attractors
from carom.equilibria import equilibria
from carom.outcome import InputError
from carom.parameters import Parameters, Scales
from carom.rotors import jeffcott
from carom.safety import least_safe_damping
from carom.whirl import rolling, runaway_speed

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


@pytest.fixture(scope="module")
def safe():
    return least_safe_damping(SOURCE, count=60, highest=2.0)


def test_synchronous_rub_sets_the_damping_of_the_source_machine(safe):
    limit = safe.within_reach

    assert (limit.motion, limit.evidence) == ("synchronous rub", "closed form")
    assert limit.gamma == limit.above == pytest.approx(0.3700060, abs=5e-8)
    assert limit.gamma * SOURCE.scales.damping == pytest.approx(3408.0, abs=0.5)


def test_simulation_agrees_with_the_closed_form(safe):
    assert safe.simulated.motion == "synchronous rub"
    assert safe.simulated.gamma < safe.rub.gamma < safe.simulated.above
    assert safe.simulated.above / safe.simulated.gamma < 1.001


def test_orbits_end_at_their_fold(safe):
    assert (safe.orbits.motion, safe.orbits.evidence) == ("B1,d", "search")
    assert safe.orbits.gamma == pytest.approx(0.1780277257, rel=2e-9)


def test_rolling_counts_only_for_starts_fast_enough(safe):
    roll = rolling(jeffcott(SOURCE))

    assert safe.at_all == safe.rolling
    assert (safe.rolling.gamma, safe.rolling.above) == (roll.largest_damping, roll.damping_bound)
    assert safe.runaway.certain == runaway_speed(jeffcott(SOURCE.replace(gamma=safe.within_reach.gamma))).certain
    assert "none of the disturbances tested got there" in safe.words


def test_words_give_the_damping_in_si(safe):
    assert "Above gamma = 0.37001 (3408 N s/m) all disturbances tested come back" in safe.words
    assert "The last motion to vanish is the synchronous rub, known by a closed form." in safe.words
    assert "60 disturbances of up to 2 c_r Omega (0.258 m/s)" in safe.words
    assert "evidence, not proof" in safe.words


@pytest.mark.parametrize("gamma", [0.38, 0.6, 1.5])
def test_above_the_limit_everything_tested_levitates(gamma):
    found = find_attractors(jeffcott(SOURCE.replace(gamma=gamma)), count=60, known=False, seed=7)

    assert [member.name for member in found] == ["levitation"]


def test_own_damping_does_not_matter(safe):
    other = least_safe_damping(SOURCE.replace(gamma=0.7), count=60, highest=2.0)

    assert (other.rub, other.orbits, other.simulated, other.rolling) == (
        safe.rub,
        safe.orbits,
        safe.simulated,
        safe.rolling,
    )


def test_faster_disturbances_reach_rolling():
    safe = least_safe_damping(SOURCE, count=60, highest=2.0, fastest=5.0)

    assert (safe.within_reach.motion, safe.within_reach.evidence) == ("rolling", "simulation")
    assert safe.rub.gamma < safe.within_reach.gamma < rolling(jeffcott(SOURCE)).largest_damping
    assert "some of the disturbances tested got there" in safe.words
    # Just below, a disturbance rolls; at the damping said to be safe none of the same sample does.
    for gamma, rolls in ((safe.simulated.gamma, True), (safe.simulated.above, False)):
        rotor = jeffcott(SOURCE.replace(gamma=gamma))
        assert ("rolling" in find_attractors(rotor, count=60, fastest=5.0, known=False)) == rolls


def test_well_balanced_stiff_machine_is_safe_at_any_damping():
    stiff = SOURCE.replace(omega=2.0, rho=0.2, mu=0.05, d=0.5)
    safe = least_safe_damping(stiff, count=60, highest=2.0)

    assert len(equilibria(jeffcott(stiff))) == 3
    assert safe.rub is safe.orbits is safe.simulated is safe.within_reach is None
    assert safe.at_all.motion == "rolling"
    assert "all disturbances tested come back to levitation" in safe.words


def test_without_friction_nothing_rolls():
    safe = least_safe_damping(SOURCE.replace(mu=0.0), count=24, highest=1.0)

    assert safe.rolling is None
    assert safe.at_all == safe.within_reach == safe.rub
    assert safe.rub.gamma == pytest.approx(3 / 7, rel=1e-15)
    assert safe.simulated.gamma < 3 / 7 < safe.simulated.above


def test_contact_at_the_highest_damping_is_said_so():
    safe = least_safe_damping(SOURCE, count=12, highest=0.2)

    assert safe.simulated.gamma == pytest.approx(0.2)
    assert safe.simulated.above == float("inf")
    assert safe.within_reach.above > safe.highest
    assert "survive up to the highest damping looked at, gamma = 0.2 (1842 N s/m)" in safe.words


def test_progress_grows_to_one():
    done = []
    least_safe_damping(SOURCE, count=12, highest=0.5, progress=done.append)

    assert done == sorted(done)
    assert done[-1] == 1.0


@pytest.mark.parametrize("highest", [0.01, float("nan"), float("inf")])
def test_useless_range_is_an_error(highest):
    with pytest.raises(InputError, match="highest"):
        least_safe_damping(SOURCE, highest=highest)
