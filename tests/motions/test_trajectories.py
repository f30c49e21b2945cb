"""Motions as results: starts, frames, samples, and that long ones are joined without a seam."""

import numpy as np
import pytest
from machines import PAPER, fly, strike

from carom.base.outcome import InputError, Outcome, Phase
from carom.models import jeffcott
from carom.motions import State, simulate, simulation

START = State(0.3 + 0.1j, 0.9 - 0.4j)
RUBBING = PAPER.replace(gamma=0.2, d=0.5)


@pytest.fixture(scope="module")
def rotor():
    return jeffcott(PAPER)


@pytest.fixture(scope="module")
def motion(rotor):
    return simulate(rotor, START, 30.0)


@pytest.fixture(scope="module")
def rubbing():
    return simulate(jeffcott(RUBBING), START, 60.0)


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


class TestWithoutATime:
    def test_a_motion_is_followed_to_where_it_settles(self, rotor):
        motion = simulate(rotor, START)
        assert motion.outcome is simulate(rotor, START, settle=True).outcome
        assert motion.outcome.settled

    def test_a_motion_that_must_not_settle_needs_a_time(self, rotor):
        with pytest.raises(InputError, match=r"^until = nothing given: "):
            simulate(rotor, START, settle=False)


class TestLongMotions:
    @pytest.mark.parametrize("chunk", [1, 3, 7])
    def test_kernel_calls_leave_no_seam(self, rotor, motion, monkeypatch, chunk):
        monkeypatch.setattr(simulation, "CHUNK", chunk)
        cut = simulate(rotor, START, 30.0)
        assert cut.outcome is motion.outcome
        assert np.array_equal(cut.segment_amplitudes, motion.segment_amplitudes)
        assert np.array_equal(cut.event_amplitudes, motion.event_amplitudes)
        # The times are sums in another order.
        assert np.allclose(cut.segment_starts, motion.segment_starts, rtol=1e-14, atol=0)
        assert cut.final.position == pytest.approx(motion.final.position, abs=1e-12)

    @pytest.mark.parametrize("chunk", [1, 5])
    def test_nor_in_lasting_contact(self, rubbing, monkeypatch, chunk):
        monkeypatch.setattr(simulation, "CHUNK", chunk)
        cut = simulate(jeffcott(RUBBING), START, 60.0)
        assert np.array_equal(cut.segment_phases, rubbing.segment_phases)
        assert np.allclose(cut.segment_amplitudes, rubbing.segment_amplitudes, rtol=0, atol=1e-12)
        assert cut.final.position == pytest.approx(rubbing.final.position, abs=1e-12)

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

    def test_landings_are_no_impacts(self, rubbing):
        assert rubbing.is_landing.any()
        assert not (rubbing.is_landing & rubbing.is_impact).any()
        assert len(rubbing.contacts) + rubbing.is_landing.sum() <= len(rubbing.segment_starts) - 1
        impulses = rubbing.log_of(rubbing.is_landing)
        # What is left to a landing are bounces lower than 1e-13 clearances.
        assert np.all(np.abs(impulses.radial_speed) < 1e-5)

    def test_chatter_ends_the_motion_if_asked(self, rubbing):
        stopped = simulate(jeffcott(RUBBING), START, 60.0, stop_at_chatter=True)
        assert stopped.outcome is Outcome.CHATTER
        assert stopped.time == rubbing.lasting_contacts[0].start
        assert abs(stopped.final.position) == pytest.approx(1.0, abs=1e-15)
        assert np.array_equal(stopped.contacts.time, rubbing.contacts.time[: len(stopped.contacts)])
