"""Kinds of attractors: each with what it claims, checked by another route."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from carom.attractors import find_attractors
from carom.attractors.characters import character_of, lasting_of
from carom.attractors.survival import Survival
from carom.models import jeffcott
from carom.motions import State, simulate
from carom.orbits import find_orbits
from carom.outcome import Outcome
from tests.compilation import sized
from tests.machines import PAPER
from tests.orbits.test_exponents import CHAOTIC, ROLLING, lively, nearby_growth

pytestmark = pytest.mark.jit_only


def characters(parameters, count=48, impacts=5000, **limits):
    found = find_attractors(parameters, count=count, **limits)
    return {entry.name: (entry, character_of(parameters, entry, impacts)) for entry in found}


def test_kinds_of_the_machine_of_the_paper():
    found = characters(PAPER.replace(gamma=0.0815))
    kinds = {name: character.kind for name, (_, character) in found.items()}
    assert kinds.pop("levitation") == "equilibrium"
    assert kinds.pop("synchronous rub") == kinds.pop("rolling backward whirl") == "rub"
    assert set(kinds.values()) == {"periodic"}
    assert {found[name][1].orbit.impacts for name in kinds} >= {6}
    entry, rub = found["synchronous rub"]
    assert entry.settled
    assert rub.lasting == "attractor"
    np.testing.assert_allclose(rub.rates, [-0.19075, -0.19075, -np.inf, -np.inf], atol=1e-4)
    np.testing.assert_allclose(found["levitation"][1].rates, -0.5 * 0.0815)


def test_chaos_has_an_exponent_that_nearby_motions_confirm_and_is_not_called_an_attractor():
    entry, chaos = characters(PAPER.replace(gamma=0.081), patience=5000)["irregular bouncing"]
    assert chaos.kind == "chaotic"
    assert chaos.lasting == "not seen to end"
    assert "attractor" not in chaos.words
    rate, error = nearby_growth(jeffcott(PAPER.replace(gamma=0.081)), entry.state, 10.0, sized(300, 1, 5000))
    assert rate > 3.0 * error
    value, uncertain = chaos.exponents.across
    assert abs(rate - value) < 5.0 * np.hypot(error, uncertain)


def test_the_torus_beside_the_orbit_of_three_impacts():
    """Two multipliers of that orbit have left the unit circle: the motion turns about it by their angle, and a little more."""
    machine = PAPER.replace(gamma=0.0918)
    (orbit,) = (orbit for orbit in find_orbits(machine, impacts=3) if 1.0 < orbit.multipliers.spectral_radius < 1.02)
    start = State(orbit.departure.position, 1.001 * orbit.departure.velocity)
    (entry,) = find_attractors(machine, [start], known=False, patience=3000)
    torus = character_of(machine, entry)
    assert torus.kind == "torus"
    assert torus.lasting == "not seen to end"
    assert torus.rotation.loops == 3
    turn = abs(np.angle(orbit.multipliers.values[0])) / (2.0 * np.pi)
    assert abs(torus.rotation.number - min(turn, 1.0 - turn)) < 0.02
    # Two exponents vanish on a torus.
    assert np.abs(torus.rates[:2]).max() < 1e-3
    assert torus.rates[2] < -1e-3


def test_periodic_ones_close_and_attract_whatever_their_word():
    rng, compared = np.random.default_rng(3), 0
    for rotor in (*(lively(rng) for _ in range(sized(4, 1, 300))), ROLLING):
        for entry, character in characters(rotor, count=24, patience=3000).values():
            if character.kind != "periodic":
                continue
            compared += 1
            orbit = character.orbit
            assert orbit.stable
            assert orbit.admissible
            # Half a period later and a period after that, in the middle between contacts.
            once, again = (simulate(rotor, orbit.departure, part * orbit.period).final for part in (0.5, 1.5))
            # The orbit is closed to 1e-13; the motion amplifies this by its largest derivative within a period.
            assert abs(again.position - once.position) + abs(again.velocity - once.velocity) < 1e-6
            assert entry.period == pytest.approx(orbit.period, rel=1e-6)
    assert compared >= 1


def test_what_has_not_repeated_but_approaches_an_orbit_becomes_periodic():
    """Next to a period doubling differences shrink slowly: the motion is irregular if it is followed for too short a time."""
    rotor = PAPER.replace(gamma=0.0834)
    (name,) = (entry.name for entry in find_attractors(rotor, count=12) if entry.name.outcome is Outcome.BOUNCING)
    entry = find_attractors(rotor, count=12)[name]
    slow = replace(entry, name=replace(entry.name, multiplicity=0, orbit=None), state=_disturbed(entry.state))
    character = character_of(rotor, slow, 4000)
    assert character.kind == "periodic"
    assert character.orbit.impacts == 1
    assert character.exponents.across[0] == pytest.approx(
        np.log(abs(character.orbit.multipliers.values[0])) / 3.0, rel=5e-3
    )


def _disturbed(state: State) -> State:
    return State(state.position, state.velocity * 1.0001)


def test_a_backward_whirl_that_slides_and_rolls_is_an_orbit():
    """Where it rolls, nothing is left of a disturbance but a delay."""
    machine = PAPER.replace(gamma=0.31, omega=0.21, rho=1.17, mu=0.11, d=0.57, radius_ratio=3.64)
    _, whirl = characters(machine, count=200)["sliding backward whirl"]
    assert sorted(str(whirl.orbit.word).split()) == ["roll", "slide+"]
    assert whirl.orbit.admissible
    assert whirl.rates.tolist() == [0.0, -np.inf, -np.inf, -np.inf]
    _, rolling = characters(PAPER.replace(gamma=0.0815))["rolling backward whirl"]
    assert rolling.rates.tolist() == [0.0, -np.inf, -np.inf, -np.inf]


def test_motions_given_up_are_undecided():
    entry = next(iter(find_attractors(CHAOTIC, count=4, patience=2000)))
    given_up = replace(entry, name=replace(entry.name, outcome=Outcome.GRAZING))
    assert character_of(CHAOTIC, given_up).kind == "undecided"


def test_irregular_bouncing_of_unknown_survival_is_undecided():
    assert lasting_of(None) == "undecided"
    assert lasting_of(Survival(100, 20_000, 0, None, (4e5, np.inf))) == "not seen to end"
