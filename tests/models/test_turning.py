"""Shafts whose speed changes: motions against a general integrator, momentum, a heavy rotor that stops, and what is refused."""

import numpy as np
import pytest
from turning_reference import SLIDES, Turning

import carom as cm
from carom.models import Force, HuntCrossley, KelvinVoigt, Race, Rigid, Shaft, Touchdown, from_matrices
from carom.models.subjects import refuse_forces

START = cm.State(0.2 + 0.1j, 1.0)
SOFT = KelvinVoigt(1e3, 3.3)


def single(law, shaft, friction=0.15, surface_speed=57.14, race=None, **changes):
    """The planar rotor."""
    numbers = {"mass": [[1.0]], "damping": [[0.1]], "stiffness": [[0.76**2]], "forcing": [3.0 / 7.0 * np.exp(0.21j)]}
    touchdowns = [Touchdown([1.0], law, friction, surface_speed, race)]
    return from_matrices(**(numbers | changes), touchdowns=touchdowns, shaft=shaft)


def double(laws, shaft, friction=(0.2, 0.3), surface_speed=(3.0, 2.0), races=(None, None)):
    """A rotor with two coordinates and two planes."""
    each = zip([[1.0, 0.8], [1.0, -0.7]], laws, friction, surface_speed, races, strict=True)
    return from_matrices(
        mass=[[1.0, 0.05], [0.05, 0.3]],
        damping=[[0.1, 0.01], [0.01, 0.04]],
        stiffness=[[0.6, 0.02], [0.02, 0.2]],
        forcing=[0.3 + 0.1j, 0.05 - 0.03j],
        touchdowns=[Touchdown(*numbers) for numbers in each],
        shaft=shaft,
    )


def assert_same(motion, reference, until, y, rotor=None):
    """Far above the errors found, 1e-12, and far below what any term of the equations contributes."""
    position, velocity, speed, ahead, races = reference.seen_in_the_frame(until, y)
    assert motion.final.position == pytest.approx(position if len(position) > 1 else position[0], abs=1e-11)
    assert motion.final.velocity == pytest.approx(velocity if len(velocity) > 1 else velocity[0], abs=1e-11)
    assert motion.final.shaft[0] == pytest.approx(speed, abs=1e-11)
    assert np.exp(1j * motion.final.shaft[1]) == pytest.approx(np.exp(1j * ahead), abs=1e-11)
    turning = [
        race
        for race, each in zip(races, (rotor or motion.rotor).equations.touchdowns, strict=True)
        if each.race is not None
    ]
    assert motion.final.races == pytest.approx(turning, abs=1e-11)


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("rotor", "contacts", "kinds"),
    [
        pytest.param(single(KelvinVoigt(1e4, 3.3), Shaft(9e2)), 5, {(0, 1)}, marks=pytest.mark.deep),
        (single(HuntCrossley(1e4, 0.05), Shaft(0.8, 0.03), 0.6, 1.5), 2, {(0, 1), (0, 0), (0, -1)}),
        pytest.param(
            single(SOFT, Shaft(3.0, 0.1), 0.6, 1.2, Race(0.5, 1.5, 0.02, 0.1)),
            6,
            {(0, 1), (0, 0)},
            marks=pytest.mark.deep,
        ),
        (
            double([SOFT, HuntCrossley(1e3, 0.1, 1.5)], Shaft(2.0, 0.1)),
            4,
            {(0, 1), (1, 1), (1, -1)},
        ),
        (
            double(
                [SOFT, KelvinVoigt(2e3, 4.0)],
                Shaft(0.5, 0.05),
                (0.6, 0.5),
                (1.5, 1.3),
                (Race(0.5, 1.5, 0.02, 0.1), None),
            ),
            7,
            {(0, 1), (0, 0), (0, -1), (1, 1), (1, 0), (1, -1)},
        ),
    ],
)
def test_contacts_that_give_way_against_a_general_integrator(rotor, contacts, kinds):
    start = START if len(rotor.equations.forcing) == 1 else cm.State(np.array([0.2 + 0.1j, 0.1]), np.array([1.0, 0.5j]))
    reference = Turning(rotor)
    y = reference.follow(reference.start(start.position, start.velocity), 12.0)
    assert (reference.contacts, {(plane, sense) for plane, _, sense in reference.seen}) == (contacts, kinds)
    assert abs(reference.parts(y)[3] - 1.0) > 5e-3
    assert_same(cm.simulate(rotor, start, 12.0), reference, 12.0, y)


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("rotor", "impacts"),
    [
        (single(Rigid(0.8), Shaft(5.0), 0.2, 4.0), 2),
        (single(Rigid(0.9), Shaft(1.0), 0.5, 2.0), 2),
        (double([Rigid(0.8), Rigid(0.7)], Shaft(2.0)), 4),
        (double([Rigid(0.8), SOFT], Shaft(2.0)), 2),
        (single(Rigid(0.8), Shaft(5.0), 0.3, 1.5, Race(0.5, 1.5, 0.02, 0.1)), 4),
        (double([Rigid(0.8), Rigid(0.7)], Shaft(2.0), races=(Race(0.05, 2.0, 0.02, 0.1), None)), 6),
    ],
)
def test_impacts_against_a_general_integrator(rotor, impacts):
    start = START if len(rotor.equations.forcing) == 1 else cm.State(np.array([0.2 + 0.1j, 0.1]), np.array([1.0, 0.5j]))
    reference = Turning(rotor)
    y = reference.follow(reference.start(start.position, start.velocity), 8.0)
    assert reference.impacts == impacts
    assert_same(cm.simulate(rotor, start, 8.0), reference, 8.0, y)


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("shaft", "friction", "surface_speed", "push", "rate", "until", "kinds"),
    [
        (Shaft(0.5, 0.02), 0.3, 1.5, 1.2 * np.exp(0.2j), 0.2, 1.0, {1}),
        (Shaft(0.5, 0.02), 0.3, 1.5, 0.5, -1.9, 0.5, {-1}),
        (Shaft(50.0, 0.02), 0.6, 1.5, 0.5, -1.5, 0.5, {-1, 0, 1}),
        (Shaft(5.0, 0.2), 0.3, 3.0, 0.5, -3.1, 2.0, {-1, 0}),
        (Shaft(5.0, 0.2), 0.05, 3.0, 0.5, -3.0, 2.0, {0, 1}),
    ],
)
def test_rubs_on_a_rigid_wall_against_a_general_integrator(shaft, friction, surface_speed, push, rate, until, kinds):
    rotor = single(Rigid(0.5), shaft, friction, surface_speed, forcing=[push])
    start = cm.State(np.exp(0.3j), 1j * rate * np.exp(0.3j), shaft=(1.0, 0.0))
    reference = Turning(rotor)
    y = reference.start(start.position, start.velocity)
    reference.phases = [SLIDES]
    reference.senses = [1 if reference.slip(0, y) > 0.0 else -1]
    if abs(reference.slip(0, y)) < 1e-12:
        reference.change_slip(0, y)
    y = reference.follow(y, until)
    assert {sense for _, _, sense in reference.seen} == kinds
    assert_same(cm.simulate(rotor, start, until), reference, until, y)


