"""Compliant walls: restitution that formulas in use promise, and an overhung rotor in a ring."""

import math

import numpy as np
import pytest
from linear_rotors import planar_rotor
from scipy.integrate import solve_ivp
from scipy.special import lambertw

import carom as cm
from carom.models import KelvinVoigt, Touchdown, rotor_of
from carom.orbits.closing import close
from carom.parameters.restitution import damping_ratio_of, dissipation_of

SPEED = 0.3
"""No matter which."""


@pytest.mark.parametrize(
    ("promised", "dissipation", "given_back"),
    [
        # Hunt and Crossley 1975: χv = 3(1 − e)/2.
        (0.76, lambda e: 1.5 * (1.0 - e), 0.80573),
        # Lankarani and Nikravesh 1990: χv = 3(1 − e²)/4.
        (0.5, lambda e: 0.75 * (1.0 - e * e), 0.7252),
    ],
)
def test_walls_made_by_approximations_give_back_more_than_promised(promised, dissipation, given_back):
    digits = len(str(given_back)) - 2

    def restitution(product):
        above = 1.0 + product  # w e^(-w) has the same value at 1 - (restitution)(product)
        return (1.0 + lambertw(-above * math.exp(-above)).real) / product

    assert round(restitution(dissipation(promised)), digits) == given_back
    assert restitution(dissipation_of(promised, SPEED) * SPEED) == pytest.approx(promised, rel=1e-14)


def test_damping_of_the_source_paper_s_restitution():
    assert round(damping_ratio_of(0.95), 7) == 0.0164982


# Zilli, Williams and Ewins 2015; Shaw et al. 2016: an overhung rotor in a frictionless ring; times in 1/ω₀, lengths in clearances.
POLAR_INERTIA, DAMPING_RATIO, RING, UNBALANCE = 0.143, 0.01, 10.0, 0.9 * 0.353


def test_synchronous_rubs_of_the_overhung_rotor():
    """``|1 − (1 − Jp)Ω² + β(1 − 1/r) + 2iζΩ| r = mεΩ²``."""
    numbers = []
    for speed in (0.9, 1.08, 1.5, 2.5, 5.0):
        rotor = planar_rotor(
            2.0 * DAMPING_RATIO / speed,
            1.0 / speed**2,
            UNBALANCE,
            [Touchdown((1.0,), KelvinVoigt(RING / speed**2, 1.0), 0.0, 20.0)],
            gyroscopic=[[POLAR_INERTIA]],
        )
        rubs = [rub for rub in cm.find_equilibria(rotor)[1:] if rub.normal_force > 0.0]
        numbers.append(len(rubs))
        for rub in rubs:
            radius = rub.radius
            spring = 1.0 - (1.0 - POLAR_INERTIA) * speed**2 + RING * (1.0 - 1.0 / radius)
            left = abs(spring + 2j * DAMPING_RATIO * speed) * radius
            assert left == pytest.approx(UNBALANCE * speed**2, rel=1e-12)
    # Levitation alone; past its resonance; beside levitation, up to the resonance with the ring.
    assert numbers == [0, 1, 2, 2, 0]


@pytest.mark.jit_only
def test_the_overhung_rotor_bounces_beside_levitation_near_its_internal_resonance():
    """Shaw et al. 2016: asynchronous partial contact appears near the 2:1 resonance and coexists with levitation above it.

    Past the resonance the family goes on, with a third contact from a grazing at 3.539 on, unstable, down to a fold at 2.7454.
    """
    speed = 5.0
    rotor = planar_rotor(
        2.0 * DAMPING_RATIO / speed,
        1.0 / speed**2,
        UNBALANCE,
        [Touchdown([1.0], KelvinVoigt(RING / speed**2, 0.0), 0.0, 1.0, farthest=4.0)],
        gyroscopic=[[POLAR_INERTIA]],
        scales=cm.parameters.Scales(1.0, 1.0, speed),
    )
    (levitation,) = cm.find_equilibria(rotor)
    assert levitation.kind == "contact-free"
    assert levitation.stable
    motion = cm.simulate(rotor, cm.State(0.2, 1.0))
    orbit = cm.orbits.orbit_of_motion(motion)
    assert orbit.segments == "slide+ lift slide+ lift"
    assert orbit.stable
    assert orbit.admissible
    again = cm.simulate(rotor, motion.final, 10.0 * orbit.period).final
    assert abs(again.position - motion.final.position) < 1e-8
    branch = cm.continue_orbit(orbit, "speed", (2.5, 9.0))
    kinds = [point.kind for point in branch.special]
    assert {"fold", "period-doubling"} <= set(kinds)
    assert branch.special[kinds.index("fold")].value == pytest.approx(2.745399, abs=1e-6)
    past = int(np.argmin(np.abs(branch.values - 3.1)))
    speed, orbit = branch.values[past], branch.orbits[past]
    assert (orbit.impacts, orbit.stable) == (3, False)

    def rates(time, y):
        pull = RING * max(0.0, 1.0 - 1.0 / abs(y[0])) + 1.0 + 2j * DAMPING_RATIO * speed
        spring = pull / speed**2 - (1.0 - POLAR_INERTIA)
        return [y[1], UNBALANCE - spring * y[0] - (2.0 * DAMPING_RATIO / speed - 1j * (POLAR_INERTIA - 2.0)) * y[1]]

    start = np.array([complex(np.squeeze(orbit.start.position)), complex(np.squeeze(orbit.start.velocity))])
    end = solve_ivp(rates, (0.0, orbit.period), start, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    assert np.abs(end - start).max() < 1e-6


@pytest.mark.jit_only
def test_the_second_family_of_the_overhung_rotor_doubles_where_published():
    """From the machine file, Ω = 5 … 4.2; published with a smoothed ring: 4.2691."""
    rotor = rotor_of(cm.load("examples/overhung-rotor.toml"))
    moved = complex(rotor.system.translated[0])
    start = cm.State((-0.39738 + 0.48784j) * moved, (-0.38677 - 0.31505j) * moved)
    orbit = close(cm.simulate(rotor, start, 6.0 * 2.6173523), 0.0, 5.0 * 2.6173523)
    assert orbit.period / 5.0 == pytest.approx(2.6173523, abs=1e-7)
    branch = cm.continue_orbit(orbit, "speed", ("420 rad/s", "505 rad/s"))
    doubled = [point.value / 100.0 for point in branch.special if point.kind == "period-doubling"]
    assert any(value == pytest.approx(4.269006, abs=1e-4) for value in doubled)
