"""The smallest lost kick, shock and loss of a blade."""

import math

import numpy as np
import pytest
from linear_rotors import as_matrices, tilting
from machines import PAPER

import carom
from carom.base.outcome import InputError, Outcome
from carom.basins import smallest_unrecovered
from carom.basins.unrecovered import FULL, _SizeSearch
from carom.disturbances import StateSlice, VelocityKick

pytestmark = pytest.mark.jit_only

MACHINE = PAPER.replace(gamma=0.15, rho=0.3)


def test_the_smallest_kick_is_lost_and_a_smaller_one_is_not():
    rotor = carom.models.jeffcott(MACHINE)
    found = smallest_unrecovered(rotor, VelocityKick(1.0))
    assert found.contact_free < found.recovered < found.size
    assert found.size - found.recovered <= 1.001e-3 * found.size
    lost = carom.simulate(rotor, carom.kick(found.size, found.angle), 2e5, settle=True)
    back = carom.simulate(rotor, carom.kick(found.recovered, found.angle), 2e5, settle=True)
    assert lost.outcome is found.outcome
    assert lost.outcome is not Outcome.LEVITATED
    assert back.outcome is Outcome.LEVITATED
    assert len(back.contacts) == 0 or found.recovered > found.contact_free


def models(machine):
    return {
        "kick": VelocityKick(0.4),
        "shock": carom.BaseShock(1.0, 0.9),
    }


def starts_of(kind, rotor, sizes, angles):
    """The starts that a size and a direction stand for, written down here anew."""
    rest = rotor.equilibrium
    if kind == "kick":
        return np.full(sizes.shape, rest), sizes * np.exp(1j * angles), np.ones(sizes.shape, bool)
    found = carom.BaseShock(1.0, 0.9).starts(rotor, sizes, angles)
    return found.positions, found.velocities, found.exists & (found.ended == 0)


@pytest.mark.parametrize("kind", ["kick", "shock"])
@pytest.mark.parametrize("machine", [MACHINE, PAPER.replace(gamma=0.1521)], ids=["far", "example"])
def test_fresh_samples_do_not_break_the_bracket(kind, machine):
    """What is said of the bracket, tried with starts that the search has not seen."""
    rotor = carom.models.jeffcott(machine)
    scan = 24 if kind == "shock" else 48
    found = smallest_unrecovered(rotor, models(machine)[kind], directions=scan, sizes=scan)
    assert found.kind == kind
    assert found.contact_free < found.all_back < found.size < found.largest
    assert found.size - found.all_back <= 1.001e-3 * found.size
    random = np.random.default_rng(77)
    count = 500 if kind == "shock" else 2000
    sizes = random.uniform(0.0, found.all_back, count)
    positions, velocities, possible = starts_of(kind, rotor, sizes, random.uniform(0.0, 2.0 * math.pi, count))
    outcomes = carom.settle(rotor, carom.State(positions[possible], velocities[possible])).outcomes
    gone = (outcomes != Outcome.LEVITATED) & (outcomes != Outcome.GRAZING)
    # None is lost below what is proven harmless, and no more than the stated share above it.
    assert not gone[sizes[possible] <= found.contact_free].any()
    assert gone.mean() <= found.share_below
    position, velocity, _ = starts_of(kind, rotor, np.array([found.size]), np.array([found.angle]))
    assert carom.settle(rotor, carom.State(position, velocity)).outcomes[0] == found.outcome


def test_fresh_starts_bring_the_smallest_loss_down():
    """A scan of four directions and sizes misses where the basin is near; what is drawn below it finds it."""
    rotor = carom.models.jeffcott(MACHINE)
    coarse, fine = (smallest_unrecovered(rotor, VelocityKick(0.4), directions=n, sizes=n) for n in (4, 96))
    assert coarse.size == pytest.approx(fine.size, rel=3e-3)


def test_a_machine_that_always_comes_back_has_no_smallest_loss():
    machine = PAPER.replace(gamma=0.6, rho=0.1)
    for kind, model in models(machine).items():
        found = smallest_unrecovered(carom.models.jeffcott(machine), model, directions=24, sizes=24)
        assert (found.kind, found.size, found.outcome, found.angle) == (kind, None, None, None)
        assert found.all_back == found.largest


def test_disturbances_without_a_size():
    with pytest.raises(InputError, match="one with a size"):
        smallest_unrecovered(carom.models.jeffcott(MACHINE), StateSlice())


@pytest.mark.parametrize("fastest", [0.0, -1.0, math.nan, math.inf])
def test_speeds_that_make_no_sense(fastest):
    with pytest.raises(InputError, match="fastest"):
        smallest_unrecovered(carom.models.jeffcott(MACHINE), VelocityKick(fastest))


def test_no_levitation():
    with pytest.raises(InputError, match="levitation"):
        smallest_unrecovered(carom.models.jeffcott(PAPER.replace(gamma=0.05)), VelocityKick())


@pytest.mark.parametrize("kind", ["kick", "blade-loss"])
def test_a_rotor_of_matrices_loses_what_the_same_planar_rotor_loses(kind):
    planar = carom.models.jeffcott(MACHINE)
    model = {**models(MACHINE), "blade-loss": carom.disturbances.BladeLoss(0.4)}[kind]
    own, found = (
        smallest_unrecovered(rotor, model, directions=24, sizes=24) for rotor in (planar, as_matrices(planar))
    )
    assert found.contact_free <= own.contact_free * (1.0 + 1e-12)
    assert found.size == pytest.approx(own.size, rel=3e-3)
    assert found.outcome == own.outcome


def test_losses_of_a_rotor_with_two_planes():
    """With what is proven by energy alone."""
    rotor = tilting().model
    found = smallest_unrecovered(rotor, VelocityKick(1.0), directions=12, sizes=12)
    assert 0.0 < found.contact_free < found.all_back < found.size
    size, back = (
        carom.simulate(rotor, carom.kick(each, found.angle), settle=True) for each in (found.size, found.recovered)
    )
    assert size.outcome is found.outcome
    assert back.outcome is Outcome.LEVITATED


def test_levitation_that_grows_has_nothing_to_come_back_to():
    growing = PAPER.replace(gamma=-0.4, rho=0.1)
    for rotor in (carom.models.jeffcott(growing), as_matrices(carom.models.jeffcott(growing))):
        with pytest.raises(InputError, match="stable levitation"):
            smallest_unrecovered(rotor, VelocityKick(1.0))


class _Striped(_SizeSearch):
    """Disturbances are lost and come back in stripes so narrow that neighbours differ."""

    def _outcomes(self, sizes, angles):
        stripes = np.floor(np.asarray(sizes) * 3e10).astype(int) % 2 == 0
        return np.where(stripes, Outcome.FORWARD_RUB, Outcome.LEVITATED)


def test_a_smallest_loss_whose_neighbours_come_back_is_said_to_be_sensitive():
    search = _Striped(carom.models.jeffcott(MACHINE), VelocityKick(1.0), 1e-3, None, FULL)
    assert search.result(1.0).sensitivity == ""
    search.smallest_ones = np.array([[0.4004], [Outcome.FORWARD_RUB], [0.3]])
    found = search.result(0.4)
    assert 0 < found.neighbours_lost < found.neighbours
    assert f"sensitive: {found.neighbours - found.neighbours_lost} of 32 within 1e-09 of it come back" in found.words
