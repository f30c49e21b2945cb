"""Spin-down to standstill against closed forms and quadrature, and with gyroscopic moments in steps of speed."""

import cmath
import dataclasses
import math

import numpy as np
import pytest
from compilation import sized
from scipy.integrate import quad, solve_ivp

import carom as cm
from carom.base.outcome import InputError
from carom.models import Force, KelvinVoigt, Rigid, Shaft, Touchdown, from_matrices
from carom.motions import spin_down
from carom.motions.descent import SEEN
from carom.parameters import Drive

pytestmark = pytest.mark.jit_only
FRICTION, RADIUS, PRESSED, INERTIA = 0.2, 4.0, 0.5, 20.0
HARD = Rigid(0.5)
LEAN = math.atan(FRICTION)
SLOWED = FRICTION * PRESSED * math.cos(LEAN) * RADIUS / INERTIA


@dataclasses.dataclass(frozen=True)
class From:
    """A start of a rotor that has no levitation."""

    rotor: object
    state: cm.State

    def stages(self, machine):
        return self.rotor, self.state


def pressed(law=HARD, force=PRESSED, friction=FRICTION, **torques):
    """A rotor pressed by a constant force, at its lean."""
    touchdown = Touchdown([1.0], law, friction, RADIUS + 1.0)
    nothing = {name: [[0.0]] for name in ("damping", "stiffness")}
    rotor = from_matrices(
        mass=[[1.0]], **nothing, forcing=[0.0], touchdowns=[touchdown], shaft=Shaft(INERTIA, **torques)
    )
    depth = 0.0 if isinstance(law, Rigid) else force * math.cos(LEAN) / law.stiffness
    place = cmath.rect(1.0 + depth, -LEAN) if force else 0j
    rotor = rotor.under(Force(-1j, np.array([force]))) if force else rotor
    return rotor, From(rotor, cm.State(place, -1j * place))


@pytest.mark.parametrize("law", [HARD, KelvinVoigt(1e4, 100.0)])
def test_a_pressed_rotor_stops_when_friction_has_taken_its_momentum(law):
    found = spin_down(*pressed(law), steps=20)
    assert found.stands
    assert found.time == pytest.approx(
        INERTIA * math.sqrt(1.0 + FRICTION**2) / (FRICTION * PRESSED * RADIUS), rel=1e-12
    )
    assert found.turns == pytest.approx(0.5 * found.time / (2.0 * math.pi), rel=1e-12)
    assert found.loads.planes[0].heat == pytest.approx(0.5 * INERTIA, rel=1e-12)
    assert found.error is None
    assert found.remaining == found.braked == 0.0


@pytest.mark.parametrize(
    "torques",
    [
        {"brake": 0.3},
        {"drag": 0.5},
        {"windage": 0.8},
        {"torque": 0.1, "drag": 0.05},
        {"torque": 0.1, "brake": 0.3, "drag": 0.5, "windage": 0.8},
    ],
)
def test_other_torques_against_quadrature_and_the_error_that_is_told(torques):
    shaft = Shaft(INERTIA, **torques)
    time = quad(lambda speed: 1.0 / (SLOWED - shaft.rate(speed)), 0.0, 1.0)[0]
    work = quad(lambda speed: INERTIA * speed * -shaft.rate(speed) / (SLOWED - shaft.rate(speed)), 0.0, 1.0)[0]
    for steps in (20, 200):
        found = spin_down(*pressed(**torques), steps=steps)
        assert abs(found.time / time - 1.0) < found.error + 1e-12
        assert abs(found.braked - work) < found.error * 0.5 * INERTIA + 1e-12
    assert found.error < 6e-4
    # Windage and friction take all: of second order in the step.
    assert found.braked == pytest.approx(work, rel=1e-3)
    assert found.braked + found.loads.planes[0].heat == pytest.approx(0.5 * INERTIA, rel=1e-3)


def test_without_contact_torques_alone_stop_it_or_never_do():
    stopped = spin_down(*pressed(force=0.0, brake=0.3), steps=20)
    assert stopped.time == pytest.approx(INERTIA / 0.3, rel=1e-12)
    endless = spin_down(*pressed(force=0.0, windage=0.3), "200", steps=20)
    assert not endless.stands
    assert endless.time == pytest.approx(200.0)
    assert endless.speed_at_end == pytest.approx(1.0 / (1.0 + 200.0 * 0.3 / INERTIA), rel=2e-2)
    assert endless.remaining > 0.0


def overhung(force, unbalance, start, **torques):
    """A rotor that tilts, with two touchdown bearings, and its start."""
    stations = np.array([[1.0, 0.9], [1.0, -0.7]])
    rotor = from_matrices(
        mass=np.diag([1.0, 0.3]),
        damping=np.diag([0.02, 0.02]),
        stiffness=np.diag([0.0, 0.02]),
        gyroscopic=np.diag([0.0, 0.4]),
        forcing=unbalance,
        touchdowns=[Touchdown(row, KelvinVoigt(50.0, 4.0), 0.2, 4.0) for row in stations],
        shaft=Shaft(4.0, in_stages=True, **torques),
    )
    rotor = rotor.under(Force(-1j, np.array(force))) if np.any(force) else rotor
    return rotor, From(rotor, start)


def test_gyroscopic_moments_in_20_steps_against_2000():
    rotor = overhung([0.3, 0.1], [0.05, 0.02], cm.State(np.array([0.0, 0.1j]), np.zeros(2)))
    coarse, fine = (spin_down(*rotor, steps=steps) for steps in (20, 2000))
    assert coarse.stands
    assert fine.stands
    assert abs(coarse.time / fine.time - 1.0) < coarse.error
    assert abs(coarse.turns / fine.turns - 1.0) < coarse.error
    assert fine.error < 0.2 * coarse.error


