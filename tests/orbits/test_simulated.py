"""Periodic motions of machines with races that turn, limits and forces of the fixed frame, against general integrators and exact orbits."""

from pathlib import Path

import numpy as np
import pytest
from limited_reference import clipped, follow, struck
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.orbits.closing import close
from carom.orbits.simulated_search import orbit_of_motion, periodic_of

EXAMPLE = Path("examples/keogh-cole.toml").read_text(encoding="utf-8").split("[zones]")[0]
SOFT = EXAMPLE.replace("restitution", "# restitution").replace("1400 N s/m", "1000 N s/m")
MASS, DAMPING, STIFFNESS, SPEED, CLEARANCE, RADIUS = 50.0, 1400.0, 9.8e5, 184.2, 7e-4, 0.04
PUSH = MASS * 3e-4 * SPEED**2 * np.exp(0.21j)
"""Force of the unbalance in N, in the frame that turns."""
DAMPING_SOFT = 1000.0
WALL, LOSS, INERTIA, DRAG = 2e8, 2000.0, 0.01, 0.5
BOUND, NEGATIVE = 400.0, 2e5


def machine(tmp_path, text):
    """A machine from the text of its file."""
    path = tmp_path / "machine.toml"
    path.write_text(text, encoding="utf-8")
    return cm.load(path)


@pytest.fixture(scope="module")
def on_race(tmp_path_factory):
    """The orbit of a rotor that bounces on a race which it turns, against drag."""
    bearing = f'law = "kelvin-voigt"\nstiffness = {WALL}\ndamping = {LOSS}\n'
    text = f"{SOFT}[touchdown]\n{bearing}race_inertia = {INERTIA}\nrace_drag = {DRAG}\n"
    found = cm.find_orbits(machine(tmp_path_factory.mktemp("race"), text), impacts=1, guesses=1)
    return next(each for each in found if each.impacts == 1)


def test_an_orbit_with_closed_form_is_found_again():
    motion = cm.simulate(cm.load("examples/keogh-cole.toml"), cm.kick("60 mm/s"))
    exact, found = orbit_of_motion(motion), periodic_of(motion)
    assert found.period == pytest.approx(exact.period, rel=1e-11)
    assert found.multipliers.values == pytest.approx(exact.multipliers.values, abs=1e-7)
    assert (found.segments, found.impacts, found.turns) == ("impact+", 1, None)
    assert found.impulse == pytest.approx(exact.impulse, rel=1e-9)
    assert len(cm.plots.multipliers([exact, found]).axes) == 1


def test_a_race_keeps_the_speed_at_which_its_torques_balance(on_race):
    orbit = on_race
    assert orbit.stable
    assert orbit.segments.startswith("slide+")
    end, deepest, strongest, torque = _race_reference(orbit)
    start = orbit.start
    assert end[:2] == pytest.approx([start.position, start.velocity], abs=2e-8)
    assert end[2].real == pytest.approx(start.races[0], abs=2e-8)
    assert torque == pytest.approx(0.0, abs=1e-7)
    assert orbit.extremes.depth == pytest.approx(deepest, rel=1e-6)
    assert orbit.extremes.force * orbit.rotor.scales.force == pytest.approx(strongest, rel=1e-5)


