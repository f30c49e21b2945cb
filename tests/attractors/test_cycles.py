"""What settled motions repeat."""

import dataclasses
import math

import numpy as np
import pytest

from carom.attractors.cycles import cycle_of, forces_on, orbit_of, same_cycle, whirl_of
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.whirl import rolling
from carom.models import Jeffcott
from carom.motions.starts import State
from carom.motions.trajectories import simulate
from carom.orbits.single_impact import find_orbits
from carom.outcome import Outcome
from carom.parameters import Parameters

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)


def settled(rotor, state):
    return simulate(rotor, state, 1e5, settle=True)


@pytest.fixture(scope="module")
def bouncing():
    rotor = Jeffcott(SOURCE)
    return settled(rotor, State(0.2 + 0.1j, -1.0 + 0.5j))


@pytest.fixture(scope="module")
def doubled():
    rotor = Jeffcott(SOURCE.replace(gamma=0.0832))
    leaving = find_orbits(rotor)["B1,d"].departure
    return [settled(rotor, State(leaving.position, factor * leaving.velocity)) for factor in (0.999, 1.001, 1.01, 0.99)]


def test_bouncing_repeats_its_orbit(bouncing):
    orbits = find_orbits(bouncing.rotor)
    cycle = cycle_of(bouncing)

    assert cycle.multiplicity == 1
    assert cycle.period == pytest.approx(orbits["B1,d"].period, rel=1e-7)
    assert orbit_of(cycle, orbits).name == "B1,d"
    assert orbit_of(cycle, [orbits["B1,c"]]) is None


@pytest.mark.jit_only
def test_two_impacts_a_period_are_the_same_from_either_impact(doubled):
    cycles = [cycle_of(motion) for motion in doubled]
    first = [cycle.velocities[0] for cycle in cycles]

    assert {cycle.multiplicity for cycle in cycles} == {2}
    assert max(abs(np.diff(first))) > 1e-2, "all of them ended at the same of the two impacts"
    assert all(same_cycle(cycles[0], cycle) for cycle in cycles)
    assert orbit_of(cycles[0], find_orbits(doubled[0].rotor)) is None


@pytest.mark.jit_only
def test_cycle_of_two_impacts_closes(doubled):
    cycle = cycle_of(doubled[0])
    before = State(complex(cycle.positions[0]), complex(cycle.velocities[0]))
    log = simulate(doubled[0].rotor, before, 1.2 * cycle.period).contacts

    assert log.time[2] == pytest.approx(cycle.period, abs=1e-7)
    assert log.radial_speed[0] == pytest.approx(
        cycle.velocities[0].real * cycle.positions[0].real + cycle.velocities[0].imag * cycle.positions[0].imag
    )
    assert log.radial_speed[2] == pytest.approx(log.radial_speed[0], abs=1e-7)
    assert log.angular_speed[2] == pytest.approx(log.angular_speed[0], abs=1e-7)
    assert log.angle[2] == pytest.approx(log.angle[0], abs=1e-7)
    assert abs(log.radial_speed[1] - log.radial_speed[0]) > 1e-2


@pytest.mark.jit_only
def test_different_orbits_are_different_cycles(bouncing, doubled):
    assert not same_cycle(cycle_of(bouncing), cycle_of(doubled[0]))
    other = dataclasses.replace(cycle_of(bouncing), velocities=cycle_of(bouncing).velocities * (1.0 + 1e-4))
    assert not same_cycle(cycle_of(bouncing), other)


def test_impulse_on_an_orbit_is_that_of_its_impact(bouncing):
    orbit = find_orbits(bouncing.rotor)["B1,d"]

    assert forces_on(bouncing, cycle_of(bouncing)) == pytest.approx((1.95 * orbit.radial_speed, 0.0), rel=1e-7)


@pytest.mark.jit_only
def test_synchronous_rub_presses_with_the_force_of_its_equilibrium():
    rotor = Jeffcott(SOURCE.replace(gamma=0.2))
    rub = find_equilibria(rotor)[1]
    motion = settled(rotor, State(rub.position, 0.05j * rub.position))
    cycle = cycle_of(motion)

    assert (cycle.outcome, cycle.synchronous, cycle.period) == (Outcome.FORWARD_RUB, True, None)
    impulse, force = forces_on(motion, cycle)
    assert impulse == 0.0
    assert force == pytest.approx(rub.normal_force, rel=1e-8)
    assert whirl_of(motion, cycle) == "forward"


def test_rolling_goes_backward_with_its_closed_form_force():
    motion = settled(Jeffcott(SOURCE), State(1.0 + 0j, -1j * (1.0 + 400 / 7)))
    cycle = cycle_of(motion)

    assert cycle.outcome is Outcome.ROLLING
    assert cycle.period == pytest.approx(2.0 * math.pi / (1.0 + 400 / 7), rel=1e-12)
    assert forces_on(motion, cycle)[1] == pytest.approx((400 / 7) ** 2 - 0.76**2 + 3 / 7, rel=1e-12)
    assert whirl_of(motion, cycle) == "backward"


@pytest.mark.jit_only
@pytest.mark.parametrize("ratio", [5.0, 400 / 7])
def test_rolling_that_slides_a_part_of_each_turn_is_backward_whirl(ratio):
    # Damping halfway between that up to which rolling holds and that beyond which no backward whirl can.
    parameters = SOURCE.replace(radius_ratio=ratio, rho=1.0)
    limits = rolling(Jeffcott(parameters))
    rotor = Jeffcott(parameters.replace(gamma=0.5 * (limits.largest_damping + limits.damping_bound)))
    motion = settled(rotor, State(1.0 + 0j, -1j * (1.0 + ratio)))
    cycle = cycle_of(motion)

    assert (cycle.outcome, cycle.synchronous) == (Outcome.BACKWARD_WHIRL, False)
    assert cycle.period > limits.period
    again = simulate(rotor, motion.final, cycle.period).final
    assert again.position == pytest.approx(motion.final.position, abs=1e-8)
    assert again.velocity == pytest.approx(motion.final.velocity, abs=1e-8 * ratio)
    assert whirl_of(motion, cycle) == "backward"
    impulse, force = forces_on(motion, cycle)
    assert impulse == 0.0
    assert limits.least_force < force <= limits.largest_force


def test_levitation_is_at_rest_and_touches_nothing():
    motion = settled(Jeffcott(SOURCE.replace(gamma=0.5)), State(0.1 + 0j))
    cycle = cycle_of(motion)

    assert (cycle.outcome, cycle.synchronous) == (Outcome.LEVITATED, True)
    assert forces_on(motion, cycle) == (0.0, 0.0)
    assert whirl_of(motion, cycle) == "forward"


def test_rotor_without_unbalance_does_not_whirl():
    motion = simulate(Jeffcott(SOURCE.replace(gamma=0.5, rho=0.0)), State(0j), 100.0, settle=True)

    assert whirl_of(motion, cycle_of(motion)) == "none"
