"""The high-precision reference itself: values against mpmath, crossings against dense sampling."""

import mpmath
import numpy as np
import pytest
from flights import inside_task, near_grazing_task, parameters, random_wall_task, rotors
from flint import acb, arb
from reference import Flight, first_crossing, jeffcott_flight, unit


@pytest.mark.parametrize(("gamma", "omega"), [(0.1, 0.76), (4.0, 0.7), (1.4, 0.7), (1.4 + 1e-15, 0.7), (0.0, 2.0)])
def test_values_against_the_matrix_exponential(gamma, omega):
    position, velocity, time = 0.3 - 0.4j, 0.7 + 0.2j, 2.7
    flight = jeffcott_flight(gamma, omega, 0.43, 0.21, acb(position), acb(velocity))
    with mpmath.workdps(40):
        g, w = mpmath.mpf(gamma), mpmath.mpf(omega)
        stiffness = w * w - 1 + 1j * g
        equilibrium = mpmath.mpf(0.43) * mpmath.expj(0.21) / stiffness
        flow = mpmath.expm(mpmath.matrix([[0, 1], [-stiffness, -(g + 2j)]]) * time)
        state = flow * mpmath.matrix([mpmath.mpc(position) - equilibrium, velocity])
        expected = [state[0] + equilibrium, state[1], -(g + 2j) * state[1] - stiffness * state[0]]
        for value, wanted in zip(flight.state(time), expected, strict=True):
            found = mpmath.mpc(value.real.mid().str(45, radius=False), value.imag.mid().str(45, radius=False))
            assert abs(found - wanted) < mpmath.mpf(10) ** -30


def test_bounds_hold():
    for rotor, rng in rotors(10, 30):
        flight = inside_task(rotor, rng).flight
        for start, span in ((0.0, 1.0), (0.7, 0.2), (3.0, 1.0)):
            first, second, third = flight.derivative_bounds(start, span)
            spread = flight.spread(start + span)
            for share in np.linspace(0.0, 1.0, 7):
                time = start + span * share
                position, velocity, acceleration = flight.state(time)
                jerk = (flight.state(time + 1e-12)[2] - acceleration) / 1e-12
                assert abs(position) <= spread
                assert abs(velocity) <= first
                assert abs(acceleration) <= second
                assert abs(jerk) <= third * (1 + 1e-9) + 1e-9


def sampled_crossing(flight: Flight, horizon: float) -> float | None:
    """First sign change of ``f`` on a fine grid, in doubles."""
    times = np.linspace(0.0, horizon, 100_001)[1:]
    position = np.full(len(times), complex(flight.offset))
    for fixed, growing, rate in flight._terms:
        position += (complex(fixed) + complex(growing) * times) * np.exp(complex(rate) * times)
    outside = np.flatnonzero(np.abs(position) > 1.0 + 1e-12)
    return float(times[outside[0]]) if len(outside) else None


def test_first_crossings_against_dense_sampling():
    found = 0
    for rotor, rng in rotors(20, 40):
        # All but critical damping divides by the split of the exponents: no task for this sampling in doubles.
        if 0.0 < abs(rotor.system.arrays.gaps[1]) < 1e-2:
            continue
        drawn = near_grazing_task(rotor, rng)
        tasks = [inside_task(rotor, rng), random_wall_task(rotor, rng, 0), drawn[0] if drawn else None]
        for task in filter(None, tasks):
            crossing = first_crossing(task.flight, 8.0, task.radial_speed)
            sampled = sampled_crossing(task.flight, 8.0)
            if crossing is None:
                assert sampled is None
                continue
            found += 1
            # The grid may step over a brief excursion, but it cannot cross before the first crossing.
            assert sampled is None or sampled > crossing.time
            assert abs(task.flight.level(crossing.exact_time)[0]) < 1e-17
            assert task.flight.level(crossing.exact_time * (1 - arb(1e-15)))[0] < 0
            assert crossing.slope > 0
    assert found > 20


def test_undecidable_passes_are_refused():
    """A circle that touches the wall from inside, tangential to all digits."""
    start = Flight(acb(0.5), [(unit(3.0) / 2, acb(0, 1))], [])
    with pytest.raises(ArithmeticError):
        first_crossing(start, 10.0)


def test_a_start_that_is_pressed_on_is_refused():
    machine = parameters(0.1, 0.7)
    flight = jeffcott_flight(0.1, 0.7, 0.4, 0.2, unit(machine.phi), acb(0))
    with pytest.raises(ArithmeticError, match="leave"):
        first_crossing(flight, 10.0, radial_speed=0.0)
