"""Motions as results: starts, frames, samples, and that long ones are joined without a seam."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from machines import PAPER, fly, strike

from carom.models import Jeffcott
from carom.motions import trajectories
from carom.motions.trajectories import Kick, State, kick, simulate
from carom.outcome import InputError, Outcome, Phase
from carom.parameters import Machine, Scales

START = State(0.3 + 0.1j, 0.9 - 0.4j)
RUBBING = PAPER.replace(gamma=0.2, d=0.5)


@pytest.fixture(scope="module")
def rotor():
    return Jeffcott(PAPER)


@pytest.fixture(scope="module")
def motion(rotor):
    return simulate(rotor, START, 30.0)


@pytest.fixture(scope="module")
def rubbing():
    return simulate(Jeffcott(RUBBING), START, 60.0)


def test_a_motion_is_flights_joined_by_impacts(motion):
    """Followed a second time with matrix exponentials and the impact law in polar coordinates."""
    assert motion.outcome is Outcome.TIME_REACHED
    assert motion.time == 30.0
    times = motion.contacts.time
    assert len(times) > 10
    position, velocity, before = START.position, START.velocity, 0.0
    for time in times:
        position, velocity = fly(PAPER, position, velocity, time - before)
        assert abs(position) == pytest.approx(1.0, abs=1e-12)
        normal = position / abs(position)
        local = velocity * normal.conjugate()
        velocity = complex(*strike(PAPER, local.real, local.imag)) * normal
        found = motion.at(time)
        # The matrix exponential loses a few digits; taking over the state found keeps them from growing.
        assert abs(found[0] - position) < 1e-12
        assert abs(found[1] - velocity) < 1e-12
        position, velocity, before = complex(found[0]), complex(found[1]), time
    position, velocity = fly(PAPER, position, velocity, 30.0 - before)
    assert motion.final.position == pytest.approx(position, abs=1e-12)
    assert motion.final.velocity == pytest.approx(velocity, abs=1e-12)


def test_position_and_velocity_at_given_times(motion):
    times = np.array([[0.0, 1.3], [17.2, 30.0]])
    position, velocity = motion.at(times)
    assert position.shape == velocity.shape == times.shape
    assert position[0, 0] == pytest.approx(START.position, abs=1e-15)
    assert velocity[0, 0] == pytest.approx(START.velocity, abs=1e-15)
    assert position[1, 1] == pytest.approx(motion.final.position, abs=1e-14)
    alone = motion.at(17.2)
    assert alone[0].shape == ()
    assert complex(alone[0]) == complex(position[1, 0])
    empty, _ = motion.at(np.array([]))
    assert empty.shape == (0,)


@pytest.mark.parametrize("frame", ["Fixed", "inertial", "", None])
def test_frames_that_are_none_are_refused(motion, frame):
    with pytest.raises(InputError, match="must be 'rotating' or 'fixed'") as caught:
        motion.position(np.zeros(1), frame=frame)
    assert caught.value.field == "frame"


def test_frames(motion):
    times = np.linspace(0.0, 30.0, 50)
    rotating, fixed = motion.position(times), motion.position(times, frame="fixed")
    assert np.allclose(fixed, rotating * np.exp(1j * times), rtol=0, atol=1e-15)
    assert np.allclose(motion.radius(times), np.abs(fixed), rtol=0, atol=1e-15)


def test_velocity_is_the_derivative_of_position(motion):
    middles = motion.contacts.time[:-1] + 0.5 * np.diff(motion.contacts.time)
    step = 1e-4
    shares = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))
    slope = sum(weight * motion.position(middles + share * step) for share, weight in shares) / step
    assert np.allclose(motion.at(middles)[1], slope, rtol=0, atol=1e-9)


def test_a_sample_holds_each_event_and_the_instant_before(motion):
    times = motion.sample(200)
    impacts = motion.contacts.time
    assert np.all(np.diff(times) > 0)
    assert times[0] == 0.0
    assert times[-1] == motion.time
    assert np.isin(impacts, times).all()
    assert np.isin(np.nextafter(impacts, 0.0), times).all()
    assert len(times) <= 200 + 2 * len(impacts)
    log = motion.contacts
    for when, speed in ((impacts, log.radial_speed_after), (np.nextafter(impacts, 0.0), log.radial_speed)):
        position, velocity = motion.at(when)
        assert np.allclose((position.conj() * velocity).real, speed, rtol=0, atol=1e-12)


def test_no_time_of_a_sample_is_outside_the_wall(motion, rubbing):
    for path in (motion, rubbing):
        assert path.radius(path.sample(300)).max() <= 1.0 + 1e-12


class TestUnits:
    MACHINE = Machine.from_parameters(PAPER, Scales(50.0, 0.7e-3, 184.2))

    def test_kicks_and_times_may_carry_units(self):
        unit = 0.7e-3 * 184.2
        told = simulate(self.MACHINE, kick("50 mm/s", angle="30 deg"), "0.2 s")
        plain = simulate(self.MACHINE, kick(0.05 / unit, angle=math.pi / 6.0), 0.2 * 184.2)
        assert told.start.velocity == pytest.approx(plain.start.velocity, rel=1e-14)
        assert told.time == pytest.approx(plain.time, rel=1e-14)
        assert kick("0.4").state(Jeffcott(PAPER)) == kick(0.4).state(Jeffcott(PAPER))

    @pytest.mark.parametrize(
        ("start", "until", "words"),
        [
            (kick("50 kg"), 1.0, "kick speed = 50 kg: must be a velocity"),
            (kick(0.4, "1 m"), 1.0, "kick angle = 1 m: must be an angle"),
            (kick(0.4), "2 m", "until = 2 m: must be a time"),
        ],
    )
    def test_another_kind_of_size_is_refused(self, start, until, words):
        with pytest.raises(InputError, match=words):
            simulate(self.MACHINE, start, until)

    def test_units_need_scales(self):
        with pytest.raises(InputError, match="has no scales"):
            simulate(PAPER, kick("50 mm/s"), 1.0)


class TestStarts:
    def test_a_kick_starts_at_the_equilibrium(self, rotor):
        machine = PAPER.replace(gamma=0.3)
        motion = simulate(Jeffcott(machine), kick(0.4, angle=0.2), 3.0)
        assert motion.start.position == Jeffcott(machine).equilibrium
        assert motion.start.velocity == pytest.approx(cmath.rect(0.4, 0.2), abs=1e-16)
        assert kick(0.4, angle=0.2) == Kick(0.4, 0.2)

    def test_no_kick_no_motion(self):
        motion = simulate(Jeffcott(PAPER.replace(gamma=0.3)), kick(0.0), 100.0)
        assert np.allclose(motion.position(motion.sample(50)), motion.start.position, rtol=0, atol=1e-15)

    @pytest.mark.parametrize("radius", [1.0 + 2e-12, 1.1, 1e300])
    def test_outside_the_wall(self, rotor, radius):
        with pytest.raises(InputError, match=r"^start position = .*inside the wall, \|U\| <= 1") as caught:
            simulate(rotor, State(radius * cmath.exp(1j)), 1.0)
        assert caught.value.field == "start position"

    def test_a_kick_from_an_equilibrium_outside_the_wall(self):
        with pytest.raises(InputError, match="start position"):
            simulate(Jeffcott(PAPER.replace(gamma=0.01)), kick(0.1), 1.0)

    @pytest.mark.parametrize("value", [math.nan, math.inf, complex(0, -math.inf)])
    def test_not_finite(self, rotor, value):
        with pytest.raises(InputError, match=r"start position = .* finite"):
            simulate(rotor, State(value), 1.0)
        with pytest.raises(InputError, match=r"start velocity = .* finite"):
            simulate(rotor, State(0.1, value), 1.0)

    @pytest.mark.parametrize("radius", [1.0, 1.0 + 0.9e-12, 1.0 - 0.9e-12])
    def test_on_the_wall_to_within_rounding(self, rotor, radius):
        """Both sides of one count as the wall: outward speed strikes at once."""
        normal = cmath.exp(0.3j)
        motion = simulate(rotor, State(radius * normal, 0.5 * normal), 1.0)
        assert motion.contacts.time[0] == 0.0
        assert motion.radius(motion.sample(100)).max() <= 1.0 + 1e-12
        assert abs(motion.at(0.0)[0]) == pytest.approx(1.0, abs=4e-16)

    def test_just_inside_the_wall(self, rotor):
        normal = cmath.exp(0.3j)
        motion = simulate(rotor, State((1.0 - 2e-12) * normal, 0.5 * normal), 1.0)
        assert motion.contacts.time[0] == pytest.approx(4e-12, rel=1e-3)

    @pytest.mark.parametrize("until", [0.0, -1.0, math.nan, math.inf])
    def test_times_that_cannot_be_reached(self, rotor, until):
        with pytest.raises(InputError, match=r"^until = "):
            simulate(rotor, START, until)

    def test_no_events_allowed(self, rotor):
        with pytest.raises(InputError, match=r"^max_events = 0"):
            simulate(rotor, START, 1.0, max_events=0)


class TestLongMotions:
    @pytest.mark.parametrize("chunk", [1, 3, 7])
    def test_kernel_calls_leave_no_seam(self, rotor, motion, monkeypatch, chunk):
        monkeypatch.setattr(trajectories, "CHUNK", chunk)
        cut = simulate(rotor, START, 30.0)
        assert cut.outcome is motion.outcome
        assert np.array_equal(cut.segment_amplitudes, motion.segment_amplitudes)
        assert np.array_equal(cut.arrivals, motion.arrivals)
        # The times are sums in another order.
        assert np.allclose(cut.segment_starts, motion.segment_starts, rtol=1e-14, atol=0)
        assert cut.final.position == pytest.approx(motion.final.position, abs=1e-12)

    @pytest.mark.parametrize("chunk", [1, 5])
    def test_nor_in_lasting_contact(self, rubbing, monkeypatch, chunk):
        monkeypatch.setattr(trajectories, "CHUNK", chunk)
        cut = simulate(Jeffcott(RUBBING), START, 60.0)
        assert np.array_equal(cut.segment_phases, rubbing.segment_phases)
        assert np.allclose(cut.segment_amplitudes, rubbing.segment_amplitudes, rtol=0, atol=1e-12)
        assert cut.final.position == pytest.approx(rubbing.final.position, abs=1e-12)

    def test_progress_is_reported_between_kernel_calls(self, rotor, monkeypatch):
        monkeypatch.setattr(trajectories, "CHUNK", 4)
        reached = []
        motion = simulate(rotor, START, 30.0, progress=reached.append)
        assert len(reached) == math.ceil((len(motion.segment_starts) - 1 + 0.5) / 4)
        assert reached == sorted(reached)
        assert reached[-1] == 30.0

    def test_the_event_limit_ends_at_an_event(self, rotor, motion):
        stopped = simulate(rotor, START, 30.0, max_events=5)
        assert stopped.outcome is Outcome.EVENT_LIMIT
        assert len(stopped.contacts) == 5
        assert stopped.time == stopped.contacts.time[-1] == motion.contacts.time[4]
        assert stopped.final.position == pytest.approx(complex(motion.at(stopped.time)[0]), abs=1e-15)

    def test_a_stopped_motion_goes_on_from_its_end(self, rotor, motion):
        stopped = simulate(rotor, START, 30.0, max_events=5)
        rest = simulate(rotor, stopped.final, 30.0 - stopped.time)
        assert np.allclose(stopped.time + rest.contacts.time[:3], motion.contacts.time[5:8], rtol=0, atol=1e-10)


class TestLastingContact:
    def test_stretches_are_in_order_and_within_the_motion(self, rubbing):
        stretches = rubbing.lasting_contacts
        assert stretches
        ends = [time for stretch in stretches for time in (stretch.start, stretch.end)]
        assert ends == sorted(ends)
        assert ends[0] > 0.0
        assert ends[-1] <= rubbing.time
        assert {stretch.kind for stretch in stretches} <= {"slide", "roll"}
        assert all(stretch.phase is not Phase.FLIGHT for stretch in stretches)

    def test_the_rotor_stays_on_the_wall(self, rubbing):
        longest = max(rubbing.lasting_contacts, key=lambda stretch: stretch.end - stretch.start)
        times = np.linspace(longest.start, longest.end, 500, endpoint=False)
        position, velocity = rubbing.at(times)
        assert np.allclose(np.abs(position), 1.0, rtol=0, atol=1e-13)
        assert np.allclose((position.conj() * velocity).real, 0.0, rtol=0, atol=1e-12)
        normal, friction = rubbing.forces(times)
        assert np.all(normal >= -1e-12)
        assert np.all(np.abs(friction) <= RUBBING.mu * normal + 1e-12)

    def test_there_is_no_force_in_flight(self, rubbing):
        first = rubbing.lasting_contacts[0].start
        normal, friction = rubbing.forces(np.linspace(0.0, first, 50, endpoint=False))
        assert not normal.any()
        assert not friction.any()

    def test_landings_are_no_impacts(self, rubbing):
        assert rubbing.is_landing.any()
        assert not (rubbing.is_landing & rubbing.is_impact).any()
        assert len(rubbing.contacts) + rubbing.is_landing.sum() <= len(rubbing.segment_starts) - 1
        impulses = rubbing.log_of(rubbing.is_landing)
        # What is left to a landing are bounces lower than 1e-13 clearances.
        assert np.all(np.abs(impulses.radial_speed) < 1e-5)

    def test_chatter_ends_the_motion_if_asked(self, rubbing):
        stopped = simulate(Jeffcott(RUBBING), START, 60.0, stop_at_chatter=True)
        assert stopped.outcome is Outcome.CHATTER
        assert stopped.time == rubbing.lasting_contacts[0].start
        assert abs(stopped.final.position) == pytest.approx(1.0, abs=1e-15)
        assert np.array_equal(stopped.contacts.time, rubbing.contacts.time[: len(stopped.contacts)])
