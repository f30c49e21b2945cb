"""Impacts of several planes in one instant: the laws that the impulses obey, and the energy that they take."""

import itertools

import numpy as np
import pytest
from compilation import sized

from carom.core.joint import join, joint_impact
from carom.core.layout import rotor_record, rub_workspace
from carom.core.phases import AWAY

MASSES, PLANES = 3, 2


class Body:
    """A rotor of free masses with planes at its walls: only velocities and mobilities matter in an impact.

    Its coordinates are amplitudes without exponents, so position and velocity are amplitudes of their own.
    """

    def __init__(self, random, planes=PLANES, *, mass=None, rows=None, friction=None, restitution=None):
        n = MASSES if mass is None else len(mass)
        root = random.normal(size=(n, n))
        self.mass = root @ root.T + 0.05 * np.eye(n) if mass is None else mass
        self.rows = random.normal(size=(planes, n)) if rows is None else rows
        self.friction = random.choice([0.0, 0.1, 0.5, 1.5], planes) if friction is None else np.full(planes, friction)
        self.restitution = random.choice([0.0, 0.4, 0.9, 1.0], planes) if restitution is None else np.array(restitution)
        self.surface_speed = random.choice([-1.0, 0.3, 5.0, 60.0], planes) + 0.0
        self.angles = np.exp(1j * random.uniform(-np.pi, np.pi, planes))
        # Positions that put each plane on its wall, by the smallest coordinates.
        self.position = np.linalg.pinv(self.rows) @ self.angles
        moved = np.linalg.solve(self.mass, self.rows.T)
        self.felt = 1.0 / np.einsum("pn,np->p", self.rows, moved)
        self.exchange = self.rows @ moved
        self.columns = moved * self.felt
        zero = np.zeros((planes, n))
        self.arrays = rotor_record(
            exponents=np.zeros(2 * n, complex),
            driven=np.array([False, True] * n),
            offsets=np.zeros(planes, complex),
            rows=_interleaved(zero, self.rows),
            columns=_interleaved(self.columns.T, zero).T.copy(),
            friction=self.friction,
            restitution=self.restitution,
            surface_speed=self.surface_speed,
            masses=self.felt,
        )
        self.planes = planes

    def local(self, velocity):
        return self.angles.conj() * (self.rows @ velocity)

    def strike(self, velocity):
        """Velocity after, and the impulses, complex, in units of momentum: ``−P + iF``."""
        work = rub_workspace(len(self.arrays.exponents), self.planes)
        before = _interleaved(velocity[None], self.position[None])[0]
        after = np.empty_like(before)
        assert join(self.arrays, np.full(self.planes, AWAY), 0, before, work) == (self.planes > 1)
        joint_impact(self.arrays, before, after, work)
        assert np.array_equal(after[1::2], before[1::2])
        return after[::2], self.felt * work.impulses

    def energy(self, velocity, impulses, after):
        """Work of the impulses on the contact points."""
        mean = 0.5 * (self.local(velocity) + self.local(after))
        return float((impulses.real * mean.real + impulses.imag * (self.surface_speed + mean.imag)).sum())


def _interleaved(driving, driven):
    """Pairs of modes: velocities drive positions."""
    pairs = np.stack([driving, driven], axis=-1).astype(complex)
    return pairs.reshape(len(pairs), -1)


def approaching(random, body):
    """A velocity with which at least one plane strikes."""
    while True:
        velocity = (
            random.normal(size=len(body.mass)) + 1j * random.normal(size=len(body.mass))
        ) * 10 ** random.uniform(-3, 1)
        if (body.local(velocity).real > 0.0).any():
            return velocity


