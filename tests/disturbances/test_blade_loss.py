"""The loss of a blade: its start, and the motion after it, integrated by SciPy in the fixed frame and in SI units."""

import cmath
import math

import machines
import numpy as np
import pytest
from compilation import sized
from scipy.integrate import solve_ivp

import carom as cm
from carom.base.outcome import Outcome
from carom.basins import smallest_unrecovered
from carom.disturbances import BladeLoss, Grid
from carom.models import Force, jeffcott
from carom.parameters import Machine, Parameters

LIGHT = machines.LIGHT.replace(speed=900.0)
CHATTER = 400
"""Impacts of the independent integration after which the rotor counts as held at the wall."""


def integrated(
    machine: Machine, change: float, phase: float, turns: float
) -> tuple[list[float], np.ndarray, np.ndarray]:
    """Times of the impacts, and the motion of the last turns: fixed frame, SI, adaptive steps, impact law in polar form.

    The machine whirls with its unbalance; at t = 0 this changes by ``m·change`` at a phase relative to the one before.
    """
    m, c, k, speed, wall = machine.mass, machine.damping, machine.stiffness, machine.speed, machine.clearance
    old = machine.eccentricity * cmath.exp(1j * machine.unbalance_phase)
    new = old + change * cmath.exp(1j * (machine.unbalance_phase + phase))
    place = speed**2 * old / (k / m - speed**2 + 1j * c / m * speed)
    state = np.array([place.real, place.imag, (1j * speed * place).real, (1j * speed * place).imag])

    def rate(t: float, y: np.ndarray) -> list[float]:
        z, v = complex(y[0], y[1]), complex(y[2], y[3])
        a = speed**2 * new * cmath.exp(1j * speed * t) - c / m * v - k / m * z
        return [v.real, v.imag, a.real, a.imag]

    def reached(t: float, y: np.ndarray) -> float:
        return math.hypot(y[0], y[1]) - wall

    reached.terminal, reached.direction = True, 1.0
    end, now, impacts = turns * 2.0 * math.pi / speed, 0.0, []
    options = {
        "method": "DOP853",
        "rtol": 1e-11,
        "atol": 1e-15,
        "events": reached,
        "max_step": 0.02 / speed * 2 * math.pi,
    }
    while True:
        found = solve_ivp(rate, (now, end), state, dense_output=True, **options)
        if found.status != 1 or len(impacts) >= CHATTER:
            late = np.linspace(max(found.t[0], end - 4.0 * math.pi / speed), found.t[-1], 400)
            return impacts, late, found.sol(late)
        now, state = float(found.t_events[0][0]), found.y_events[0][0].copy()
        impacts.append(now)
        angle = math.atan2(state[1], state[0])
        outward = state[2] * math.cos(angle) + state[3] * math.sin(angle)
        along = -state[2] * math.sin(angle) + state[3] * math.cos(angle)
        slip = along + speed * machine.rotor_radius
        rub = min(machine.friction * (1.0 + machine.restitution) * outward, abs(slip)) * math.copysign(1.0, slip)
        outward, along = -machine.restitution * outward, along - rub
        state[2] = outward * math.cos(angle) - along * math.sin(angle)
        state[3] = outward * math.sin(angle) + along * math.cos(angle)
        # On the wall to rounding, and moving inwards.
        state[0], state[1] = (1.0 - 1e-13) * wall * math.cos(angle), (1.0 - 1e-13) * wall * math.sin(angle)


def survives(machine: Machine, change: float, phase: float) -> bool:
    """Whether the integrated motion ends in the whirl of the unbalance after the loss."""
    impacts, late, motion = integrated(machine, change, phase, 25.0)
    if len(impacts) >= CHATTER or (impacts and impacts[-1] > late[0]):
        return False
    speed = machine.speed
    new = (machine.eccentricity + change * cmath.exp(1j * phase)) * cmath.exp(1j * machine.unbalance_phase)
    place = speed**2 * new / (machine.stiffness / machine.mass - speed**2 + 1j * machine.damping / machine.mass * speed)
    away = np.abs(motion[0] + 1j * motion[1] - place * np.exp(1j * speed * late))
    return bool(away.max() < 1e-3 * machine.clearance)


def in_fixed_frame(machine: Machine, motion, turned: float, times: np.ndarray) -> np.ndarray:
    """Displacement in m at times in s; in the frame of the simulation the unbalance has kept its phase."""
    own = times * machine.speed
    return machine.clearance * motion.position(own, "fixed") * np.exp(1j * turned)


