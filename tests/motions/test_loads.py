"""Loads of touchdowns: against the ledger, and against equations of sliding and of impacts integrated a second time."""

import cmath
import math

import numpy as np
import pytest
from compilation import sized
from linear_rotors import single
from machines import PAPER
from scipy.integrate import solve_ivp
from yielding_walls import with_walls

import carom as cm
from carom.models import HuntCrossley, KelvinVoigt
from carom.motions import drop_loads, energy_ledger
from carom.parameters import Parameters


def random_parameters(random: np.random.Generator) -> Parameters:
    return Parameters(
        gamma=random.uniform(0.02, 0.5),
        omega=random.uniform(0.3, 1.5),
        rho=random.uniform(0.1, 0.6),
        phi=random.uniform(-3, 3),
        mu=random.uniform(0.02, 0.4),
        d=random.uniform(0.0, 0.9),
        radius_ratio=random.uniform(5, 80),
    )


def test_heat_is_that_of_the_ledger():
    """What friction and restitution take is what the ledger says that contact takes, for motions with contact of all kinds."""
    random = np.random.default_rng(31)
    slides, impacts = 0, 0
    for _ in range(sized(40, 3, 400)):
        start = cm.State(
            cmath.rect(0.9 * math.sqrt(random.uniform()), random.uniform(0, 6.3)), complex(*random.normal(size=2))
        )
        motion = cm.simulate(random_parameters(random), start, 40.0)
        loads, ledger = drop_loads(motion).planes[0], energy_ledger(motion)
        lost = -(ledger.impacts[-1] + ledger.friction[-1])
        assert loads.heat + loads.restitution_loss == pytest.approx(lost, rel=1e-10, abs=1e-12)
        assert loads.heat >= 0.0
        assert loads.restitution_loss >= 0.0
        assert loads.contacts == len(motion.contacts)
        slides += loads.contact_time > 1.0
        impacts += loads.contacts > 3
    assert min(slides, impacts) >= sized(10, 1, 100)


def slide(at: Parameters, angle: float, whirl: float, time: float):
    """Sliding with forward slip along the wall: angle from the unbalance, whirl speed and heat."""
    slip = at.radius_ratio

    def force(x: float, w: float) -> float:
        return at.rho * math.cos(x) + w * w - at.omega**2

    def rate(_: float, y: np.ndarray) -> list[float]:
        x, w, _ = y
        n = force(x, w)
        return [w - 1.0, -at.gamma * w - at.rho * math.sin(x) - at.mu * n, at.mu * n * (slip + w)]

    return force, solve_ivp(rate, (0.0, time), [angle, whirl, 0.0], rtol=1e-11, atol=1e-12, dense_output=True).sol


def test_sliding_against_an_independent_integration():
    """A rotor released on the wall, pressed on it and slipping forward until the end."""
    random = np.random.default_rng(32)
    tried = 0
    for _ in range(sized(100, 20, 400)):
        at = random_parameters(random)
        angle, whirl, time = random.uniform(-1.5, 1.5), random.uniform(0.5, 3.0), random.uniform(2.0, 12.0)
        force, found = slide(at, angle, whirl, time)
        times = np.linspace(0.0, time, 4_001)
        x, w, heat = found(times)
        forces = np.array([force(*pair) for pair in zip(x, w, strict=True)])
        if forces.min() < 1e-3:
            continue  # it lifts off
        tried += 1
        place = cmath.rect(1.0, angle + at.phi)
        motion = cm.simulate(at, cm.State(place, 1j * (whirl - 1.0) * place), time)
        loads = drop_loads(motion).planes[0]
        assert loads.contact_time == pytest.approx(time)
        assert loads.heat == pytest.approx(heat[-1], rel=1e-7)
        # A smooth maximum between two nodes is missed by less than a thousandth.
        assert loads.force == pytest.approx(forces.max(), rel=1e-3)
        assert loads.power == pytest.approx((at.mu * forces * (at.radius_ratio + w)).max(), rel=1e-3)
        assert loads.impulse == loads.contacts == 0
    assert tried >= sized(10, 2, 40)


def test_heat_of_impacts_by_the_law_in_polar_form():
    motion = cm.simulate(PAPER.replace(gamma=0.15), cm.State(0.2, 0.6 + 0.2j), 60.0)
    log, heat = motion.contacts, 0.0
    assert len(log) > 10
    assert not motion.lasting_contacts
    slip = PAPER.radius_ratio + 1.0
    for radial, angular in zip(log.radial_speed, log.angular_speed, strict=True):
        taken = min(PAPER.mu * (1.0 + PAPER.d) * radial, abs(slip + angular)) * math.copysign(1.0, slip + angular)
        heat += taken * (slip + angular - 0.5 * taken)
    loads = drop_loads(motion).planes[0]
    assert loads.heat == pytest.approx(heat, rel=1e-12)
    assert loads.impulse == pytest.approx((1.0 + PAPER.d) * log.radial_speed.max(), rel=1e-12)
    assert loads.restitution_loss == pytest.approx(0.5 * (1.0 - PAPER.d**2) * (log.radial_speed**2).sum(), rel=1e-9)
    assert loads.lasting_power == 0.0  # it has not settled
    assert not loads.goes_on


@pytest.mark.jit_only
@pytest.mark.parametrize("law", [KelvinVoigt(1e4, 3.0), HuntCrossley(1e5, 0.05, 1.5)])
def test_walls_that_give_way(law):
    """Against the contacts and the ledger; a stiff wall bears nearly the impulses and heat of the rigid one."""
    motion = cm.simulate(with_walls(single(1), law), cm.State(0.2 + 0.1j, 1.0), 20.0)
    loads, touches, ledger = drop_loads(motion).planes[0], motion.contacts, energy_ledger(motion)
    assert loads.contacts == len(touches) > 5
    assert loads.impulse == touches.normal_impulse.max()
    assert loads.force == pytest.approx(motion.forces(touches.peak_time)[0].max(), rel=1e-9)
    # Two thousand samples of a contact miss its maxima by less than a millionth.
    times = np.linspace(touches.time, touches.end, 2_000)
    assert loads.depth == pytest.approx(motion.radius(times).max() - 1.0, rel=1e-5)
    assert loads.power == pytest.approx(-motion.history(times.ravel()).friction_power.min(), rel=1e-5)
    assert loads.heat == pytest.approx(-ledger.friction[-1], rel=1e-10)
    assert loads.restitution_loss == pytest.approx(-ledger.wall_loss[-1], rel=1e-10)
    held = sum(contact.end - contact.start for contact in motion.lasting_contacts)
    assert loads.contact_time == held <= touches.duration.sum() * (1.0 + 1e-12)
