"""Energy ledger: every energy is booked, through ten thousand contacts and through each kind of contact."""

from dataclasses import replace

import numpy as np
import pytest
from compilation import sized
from linear_rotors import bending, single, tilting, to_fixed
from yielding_walls import with_walls

import carom
from carom.models import HuntCrossley, KelvinVoigt, Race
from carom.motions.ledger import energy_ledger


def _rotor(gamma: float) -> carom.models.Rotor:
    return carom.models.jeffcott(
        carom.parameters.Parameters(gamma=gamma, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)
    )


@pytest.mark.jit_only
def test_energy_closes_over_ten_thousand_impacts():
    motion = carom.simulate(_rotor(0.0834), carom.State(0.3 + 0j, 0.4j), until=3e4)
    assert len(motion.contacts) > 10_000
    assert energy_ledger(motion).imbalance < 1e-9


@pytest.mark.parametrize(
    ("gamma", "start", "phases"),
    [
        (0.2, carom.State(0.2 + 0.1j, 0.5 + 0.3j), {carom.base.outcome.Phase.FORWARD_SLIP}),
        pytest.param(
            0.07,
            carom.State(0.2 + 0.1j, 0.3j),
            {carom.base.outcome.Phase.FORWARD_SLIP, carom.base.outcome.Phase.ROLLING},
            marks=pytest.mark.jit_only,
        ),
        (0.4, carom.State(0.2 + 0.1j, 0.5 + 0.3j), set()),
    ],
)
def test_energy_closes_through_chatter_sliding_and_rolling(gamma, start, phases):
    motion = carom.simulate(_rotor(gamma), start, until=sized(400, 138), settle=True)
    assert {contact.phase for contact in motion.lasting_contacts} >= phases
    ledger = energy_ledger(motion)
    assert ledger.imbalance < 1e-9
    assert np.diff(ledger.impacts).max() <= 0.0
    assert ledger.times[0] == 0.0
    assert ledger.times[-1] == motion.time


def test_a_missing_account_would_show():
    motion = carom.simulate(_rotor(0.2), carom.State(0.2 + 0.1j, 0.5 + 0.3j), until=30.0)
    ledger = energy_ledger(motion)
    without_drive = np.abs(ledger.energy - ledger.energy[0] - np.sum(ledger.works, axis=0) + ledger.drive).max()
    assert without_drive > 1e-2 * np.abs(ledger.drive).max()


@pytest.mark.jit_only
@pytest.mark.parametrize(
    "settings", [["damping=1 N s/m"], ["eccentricity=0.1 mm", "restitution=0.9"], ["stiffness=1e5 N/m"]]
)
@pytest.mark.parametrize("drops", [False, True])
def test_energy_under_gravity_closes_with_the_work_of_the_weight(settings, drops):
    heavy = carom.load("examples/dropped-rotor.toml", settings)
    start = carom.drop(carom.State(0.4j, 2.0), regained_after="40 ms") if drops else carom.State(0.4j, 2.0)
    motion = carom.simulate(heavy, start, until=200.0)
    assert len(motion.parts[0].contacts) > 3
    for part in motion.parts:
        ledger = energy_ledger(part)
        assert ledger.imbalance < 1e-10
        # The work of the weight is what the height of the centre says, at the ends of all segments.
        height = part.position(ledger.times, "fixed").imag
        pull = 9.81 / heavy.parameters.scales.acceleration
        assert ledger.forces == pytest.approx(pull * (height[0] - height), abs=1e-11)


def _turned_springs(rotor):
    """The rotor with cross-coupled stiffness."""
    skew = np.triu(np.full(rotor.stiffness.shape, 0.02), 1)
    return replace(rotor, stiffness=rotor.stiffness + skew - skew.T + 0.03j * np.eye(len(skew)), restitution=0.3)