def fallen(rng):
    """A rotor at random that falls into a compliant bearing, and its start; or one that tilts, every other time."""
    torques = {name: size * rng.random() for name, size in (("brake", 0.3), ("drag", 0.5), ("windage", 0.8))}
    place, pull = complex(*rng.uniform(-0.5, 0.5, 2)), rng.uniform(0.1, 1.0)
    if rng.random() < 0.5:
        start = cm.State(np.array([place, 0.1 * place]), np.zeros(2))
        return overhung([pull, 0.4 * pull], rng.uniform(0.0, 0.05, 2), start, **torques)
    rotor, _ = pressed(KelvinVoigt(10.0 ** rng.uniform(1.5, 3.5), 4.0), pull, rng.uniform(0.05, 0.4), **torques)
    return rotor, From(rotor, cm.State(place, -1j * place))


def test_the_error_that_is_told_holds_for_nine_of_ten_machines():
    """Motions with many contacts: both comparisons of a machine may agree by chance."""
    machines = [fallen(np.random.default_rng([47, number])) for number in range(sized(8, 1, 80))]
    held = 0
    for machine in machines:
        found, fine = (spin_down(*machine, steps=steps) for steps in (20, 400))
        assert found.stands
        shaft = machine[0].equations.shaft
        changes = (
            found.time / fine.time,
            found.turns / fine.turns,
            1.0 + (found.braked - fine.braked) / (0.5 * shaft.inertia),
        )
        held += max(abs(change - 1.0) for change in changes) < found.error
    assert held >= 0.9 * len(machines) - 1


def test_precession_of_a_shaft_that_slows_down_against_a_general_integrator():
    """Without contact, where whirl is looked at in all steps; the error falls like the square of the step."""
    start, errors = cm.State(np.array([0.0, 0.1]), np.array([0.0, 0.1j])), []

    def rates(time, y):
        return y[1], (-0.02 * y[0] - (0.02 - 0.4j * (1.0 - 0.025 * time)) * y[1]) / 0.3

    for steps in (50, 100):
        found = spin_down(*overhung([0.0, 0.0], [0.0, 0.0], start, brake=0.1), steps=steps)
        assert found.time == pytest.approx(40.0)
        ends = found.course[:, 0]
        begins = np.append(0.0, ends[:-1])
        seen = np.append(SEEN, 1.0)
        ode = solve_ivp(rates, (0.0, 40.1), [0.1 + 0j, 0.2j], "DOP853", dense_output=True, rtol=1e-11, atol=1e-13).sol
        radii = 0.9 * np.abs(ode((begins[:, None] + np.outer(ends - begins, seen)).ravel())[0])
        errors.append(np.abs(found.course[:, 2] - radii.reshape(len(ends), -1).max(axis=1)).max())
    assert errors[1] < 0.35 * errors[0] < 1e-4


def test_the_unbalance_takes_from_the_shaft_what_the_damping_of_supports_takes_from_the_whirl():
    """Through a critical speed without contact: its torque, which does not act, against the integral of a general integrator."""
    damping, stiffness, unbalance, rate = 0.1, 0.25, 0.02, 0.0025
    rotor = from_matrices(
        mass=[[1.0]],
        damping=[[damping]],
        stiffness=[[stiffness]],
        forcing=[unbalance],
        touchdowns=[Touchdown([1.0], HARD, 0.2, 5.0)],
        shaft=Shaft(INERTIA, brake=INERTIA * rate),
    )
    found = spin_down(rotor, From(rotor, cm.State(rotor.equilibrium, 0j)), steps=200)

    def rates(time, y):
        place, velocity, angle, _ = y
        speed = 1.0 - rate * time
        push = unbalance * speed**2 * np.exp(1j * angle.real)
        power = (velocity * push.conjugate()).real
        return velocity, push - damping * velocity - stiffness * place, speed, power

    begin = [rotor.equilibrium, 1j * rotor.equilibrium, 0j, 0j]
    ode = solve_ivp(rates, (0.0, 400.0), begin, "DOP853", rtol=1e-10, atol=1e-13, max_step=1.0)
    torque, _, energy = found.unbalance_torque
    # 64 looks at each step, some of which are no whole turns.
    assert energy == pytest.approx(ode.y[3, -1].real, rel=0.02)
    taken = np.diff(np.interp(found.course[:, 0], ode.t, ode.y[3].real)) / np.diff(found.course[:, 0])
    torques = taken / (found.course[1:, 1] + 0.5 / found.steps)
    assert found.course[1:-1, -1] == pytest.approx(torques[:-1], abs=0.05 * torques.max())
    assert torque == pytest.approx(torques.max(), rel=0.05)
    assert found.largest[0][0] == pytest.approx(np.abs(ode.y[0]).max(), rel=5e-3)
    assert found.criticals == pytest.approx([math.sqrt(stiffness - damping**2 / 4.0)], rel=5e-3)


@pytest.mark.parametrize(
    ("drive", "words"),
    [
        (None, "polar_inertia = nothing given: a shaft that slows down needs"),
        (Drive("1 kg m^2"), "regained_after = a time: left out"),
    ],
)
def test_what_cannot_slow_down(drive, words):
    machine = cm.load("examples/touchdown-balls.toml")
    with pytest.raises(InputError, match=words):
        spin_down(machine, cm.drop(regained_after=None if drive is None else "10 ms"), drive=drive)