def _race_reference(orbit):
    """Where an orbit on the race ends in a general integrator, its largest depth and force, and the impulse of the torque on the race.

    In SI units and the fixed frame; the rotor slides forward on the race all the time that it touches.
    """
    radius = RADIUS + CLEARANCE
    state = orbit.start
    z, v = state.position * CLEARANCE, (state.velocity + 1j * state.position) * CLEARANCE * SPEED
    y = np.array([z, v, state.races[0] * CLEARANCE * SPEED / radius, 0.0], complex)
    time, touching, deepest, strongest = 0.0, False, 0.0, 0.0
    until = orbit.period / SPEED

    def force(y):
        depth = abs(y[0]) - CLEARANCE
        return WALL * depth + LOSS * (y[1] * np.conj(y[0])).real / abs(y[0])

    def rates(at, y):
        push = force(y) if touching else 0.0
        normal = y[0] / abs(y[0])
        slip = (y[1] * normal.conjugate()).imag + RADIUS * SPEED - radius * y[2].real
        assert not touching or slip > 0.0
        grip = 0.15 * push
        outer = PUSH * np.exp(1j * SPEED * at) - DAMPING_SOFT * y[1] - STIFFNESS * y[0]
        pull = radius * grip - DRAG * y[2].real
        return np.array([y[1], (outer - (push + 1j * grip) * normal) / MASS, pull / INERTIA, pull])

    def enters(_, y):
        return abs(y[0]) - CLEARANCE

    def leaves(_, y):
        return force(y)

    enters.terminal, enters.direction = True, 1.0
    leaves.terminal, leaves.direction = True, -1.0
    while time < until:
        event = leaves if touching else enters
        found = solve_ivp(rates, (time, until), y, "DOP853", rtol=1e-12, atol=1e-15, events=event, dense_output=True)
        if touching:
            passed = found.sol(np.linspace(time, found.t[-1], 5000))
            deepest = max(deepest, np.abs(passed[0]).max() - CLEARANCE)
            strongest = max(strongest, *(force(each) for each in passed.T))
        time, y = float(found.t[-1]), found.y[:, -1]
        if found.status == 1:
            touching = not touching
    turn = np.exp(-1j * SPEED * time)
    place = y[0] * turn / CLEARANCE
    end = [place, y[1] * turn / (CLEARANCE * SPEED) - 1j * place, y[2] * radius / (CLEARANCE * SPEED)]
    return np.array(end), deepest / CLEARANCE, strongest, abs(y[3])


def test_an_orbit_at_limits_closes_after_a_quarter_of_a_turn(tmp_path):
    # It bounces while its magnetic bearing is at its limits.
    magnet = f"negative_stiffness = {NEGATIVE}\nforce_current_factor = 100.0\nmagnetic_bearings = 1\n"
    limited = machine(tmp_path, f"{EXAMPLE}force_limit = {BOUND}\n{magnet}")
    found = cm.find_orbits(limited, impacts=1, guesses=40)
    orbit = next(each for each in found if each.impacts == 1 and "saturate" in each.segments)
    assert orbit.period == pytest.approx(0.5 * np.pi, rel=1e-14)
    unit = CLEARANCE * SPEED
    start = np.array([orbit.start.position, orbit.start.velocity + 1j * orbit.start.position])
    begins = orbit.start.time

    def rates(at, y):
        z, v = y[0] * CLEARANCE, y[1] * unit
        asked = -(STIFFNESS + NEGATIVE) * z - DAMPING * v
        turned = np.exp(1j * (at + begins))
        # The start is turned to where its frame points.
        force = clipped(asked * np.exp(1j * begins), BOUND) * np.exp(-1j * begins)
        return np.array([y[1], (force + NEGATIVE * z + PUSH * turned * np.exp(-1j * begins)) / (MASS * unit * SPEED)])

    end, events = follow(
        rates,
        start,
        orbit.period,
        ends=lambda _, y: abs(y[0]) - 1.0,
        after=lambda _, y: np.array([y[0], struck(y[0], y[1], 0.95, 0.15, RADIUS / CLEARANCE)]),
    )
    place = end[0] * np.exp(-1j * orbit.period)
    assert len(events) == 1
    assert place == pytest.approx(orbit.start.position, abs=1e-8)
    assert end[1] * np.exp(-1j * orbit.period) - 1j * place == pytest.approx(orbit.start.velocity, abs=1e-8)


def test_exponents_are_those_of_the_multipliers(on_race):
    orbit = on_race
    found = cm.orbits.lyapunov_exponents(orbit.rotor, orbit.start, impacts=60, transient=40, batches=5)
    expected = float(np.log(orbit.multipliers.spectral_radius)) / orbit.period
    assert found.values[0] == found.along == pytest.approx(0.0, abs=0.01)
    assert found.values[1] == pytest.approx(expected, abs=0.02)
    assert found.impacts >= 60


def test_levitation_and_no_time_at_all_are_no_orbits():
    motion = cm.simulate(cm.load("examples/keogh-cole.toml"), cm.State(0.1 + 0j, 0j), 10.0)
    assert close(motion, 1.0, 3.0) is None
    assert close(motion, 1.0, 1e-4) is None


def test_a_shaft_that_slows_down_has_no_orbits(tmp_path):
    text = (
        SOFT + '[touchdown]\nlaw = "kelvin-voigt"\nstiffness = 2e8\ndamping = 2000.0\n[drive]\npolar_inertia = 0.05\n'
    )
    with pytest.raises(InputError, match="a shaft whose speed changes"):
        cm.find_orbits(machine(tmp_path, text), impacts=1)
