"""Bounces that hardly fade, on walls that return nearly all of the speed: no survivors."""

import numpy as np
import pytest
from compilation import sized

from carom.attractors import exponents_of, find_attractors
from carom.base.outcome import Outcome
from carom.basins import share_of_kicks
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.parameters import Parameters
from carom.studies.wording import ending_phrase, ending_words

ROLLS = Parameters(
    gamma=0.05071695, omega=0.77359473, rho=0.20472252, phi=1.08396837, mu=0.34598246, d=0.999, radius_ratio=99.134234
)
UNPROVEN = ROLLS.replace(gamma=1e-3, d=1.0)
"""Damping too weak for the proof that bounces fade to rolling."""


def starts(count: int, seed: int = 0) -> list[State]:
    random = np.random.default_rng(seed)
    places, speeds = np.sqrt(random.random((2, count))) * np.exp(2j * np.pi * random.random((2, count)))
    return [
        State(complex(place), complex(1.5 * speed - 1j * place)) for place, speed in zip(places, speeds, strict=True)
    ]


@pytest.mark.parametrize("d", [0.9995, 0.9999, 1.0])
def test_as_many_roll_as_a_little_below(d):
    below, here = (
        find_attractors(jeffcott(ROLLS.replace(d=each)), starts(sized(60, 4)), known=False) for each in (0.995, d)
    )
    assert [(str(member.name), member.count) for member in here] == [
        (str(member.name), member.count) for member in below
    ]
    assert {str(member.name) for member in here} == {"rolling backward whirl", "levitation"}
    rolls = here["rolling backward whirl"]
    assert rolls.whirl == "backward"
    assert "the bounces provably fade" in rolls.words
    # What is left of a bounce fades in finite time, unless the wall is elastic.
    assert (exponents_of(here.rotor, rolls) is None) == (d == 1.0)


def test_what_is_not_proven_to_fade_is_undecided_and_neither_survives_nor_comes_back():
    found = find_attractors(jeffcott(UNPROVEN), starts(sized(40, 4)), known=False)
    undecided = [member for member in found if member.name.outcome is Outcome.LOW_BOUNCES]
    assert sum(member.count for member in undecided) > 0.3 * len(found.endings)
    assert not any(member.settled or member.survival for member in undecided)
    assert not any(member.name.irregular for member in found)
    assert not any(ending.recovered for ending in found.endings if ending.attractor in {one.name for one in undecided})
    share = share_of_kicks(found)
    assert share is None or share.count == sum(ending.attractor == "levitation" for ending in found.endings)
    for one in undecided:
        assert ending_phrase(one.name) == "low bounces along the wall, undecided"
        assert ending_words(one.name.outcome) == "its end was not found: low bounces along the wall, undecided"
    assert exponents_of(found.rotor, undecided[0]) is None


@pytest.mark.parametrize("seed", range(sized(3, 1, 40)))
def test_no_motion_without_slip_survives_on_random_machines(seed):
    random = np.random.default_rng(seed)
    parameters = Parameters(
        gamma=10.0 ** random.uniform(-3.0, -0.3),
        omega=10.0 ** random.uniform(-0.5, 0.3),
        rho=random.uniform(0.02, 0.9),
        phi=random.uniform(-3.0, 3.0),
        mu=random.uniform(0.05, 0.6),
        d=random.choice([1.0, 1.0 - 10.0 ** random.uniform(-6.0, -3.0)]),
        radius_ratio=10.0 ** random.uniform(0.3, 2.3),
    )
    found = find_attractors(jeffcott(parameters), starts(sized(40, 4), seed), known=False)
    for member in found:
        if member.name.irregular:
            motion = simulate(found.rotor, member.state, 1e6, max_events=2000)
            log = motion.log_of(motion.is_impact)
            slip = np.abs(log.angular_speed + 1.0 + parameters.radius_ratio)
            stopped = slip <= parameters.mu * (1.0 + parameters.d) * log.radial_speed
            assert not stopped.all()
