"""The same disturbances on rigid walls and on walls that give way."""

from dataclasses import replace

import numpy as np
import pytest
from machines import PAPER

import carom as cm
from carom.models import KelvinVoigt, Touchdown, from_matrices, jeffcott, rotor_of
from carom.parameters import Drive, TouchdownBearing
from carom.studies.rigid_limit import RATIOS, SEED, on_other_walls, wall_values, wall_words
from carom.studies.wording import Wording

SPINDLE = cm.parameters.Machine(
    mass=50.0,
    clearance="0.7 mm",
    speed="1759 rpm",
    stiffness=980_000.0,
    damping=1400.0,
    eccentricity="0.3 mm",
    friction=0.15,
    restitution=0.8,
    rotor_radius="40 mm",
)


def asked(rotor, count=60):
    fastest = cm.disturbances.VelocityKick(0.9)
    return [cm.disturbances.Sample(fastest, count)]


@pytest.mark.jit_only
def test_each_disturbance_is_followed_on_both_walls():
    """Once more one by one, on a wall made here from damping ratio and restitution."""
    rotor = jeffcott(PAPER)
    found = on_other_walls(rotor, asked(rotor))
    assert [other.stiffness for other in found] == list(RATIOS)
    assert {other.alike.total for other in found} == {60}
    drawn = replace(asked(rotor)[0], seed=SEED).starts(rotor)
    for other in found:
        ratio = 0.0164982  # of d = 0.95, to the digits of its source
        law = KelvinVoigt(other.stiffness, 2.0 * ratio * other.stiffness**0.5)
        soft = from_matrices(
            mass=[[1.0]],
            damping=[[PAPER.gamma]],
            stiffness=[[PAPER.omega**2]],
            forcing=[PAPER.rho * np.exp(1j * PAPER.phi)],
            touchdowns=[Touchdown([1.0], law, PAPER.mu, PAPER.radius_ratio + 1.0)],
        )
        ends = [
            [cm.simulate(each, cm.State(complex(position), complex(velocity))).outcome for each in (rotor, soft)]
            for position, velocity in zip(drawn.positions, drawn.velocities, strict=True)
        ]
        alike = sum(rigid == yielding for rigid, yielding in ends)
        assert abs(alike - other.alike.count) <= 1  # the damping ratio is rounded


@pytest.mark.jit_only
@pytest.mark.parametrize("law", ["kelvin-voigt", "hunt-crossley"])
def test_a_bearing_that_gives_way_is_compared_with_the_rigid_wall(law):
    speed = {"restitution_speed": 0.9 * 0.7e-3 * 184.2} if law == "hunt-crossley" else {}
    bearing = TouchdownBearing(law, "1e9 N/m", restitution=0.8, **speed)
    rotor = jeffcott(rotor_of(SPINDLE).parameters, bearing)
    (other,) = on_other_walls(rotor, asked(rotor))
    assert other.stiffness is None
    assert other.restitution == pytest.approx(0.8, rel=1e-4 if speed else 1e-12)
    assert 0.9 <= other.alike.fraction <= 1.0


def test_there_is_nothing_to_compare_where_a_rigid_wall_has_no_counterpart():
    rotor = rotor_of(SPINDLE)
    stiff = {"law": "kelvin-voigt", "stiffness": 1e8, "damping": 2e3}
    for more in (
        {"mount_mass": 2.0, "mount_stiffness": 1e7},
        {"race_inertia": 1e-4},
        {"offset": 1e-5},
    ):
        assert on_other_walls(jeffcott(rotor.parameters, TouchdownBearing(**stiff, **more)), asked(rotor)) == ()
    driven = jeffcott(rotor.parameters, TouchdownBearing(**stiff), drive=Drive(polar_inertia=0.01))
    assert on_other_walls(driven, asked(rotor)) == ()
    assert on_other_walls(jeffcott(PAPER.replace(d=0.0)), asked(rotor)) == ()


@pytest.mark.parametrize(
    ("counts", "words"),
    [
        ((30, 58, 60), "the rigid answer is good enough from 1,000 MN/m on"),
        ((60, 60, 60), "the rigid answer is good enough from 10 MN/m on"),
        ((60, 60, 59), "none of these bearings ends all of them alike"),
    ],
)
def test_words_say_from_which_stiffness_on(counts, words):
    rotor = rotor_of(SPINDLE)
    found = on_other_walls(rotor, asked(rotor, 2))
    found = [
        replace(other, alike=cm.basins.Share.of(count, 60, drawn=True))
        for other, count in zip(found, counts, strict=True)
    ]
    text = wall_words(Wording(rotor.scales), found)
    assert words in text
    assert "10 MN/m, 100 MN/m and 1,000 MN/m" in text
    values = wall_values(found, rotor.scales)
    assert [wall["stiffness_si"] for wall in values["walls"]] == pytest.approx([1e7, 1e8, 1e9])
