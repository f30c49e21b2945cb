"""What motions ask of magnetic bearings: against the equations in SI units, integrated in the fixed frame."""

from __future__ import annotations

import dataclasses
import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from studies import study_once

from carom.attractors import find_attractors
from carom.closed_forms.equilibria import find_equilibria
from carom.closed_forms.whirl import rolling
from carom.disturbances import KickPlane, Sample
from carom.files import as_json
from carom.loading import load
from carom.models import Jeffcott
from carom.motions import State, simulate
from carom.orbits import orbits_within_reach
from carom.outcome import Phase
from carom.parameters import Case, Machine, Parameters, Scales, Zones
from carom.parameters.told import number
from carom.studies.actuator import Centre, actuator_words, bearing_demand, largest_along, largest_jumps, limits_of

KEOGH = "examples/keogh-cole.toml"
BEARINGS = ["magnetic_bearings=2", "force_current_factor=70 N/A", "negative_stiffness=210 N/mm"]


def limited(*settings, force="500 N", current="10 A", slew="5 A/ms"):
    limits = [f"force_limit={force}", f"current_limit={current}", f"slew_rate_limit={slew}"]
    return load(KEOGH, [*BEARINGS, *limits, *settings])


def demand_of(case, found):
    rotor = Jeffcott(case.parameters)
    return bearing_demand(case, find_equilibria(rotor).members, orbits_within_reach(rotor), rolling(rotor), found)


