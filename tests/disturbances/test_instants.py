"""Where something stands in the fixed frame the instant of the turn is part of a disturbance."""

import math

import numpy as np
import pytest

import carom as cm
from carom.attractors import DisturbanceSet
from carom.basins.shares import Population
from carom.disturbances import AnyState, BladeLoss, ContactRelease, Grid, Sample, VelocityKick
from carom.disturbances.plans import ANY_INSTANT
from carom.models import rotor_of

MACHINE, PLAIN = "examples/dropped-rotor.toml", "examples/keogh-cole.toml"
TURNED = 0.7


def turned(angle):
    """The machine whose unbalance is ahead by an angle, when both frames coincide."""
    return rotor_of(cm.load(MACHINE)).replace(phi=rotor_of(cm.load(MACHINE)).value("phi") + angle)


@pytest.mark.parametrize(
    ("model", "values", "angles"),
    [
        (VelocityKick(0.3), (0.2, 1.1), (1,)),
        (cm.BaseShock(0.2, 2.0), (0.1, 1.1), (1,)),
        (BladeLoss(0.1), (1.1,), ()),
        (AnyState(0.3), (0.5, 0.2, 0.2, 1.0), (1, 3)),
        (ContactRelease(), (1.0,), (0,)),
    ],
)
def test_an_instant_later_is_an_unbalance_ahead(model, values, angles):
    """Only the angle between the unbalance and the room counts: the same start, seen in a frame that is turned."""
    here = model.starts(turned(0.0), *(np.array([value]) for value in values), instant=np.array([TURNED]))
    ahead = [np.array([value + TURNED * (place in angles)]) for place, value in enumerate(values)]
    there = model.starts(turned(TURNED), *ahead)
    assert here.exists.all()
    assert here.positions * np.exp(1j * TURNED) == pytest.approx(there.positions, abs=1e-13)
    assert here.velocities * np.exp(1j * TURNED) == pytest.approx(there.velocities, abs=1e-13)
    assert here.begins - there.begins == pytest.approx(TURNED)


def test_samples_are_over_the_instant_where_it_matters():
    kicks, weighs, plain = VelocityKick(0.2), turned(0.0), rotor_of(cm.load(PLAIN))
    for plan in (Sample(kicks, 400, 3), Grid(kicks, (20, 20)), DisturbanceSet(400, 3, 0.2)):
        begins = plan.starts(weighs).begins
        assert np.unique(begins).size == 400
        assert np.histogram(begins, 4, (0.0, 2.0 * math.pi))[0].min() > 70
        assert not plan.starts(plain).begins.any()
    # Sizes and directions do not depend on whether the instant matters.
    heavy, light = (Sample(kicks, 50, 3).starts(each) for each in (weighs, turned(0.0).unforced))
    pushes = weighs.system.translation_velocity(heavy.velocities, heavy.begins)
    assert pushes == pytest.approx(light.velocities, abs=1e-15)
    one = Grid(kicks, (4, 6), 0.3)
    assert (one.starts(weighs).begins == 0.3).all()
    assert Population.of_model(kicks, None, ANY_INSTANT).words.endswith("c_r Ω at any instant of the turn")
