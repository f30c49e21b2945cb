"""Shock response spectra: closed forms of a half-sine, and DOP853 for damped oscillators on records, bases and rotors."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom as cm
from carom.disturbances.response_spectra import BaseCourse, maximax, shock_response

LASTS = 1.3
TURN = np.pi / LASTS
HALF_SINE = BaseCourse(*np.array([[LASTS], [0.0], [TURN], [TURN]]))


def undamped(ratio):
    """Maximax of an undamped oscillator on a half-sine of size one: the largest stationary value during it, and the amplitude after it."""
    frequency, b = ratio * TURN, 1.0 / ratio
    if ratio == 1.0:
        return 0.5 * np.pi
    turns = 2.0 * np.pi * np.arange(1, 200)
    times = np.concatenate([turns / (frequency - TURN), turns / (frequency + TURN)])
    times = times[(times > 0.0) & (times <= LASTS)]
    during = np.abs(np.sin(TURN * times) - b * np.sin(frequency * times)) / abs(1.0 - b * b)
    return max(during.max(initial=0.0), abs(2.0 * b * np.cos(0.5 * np.pi / b) / (1.0 - b * b)))


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.7, 0.95, 1.0, 1.5, 2.0, 3.3, 10.0, 57.0])
def test_half_sine_has_its_closed_form(ratio):
    assert maximax(HALF_SINE, ratio * TURN, 0.0)[0] == pytest.approx(undamped(ratio), rel=1e-12)


def largest(base, frequency, quality, ends, time):
    """Largest absolute acceleration on a base with place and velocity ``base(t)``, by DOP853 in the fixed frame between times at which it may jump."""

    def rates(now, state, until):
        place, speed = base(min(now, until - 1e-12))
        return [state[1], -frequency / quality * (state[1] - speed) - frequency**2 * (state[0] - place)]

    state, found = np.array(base(0.0), complex), np.zeros(2)
    for begins, until in zip([0.0, *ends], [*ends, time], strict=True):
        times = np.linspace(begins, until, 1500)
        moved = solve_ivp(rates, (begins, until), state, "DOP853", times, rtol=1e-11, atol=1e-12, args=(until,))
        pulls = [rates(now, each, until)[1] for now, each in zip(times, moved.y.T, strict=True)]
        found = np.maximum(found, [np.abs(np.real(pulls)).max(), np.abs(np.imag(pulls)).max()])
        state = moved.y[:, -1]
    return found


@pytest.mark.parametrize(("frequency", "quality"), [(0.5, 10.0), (3.0, 5.0), (12.0, 0.5)])
def test_a_record_with_unequal_steps_has_that_of_dop853(frequency, quality):
    draw = np.random.default_rng(0)
    durations, values = draw.uniform(0.1, 0.5, 20), draw.normal(size=21) + 1j * draw.normal(size=21)
    times, slopes = np.append(0.0, np.cumsum(durations)), np.diff(values) / durations
    speeds = np.append(0.0, np.cumsum(durations * (values[:-1] + 0.5 * durations * slopes)))
    steps = durations**2 * (values[:-1] / 2.0 + durations * slopes / 6.0) + durations * speeds[:-1]
    places = np.append(0.0, np.cumsum(steps))

    def base(now):
        k = min(np.searchsorted(times, now, side="right") - 1, 20)
        t = now - times[k]
        a, b = (values[k], slopes[k]) if k < 20 else (0.0, 0.0)
        return places[k] + t * speeds[k] + a * t**2 / 2.0 + b * t**3 / 6.0, speeds[k] + a * t + b * t**2 / 2.0

    course = BaseCourse(durations, values[:-1], slopes, np.zeros(20))
    found = maximax(course, frequency, 0.5 / quality)
    expected = largest(base, frequency, quality, times[1:], times[-1] + 2.0 * np.pi / frequency)
    # The reference is sampled: its largest value may be missed by so much.
    assert found == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("peak", [0.05, 1.5])
def test_the_rotor_shakes_oscillators_as_it_moves(peak):
    """Without contact, and with impacts that change its velocity at once."""
    machine, shock = cm.load("examples/keogh-cole.toml"), cm.BaseShock(peak, 0.9)
    motion = cm.simulate(*shock.apply(machine), 12.0)
    assert (sum(len(part.contacts) for part in motion.parts) > 3) == (peak > 1.0)
    found = shock_response(motion, shock.course(peak), 10.0)
    nu, (first, last) = np.pi / 0.9, motion.parts

    def base(now):
        part, elapsed = (first, now) if now < 0.9 else (last, min(now - 0.9, last.time))
        place, rate = part.at(np.array(elapsed))
        turn, shaken = np.exp(1j * now), min(now, 0.9)
        speed = peak / nu * (1.0 - np.cos(nu * shaken))
        moved = peak / nu * (shaken - np.sin(nu * shaken) / nu) + speed * (now - shaken)
        return moved + place * turn, speed + (rate + 1j * place) * turn

    ends = [*first.segment_starts[1:], 0.9, *(0.9 + last.segment_starts[1:])]
    for number in (20, 40):
        frequency = float(found.frequencies[number])
        expected = largest(base, frequency, 10.0, ends, 12.0)
        # Between samples, 32 in the period of the highest frequency, the acceleration is its mean.
        assert found.bearings[0][:, number] == pytest.approx(expected, rel=2e-3)
