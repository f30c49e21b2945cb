"""Which values of a parameter leave only recovery: against fresh disturbances drawn without the code under test."""

import numpy as np
import pytest
from linear_rotors import planar_rotor, touchdowns
from machines import PAPER

import carom as cm
from carom.base.outcome import InputError
from carom.closed_forms import contact_free_kick
from carom.disturbances import AnyState, Sample, VelocityKick
from carom.models import jeffcott
from carom.motions import settle
from carom.studies import check_recovery, find_recovery

SPEED = 1.3

pytestmark = pytest.mark.jit_only


def tried(count=400, fastest=SPEED):
    return [Sample(VelocityKick(fastest), count), Sample(AnyState(fastest), count)]


def fresh(rotor, count, seed, fastest=SPEED):
    """Kicks and starts in the clearance, both bounded in the fixed frame: co-rotating positions and velocities."""
    random = np.random.default_rng(seed)

    def disc(radius):
        return radius * np.sqrt(random.random(count)) * np.exp(2j * np.pi * random.random(count))

    rest = rotor.equilibrium
    places = np.concatenate([np.full(count, rest), disc(1.0)])
    seen_in_the_room = disc(fastest)
    speeds = np.concatenate([disc(fastest), seen_in_the_room - 1j * places[count:]])
    return places, speeds


@pytest.fixture(scope="module")
def along_damping():
    return find_recovery(PAPER, "gamma", tried(), within=(0.1, 4.0), seed=3)


def test_nothing_fresh_is_lost_inside_a_range(along_damping):
    (span,) = along_damping.spans
    assert span.low.kind == "simulated"
    assert (span.high.value, span.high.kind) == (4.0, "")
    for number, gamma in enumerate(np.geomspace(1.05 * span.low.value, span.high.value, 5)):
        rotor = jeffcott(PAPER.replace(gamma=float(gamma)))
        lost = ~settle(rotor, cm.State(*fresh(rotor, 2000, 100 + number))).recovered
        assert lost.sum() == 0


def test_something_is_lost_just_beyond_its_end(along_damping):
    (span,) = along_damping.spans
    beyond = max(check.value for check in along_damping.checks if check.value < span.low.value)
    assert beyond > 0.995 * span.low.value
    (check,) = [check for check in along_damping.checks if check.value == beyond]
    lost = check.example
    assert lost.motion == span.low.motion
    rotor = jeffcott(PAPER.replace(gamma=beyond))
    starts = lost.model.starts(rotor, *(np.array([value]) for value in lost.values))
    (outcome,) = settle(rotor, cm.State(starts.positions, starts.velocities)).outcomes
    assert outcome == lost.motion.outcome


def test_every_check_has_a_sample_of_its_own_and_all_of_it(along_damping):
    for check in along_damping.clear:
        assert [share.total for share in check.returned] == [400, 400]
        assert [share.total for share in check.largest] == [96, 96]
        assert check.tried == 992
        assert check.recovers


def test_any_parameter_of_any_model():
    rotor = planar_rotor(0.4, 1.5, 0.1, touchdowns([[1.0]], [0.1], [0.6], [30.0]))
    name = next(name for name in rotor.varied if "friction" in name)
    kicks = [Sample(VelocityKick(0.8), 60)]
    assert (
        check_recovery(rotor, kicks, along=name).drawn
        == check_recovery(rotor, kicks, along=name, value=rotor.value(name)).drawn
    )
    assert check_recovery(rotor, kicks).drawn.total == 60
    found = find_recovery(rotor, name, kicks, within=(0.02, 0.9))
    assert found.along.name == name
    assert found.clear
    machine = cm.load("examples/keogh-cole.toml", ["damping=4000 N s/m"])
    kicks = [Sample(VelocityKick.of(machine, "50 mm/s"), 60)]
    along_speed = find_recovery(machine, "speed", kicks, within=("1500 rpm", "1900 rpm"))
    moved = along_speed.checks[0].value
    assert all(share.total == 60 for share in along_speed.clear[0].returned), moved


def test_without_a_range_it_is_looked_for_wherever_the_rotor_levitates():
    machine = cm.load("examples/keogh-cole.toml")
    kicks = [Sample(VelocityKick.of(machine, "166 mm/s"), 60)]
    found = find_recovery(machine, "speed", kicks)
    assert found.searched == found.range_of("contact-free").spans
    # Beyond it a rub can hold the rotor.
    (span,) = found.spans
    assert span == found.searched[0]
    assert span.high == found.range_of("rub").spans[0].low
    own, physical = (find_recovery(machine, name, kicks) for name in ("gamma", "damping"))
    ends = [edge.value * machine.parameters.scales.damping for span in own.spans for edge in span]
    assert [edge.value for span in physical.spans for edge in span] == pytest.approx(ends, rel=1e-14)


def test_what_is_required_decides_not_whether_a_rub_could_hold_the_rotor():
    """Nothing comes back from a rub, but small kicks never reach it."""
    rotor = jeffcott(PAPER)
    small = [Sample(VelocityKick(0.5 * contact_free_kick(rotor)), 60)]
    found = find_recovery(rotor, "gamma", small, factor=2.0)
    assert found.range_of("rub").exists_at(PAPER.gamma)
    assert found.span_at(PAPER.gamma) is not None
    # No farther than the damping may be changed.
    (searched,) = found.searched
    assert searched.high.value == pytest.approx(2.0 * PAPER.gamma)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"disturbances": []}, "disturbances"),
        ({"along": "gama"}, "gama"),
        ({"within": (2.0, 1.0)}, "gamma"),
        ({"within": (0.0, 1.0)}, "within"),
    ],
)
def test_what_cannot_be_searched_is_refused(options, message):
    given = {"along": "gamma", "disturbances": tried(10)} | options
    with pytest.raises(InputError, match=message):
        find_recovery(PAPER, **given)