def by_integration(machine, place, speed, until, count=20_001):
    """Force, current and rate of the current of one bearing while the rotor flies, and its largest distance, in SI units.

    From a state in the fixed frame at the time zero; the rate is that of differences.
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
    force = machine.force_current_factor * -current + machine.negative_stiffness * z
    rates = np.abs(np.gradient(current, times, edge_order=2))
    return np.abs(force), np.abs(current), rates, np.abs(z).max()


@pytest.mark.parametrize(("place", "kick"), [(0.05 + 0.1j, 0.1), (-0.2j, 0.05j)])
def test_force_and_current_of_a_flight_are_those_of_the_equations_in_si_units(place, kick):
    case = limited("eccentricity=0.02 mm")
    machine, scales = case.machine, case.parameters.scales
    until = 60.0
    motion = simulate(case, State(place, kick), until)
    forces, currents, rates, farthest = by_integration(
        machine, place * scales.length, (kick + 1j * place) * scales.velocity, until * scales.time
    )
    assert farthest < machine.clearance  # it does not touch

    force, current, rate = largest_along(motion, limits_of(case))

    # The instants are so close that the largest value is missed by less than 0.1 %.
    assert forces.max() * (1 - 1e-3) <= force <= forces.max() * (1 + 1e-9)
    assert currents.max() * (1 - 1e-3) <= current <= currents.max() * (1 + 1e-9)
    # Differences over 0.003 of the fastest period are wrong by the square of that times some number of order 10.
    assert rates.max() * (1 - 1e-3) <= rate <= rates.max() * (1 + 1e-4)
    assert largest_jumps(motion, limits_of(case)) == (0.0, 0.0, 0.0)


def test_a_bouncing_orbit_asks_for_what_its_flight_does():
    case = limited("damping=1200 N s/m")
    machine, scales = case.machine, case.parameters.scales
    (orbit,) = [orbit for orbit in orbits_within_reach(Jeffcott(case.parameters)) if orbit.admissible and orbit.stable]
    state = orbit.departure
    forces, currents, rates, _ = by_integration(
        machine,
        state.position * scales.length,
        (state.velocity + 1j * state.position) * scales.velocity,
        orbit.period * scales.time,
    )

    motion, limits = orbit.trajectory(), limits_of(case)
    force, current, rate = largest_along(motion, limits)

    assert force == pytest.approx(forces.max(), rel=1e-3)
    assert current == pytest.approx(currents.max(), rel=1e-3)
    assert rate == pytest.approx(rates.max(), rel=1e-3)
    log = motion.contacts
    impulse = float(np.hypot(log.normal_impulse, log.tangential_impulse).max()) * scales.impulse
    *others, jump = largest_jumps(motion, limits)
    assert others == [0.0, 0.0]
    assert jump == pytest.approx(machine.controller_gains["derivative_gain"] * impulse / machine.mass, rel=1e-9)


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

    centre = Centre.along(motion, times)

    before, after = (Centre.along(motion, times + shift).velocity for shift in (-step, step))
    turned = after * np.exp(1j * step) - before * np.exp(-1j * step)
    # The centre goes round up to 20 times a turn, so fourth derivatives are at most some 400 accelerations.
    error = np.abs(turned / (2 * step) - centre.acceleration).max()
    assert error <= (20 * step) ** 2 * np.abs(centre.acceleration).max()


def test_steady_motions_are_exact():
    case = limited()
    machine = case.machine
    demand = demand_of(case, find_attractors(case, Sample(KickPlane(0.01), 4), known=False))
    by_name = {(each.motion, each.limit.kind): each for each in demand.motions}

    whirl = abs(machine.stiffness + 1j * machine.damping * machine.speed) / 2
    rub = by_name["synchronous rub", "force"]
    assert rub.largest == pytest.approx(whirl * machine.clearance, rel=1e-12)
    assert rub.share == pytest.approx(whirl * machine.clearance / 500.0, rel=1e-12)
    unbalance = machine.mass * machine.eccentricity * machine.speed**2
    dynamic = machine.stiffness - machine.mass * machine.speed**2 + 1j * machine.damping * machine.speed
    levitation = by_name["levitation", "force"]
    assert levitation.largest == pytest.approx(whirl * unbalance / abs(dynamic), rel=1e-10)
    gains = machine.controller_gains
    backward = machine.speed * machine.rotor_radius / machine.clearance
    current = abs(gains["proportional_gain"] - 1j * gains["derivative_gain"] * backward) * machine.clearance
    assert by_name["rolling backward whirl", "current"].largest == pytest.approx(current, rel=1e-12)
    # In a circular whirl the rate is the current times the speed of the whirl.
    assert by_name["rolling backward whirl", "slew rate"].largest == pytest.approx(current * backward, rel=1e-12)
    rate = by_name["levitation", "current"].largest * machine.speed
    assert by_name["levitation", "slew rate"].largest == pytest.approx(rate, rel=1e-12)


def test_one_bearing_of_two_bears_half():
    shares = []
    for count in (1, 2):
        case = load(KEOGH, [f"magnetic_bearings={count}", "force_limit=500 N"] if count > 1 else ["force_limit=500 N"])
        (limit,) = limits_of(case)
        shares.append(float(limit.asked(Centre(1.0, 0.0, 0.0))))
    assert shares[0] == pytest.approx(2 * shares[1], rel=1e-15)


def test_without_limits_nothing_is_said_and_a_dimensionless_machine_has_none():
    assert limits_of(load(KEOGH)) == limits_of(load("examples/source-paper.toml")) == ()
    assert demand_of(load(KEOGH), find_attractors(KEOGH_PARAMETERS, Sample(KickPlane(0.01), 2), known=False)) is None


KEOGH_PARAMETERS = load(KEOGH).parameters
QUIET = Parameters(0.5, 0.76, 3 / 7, 0.21, 0.0, 0.95, 400 / 7, Scales(50.0, 0.7e-3, 184.2))
BEARING_NUMBERS = {"magnetic_bearings": 2, "force_current_factor": 70.0, "negative_stiffness": 2.1e5}


@pytest.mark.jit_only
def test_a_study_says_what_the_bearings_cannot_give():
    """The study of a machine without limits, which other tests look at too, with the limits of its bearings."""
    free = study_once(QUIET)
    machine = Machine.from_parameters(QUIET).replace(force_limit="500 N", **BEARING_NUMBERS, current_limit="1 kA")
    case = Case("limited", QUIET, machine, Zones())
    result = dataclasses.replace(free, case=case)
    demand = result.bearing_demand

    beyond = demand.disturbances[0] > 1.0
    assert 0 < beyond.sum() < len(beyond)
    assert not (demand.disturbances[1] > 1.0).any()
    assert demand.doubtful == beyond.sum()
    text = next(fact.text for fact in result.facts if fact.topic == "Magnetic bearings")
    assert "at most 500 N of force and 1,000 A of current" in text
    assert f"{beyond.sum()} of {len(beyond)} disturbances ask for more force than that" in text
    assert f"None of {len(beyond)} disturbances ask for more current than that" in text
    (levitation,) = [each for each in demand.motions if (each.motion, each.limit.kind) == ("levitation", "force")]
    assert (
        f"In levitation the bearing force reaches {levitation.share:.3g} times its limit of 500 N and the bearing"
        in text
    )
    assert f"{demand.doubtful} of the {len(beyond)} that came back are among them" in text
    assert f"{demand.doubtful} disturbances ask for more than its magnetic bearings can give" in result.verdict.headline
    document = json.loads(as_json(result.to_dict()))["bearing_demand"]
    assert document["came_back_beyond"] == demand.doubtful
    assert document["disturbances"][0]["beyond"] == beyond.sum()
    assert math.isclose(document["motions"][0]["share"], document["motions"][0]["largest_si"] / 500.0, rel_tol=1e-12)

    # The worst disturbance, followed again at random instants.
    rng = np.random.default_rng(1)
    worst = int(np.argmax(demand.disturbances[0]))
    ending = result.attractors.disturbances[worst]
    motion = simulate(case, ending.start.state, ending.time)
    position, velocity = motion.at(np.sort(rng.uniform(0.0, min(ending.time, 20.0), 200_000)))
    machine, scales = case.machine, case.parameters.scales
    z, w = position * scales.length, (velocity + 1j * position) * scales.velocity
    forces = np.abs(machine.stiffness * z + machine.damping * w) / machine.magnetic_bearings
    assert forces.max() / 500.0 == pytest.approx(demand.disturbances[0][worst], rel=2e-3)


@pytest.mark.jit_only
def test_jumps_of_the_current_are_told_apart_from_its_rate():
    machine = Machine.from_parameters(QUIET).replace(**BEARING_NUMBERS, slew_rate_limit="40 kA/s")
    result = dataclasses.replace(study_once(QUIET), case=Case("limited", QUIET, machine, Zones()))
    demand = result.bearing_demand

    (limit,) = demand.limits
    assert (limit.kind, limit.most) == ("slew rate", 4e4)
    struck = np.array(
        [len(simulate(e.rotor, e.start.state, e.time).contacts) > 0 for e in result.attractors.disturbances]
    )
    assert (demand.jumps[0] > 0.0).tolist() == struck.tolist()
    assert (demand.disturbances[0] > 0.0).all()
    text = actuator_words(demand)
    assert "one magnetic bearing gives at most 40,000 A/s of slew rate" in text
    largest = demand.jumps[0].max()
    assert f"At an impact the controller asks at once for a current that differs by up to {number(largest)} A." in text
    assert f"The bearing takes {number(largest / 40)} ms for that" in text
    document = json.loads(as_json(demand.document()))
    assert document["disturbances"][0]["largest_jump_si"] == pytest.approx(largest)


@pytest.mark.deep
def test_no_instant_of_fresh_motions_asks_for_more_than_the_largest_value_found():
    rng = np.random.default_rng(20)
    for _ in range(300):
        numbers = {"gamma": rng.uniform(0.01, 1.5), "omega": 10 ** rng.uniform(-0.7, 1.0), "mu": rng.uniform(0.0, 0.4)}
        case = limited("eccentricity=0.1 mm", *(f"{name}={value!r}" for name, value in numbers.items()))
        start = State(rng.uniform(0, 0.9) * np.exp(1j * rng.uniform(0, 7)), complex(*rng.normal(0.0, 0.5, 2)))
        motion = simulate(case, start, 40.0)
        centre = Centre.along(motion, np.sort(rng.uniform(0.0, motion.time, 50_000)))
        for limit, largest in zip(limits_of(case), largest_along(motion, limits_of(case)), strict=True):
            assert limit.asked(centre).max() <= largest * (1 + 1e-3)
