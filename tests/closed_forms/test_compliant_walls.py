"""Steady motions on compliant walls, put into the equations of motion of a reference that shares nothing with them."""

import cmath
from typing import NamedTuple

import numpy as np
import pytest
from compliant_reference import FORWARD, HuntCrossley, KelvinVoigt, Plane, Rotor
from machines import PAPER
from scipy.optimize import brentq

import carom
from carom import models
from carom.base.outcome import InputError
from carom.closed_forms import find_equilibria, runaway_speed, slipping_whirls
from carom.closed_forms.statics import rubs_in_wall
from carom.parameters import Parameters

EXPONENTS = [1.0, 10 / 9, 1.5]


def law_of(stiffness, exponent):
    """A wall with that force at rest, whatever it dissipates."""
    return KelvinVoigt(stiffness, 3.0) if exponent == 1.0 else HuntCrossley(stiffness, 0.7, exponent)


def reference(at, stiffness, exponent):
    plane = Plane((1.0,), law_of(stiffness, exponent), at.mu, at.radius_ratio + 1.0)
    return Rotor.planar(at.gamma, at.omega, at.rho, at.phi, plane)


def drawn(random):
    return Parameters(
        gamma=10.0 ** random.uniform(-3.0, 0.0),
        omega=random.uniform(0.1, 1.1),
        rho=10.0 ** random.uniform(-1.5, 0.5),
        phi=random.uniform(-3.0, 3.0),
        mu=random.uniform(0.0, 0.8),
        d=0.9,
        radius_ratio=20.0,
    )


# ------------------------------------------------------------------------------------------------ synchronous rubs


def excess(at, stiffness, exponent, depths):
    """What the rotor at each depth misses of the balance: the equation of motion, solved for the unbalance it would need."""
    needed = (at.omega**2 - 1.0 + 1j * at.gamma) * (1.0 + depths) + (1.0 + 1j * at.mu) * stiffness * depths**exponent
    return np.abs(needed) - at.rho


class Rub(NamedTuple):
    depth: float
    place: complex
    normal_force: float


def yielding_rubs(at, stiffness, exponent=1.0):
    """Depth, place and force of each of the rubs of a planar rotor."""
    held = complex(at.omega**2 - 1.0, at.gamma)
    rest = cmath.rect(at.rho, at.phi) / held
    return [
        Rub(depth, cmath.rect(1.0 + depth, cmath.phase(turned)), stiffness * depth**exponent)
        for depth, turned in rubs_in_wall(complex(1.0, at.mu) / held, rest, stiffness, exponent)
    ]


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_rubs_are_equilibria_and_all_of_them(exponent):
    random, several = np.random.default_rng(3), 0
    depths = np.concatenate([[0.0], np.logspace(-9.0, 3.0, 40_001)])
    for _ in range(200):
        at, stiffness = drawn(random), 10.0 ** random.uniform(-1.5, 5.0)
        rubs, rotor = yielding_rubs(at, stiffness, exponent), reference(at, stiffness, exponent)
        for rub in rubs:
            found = rotor.contact(0.0, np.array([rub.place]), np.zeros(1), [FORWARD])
            # The radius of a thin indentation is known to a rounding error only.
            rounding = 1e-13 * (1.0 + at.rho) + 1e-15 * stiffness
            assert abs(found.acceleration[0]) < rounding
            assert rub.normal_force == pytest.approx(found.push[0], abs=rounding)
        seen = np.diff(np.sign(excess(at, stiffness, exponent, depths))) != 0.0
        assert len(rubs) == seen.sum()
        assert [rub.depth for rub in rubs] == pytest.approx(depths[:-1][seen], rel=1e-3, abs=1e-9)
        several += len(rubs) > 1
    assert several > 10


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_rubs_on_a_stiff_wall_are_those_on_a_rigid_one(exponent):
    at = PAPER.replace(gamma=0.1)
    rigid = sorted(rub.normal_force for rub in find_equilibria(at).members[1:])
    misses = []
    for depth in (1e-4, 1e-6):
        rubs = yielding_rubs(at, depth**-exponent, exponent)
        misses.append(np.abs(np.subtract([rub.normal_force for rub in rubs], rigid)).max())
    assert misses[1] < 1e-6
    assert misses[0] / misses[1] == pytest.approx(100.0, rel=0.01)  # of the order of the depth


# ------------------------------------------------------------------------------------------------ slipping whirl


def only(whirls):
    (whirl,) = whirls
    return whirl


@pytest.mark.parametrize("exponent", EXPONENTS)
@pytest.mark.parametrize("stiffness", [2.0, 1e2, 1e6])
def test_slipping_whirl_is_a_circular_motion(exponent, stiffness):
    at = PAPER.replace(gamma=0.1, rho=0.0)
    whirl = only(slipping_whirls(at, stiffness, exponent))
    turn = -1j * (1.0 + whirl.speed)  # in the co-rotating frame
    place = whirl.radius * cmath.exp(0.3j)
    found = reference(at, stiffness, exponent).contact(0.0, np.array([place]), np.array([turn * place]), [FORWARD])

    # The depth is the radius less one, and its rounding error is multiplied by the stiffness.
    rounding = 1e-13 * whirl.radius + 1e-15 * stiffness
    assert found.acceleration[0] == pytest.approx(turn**2 * place, abs=rounding)
    assert found.push[0] == pytest.approx(whirl.normal_force, abs=rounding)
    assert whirl.slips == (found.slip[0] > 0.0)
    assert whirl.speed == pytest.approx(runaway_speed(at).average, rel=1e-13)


