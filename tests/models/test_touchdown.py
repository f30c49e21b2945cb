"""Contact planes and the laws of their walls: a second law beside the rigid one runs through everything general."""

import numpy as np
import pytest
from linear_rotors import planar_rotor
from refusals import assert_refused

import carom as cm
from carom.base.outcome import InputError
from carom.models import FallingRestitution, HuntCrossley, KelvinVoigt, Rigid, Rotor, Touchdown, from_matrices, jeffcott
from carom.motions import State
from carom.parameters import Parameters, Scales

PAPER = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=50.0)
START = State(0.2 + 0.1j, 1.2 - 0.3j)


def paper(law) -> Rotor:
    """The paper's rotor by its matrices, with a wall of another law."""
    return planar_rotor(
        PAPER.gamma,
        PAPER.omega**2,
        PAPER.rho * np.exp(1j * PAPER.phi),
        [Touchdown([1.0], law, PAPER.mu, PAPER.radius_ratio + 1.0)],
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
    by_matrices, planar = paper(Rigid(0.95)).system.arrays, jeffcott(PAPER).system.arrays
    for name in ("friction", "restitution", "surface_speed", "law", "law_number"):
        assert np.array_equal(by_matrices[name], planar[name])


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: Rigid(1.2), "restitution = 1.2"),
        (lambda: FallingRestitution(0.5, 0.0), "speed = 0.0"),
        (lambda: Touchdown([1.0], Rigid(0.5), -0.1, 2.0), "friction = -0.1"),
        (lambda: Touchdown([1.0], Rigid(0.5), 0.1, 0.5), "surface_speed = 0.5"),
        (lambda: Touchdown([], Rigid(0.5), 0.1, 2.0), "plane = "),
    ],
)
def test_bad_values_are_refused(make, named):
    with pytest.raises(InputError, match=named):
        make()


# ------------------------------------------------------------------------------------------------ compliant walls

SPRING, BALLS = KelvinVoigt(3e4, 7.0), HuntCrossley(5e4, 0.3, 1.5)
IN_SI = Scales(mass=3.0, clearance=0.2e-3, speed=400.0)


def with_two_walls(first, second, scales=None) -> Rotor:
    """A rotor that tilts, with a wall at each end."""
    return from_matrices(
        mass=[[1.0, 0.0], [0.0, 0.4]],
        damping=[[0.1, 0.0], [0.0, 0.05]],
        stiffness=[[0.6, 0.05], [0.05, 0.3]],
        gyroscopic=[[0.0, 0.0], [0.0, 0.3]],
        forcing=[0.3, 0.05j],
        touchdowns=[Touchdown([1.0, 0.8], first, 0.2, 21.0), Touchdown([1.0, -0.7], second, 0.1, 31.0)],
        scales=scales,
    )


def test_parameters_of_walls_have_names_by_law_and_plane():
    both = with_two_walls(SPRING, BALLS)
    walls = {name for name in both.varied if name.startswith("wall")}
    assert walls == {"wall_stiffness", "wall_stiffness_1", "wall_stiffness_2", "wall_damping_1", "wall_dissipation_2"}
    assert not {"d", "d_1", "d_2", "restitution"} & set(both.varied)
    changed = both.replace(wall_stiffness=9e3, wall_damping_1=2.0, wall_dissipation_2=0.1, mu_2=0.3)
    assert [each.law for each in changed.equations.touchdowns] == [KelvinVoigt(9e3, 2.0), HuntCrossley(9e3, 0.1, 1.5)]
    assert changed.value("wall_stiffness") == 9e3
    one = with_two_walls(SPRING, Rigid(0.9))
    assert {"wall_stiffness_1", "wall_damping_1", "d_2"} <= set(one.varied)
    assert not {"wall_stiffness", "wall_stiffness_2", "d", "d_1"} & set(one.varied)
    alone = paper(BALLS)
    assert {name for name in alone.varied if name.startswith("wall")} == {"wall_stiffness", "wall_dissipation"}
    assert alone.replace(wall_dissipation=0.5).equations.touchdowns[0].law == HuntCrossley(5e4, 0.5, 1.5)


@pytest.mark.parametrize("law", [SPRING, BALLS], ids=str)
def test_the_same_wall_at_another_speed_gives_the_same_motion_in_si(law):
    """Without unbalance, which grows with the speed, and in a fixed frame: nothing else then depends on the speed."""
    rotor = paper(law).replace(forcing=np.zeros(1), scales=IN_SI)
    factor = 1.7
    faster = rotor.replace(speed=IN_SI.speed * factor)
    # The surface is the shaft's: without friction its speed does not matter.
    rotor, faster = (each.replace(mu=0.0) for each in (rotor, faster))
    position, velocity, until = 0.3 + 0.2j, 2.0 - 0.4j, 6.0
    slow = cm.simulate(rotor, State(position, velocity - 1j * position), until)
    fast = cm.simulate(faster, State(position, velocity / factor - 1j * position), until * factor)
    assert len(slow.lasting_contacts) == len(fast.lasting_contacts) >= 3
    ends = [
        (np.exp(1j * motion.time) * motion.final.position, np.exp(1j * motion.time) * speed * velocity_in_fixed(motion))
        for motion, speed in ((slow, 1.0), (fast, factor))
    ]
    np.testing.assert_allclose(ends[0], ends[1], rtol=0.0, atol=1e-10)


def velocity_in_fixed(motion):
    """Velocity at the end in the fixed frame, turned back."""
    return motion.final.velocity + 1j * motion.final.position


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: KelvinVoigt(0.0, 0.0), "stiffness = 0.0: "),
        (lambda: KelvinVoigt(1e4, -0.1), "damping = -0.1: "),
        (lambda: KelvinVoigt(float("inf"), 0.0), "stiffness = inf: "),
        (lambda: HuntCrossley(1e4, -0.1), "dissipation = -0.1: "),
        (lambda: HuntCrossley(1e4, 0.1, 0.9), "exponent = 0.9: "),
        (lambda: HuntCrossley(1e4, 0.1, 2.5), "exponent = 2.5: "),
        (lambda: paper(SPRING).replace(wall_stiffness=-1.0), "wall_stiffness = -1.0: "),
        (lambda: paper(BALLS).replace(wall_dissipation=float("nan")), "wall_dissipation = nan: "),
        (lambda: paper(BALLS).replace(wall_damping=1.0), "wall_damping = 1.0: "),
    ],
)
def test_bad_values_of_walls_that_give_way_are_refused_in_one_line(make, named):
    assert_refused(make, named)
