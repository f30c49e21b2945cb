"""What a machine survives: brackets that fresh disturbances, drawn and followed without the search, must not break."""

import math

import pytest

import carom as cm
from carom.base.progress import Reporter
from carom.models import jeffcott
from carom.motions.budget import Budget
from carom.parameters import Parameters, Required, Shock
from carom.studies.questions import required_disturbances
from carom.studies.survives import has_unrecovered, survives

SOURCE = Parameters(gamma=0.2, omega=0.76, rho=0.2, phi=0.21, mu=0.15, d=0.7, radius_ratio=400 / 7)
REQUIRED = Required(kick=1.0, shock=Shock(peak=2.0, duration=2.0), blade_loss=0.4)

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def found():
    return survives(jeffcott(SOURCE), REQUIRED, Budget(), Reporter.of(None, "test"))


def test_shocks_are_of_the_duration_required(found):
    assert found.duration == 2.0
    assert found.shock.largest >= 4.0 * 2.0
    assert 0.0 < found.shock.contact_free < found.shock.all_back


def test_sizes_do_not_depend_on_what_is_required(found):
    # Another requirement searches another range, in other steps: the brackets must overlap.
    other = survives(
        jeffcott(SOURCE), Required(kick=0.8, shock=None, blade_loss=None), Budget(), Reporter.of(None, "test")
    )
    assert other.kick.contact_free == found.kick.contact_free
    assert other.kick.size == pytest.approx(found.kick.size, rel=5e-3)
    assert other.shock is None


def test_the_speed_of_the_shaft_does_not_move_the_yardstick():
    """A spindle at two speeds: what must be survived is the same in mm/s, and so are nearly the brackets."""
    sizes = []
    for speed in ("3000 rpm", "10000 rpm"):
        machine = cm.parameters.Machine(
            mass=3.2,
            damping=350.0,
            stiffness=4e5,
            eccentricity=1e-6,
            clearance=0.25e-3,
            rotor_radius=0.015,
            speed=speed,
            friction=0.2,
            restitution=0.7,
        )
        result = cm.study(machine)
        si = result.rotor.scales.velocity
        assert result.required.kick * si == pytest.approx(math.sqrt(4.0 * 9.80665 * 0.25e-3), rel=1e-12)
        sizes.append(result.survives.kick.size * si)
    assert sizes[0] == pytest.approx(sizes[1], rel=0.1)


def test_without_stable_levitation_nothing_is_survived():
    tell = Reporter.of(None, "test")
    assert survives(jeffcott(SOURCE.replace(gamma=0.0)), REQUIRED, Budget(), tell) is None
    assert survives(jeffcott(SOURCE.replace(gamma=0.05, rho=0.6)), REQUIRED, Budget(), tell) is None


def test_sizes_with_unrecovered_disturbances(found):
    assert not has_unrecovered(found.kick, found.kick.all_back)
    assert has_unrecovered(found.kick, found.kick.size)


def test_required_kinds():
    kinds = [sample.model.kind for sample in required_disturbances(REQUIRED, 1000)]
    assert kinds == ["kick", "shock", "blade-loss"]
    assert [sample.count for sample in required_disturbances(Required(1.0, None, None), 1000)] == [1000]