@pytest.mark.jit_only
def test_the_motion_is_that_of_an_integration_in_the_fixed_frame():
    random = np.random.default_rng(21)
    touched = 0
    for _ in range(sized(4, 1, 40)):
        machine = LIGHT.replace(eccentricity=2e-4 * random.uniform(0.0, 0.2), damping=random.uniform(500.0, 5000.0))
        change, phase = 2e-4 * random.uniform(0.2, 0.6), random.uniform(-math.pi, math.pi)
        loss = BladeLoss.of(machine, f"{change} m")
        rotor, state = loss.apply(machine, phase)
        impacts, late, found = integrated(machine, change, phase, 4.0)
        motion = cm.simulate(rotor, state, 4.0 * 2.0 * math.pi)
        count = min(len(impacts), 4)  # later ones depend on rounding ever more
        touched += count
        np.testing.assert_allclose(motion.contacts.time[:count] / machine.speed, impacts[:count], rtol=1e-7)
        turned = cmath.phase(machine.eccentricity + cmath.rect(change, phase))
        if not impacts:
            np.testing.assert_allclose(
                in_fixed_frame(machine, motion, turned, late), found[0] + 1j * found[1], atol=1e-8 * machine.clearance
            )
    assert touched >= sized(4, 1, 40)


@pytest.mark.jit_only
def test_what_is_said_to_be_survived_is():
    """Fresh changes of the unbalance up to the largest that is said to be survived, and the smallest that is not, integrated by SciPy."""
    random = np.random.default_rng(22)
    tried = 0
    for machine in (LIGHT, LIGHT.replace(damping=6000.0, friction=0.05, speed=1400.0))[: sized(1, 1, 2)]:
        found = smallest_unrecovered(machine, BladeLoss.of(machine, "0.15 mm"))
        assert found.contact_free < found.all_back < found.size
        assert found.size - found.all_back < 2e-3 * found.size
        for _ in range(sized(2, 1, 60)):
            change = machine.clearance * random.uniform(0.85, 1.0) * found.all_back
            assert survives(machine, change, random.uniform(-math.pi, math.pi))
            tried += 1
        assert survives(machine, machine.clearance * 0.998 * found.all_back, found.angle)
        assert not survives(machine, machine.clearance * 1.001 * found.size, found.angle)
        motion = cm.simulate(*BladeLoss(found.all_back).apply(machine, found.angle), settle=True)
        assert motion.outcome is Outcome.LEVITATED
        assert len(motion.contacts) > 0  # it is not survived for want of contact
        lost = cm.simulate(*BladeLoss(found.size).apply(machine, found.angle), settle=True)
        assert lost.outcome is found.outcome


def test_no_contact_below_the_harmless_change():
    random = np.random.default_rng(23)
    for _ in range(sized(40, 4, 400)):
        machine = LIGHT.replace(
            eccentricity=2e-4 * random.uniform(0.0, 0.3),
            damping=10 ** random.uniform(2, 5),
            speed=10 ** random.uniform(2, 3.5),
        )
        bound = cm.closed_forms.contact_free_blade_loss(machine)
        if bound == 0.0:
            continue
        loss, phase = BladeLoss(bound * random.uniform(0.9, 1.0)), random.uniform(-math.pi, math.pi)
        assert len(cm.simulate(*loss.apply(machine, phase), until=30.0).contacts) == 0


def test_the_start_is_the_old_whirl():
    rotor = jeffcott(LIGHT.parameters)
    loss = BladeLoss(0.4)
    starts = Grid(loss, (8,)).starts(rotor)
    unbalances = rotor.parameters.rho + 0.4 * np.exp(1j * Grid(loss, (8,)).values()[0])
    for after, unbalance, position in zip(starts.after, unbalances, starts.positions, strict=True):
        assert after.parameters == rotor.parameters.replace(rho=after.parameters.rho)
        assert after.parameters.rho == pytest.approx(abs(unbalance), rel=1e-14)
        assert position == pytest.approx(rotor.equilibrium * abs(unbalance) / unbalance, rel=1e-14)
    assert not starts.velocities.any()
    assert starts.exists.all()
    assert not starts.touched.any()


def test_a_rotor_that_weighs_something_whirls_about_its_sag_before_the_unbalance_changes():
    """Both unbalances and the weight in the fixed frame, whose axes are those of the rotor when the change happens."""
    numbers, weight, phase = Parameters(0.3, 0.76, 0.1, 0.4, 0.15, 0.9, 50.0), 0.04 - 0.1j, 1.1
    rotor = jeffcott(numbers).under(Force(-1j, np.array([weight])))
    before = 0.1 * cmath.exp(0.4j)
    after = before + 0.16 * cmath.exp(1j * (0.4 + phase))
    changed, start = BladeLoss(0.16).apply(rotor, phase)
    whirl = before / (0.76**2 - 1.0 + 0.3j)
    place, speed = whirl + weight / 0.76**2, 1j * whirl

    def rate(time, y):
        z, v = complex(y[0], y[1]), complex(y[2], y[3])
        a = after * cmath.exp(1j * time) + weight - 0.3 * v - 0.76**2 * z
        return [v.real, v.imag, a.real, a.imag]

    times = np.linspace(0.0, 12.0, 30)
    begin = [place.real, place.imag, speed.real, speed.imag]
    found = solve_ivp(rate, (0.0, 12.0), begin, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=times).y
    motion = cm.simulate(changed, start, 12.0)
    assert not len(motion.contacts)
    assert motion.position(times, "fixed") == pytest.approx(found[0] + 1j * found[1], abs=1e-10)