@pytest.mark.jit_only
@pytest.mark.parametrize("cross_coupled", [False, True])
@pytest.mark.parametrize(
    "rotor",
    [single(1), single(2), tilting(1), tilting(2), pytest.param(bending(1), marks=pytest.mark.deep), bending(2)],
    ids=["2 modes, 1 plane", "2, 2", "4, 1", "4, 2", "8, 1", "8, 2"],
)
def test_energy_of_any_linear_rotor_closes(rotor, cross_coupled):
    rotor = _turned_springs(rotor) if cross_coupled else rotor
    motion = carom.simulate(rotor.model, carom.kick(1.5, 0.7), until=sized(60, 10, 100), max_events=20_000)
    assert motion.is_impact.any()
    ledger = energy_ledger(motion)
    assert ledger.imbalance < 1e-9
    assert ledger.circulatory.any() == cross_coupled
    if not cross_coupled:
        # The energy from the matrices and states of the fixed frame; of several events at one instant, after the last.
        last = np.flatnonzero(np.diff(ledger.times) > 0.0)[1:]
        position, velocity = motion.at(ledger.times[last])
        if len(rotor.mass) == 1:
            position, velocity = position[:, None], velocity[:, None]
        expected = rotor.energy(*to_fixed(ledger.times[last], position, velocity))
        assert np.allclose(ledger.energy[last], expected, rtol=1e-10, atol=1e-12)


@pytest.mark.jit_only
def test_energy_closes_in_lasting_contact_at_two_planes():
    motion = carom.simulate(tilting().model, carom.kick(1.5), until=100.0)
    assert (motion.segment_phases > 0).all(axis=1).any()
    ledger = energy_ledger(motion)
    assert ledger.imbalance < 1e-9
    # Of one plane alone the balance does not close: contact at the other works too.
    assert np.abs(ledger.friction).max() > 1e-3 * np.abs(ledger.drive).max() > 0.0


@pytest.mark.jit_only
@pytest.mark.parametrize(("friction", "ratio"), [(0.15, 20.0), (0.9, 1.5)], ids=["slides", "rolls"])
@pytest.mark.parametrize("stiffness", [1e2, 1e4, 1e7])
@pytest.mark.parametrize("law", ["light damper", "strong damper", "linear", "balls", "rollers"])
def test_energy_closes_in_walls_that_give_way(law, stiffness, friction, ratio):
    laws = {
        "light damper": KelvinVoigt(stiffness, 0.03 * stiffness**0.5),
        "strong damper": KelvinVoigt(stiffness, 3.0 * stiffness**0.5),
        "linear": HuntCrossley(stiffness, 0.05),
        "balls": HuntCrossley(stiffness, 0.3, 1.5),
        "rollers": HuntCrossley(stiffness, 0.3, 10 / 9),
    }
    rotor = with_walls(single(1, friction=friction, radius_ratio=ratio), laws[law])
    motion = carom.simulate(rotor, carom.State(0.2 + 0.1j, 1.0), until=4.0)
    ledger = energy_ledger(motion)
    assert ledger.imbalance < 1e-10
    assert ledger.wall.any()
    assert ledger.wall_loss.max() <= 0.0
    assert (carom.base.outcome.Phase.ROLLING in motion.segment_phases) == (ratio < 2.0)
    assert not ledger.races.any()
    touches = motion.contacts
    size = np.abs(ledger.friction).max()
    assert touches.heat.sum() == pytest.approx(-ledger.friction[-1], rel=1e-9)
    assert touches.drive_work.sum() == pytest.approx(ledger.drive[-1], abs=1e-9 * size)
    assert touches.normal_loss.sum() == pytest.approx(-ledger.wall_loss[-1], rel=1e-9)


@pytest.mark.jit_only
@pytest.mark.parametrize("law", [KelvinVoigt(1e4, 3.0), KelvinVoigt(1e3, 60.0), HuntCrossley(1e5, 0.1, 1.5)])
@pytest.mark.parametrize("speed", [0.0, 1.5])
def test_energy_closes_with_a_race_that_turns(law, speed):
    """It takes up energy until the contact rolls, and loses it to its drag; without it the balance does not close."""
    race = Race(inertia=0.2, radius=15.0, drag=0.05, speed=speed)
    motion = carom.simulate(with_walls(single(1, friction=0.6), law, race=race), carom.State(0.2 + 0.1j, 1.0), 6.0)
    ledger = energy_ledger(motion)
    assert ledger.imbalance < 1e-12
    assert np.ptp(ledger.races) > 1e-3
    assert np.diff(ledger.race_drag).max() <= 0.0 < -ledger.race_drag[-1]
    assert ledger.races[0] == pytest.approx(0.5 * race.inertia * speed**2)
    assert carom.base.outcome.Phase.ROLLING in motion.segment_phases
    history = motion.history()
    rolls = history.phase == carom.base.outcome.Phase.ROLLING
    assert np.abs(history.slip[rolls]).max() < 1e-11
    assert np.all(history.friction_power <= 1e-9 * np.abs(history.friction_power).max())