@pytest.mark.parametrize("restitution", [1.0, 0.8, 0.3])
def test_momentum_that_a_rigid_wall_does_not_change(restitution):
    """Friction turns the centre about the bearing at the radius one, and the shaft about its axis at the rotor's radius."""
    rotor = single(Rigid(restitution), Shaft(1.5), 0.2, 3.0, damping=[[0.0]], forcing=[0.0])
    motion = cm.simulate(rotor, START, 40.0)
    assert len(motion.contacts) >= 10
    assert motion.final.shaft[0] < 0.75

    def momentum(position, velocity, speed):
        return 1.5 * speed - 2.0 * (np.conj(position) * (velocity + 1j * position)).imag

    final = momentum(motion.final.position, motion.final.velocity, motion.final.shaft[0])
    assert final == pytest.approx(momentum(START.position, START.velocity, 1.0), abs=1e-11)


def test_a_heavy_rotor_stops_when_friction_has_taken_its_momentum():
    """Where it lies at the angle of friction, the wall presses with ``N = W/√(1 + μ²)``, and it stops after ``JΩ/(μNR)``."""
    inertia, friction, radius, weight, stiffness = 20.0, 0.2, 4.0, 0.5, 1e3
    bare = single(
        KelvinVoigt(stiffness, 30.0),
        Shaft(inertia),
        friction,
        radius + 1.0,
        damping=[[0.0]],
        stiffness=[[0.0]],
        forcing=[0.0],
    )
    rotor = bare.under(Force(-1j, np.array([-1j * weight])))
    normal = weight / np.hypot(1.0, friction)
    place = (1.0 + normal / stiffness) * np.exp(-1j * (0.5 * np.pi + np.arctan(friction)))
    stop = inertia / (friction * normal * radius)
    motion = cm.simulate(rotor, cm.State(place, -1j * place), 1.1 * stop)
    first, after = motion.lasting_contacts[:2]
    assert first.phase is cm.outcome.Phase.FORWARD_SLIP
    assert first.end == pytest.approx(stop, rel=1e-11)
    assert after.phase is cm.outcome.Phase.ROLLING
    half = cm.simulate(rotor, cm.State(place, -1j * place), 0.5 * stop).final
    assert half.shaft[0] == pytest.approx(0.5, abs=1e-12)
    assert half.position == pytest.approx(place * np.exp(-0.5j * stop), abs=1e-11)