def newton_violations(body, velocity, impulses, after):
    """How far the impulses are from Newton's restitution and Coulomb's friction, relative to their size."""
    speeds, left = body.local(velocity), body.local(after)
    target = -body.restitution * np.maximum(speeds.real, 0.0)
    push, grip = -impulses.real / body.felt, impulses.imag / body.felt
    slip = body.surface_speed + left.imag
    wrong = [
        np.maximum(-push, 0.0),
        np.maximum(left.real - target, 0.0),
        np.minimum(np.abs(push), np.abs(left.real - target)),
        np.maximum(np.abs(grip) - body.friction * push, 0.0),
        # It slips against full friction, or not at all.
        np.minimum(np.abs(slip), np.abs(grip + body.friction * push * np.sign(slip))),
    ]
    size = np.abs(speeds).max() + push.max() + np.abs(grip).max()
    return max(part.max() for part in wrong) / size


def test_impulses_obey_the_laws_at_every_plane_at_once():
    """Newton's restitution or, where that would gain energy, another one that does not; momentum balances."""
    random = np.random.default_rng(1)
    other = 0
    for _ in range(sized(3000, 250, 100_000)):
        body = Body(random, int(random.integers(2, 4)))
        velocity = approaching(random, body)
        after, impulses = body.strike(velocity)
        given = body.rows.T @ (body.angles * impulses)
        size = np.abs(velocity).max() + np.abs(impulses).max()
        assert np.abs(body.mass @ (after - velocity) - given).max() < 1e-11 * size * np.abs(body.mass).max()
        push, grip = -impulses.real, impulses.imag
        assert (push >= -1e-11 * size).all()
        assert (np.abs(grip) <= body.friction * push + 1e-10 * size * body.felt).all()
        assert (body.local(after).real <= 1e-10 * size).all()
        work = body.energy(velocity, impulses, after)
        terms = np.abs(impulses).sum() * (np.abs(velocity).max() + np.abs(body.surface_speed).max())
        assert work <= 1e-11 * terms
        if newton_violations(body, velocity, impulses, after) > 1e-9:
            other += 1
            assert _newton_gains(body, velocity)
    assert other > 0


def _newton_gains(body, velocity):
    """Whether some solution of Newton's and Coulomb's laws gains energy, by trying all ways in which they may hold."""
    speeds = body.local(velocity)
    couplings = body.angles.conj()[:, None] * (body.exchange / np.diag(body.exchange)) * body.angles
    target = -body.restitution * np.maximum(speeds.real, 0.0)
    n = body.planes
    for kinds in itertools.product(("open", "stick", "forward", "backward"), repeat=n):
        matrix, right = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
        for p, kind in enumerate(kinds):
            if kind == "open":
                matrix[2 * p, 2 * p] = matrix[2 * p + 1, 2 * p + 1] = 1.0
                continue
            matrix[2 * p, 0::2], matrix[2 * p, 1::2] = -couplings[p].real, -couplings[p].imag
            right[2 * p] = target[p] - speeds[p].real
            if kind == "stick":
                matrix[2 * p + 1, 0::2], matrix[2 * p + 1, 1::2] = -couplings[p].imag, couplings[p].real
                right[2 * p + 1] = -body.surface_speed[p] - speeds[p].imag
            else:
                matrix[2 * p + 1, 2 * p + 1] = 1.0
                matrix[2 * p + 1, 2 * p] = body.friction[p] * (1.0 if kind == "forward" else -1.0)
        try:
            solved = np.linalg.solve(matrix, right)
        except np.linalg.LinAlgError:
            continue
        impulses = (-solved[0::2] + 1j * solved[1::2]) * body.felt
        after = velocity + np.linalg.solve(body.mass, body.rows.T @ (body.angles * impulses))
        if newton_violations(body, velocity, impulses, after) < 1e-9 and body.energy(velocity, impulses, after) > 0.0:
            return True
    return False


