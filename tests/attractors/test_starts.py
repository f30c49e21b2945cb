"""Samples of starts: what they hold and that they repeat."""

import numpy as np
import pytest

from carom.attractors import DisturbanceSet, known_starts
from carom.attractors.starts import disturbances_of
from carom.closed_forms.whirl import runaway_speed
from carom.models import Jeffcott
from carom.orbits.single_impact import find_orbits
from carom.outcome import InputError
from carom.parameters import Parameters, Scales

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)


def disturbances(rotor, *chosen, **named):
    single, _ = disturbances_of(rotor, DisturbanceSet(*chosen, **named))
    return single


def states(starts):
    return [(start.kind, start.state.position, start.state.velocity) for start in starts]


def test_sample_is_the_same_for_the_same_seed_only():
    rotor = Jeffcott(SOURCE)

    assert states(disturbances(rotor, 50, seed=3)) == states(disturbances(rotor, 50, seed=3))
    assert states(disturbances(rotor, 50, seed=3)) != states(disturbances(rotor, 50, seed=4))


@pytest.mark.parametrize("count", [0, 1, 11, 100, 300])
def test_sample_has_as_many_starts_as_asked_for(count):
    sample = disturbances(Jeffcott(SOURCE), count)

    assert len(sample) == count
    assert all(start.disturbance for start in sample)


def test_kicks_grow_and_start_from_levitation_in_all_directions():
    rotor = Jeffcott(SOURCE)
    kicks = [start for start in disturbances(rotor, 200, fastest=3.0) if start.kind == "kick"]
    speeds = [start.speed for start in kicks]

    assert len(kicks) == 120
    assert {start.state.position for start in kicks} == {rotor.equilibrium}
    assert speeds == pytest.approx(sorted(speeds))
    assert (speeds[0], speeds[-1]) == pytest.approx((0.01, 3.0))
    for ring in np.split(np.array([start.angle for start in kicks]), 10):
        gaps = np.diff(np.sort(np.mod(ring, 2.0 * np.pi)))
        assert gaps == pytest.approx(np.full(11, np.pi / 6.0))


def test_starts_fill_the_clearance_and_the_disc_of_velocities():
    sample = [start.state for start in disturbances(Jeffcott(SOURCE), 5000, fastest=0.5) if start.kind == "start"]
    radii = np.abs([state.position for state in sample])
    speeds = np.abs([state.velocity for state in sample])

    assert radii.max() < 1.0
    assert speeds.max() < 0.5
    # Even over the area: the mean of r² is 1/2, to within four standard deviations of the sample.
    spread = 4.0 / np.sqrt(12.0 * len(sample))
    assert (radii**2).mean() == pytest.approx(0.5, abs=spread)
    assert ((speeds / 0.5) ** 2).mean() == pytest.approx(0.5, abs=spread)


def test_rotor_that_cannot_levitate_is_not_kicked_out_of_levitation():
    rotor = Jeffcott(SOURCE.replace(gamma=0.05))

    assert abs(rotor.equilibrium) > 1.0
    assert {start.kind for start in disturbances(rotor, 40)} == {"start"}


def test_set_is_the_sample_and_says_what_it_holds():
    rotor, chosen = Jeffcott(SOURCE), DisturbanceSet(50, seed=3, fastest=1.5)
    starts = chosen.starts(rotor)

    assert [(s.state.position, s.state.velocity) for s in disturbances(rotor, 50, 3, 1.5)] == [
        *zip(starts.positions.tolist(), starts.velocities.tolist(), strict=True)
    ]
    assert starts.exists.all()
    assert chosen.words(rotor) == (
        "50 disturbances (seed 3): 24 velocity kicks of the levitating rotor, 0.01 c_r Omega to 1.5 c_r Omega, and 26 starts "
        "spread over the clearance at up to 1.5 c_r Omega"
    )
    scaled = Jeffcott(SOURCE.replace(gamma=0.05, scales=Scales(mass=50.0, clearance=0.7e-3, speed=184.2)))
    assert chosen.words(scaled) == (
        "50 disturbances (seed 3): 50 starts spread over the clearance at up to 1.5 c_r Omega (193 mm/s)"
    )


@pytest.mark.parametrize("wrong", [{"count": -1}, {"fastest": 0.0}, {"fastest": float("inf")}])
def test_useless_set_is_an_error(wrong):
    with pytest.raises(InputError, match=next(iter(wrong))):
        DisturbanceSet(**wrong)


def test_known_motions_are_approached_from_both_sides():
    rotor = Jeffcott(SOURCE)
    sample = known_starts(rotor, find_orbits(rotor))
    kinds = [start.kind for start in sample]

    assert (kinds.count("orbit"), kinds.count("rub"), kinds.count("whirl")) == (8, 4, 2)
    assert not any(start.disturbance for start in sample)
    for first, second in zip(sample[0:12:2], sample[1:12:2], strict=True):
        assert first.state.position == second.state.position
        assert first.state.velocity != second.state.velocity


def test_virtual_motions_are_left_out():
    rotor = Jeffcott(SOURCE.replace(gamma=0.05))
    orbits = find_orbits(rotor)
    named = {start.words for start in known_starts(rotor, orbits) if start.kind == "orbit"}

    assert named == {f"a start next to {orbit.name}" for orbit in orbits if orbit.admissible}
    assert len(named) < len(orbits)


def test_whirl_starts_beyond_the_runaway_speed_and_at_rolling():
    rotor = Jeffcott(SOURCE)
    speeds = [-1.0 - start.state.velocity.imag for start in known_starts(rotor, ()) if start.kind == "whirl"]

    assert speeds == pytest.approx([1.001 * runaway_speed(rotor).certain, 400 / 7])


def test_no_whirl_start_without_friction():
    rotor = Jeffcott(SOURCE.replace(mu=0.0))

    assert [start.kind for start in known_starts(rotor, ())] == ["rub"] * 4
