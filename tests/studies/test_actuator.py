"""What motions ask of magnetic bearings: against the equations in SI units, integrated in the fixed frame."""

import json

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from carom import State, find_attractors, load, simulate
from carom.base.files import as_json
from carom.base.outcome import Phase
from carom.disturbances import KickPlane, Sample
from carom.models import jeffcott
from carom.orbits import orbits_within_reach
from carom.parameters import Case, Machine, Parameters, Scales, Zones
from carom.studies.actuator import bearing_demand, centre_along, largest_along, slew_limit_of

KEOGH = "examples/keogh-cole.toml"
BEARINGS = ["magnetic_bearings=2", "force_current_factor=70 N/A", "negative_stiffness=210 N/mm"]


def rated(*settings, slew="5 A/ms"):
    return load(KEOGH, [*BEARINGS, f"slew_rate_limit={slew}", *settings])


def by_integration(machine, place, speed, until, count=20_001):
    """Rate of the current of one bearing while the rotor flies, by differences, and its largest distance, in SI units.

    From a state in the fixed frame at the time zero.
    """

    def rate(time, state):
        z, w = state
        unbalance = machine.mass * machine.eccentricity * machine.speed**2
        turning = np.exp(1j * (machine.speed * time + machine.unbalance_phase))
        return np.array([w, (unbalance * turning - machine.damping * w - machine.stiffness * z) / machine.mass])

    times = np.linspace(0.0, until, count)
    run = solve_ivp(rate, (0.0, until), np.array([place, speed], complex), "DOP853", times, rtol=1e-11, atol=1e-14)
    z, w = run.y
    gains = machine.controller_gains
    current = gains["proportional_gain"] * z + gains["derivative_gain"] * w
    return np.abs(np.gradient(current, times, edge_order=2)), np.abs(z).max()


@pytest.mark.parametrize(("place", "kick"), [(0.05 + 0.1j, 0.1), (-0.2j, 0.05j)])
def test_the_rate_of_the_current_of_a_flight_is_that_of_the_equations_in_si_units(place, kick):
    case = rated("eccentricity=0.02 mm")
    machine, scales = case.machine, case.parameters.scales
    until = 60.0
    motion = simulate(case, State(place, kick), until)
    rates, farthest = by_integration(
        machine, place * scales.length, (kick + 1j * place) * scales.velocity, until * scales.time
    )
    assert farthest < machine.clearance  # it does not touch

    rate = largest_along(motion, slew_limit_of(case))

    # The instants are so close that the largest value is missed by less than 0.1 %.
    # Differences over 0.003 of the fastest period are wrong by the square of that times some number of order 10.
    assert rates.max() * (1 - 1e-3) <= rate <= rates.max() * (1 + 1e-4)


def test_a_bouncing_orbit_asks_for_what_its_flight_does():
    case = rated("damping=1200 N s/m")
    machine, scales = case.machine, case.parameters.scales
    (orbit,) = [orbit for orbit in orbits_within_reach(jeffcott(case.parameters)) if orbit.admissible and orbit.stable]
    state = orbit.departure
    rates, _ = by_integration(
        machine,
        state.position * scales.length,
        (state.velocity + 1j * state.position) * scales.velocity,
        orbit.period * scales.time,
    )

    motion, limit = orbit.trajectory(), slew_limit_of(case)

    assert largest_along(motion, limit) == pytest.approx(rates.max(), rel=1e-3)


