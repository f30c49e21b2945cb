"""All modes decide whether a machine levitates: against a generalized eigenvalue problem written down anew, and never by the reduced rotor."""

import math
import re

import numpy as np
import pytest
import scipy.linalg
import scipy.signal
from compilation import sized

import carom as cm
from carom.base.outcome import InputError
from carom.rotors import campbell, find_whirls, load_machine, sensitivity

UBERLANDIA = "examples/uberlandia-flexible-rotor.toml"
MUNICH = "examples/tum-flexible-rotor.toml"
STABLE = ["damping_of_stiffness=0.3 us", "filter_time=0.02 ms", "delay=0.1 ms"]
"""With these a vector of the reduction grows by 9 1/s, and no mode does."""
UNSTABLE = ["damping_of_stiffness=0.1 us", "filter_time=0.05 ms", "delay=0.3 ms"]
"""With these a bending mode at 3,135 Hz grows by 5 1/s that the usual reduction leaves out."""


def exponents(machine):
    """Exponents of the finite elements with PID, Padé's delay and amplifier as transfer functions of SciPy, 1/s."""
    rotor, speed, scale = machine.rotor, machine.speed, 3e3
    n, loops = len(rotor.matrices.mass), []
    stiffness = rotor.matrices.stiffness.astype(complex)
    for each in machine.bearings:
        at, given = 2 * rotor.place_of(each.node), each.controller
        stiffness[at, at] += each.ks
        above, below = np.array([given.proportional]), np.array([1.0])
        if given.integral:
            above, below = np.polyadd(np.polymul(above, [1, 0]), given.integral * below), np.polymul(below, [1, 0])
        if given.derivative:
            lag = [given.filter_time, 1.0]
            above = np.polyadd(np.polymul(above, lag), np.polymul(below, [given.derivative, 0.0]))
            below = np.polymul(below, lag)
        late = each.delay
        above = np.polymul(above, [-(late**3) / 120, late**2 / 10, -late / 2, 1.0])
        below = np.polymul(below, [late**3 / 120, late**2 / 10, late / 2, 1.0])
        if each.amplifier_bandwidth:
            below = np.polymul(below, [1.0 / each.amplifier_bandwidth, 1.0])
        # In a unit of time in which coefficients are of one size.
        above, below = (each * scale ** np.arange(len(each) - 1, -1, -1) for each in (above, below))
        loops.append(
            (
                at,
                [2 * rotor.place_of(node) for node in each.sensor_nodes],
                each.ki,
                *scipy.signal.tf2ss(above, below),
            )
        )
    size = 2 * n + sum(len(loop[3]) for loop in loops)
    rates, matrix = np.eye(size), np.zeros((size, size), complex)
    rates[n : 2 * n, n : 2 * n] = rotor.matrices.mass
    matrix[:n, n : 2 * n] = np.eye(n)
    matrix[n : 2 * n, :n] = -stiffness
    matrix[n : 2 * n, n : 2 * n] = 1j * speed * rotor.matrices.gyroscopic - rotor.damping_matrix
    first = 2 * n
    for at, seen, ki, A, B, C, D in loops:
        own = slice(first, first + len(A))
        matrix[own, own] = scale * A
        for place in seen:
            matrix[own, place] += scale * B[:, 0] / len(seen)
            matrix[n + at, place] -= ki * D[0, 0] / len(seen)
        matrix[n + at, own] = -ki * C[0]
        first = own.stop
    return scipy.linalg.eigvals(np.linalg.solve(rates, matrix))


@pytest.mark.parametrize("example", [UBERLANDIA, MUNICH])
def test_verdicts_are_those_of_all_exponents(example):
    """Machines on both sides of the boundary: accepted where all exponents lie left, refused by the rightmost where not."""
    random, verdicts = np.random.default_rng(1), set()
    for _ in range(sized(6, 60)):
        damping, lag, late = 10.0 ** random.uniform([-1.3, -2.0, -2.0], [1.0, -1.0, -0.3])
        settings = [f"damping_of_stiffness={damping} us", f"filter_time={lag} ms", f"delay={late} ms"]
        exact = exponents(load_machine(example, settings))
        worst = exact[exact.real.argmax()]
        if abs(worst.real) < 1e-3:  # what SciPy rounds
            continue
        verdicts.add(bool(worst.real > 0.0))
        if worst.real < 0.0:
            assert cm.models.rotor_of(cm.load(example, settings)).system.decay > 0.0
            continue
        with pytest.raises(InputError) as refused:
            cm.load(example, settings)
        shown = re.search(r"whirl of (\S+) Hz grows with (\S+) 1/s", str(refused.value))
        assert float(shown[1]) == pytest.approx(abs(worst.imag) / 2.0 / math.pi, rel=1e-3)  # four digits are stated
        assert float(shown[2]) == pytest.approx(worst.real, rel=1e-3)
    assert verdicts == {True, False}


def test_vectors_that_are_no_modes_do_not_grow():
    reduced = cm.load(UBERLANDIA, STABLE).parameters.finite_elements
    assert np.linalg.eigvals(reduced._equations(reduced.basis).generator(reduced.machine.speed)).real.max() > 5.0
    # The slowest of all modes, an integrator, is the slowest of the vectors too.
    slowest = reduced.machine.slowest.exponents[0].real
    assert -reduced.linear.system.decay * reduced.machine.speed == pytest.approx(slowest, rel=1e-3)


def test_a_gain_with_which_a_mode_grows_does_not_levitate_in_maps():
    model = cm.load(MUNICH, ["damping_of_stiffness=0.15 us", *UNSTABLE[1:]]).parameters
    faster = model.replace(derivative=8.0)
    assert model.system.levitates
    assert faster.system.exponents.real.max() < 0.0  # of its vectors none grows
    assert not faster.system.levitates


def test_what_grows_is_told_beyond_what_is_listed():
    machine = load_machine(MUNICH, UNSTABLE)
    grows = [each for each in find_whirls(machine, count=3) if each.damping_ratio < 0.0]
    assert [round(each.frequency) for each in grows] == [3133, 3135]  # one backward, one forward
    found = campbell(machine, [0.5 * machine.speed, machine.speed], count=3)
    assert not found.levitates.any()
    assert (found.exponents.real > 0.0).any()
    assert sensitivity(machine).zones is None
    assert campbell(load_machine(MUNICH), [100.0]).levitates.all()
