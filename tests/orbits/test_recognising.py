"""Orbits on which simulated motions with lasting contact settle."""

import numpy as np
import pytest
from linear_rotors import touchdowns

from carom.models import from_matrices
from carom.motions import State, simulate
from carom.orbits.simulated_search import orbit_of_motion
from carom.parameters import Parameters

pytestmark = pytest.mark.jit_only


def test_impacts_without_rebound_that_do_not_stay():
    """After the first of two impacts nothing presses the rotor outward: it leaves the wall, although it does not rebound."""
    machine = Parameters(gamma=0.0182, omega=0.102, rho=0.101, phi=0.0, mu=0.194, d=0.0, radius_ratio=3.18)
    orbit = orbit_of_motion(simulate(machine, State(-0.9 + 0.36j, 0.37 + 0.92j), settle=True))
    assert orbit.segments == "land slide+ lift"

    def struck(factor):
        start = State(orbit.departure.position, factor * orbit.departure.velocity)
        motion = simulate(machine, start, 5.0 * orbit.period)
        return motion.rotor.system.states_of(motion.event_amplitudes[motion.is_impact])

    # Of a disturbed motion, the states at the impacts, two a period, come closer by the multiplier in each period.
    apart = np.abs(struck(1.0 + 1e-7) - struck(1.0)).max(axis=1)
    assert len(apart) == 10
    assert apart[8] / apart[6] == pytest.approx(orbit.multipliers.spectral_radius, rel=2e-4)


@pytest.mark.parametrize(
    ("machine", "impacts"),
    [
        (Parameters(gamma=0.0701, omega=0.101, rho=0.381, phi=0.0, mu=0.0, d=0.106, radius_ratio=0.218), 13),
        (Parameters(gamma=0.0386, omega=0.201, rho=0.682, phi=0.0, mu=0.474, d=0.17, radius_ratio=1.07), 7),
    ],
)
@pytest.mark.parametrize("touched", [0, 1])
def test_a_plane_that_is_never_touched_changes_no_orbit(machine, impacts, touched):
    """The planar rotor beside a coordinate that it does not feel, with a contact plane far from that coordinate's motion."""
    alone = orbit_of_motion(simulate(machine, State(0.1, -1.0 - 1.0j), settle=True))
    rotor = from_matrices(
        mass=np.eye(2),
        damping=np.diag([machine.gamma, 0.3]),
        stiffness=np.diag([machine.omega**2, 0.7]),
        forcing=[machine.rho, 0.3],
        touchdowns=touchdowns(
            [[1.0, 0.0], [0.0, 0.1]][:: 1 - 2 * touched],
            [machine.mu] * 2,
            [machine.d] * 2,
            [machine.radius_ratio + 1.0] * 2,
        ),
    )
    motion = simulate(rotor, State.of([0.1, 0.0], [-1.0 - 1.0j, 0.1]), settle=True)
    assert motion.multiplicity == impacts
    orbit = orbit_of_motion(motion)
    assert {each.place for each in orbit.happenings} == {touched}
    assert orbit.impacts == alone.impacts
    assert orbit.period == pytest.approx(alone.period, rel=1e-10)
    moduli, others = np.abs(orbit.multipliers.values), np.abs(alone.multipliers.values)
    # Those of the other coordinate, in pairs of one modulus, besides.
    assert all(np.abs(moduli - other).min() < 1e-6 for other in others)