def test_accelerations_are_those_of_differences_also_in_lasting_contact():
    """Of the velocity in the fixed frame, over an interval short against any change but long against rounding."""
    case = load(KEOGH, ["friction=0.1", "damping=300 N s/m", "restitution=0.5", "rotor_radius=14 mm"])
    motion = simulate(case, State(1.0, -2.5 - 1.5j), 30.0)
    assert {stay.phase for stay in motion.lasting_contacts} >= {Phase.FORWARD_SLIP, Phase.ROLLING}
    rng = np.random.default_rng(3)
    step = 1e-5
    times = rng.uniform(step, motion.time - step, 4000)
    nearest = np.abs(times[:, None] - motion.segment_starts[None, :]).min(axis=1)
    times = times[nearest > 2 * step]
    phases = motion.segment_phases[np.searchsorted(motion.segment_starts, times, side="right") - 1, 0]
    assert {Phase.FLIGHT, Phase.FORWARD_SLIP, Phase.ROLLING} <= set(phases.tolist())

    _, acceleration = centre_along(motion, times)

    before, after = (centre_along(motion, times + shift)[0] for shift in (-step, step))
    turned = after * np.exp(1j * step) - before * np.exp(-1j * step)
    # The centre goes round up to 20 times a turn, so fourth derivatives are at most some 400 accelerations.
    error = np.abs(turned / (2 * step) - acceleration).max()
    assert error <= (20 * step) ** 2 * np.abs(acceleration).max()


def test_the_acceleration_at_a_limit_is_that_of_differences():
    case = load(KEOGH, ["force_limit=400 N"])
    motion = simulate(case, State(0.3, 0.4 + 0.3j), 4.0)
    assert (motion.segment_limits > 1).any()
    step = 1e-5
    times = np.random.default_rng(1).uniform(step, motion.time - step, 2000)
    times = times[np.abs(times[:, None] - motion.segment_starts[None, :]).min(axis=1) > 2 * step]

    before, after = (centre_along(motion, times + shift)[0] for shift in (-step, step))
    turned = after * np.exp(1j * step) - before * np.exp(-1j * step)

    assert np.abs(turned / (2 * step) - centre_along(motion, times)[1]).max() < 1e-8


def test_without_limits_nothing_is_said_and_a_dimensionless_machine_has_none():
    assert slew_limit_of(load(KEOGH)) is None
    assert slew_limit_of(load("examples/source-paper.toml")) is None
    assert (
        bearing_demand(load(KEOGH), find_attractors(KEOGH_PARAMETERS, Sample(KickPlane(0.01), 2), known=False), ())
        is None
    )


KEOGH_PARAMETERS = load(KEOGH).parameters
QUIET = Parameters(0.5, 0.76, 3 / 7, 0.21, 0.0, 0.95, 400 / 7, Scales(50.0, 0.7e-3, 184.2))
BEARING_NUMBERS = {"magnetic_bearings": 2, "force_current_factor": 70.0, "negative_stiffness": 2.1e5}


@pytest.mark.jit_only
def test_disturbances_that_come_to_a_limit_are_counted_and_whether_they_come_back():
    machine = Machine.from_parameters(QUIET).replace(force_limit="500 N", **BEARING_NUMBERS)
    case = Case("limited", QUIET, machine, Zones())
    found = find_attractors(case, Sample(KickPlane(1.0), 12), known=False)

    demand = bearing_demand(case, found, ())

    assert demand.control.force == 1000.0
    assert demand.slew is None
    asked = []
    for ending in found.disturbances:
        motion = simulate(case, ending.start.state, max(ending.time, 1e-6))
        position, velocity = motion.at(motion.sample(5000))
        turned = motion.sample(5000) + ending.start.state.time
        place, speed = position * np.exp(1j * turned), (velocity + 1j * position) * np.exp(1j * turned)
        pull = machine.negative_stiffness * 2 / case.parameters.scales.stiffness
        force = ((QUIET.omega**2 + pull) * place + QUIET.gamma * speed) * case.parameters.scales.force
        asked.append(max(np.abs(force.real).max(), np.abs(force.imag).max()) > 1000.0)
    assert (demand.at_limit, demand.total) == (sum(asked), 12)
    text = demand.words
    assert "a control force of at most 1,000 N along each axis against a negative stiffness of 420,000 N/m" in text
    assert f"{sum(asked)} of 12 disturbances bring them to this limit" in text
    assert json.loads(as_json(demand.document()))["disturbances"]["at_limit"] == sum(asked)
