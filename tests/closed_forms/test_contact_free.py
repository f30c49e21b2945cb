"""Sizes of disturbances that never bring a linear rotor to the wall: against its exact flight, and where nothing is known."""

import numpy as np
import pytest
from linear_rotors import bending, single, tilting

import carom as cm
from carom.closed_forms import contact_free_blade_loss, contact_free_kick, contact_free_shock
from carom.disturbances import BaseShock, BladeLoss, VelocityKick

TIMES = np.linspace(0.0, 150.0, 6001)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
KINDS = "kick", "shock", "blade-loss"
ROTORS = {"tilting": tilting, "bending": bending, "two bearings": single}


def farthest(rotor, starts):
    """Largest distance of any plane from its centre in flight after the starts."""
    system, count = rotor.system, len(starts.positions)
    states = np.concatenate([starts.positions.reshape(count, -1), starts.velocities.reshape(count, -1)], axis=1)
    flown = system.fly(system.amplitudes_of(states)[:, None], np.tile(TIMES, (count, 1)))
    return max(np.abs(system.at_plane(flown, plane)[0]).max() for plane in range(len(system.contacts)))


def of_size(rotor, kind, factor):
    """Disturbances of a kind that are that many times the harmless ones, and the rotor after them."""
    if kind == "kick":
        return rotor, VelocityKick().starts(rotor, np.full(ANGLES.shape, factor * contact_free_kick(rotor)), ANGLES)
    if kind == "shock":
        sizes = np.full(ANGLES.shape, factor * contact_free_shock(rotor, 0.4))
        return rotor, BaseShock(float(sizes[0]), 0.4).starts(rotor, sizes, ANGLES)
    loss = BladeLoss(factor * contact_free_blade_loss(rotor)).starts(rotor, np.zeros(1))
    return loss.after[0], loss


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("name", "kind"), [(name, kind) for name in ROTORS for kind in KINDS if (name, kind) != ("bending", "shock")]
)
def test_no_plane_touches_after_a_harmless_disturbance_of_any_rotor(name, kind):
    rotor = ROTORS[name]().model
    levitation = rotor.system.rest_radius
    assert levitation < farthest(*of_size(rotor, kind, 1.0)) <= 1.0
    assert farthest(*of_size(rotor, kind, 4.0)) > 1.0


@pytest.mark.jit_only
@pytest.mark.parametrize("kind", KINDS)
def test_modes_that_decay_serve_where_there_is_no_energy(kind):
    """A stiffness that feeds whirl, as the controllers of flexible rotors have: the moduli of the modes together bound the flight."""
    made = tilting().model
    mass, damping, gyroscopic, stiffness, forcing = made.matrices
    circulatory = stiffness + 0.01j * np.eye(2)
    rotor = cm.models.from_matrices(
        mass=mass,
        damping=damping,
        gyroscopic=gyroscopic,
        stiffness=circulatory,
        forcing=forcing,
        touchdowns=made.equations.touchdowns,
        translation=made.equations.translation,
    )
    assert rotor.system.decay > 0.0
    assert rotor.system.rest_radius < farthest(*of_size(rotor, kind, 1.0)) <= 1.0
    assert farthest(*of_size(rotor, kind, 4.0)) > 1.0


@pytest.mark.jit_only
def test_no_harmless_kick_brings_a_heavy_rotor_to_the_wall():
    """Levitation is a circle about the sag; kicks in any direction, at any phase of the unbalance."""
    heavy = cm.load("examples/dropped-rotor.toml", ["unbalance=40 g mm"])
    contact_free, touched = contact_free_kick(heavy), {0.99: 0, 1.4: 0}
    assert 0.0 < contact_free < contact_free_kick(heavy.replace(gravity=0))
    for phase in np.linspace(0.0, 6.0, 7):
        rotor = cm.models.rotor_of(heavy.replace(unbalance_phase=float(phase)))
        for size in touched:
            places, speeds = rotor.system.kicked(size * contact_free * np.exp(1j * np.linspace(0.0, 6.2, 60)))
            touched[size] += np.count_nonzero(cm.settle(rotor, cm.State(places[:, 0], speeds[:, 0])).impacts)
    assert touched[0.99] == 0 < touched[1.4]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("force", ["180 N", "250 N", "1 kN"])
def test_no_harmless_disturbance_brings_bearings_to_their_limit(kind, force):
    """The rotor then moves as the linear one, for which contact is excluded; a bound without the limits was passed by 18 of 40 kicks."""
    case = cm.load("examples/keogh-cole.toml", ["eccentricity=0.05 mm", f"force_limit={force}"])
    rotor = cm.models.rotor_of(case)

    def ends(factor):
        after, starts = of_size(rotor, kind, factor)
        places = zip(np.ravel(starts.positions), np.ravel(starts.velocities), strict=True)
        return [cm.simulate(after, cm.State(complex(place), complex(speed)), 400.0) for place, speed in places]

    for motion in ends(1.0):
        assert len(motion.event_planes) == 0
        assert not motion.segment_limits.any()
    assert any(len(motion.event_planes) for motion in ends(6.0))