def drawn_rotor(random, size):
    """A rotor with a gyroscopic matrix, cross-coupled stiffness and planes that are a part of its coordinates."""

    def hermitian():
        half = random.normal(size=(size, size))
        return half @ half.T / size

    skew = random.normal(size=(size, size))
    return {
        "mass": hermitian() + 0.3 * np.eye(size),
        "damping": 0.2 * random.random() * (hermitian() + 0.1 * np.eye(size)),
        "gyroscopic": 0.5 * hermitian(),
        "stiffness": 2.0 * hermitian() + 0.05j * (skew - skew.T),
    }, random.normal(size=size)


@pytest.mark.parametrize("seed", range(40))
def test_slipping_whirls_of_any_rotor_are_all_changes_of_sign_of_the_receptance(seed):
    """Found again from the matrices in the fixed frame, on a fine grid of speeds."""
    random = np.random.default_rng(seed)
    numbers, row = drawn_rotor(random, 1 + seed % 4)
    friction = 10.0 ** random.uniform(-1.5, 0.0)
    plane = models.Touchdown(row, models.KelvinVoigt(1e4, 1.0), friction, 1e3)
    rotor = models.from_matrices(**numbers, forcing=np.zeros(len(row)), touchdowns=[plane])
    felt = 1.0 / (row @ np.linalg.solve(numbers["mass"], row))

    def lever(speed):
        turn = -1j * speed
        resisting = turn * (numbers["damping"] - 1j * numbers["gyroscopic"]) + numbers["stiffness"]
        return -(1.0 + 1j * friction) * felt * (row @ np.linalg.solve(turn**2 * numbers["mass"] + resisting, row))

    grid = np.concatenate([np.linspace(1e-6, 8.0, 16001), np.geomspace(8.0, 1e3, 4000)[1:]])
    values = np.array([lever(speed) for speed in grid])
    changes = np.flatnonzero(np.diff(np.sign(values.imag)) != 0)
    roots = [brentq(lambda speed: lever(speed).imag, *grid[at : at + 2], xtol=1e-14, rtol=1e-14) for at in changes]
    expected = [root for root in roots if lever(root).real > 0.0]
    whirls = slipping_whirls(rotor, stiffness=1e6)
    assert [whirl.speed for whirl in whirls if whirl.speed < 1e3] == pytest.approx(expected, rel=1e-9, abs=1e-9)
    for whirl in whirls:
        assert whirl.radius == pytest.approx(lever(whirl.speed).real * whirl.normal_force, rel=1e-7)
        assert whirl.radius - 1.0 == pytest.approx(1e-6 * whirl.normal_force, rel=1e-6, abs=1e-15)


@pytest.mark.parametrize("ratio", [1e-4, 1e-5, 1e-6])
def test_a_slipping_whirl_close_to_the_resonance_of_a_soft_and_hardly_damped_rotor(ratio):
    """There one rounding of the speed changes what is left of the imaginary part by more than any share of its modulus allows."""
    at = PAPER.replace(gamma=ratio, omega=0.01, mu=2.0, rho=0.0)
    whirl = only(slipping_whirls(at, 1e9))
    assert whirl.speed == pytest.approx(runaway_speed(at).average, abs=1e-15)


@pytest.mark.jit_only
@pytest.mark.parametrize("plane", [0, 1])
def test_a_whirl_of_two_coordinates_goes_on_as_a_circle(plane):
    """Followed for a fifth of a turn from its exact state: these whirls are thresholds, and small errors grow."""
    mass, stiffness = np.diag([1.0, 0.3]), np.array([[0.6, 0.02], [0.02, 0.2]])
    damping = np.array([[0.1, 0.01], [0.01, 0.04]])
    rows = ([1.0, 0.8], [1.0, -0.7])
    planes = [models.Touchdown(row, models.KelvinVoigt(1e3, 2.0), 0.2, 60.0) for row in rows]
    rotor = models.from_matrices(
        mass=mass, damping=damping, stiffness=stiffness, forcing=np.zeros(2), touchdowns=planes
    )
    row, followed = np.array(rows[plane]), 0
    felt = 1.0 / (row @ np.linalg.solve(mass, row))
    for whirl in slipping_whirls(rotor, 1e3 / felt, plane=plane):
        turn = -1j * whirl.speed
        push = -(1.0 + 0.2j) * felt * whirl.normal_force
        shape = np.linalg.solve(turn**2 * mass + turn * damping + stiffness, row * push)
        start = carom.State(shape, (turn - 1j) * shape)
        until = 0.2 * 2.0 * np.pi / whirl.speed
        motion = carom.simulate(rotor, start, until)
        assert abs(row @ shape) == pytest.approx(whirl.radius, rel=1e-12)
        if abs(np.array(rows[1 - plane]) @ shape) < 1.0:
            followed += 1
            assert motion.final.position == pytest.approx(shape * np.exp((turn - 1j) * until), abs=1e-9)
    assert followed


def test_there_is_no_slipping_whirl_without_friction_or_damping_or_on_a_wall_too_soft():
    at = PAPER.replace(gamma=0.1)
    softest = 0.1 * only(slipping_whirls(at, 1e3)).speed / at.mu

    assert slipping_whirls(at.replace(mu=0.0), 1e3) == ()
    assert slipping_whirls(at.replace(gamma=0.0), 1e3) == ()
    assert slipping_whirls(at, softest * (1.0 - 1e-9)) == ()
    assert only(slipping_whirls(at, softest * 1.001)).radius == pytest.approx(1001.0, rel=1e-9)
    assert not only(slipping_whirls(at, softest * 1.001)).slips
    assert only(slipping_whirls(at, softest / 2.0, 1.5)).radius > 1.0
    assert slipping_whirls(at, 1e-6, 1.5) == ()  # deeper than any wall
    with pytest.raises(InputError, match="plane = 1"):
        slipping_whirls(at, 1e3, plane=1)