@pytest.mark.jit_only
def test_a_drop_against_a_general_integrator():
    """An unbalanced rotor falls, strikes the bearing and climbs along it, while friction brakes the shaft."""
    bare = single(KelvinVoigt(2e3, 20.0), Shaft(6.0, 0.01), 0.3, 5.0, damping=[[0.0]], stiffness=[[0.0]], forcing=[0.1])
    motion = cm.simulate(bare.under(Force(-1j, np.array([-0.02j]))), cm.State(0.1, -0.05j), 26.0)
    reference = Turning(bare, weight=-0.02j)
    y = reference.follow(reference.start(0.1, -0.05j), 26.0)
    assert reference.contacts == 2
    assert reference.parts(y)[3] < 0.9
    assert_same(motion, reference, 26.0, y, bare)


def test_what_cannot_be_is_refused():
    with pytest.raises(cm.outcome.InputError, match=r"inertia = 0.0"):
        Shaft(0.0)
    with pytest.raises(cm.outcome.InputError, match="shaft = "):
        single(SOFT, 3.0)
    with pytest.raises(cm.outcome.InputError, match="gyroscopic"):
        single(SOFT, Shaft(1.0), gyroscopic=[[0.2]])
    with pytest.raises(cm.outcome.InputError, match="undamped resonance"):
        single(SOFT, Shaft(1.0), damping=[[0.0]], stiffness=[[1.0]])
    with pytest.raises(cm.outcome.InputError, match="start shaft"):
        cm.simulate(single(SOFT, Shaft(2.0)), cm.State(0.1, 0.0, shaft=(1.0,)), 1.0)
    with pytest.raises(cm.outcome.InputError, match="start shaft"):
        cm.simulate(single(SOFT, None), cm.State(0.1, 0.0, shaft=(1.0, 0.0)), 1.0)
    with pytest.raises(cm.outcome.InputError, match="a shaft whose speed changes"):
        refuse_forces(single(SOFT, Shaft(2.0)))


@pytest.mark.jit_only
@pytest.mark.parametrize(
    "rotor",
    [
        single(SOFT, Shaft(3.0, 0.1), 0.6, 1.2, Race(0.5, 1.5, 0.02, 0.1)),
        single(Rigid(0.2), Shaft(5.0, 0.3), 0.2, 4.0, damping=[[-0.1]]),
        single(Rigid(0.9), Shaft(1.0, 0.1), 0.5, 2.0),
        double([Rigid(0.8), Rigid(0.7)], Shaft(2.0)),
        double([Rigid(0.8), SOFT], Shaft(2.0)),
    ],
)
def test_the_energy_ledger_holds_the_spin(rotor):
    """What friction takes comes from the shaft, also in the instant of an impact, in which the unbalance pushes too."""
    start = START if len(rotor.equations.forcing) == 1 else cm.State(np.array([0.2 + 0.1j, 0.1]), np.array([1.0, 0.5j]))
    motion = cm.simulate(rotor, start, 30.0)
    ledger = cm.motions.energy_ledger(motion)
    assert ledger.imbalance < 1e-13
    assert abs(ledger.shaft[-1] / ledger.shaft[0] - 1.0) > 0.1
    assert ledger.shaft[-1] == pytest.approx(
        0.5 * rotor.equations.shaft.inertia * motion.final.shaft[0] ** 2, rel=1e-14
    )
    assert (ledger.drive[-1] != 0.0) == (rotor.equations.shaft.torque != 0.0 and len(motion.lasting_contacts) > 0)


@pytest.mark.jit_only
@pytest.mark.parametrize("laws", [[Rigid(0.8), Rigid(0.7)], [Rigid(0.8), SOFT]])
def test_impulses_at_a_rigid_wall_are_those_that_brake_the_shaft(laws):
    rotor = double(laws, Shaft(2.0))
    start = cm.State(np.array([0.2 + 0.1j, 0.1]), np.array([1.0, 0.5j]))
    motion = cm.simulate(rotor, start, 30.0)
    contacts = motion.log_of(motion.is_impact)
    assert len(contacts) >= 3
    radius = rotor.system.arrays.surface_speed[contacts.touchdown_bearing - 1] - 1.0
    ends = [
        each[:, int(rotor.system.arrays.shaft[0]) + 1].real
        for each in (motion.event_amplitudes, motion.segment_amplitudes[1:])
    ]
    jumps = (ends[1] - ends[0])[motion.is_impact]
    assert radius * contacts.friction_impulse / 2.0 == pytest.approx(jumps, rel=1e-12)
    assert (
        np.abs(contacts.friction_impulse)
        <= rotor.system.arrays.friction[contacts.touchdown_bearing - 1] * contacts.normal_impulse + 1e-14
    ).all()
    assert contacts.drive_work == pytest.approx(-(ends[1] ** 2 - ends[0] ** 2)[motion.is_impact], rel=1e-12)
    assert (contacts.contact_work <= 0.0).all()
