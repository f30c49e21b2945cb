"""The onset of lasting contact in a periodic motion, from flights and impacts alone in 70 digits.

There the motion lifts off, bounces infinitely often, and the bounces end exactly where it lifts off again: with no contact
in between.  In front of that end a bounce takes the share ``τ`` of the time that is left, and leaves ``1 − τ`` for the next
(:mod:`carom.orbits.landings`), so the times of bounces have this ratio, and the place of the end follows from the last.
Both conditions fix the angle of the lift-off and the damping.  What is left out at a bounce falls by ``1 − τ`` with each further
one, and what it changes by ``(1 − τ)/λ``: with 80 bounces both are known to 25 digits.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest

from carom.bifurcations import continue_orbit
from carom.orbits import lift_off_of, rubbing_orbits
from tests.against_peers.exact_chatter import DIGITS, ExactRotor
from tests.machines import PAPER

MACHINE = PAPER.replace(omega=0.334, rho=0.416, d=0.49, gamma=0.18, mu=0.287)
DAMPING, ANGLE = "0.1458918315241016219620344", "-2.0259930402505372304761877"
PERIOD = "3.5909977860421371119750176"
FIRST = (2.3349, 0.4783, 0.2742, 0.1738, 0.1134)
"""Durations of the first flights, to begin Newton's method with."""
BOUNCES = 45


def chain(damping: mp.mpf, angle: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """Ratio of the last two bounces relative to ``1 − τ``, less one; angle of the end less that of the lift-off; time."""
    rotor = ExactRotor(MACHINE, gamma=damping)
    share = mp.findroot(lambda part: (3 - part) * (1 - part) ** 2 - rotor.d * (3 - 2 * part), 0.3)
    # No normal force: ρ cos(θ − φ) + (1 + θ̇)² = ω²; the rotor whirls backward in the fixed frame.
    rate = -mp.sqrt(rotor.omega**2 - rotor.rho * mp.cos(angle - rotor.phi)) - 1
    position = mp.expj(angle)
    velocity = 1j * rate * position
    times = []
    for number in range(BOUNCES):
        duration, position, velocity = rotor.bounce(position, velocity, (*FIRST, *(None,) * BOUNCES)[number])
        times.append(duration)
    left = times[-1] * (1 - share) / share
    end = position * mp.expj((mp.conj(position) * velocity).imag * left)
    return times[-1] / times[-2] / (1 - share) - 1, mp.arg(end * mp.expj(-angle)), mp.fsum(times) + left


def test_the_damping_and_the_angle_are_those_of_the_onset():
    with mp.workdps(DIGITS):
        damping, angle = mp.mpf(DAMPING), mp.mpf(ANGLE)
        ratio, apart, time = chain(damping, angle)
        # The last bounce but one begins 1e-8 before the end; the angle is right to the square of this.
        assert abs(ratio) < 1e-8
        assert max(abs(apart), abs(time - mp.mpf(PERIOD))) < 1e-15
        # A change of the last digit of a double is seen.
        below, above = (chain(damping + shift, angle)[0] for shift in (mp.mpf("-2e-17"), mp.mpf("2e-17")))
        assert below * above < 0
        assert min(abs(below), abs(above)) > 1e3 * abs(ratio)


@pytest.mark.jit_only
def test_words_have_fourteen_digits_of_it():
    (known,) = rubbing_orbits(MACHINE)
    (point,) = [each for each in continue_orbit(known, "gamma", (0.14, 0.25)).special if each.kind == "contact-onset"]
    assert point.value == pytest.approx(float(DAMPING), abs=3e-14)
    assert point.period == pytest.approx(float(PERIOD), abs=1e-13)
    # The lift-off is told by its angle from the unbalance.
    turn = lift_off_of(point.orbit).angle + MACHINE.phi - float(ANGLE)
    assert abs(np.exp(1j * turn) - 1.0) < 1e-12