def test_a_plane_alone_is_struck_as_by_the_law_of_one_plane():
    """Planes that do not feel each other, each with ``m (1 + d) ṙ``."""
    random = np.random.default_rng(2)
    for _ in range(50):
        body = Body(random, mass=np.diag(random.uniform(0.2, 3.0, 2)), rows=np.eye(2))
        velocity = approaching(random, body)
        after, impulses = body.strike(velocity)
        speeds = body.local(velocity)
        push = body.felt * (1.0 + body.restitution) * np.maximum(speeds.real, 0.0)
        slip = body.surface_speed + speeds.imag
        grip = -np.sign(slip) * np.minimum(body.friction * push, body.felt * np.abs(slip))
        assert np.allclose(impulses, -push + 1j * grip, rtol=1e-13, atol=1e-14 * (1.0 + np.abs(slip).max()))
        assert np.allclose(body.local(after), speeds + impulses / body.felt, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("inertia", [0.05, 0.4, 1.0, 3.0, 1e3])
def test_a_symmetric_rotor_struck_at_both_ends_does_not_tilt(inertia):
    """Each end takes half of what the whole mass would: by hand, for ends close together and far apart."""
    random = np.random.default_rng(3)
    arms = np.array([[1.0, 1.0], [1.0, -1.0]])
    body = Body(random, mass=np.diag([1.0, inertia]), rows=arms, friction=0.2, restitution=[0.8, 0.8])
    body = _aligned(body, inertia)
    after, impulses = body.strike(np.array([0.7 + 0.3j, 0.0]))
    push = 1.8 * 0.7
    assert impulses == pytest.approx([0.5 * (-push - 0.2j * push)] * 2, rel=1e-14)
    assert after == pytest.approx([0.7 - push + 1j * (0.3 - 0.2 * push), 0.0], rel=1e-14, abs=1e-14)


def _aligned(body, inertia):
    """The same with both planes at angle zero, slipping forward."""
    random = np.random.default_rng(0)
    aligned = Body(random, mass=np.diag([1.0, inertia]), rows=body.rows, friction=0.2, restitution=[0.8, 0.8])
    aligned.angles = np.ones(2, complex)
    aligned.position = np.array([1.0, 0.0], complex)
    aligned.surface_speed = np.full(2, 20.0)
    aligned.arrays.surface_speed[:] = 20.0
    return aligned


def test_a_resting_plane_holds_while_another_is_struck():
    """A resting plane that the blow pushes outward takes an impulse and stays; one that it pulls inward leaves."""
    for sign in (1.0, -1.0):
        random = np.random.default_rng(4)
        # Mass one half at each plane if the other is free; a blow at one moves the other by ±0.5 of its own change.
        exchange = np.array([[1.0, 0.5 * sign], [0.5 * sign, 1.0]])
        body = Body(random, mass=np.linalg.inv(exchange), rows=np.eye(2), friction=0.0, restitution=[0.9, 0.9])
        body.angles = np.ones(2, complex)
        body.position = np.ones(2, complex)
        after, impulses = body.strike(np.array([1.0, 0.0], complex))
        if sign > 0.0:  # the blow pulls the other plane inward
            assert impulses[1] == 0.0
            assert after[1].real == pytest.approx(-0.5 * 1.9)
        else:
            assert -impulses[1].real > 0.0
            assert abs(after[1].real) < 1e-15
        assert after[0].real == pytest.approx(-0.9)


def test_planes_that_move_alike_share_a_blow_without_gaining():
    """Two planes at one place: the equations for each are the same, and the sum of the impulses is that of one."""
    random = np.random.default_rng(5)
    body = Body(random, mass=np.eye(1), rows=np.ones((2, 1)), friction=0.3, restitution=[0.7, 0.7])
    body.angles, body.position, body.surface_speed = np.ones(2, complex), np.ones(1, complex), np.full(2, 30.0)
    body.arrays.surface_speed[:] = 30.0
    after, impulses = body.strike(np.array([1.0 + 0.5j]))
    assert impulses.sum() == pytest.approx(-1.7 - 0.3j * 1.7)
    assert after[0] == pytest.approx(-0.7 + 0.5j - 0.51j)
