"""What is born where levitation meets a wall: against the planar theory, orbits on both sides, simulation, and degenerate limits."""

import numpy as np
import pytest
from boundary_rotors import touching

import carom as cm
from carom.base.outcome import Outcome
from carom.closed_forms import find_equilibria, small_cycles
from carom.models import HuntCrossley, KelvinVoigt, Rigid
from carom.motions.starts import State
from carom.orbits.closing import close
from carom.orbits.happenings import begins_contact

PAPER = cm.load("examples/source-paper.toml").parameters
STAR = float(np.sqrt(PAPER.rho**2 - (1.0 - PAPER.omega**2) ** 2))
RIGID, SPRING, BALLS = Rigid(0.96), KelvinVoigt(3e3, 1.5), HuntCrossley(500.0, 0.3)


def inside(cycle, gap):
    """The gap on the side of a cycle."""
    return -gap if cycle.levitating_side else gap


def same(meeting, cycle):
    return min((each for each in meeting.cycles if each.admissible), key=lambda each: abs(each.period - cycle.period))


def closed(rotor, meeting, cycle):
    """The exact orbit next to a cycle, by Newton's method from its motion."""
    position, velocity = meeting.coordinates(cycle)
    position = position / max(1.0, float(np.abs(rotor.system.planes @ position).max()))  # on the wall to second order
    state = State(position, velocity) if len(position) > 1 else State(position[0], velocity[0])
    motion = cm.simulate(rotor, state, 2.6 * cycle.period)
    begins = motion.segment_starts[1:][begins_contact(motion)]
    return close(motion, float(begins[0]) + 0.5 * cycle.period, cycle.period)


def test_the_planar_rotor_has_the_cycles_of_the_paper():
    found = small_cycles(PAPER.replace(gamma=STAR))
    assert found.complete
    assert abs(found.gap) < 1e-12
    assert {cycle.criticality for cycle in found.cycles} == {"subcritical"}
    (boundary,) = cm.bifurcations.boundary_equilibria(PAPER)
    assert found.kind == boundary.kind
    assert found.force_rate == pytest.approx(-boundary.force_rate, rel=1e-10)
    assert [cycle.admissible for cycle in found.cycles] == [orbit.admissible for orbit in boundary.orbits]


@pytest.mark.parametrize("seed", [1, 2, 3, 4, 5])
def test_orbits_of_two_coordinates_shrink_as_foretold(seed):
    """Size, period and multipliers tend to the local theory in proportion to the gap, at fresh rotors of two touchdown bearings."""
    cycles = [cycle for cycle in small_cycles(touching(RIGID, seed)).cycles if cycle.admissible]
    assert cycles
    for cycle in cycles:
        errors = []
        for gap in (1e-3, 1e-4):
            rotor = touching(RIGID, seed, inside(cycle, gap))
            meeting = small_cycles(rotor)
            local = same(meeting, cycle)
            orbit = closed(rotor, meeting, local)
            assert orbit.admissible
            assert orbit.stable == local.stable
            # The multiplier of the return to the wall, zero, has no place among those of an orbit.
            own = np.sort(np.abs(local.multipliers))[-len(orbit.multipliers.values) :]
            apart = np.abs(np.sort(np.abs(orbit.multipliers.values)) - own).max()
            errors.append(
                (
                    abs(orbit.period / local.period - 1.0),
                    abs(orbit.radial_speed / (local.speed_rate * gap) - 1.0),
                    apart,
                )
            )
        first, second = np.array(errors).T[:, 0], np.array(errors).T[:, 1]
        # Proportional to the gap: ten times closer to it ten times smaller, above what closing leaves of orbits of some 1e-4.
        assert (second <= 0.2 * first + 1e-8).all()
        assert second.max() < 1e-2


@pytest.mark.parametrize("law", [SPRING, BALLS, RIGID])
@pytest.mark.parametrize("seed", [1, 3, 4, 5])
def test_rubs_lie_on_the_side_and_have_the_stability_foretold(law, seed):
    meeting = small_cycles(touching(law, seed))
    for gap in (-1e-4, 1e-4):
        rotor = touching(law, seed, gap)
        rubs = [each for each in find_equilibria(rotor) if each.kind == "rub" and each.planes == (meeting.plane,)]
        near = [each for each in rubs if each.status == "admissible" and each.normal_force < 1e-2]
        assert bool(near) == (meeting.force_rate * gap > 0.0)
        for rub in near:
            assert rub.normal_force == pytest.approx(meeting.force_rate * gap, rel=1e-2)
            if law is not RIGID:
                assert rub.stable == meeting.rub_stable


def test_a_stable_cycle_takes_over_beyond_the_wall_and_nothing_before():
    """Supercritical and stable: simulated beyond the wall a disturbance ends on the bounces, before it on levitation."""

    def rotor(gap):
        return touching(RIGID, 1, gap)

    (cycle,) = (each for each in small_cycles(rotor(0.0)).cycles if each.stable and each.admissible)
    assert cycle.criticality == "supercritical"
    sizes = []
    for gap in (1e-3, 1e-4):
        meeting = small_cycles(rotor(gap))
        position, velocity = meeting.coordinates(same(meeting, cycle))
        rest = rotor(gap).system.rest
        # A fifth larger than the cycle: it is not begun on it.
        beside = rest + 1.2 * (position - rest), 1.2 * velocity
        beside = beside if len(rest) > 1 else (beside[0][0], beside[1][0])
        there = cm.simulate(rotor(gap), State(*beside), settle=True)
        assert there.outcome is Outcome.BOUNCING
        assert there.multiplicity == 1
        orbit = cm.orbits.orbit_of_motion(there)
        sizes.append(orbit.radial_speed)
        assert orbit.period == pytest.approx(cycle.period, rel=1e-2)
        before = cm.simulate(rotor(-gap), State(*beside), settle=True)
        assert before.outcome is Outcome.LEVITATED
    assert sizes[0] / sizes[1] == pytest.approx(10.0, rel=1e-2)
