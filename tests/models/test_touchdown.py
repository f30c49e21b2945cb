"""Contact planes and the laws of their walls: a second law beside the rigid one runs through everything general."""

from __future__ import annotations

import numpy as np
import pytest

import carom as cm
from carom.disturbances import KickPlane
from carom.models import FallingRestitution, Jeffcott, LinearRotor, Rigid, Touchdown, model_from
from carom.motions.starts import State
from carom.outcome import InputError, Outcome
from carom.parameters import Parameters

PAPER = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=50.0)
START = State(0.2 + 0.1j, 1.2 - 0.3j)


def paper(law) -> LinearRotor:
    """The paper's rotor by its matrices, with a wall of another law."""
    return LinearRotor.in_fixed_frame(
        mass=[[1.0]],
        damping=[[PAPER.gamma]],
        stiffness=[[PAPER.omega**2]],
        forcing=[PAPER.rho * np.exp(1j * PAPER.phi)],
        touchdowns=[Touchdown([1.0], law, PAPER.mu, PAPER.radius_ratio + 1.0)],
    )


def test_every_impact_obeys_the_law_of_its_wall():
    contacts = cm.simulate(paper(FallingRestitution(0.95, 2.0)), START, 60.0).contacts
    assert len(contacts) > 50
    speed = contacts.radial_speed
    np.testing.assert_allclose(contacts.radial_speed_after, -0.95 * speed / (1.0 + speed / 2.0), atol=1e-14)
    assert not contacts.by_poisson.any()
    assert (contacts.contact_work <= 0.0).all()


def test_a_wall_that_hardly_yields_is_rigid():
    """Its speed so high that no impact notices; the rigid wall is that of the planar rotor, to the last bit."""
    almost, rigid = (cm.simulate(paper(law), START, 20.0) for law in (FallingRestitution(0.95, 1e12), Rigid(0.95)))
    np.testing.assert_allclose(almost.contacts.time, rigid.contacts.time, rtol=1e-8)
    assert not paper(FallingRestitution(0.95, 1e12)).system.is_planar
    by_matrices, planar = paper(Rigid(0.95)).system.arrays, Jeffcott(PAPER).system.arrays
    for name in ("friction", "restitution", "surface_speed", "law", "law_number"):
        assert np.array_equal(by_matrices[name], planar[name])


@pytest.mark.jit_only
def test_the_second_law_runs_through_settling_basins_orbits_and_continuation():
    rotor = paper(FallingRestitution(0.95, 8.0))
    rest = complex(rotor.system.rest[0])
    assert cm.settle(rotor, np.full(8, rest), np.linspace(0.2, 1.5, 8) * 1j).outcomes.min() >= Outcome.LEVITATED
    basin = cm.map_basins(rotor, cm.Grid(KickPlane(1.0), (6, 6)))
    assert basin.unresolved == 0
    orbits = cm.find_orbits(rotor, impacts=1)
    assert len(orbits) > 0
    for orbit in orbits:
        again = cm.simulate(rotor, orbit.departure, orbit.period * (1.0 - 1e-9))
        assert abs(again.final.position - orbit.departure.position) < 1e-6
    branch = cm.continue_orbit(orbits[0], "gamma", (0.09, 0.11))
    assert len(branch.values) > 2


def test_it_is_stored_and_read_again():
    rotor = paper(FallingRestitution(0.9, 3.0))
    again = model_from(rotor.attributes())
    assert again.touchdowns == rotor.touchdowns
    assert again.replace(d=0.5, mu=0.2).touchdowns[0].law == FallingRestitution(0.5, 3.0)


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: Rigid(1.2), "restitution = 1.2"),
        (lambda: FallingRestitution(0.5, 0.0), "speed = 0.0"),
        (lambda: Touchdown([1.0], Rigid(0.5), -0.1, 2.0), "friction = -0.1"),
        (lambda: Touchdown([1.0], Rigid(0.5), 0.1, 0.5), "surface_speed = 0.5"),
        (lambda: Touchdown([1.0], 0.5, 0.1, 2.0), "law = 0.5"),
        (lambda: Touchdown("ab", Rigid(0.5), 0.1, 2.0), "plane = ab"),
        (lambda: Touchdown([], Rigid(0.5), 0.1, 2.0), "plane = "),
    ],
)
def test_bad_values_are_refused(make, named):
    with pytest.raises(InputError, match=named):
        make()


def test_the_outcomes_of_a_wall_that_yields_are_those_of_any_other():
    motion = cm.simulate(paper(FallingRestitution(0.3, 0.5)), cm.kick(1.1))
    assert motion.outcome in (Outcome.LEVITATED, Outcome.FORWARD_RUB, Outcome.BOUNCING)
