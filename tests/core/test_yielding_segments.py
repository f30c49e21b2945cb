"""Segment maps in walls that give way: their ends against a general integrator, their derivatives against differences."""

from __future__ import annotations

import numpy as np
import pytest
from yielding_rotors import Yielding, packed, two_planes

from carom.models import HuntCrossley, KelvinVoigt, Rigid
from carom.orbits.shooting import Start, links_of
from carom.orbits.word import Kind, Segment, Word
from tests.core.test_segments import differences

pytestmark = pytest.mark.jit_only
LAWS = [KelvinVoigt(40.0, 3.0), HuntCrossley(30.0, 0.4, 1.0), HuntCrossley(30.0, 0.4, 1.5)]
KINDS = {Kind.SLIDE_FORWARD: "+", Kind.SLIDE_BACKWARD: "-", Kind.ROLL: "0", Kind.FREE: ""}
WORDS = [
    (Kind.SLIDE_FORWARD, Kind.ROLL, Kind.SLIDE_BACKWARD, Kind.LIFT),
    (Kind.SLIDE_BACKWARD, Kind.ROLL, Kind.SLIDE_FORWARD, Kind.FREE, Kind.LIFT),
    (Kind.SLIDE_FORWARD, Kind.FREE),
    (Kind.SLIDE_BACKWARD,),
    (Kind.ROLL, Kind.FREE, Kind.SLIDE_BACKWARD),
]


def inside(rotor, word, rng):
    """Nodes that are some way in the wall, and durations of a part of a bounce."""
    angles, sizes = np.exp(2j * np.pi * rng.uniform(size=len(word))), 1.0 + rng.uniform(0.05, 0.2, len(word))
    speeds = angles * (rng.uniform(-0.3, 0.3, len(word)) + 1j * rng.uniform(-1.0, 1.0, len(word)))
    return Start(np.stack([angles * sizes, speeds], axis=1), rng.uniform(0.05, 0.3, len(word)))


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_each_segment_ends_where_a_general_integrator_says(law):
    rotor, rng = Yielding(law, mu=0.3, surface_speed=1.4), np.random.default_rng(7)
    word = Word.of(*WORDS[1])
    start = inside(rotor.model, word, rng)
    links = links_of(rotor.model, word, start)
    for segment, node, arrival, time in zip(word, start.nodes, links.arrivals, start.durations, strict=True):
        if segment.kind is Kind.LIFT:
            continue
        end = rotor.follow(packed(*node), time, KINDS[segment.kind])
        assert packed(*arrival) == pytest.approx(end, abs=1e-11)


@pytest.mark.parametrize("law", LAWS, ids=str)
@pytest.mark.parametrize("kinds", WORDS, ids=lambda kinds: "-".join(kind.label for kind in kinds))
def test_derivatives_agree_with_differences(law, kinds):
    rotor, word = Yielding(law, mu=0.3, surface_speed=1.4).model, Word.of(*kinds)
    start = inside(rotor, word, np.random.default_rng(len(kinds)))
    links = links_of(rotor, word, start)
    assert np.isfinite(links.jacobian).all()
    scale = max(1.0, np.abs(links.jacobian).max())
    assert np.abs(differences(rotor, word, start) - links.jacobian).max() < 1e-8 * scale


def test_derivatives_of_a_rotor_with_a_rigid_plane_too():
    model = two_planes(KelvinVoigt(60.0, 5.0), Rigid(0.8), speeds=(1.4, 3.0))
    word = Word(
        (
            Segment(Kind.SLIDE_FORWARD, 0),
            Segment(Kind.ROLL, 0),
            Segment(Kind.SLIDE_BACKWARD, 0),
            Segment(Kind.FREE, 0),
            Segment(Kind.LIFT, 0),
            Segment(Kind.IMPACT_FORWARD, 1),
        )
    )
    rng = np.random.default_rng(3)
    nodes = rng.normal(size=(len(word), 4, 2)) @ [1.0, 1j]
    nodes[:, :2] *= 1.2 / np.abs(nodes[:, :2] @ [1.0, 0.3])[:, None]
    start = Start(nodes, rng.uniform(0.05, 0.3, len(word)))
    links = links_of(model, word, start)
    scale = max(1.0, np.abs(links.jacobian).max())
    assert np.abs(differences(model, word, start) - links.jacobian).max() < 1e-8 * scale


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_conditions_are_the_depth_the_force_the_slip_and_the_limits_of_friction(law):
    rotor, word = Yielding(law, mu=0.3, surface_speed=1.4), Word.of(*WORDS[1])
    start = inside(rotor.model, word, np.random.default_rng(5))
    links = links_of(rotor.model, word, start)
    ends = []
    for position, velocity in links.arrivals:
        depth, local = abs(position) - 1.0, np.conj(position / abs(position)) * velocity
        force, slip = rotor.force(depth, local.real), rotor.surface_speed + depth + local.imag
        free = rotor.rates(packed(position, velocity))
        rolls = rotor.rates(packed(position, velocity), "0")
        along = (np.conj(position / abs(position)) * complex(rolls[2] - free[2], rolls[3] - free[3])).imag
        ends.append((depth, rotor.parts(depth, local.real), slip, rotor.mu * force + along))
    slide, roll, free = links.values[0], links.values[1], links.values[3]
    assert slide == pytest.approx(ends[0][2], abs=1e-12)
    # Forces are divided by their size per unit of depth and rate.
    assert np.sign(roll) == np.sign(ends[1][3])
    assert free == pytest.approx(ends[3][0], abs=1e-12)
    size = law.dissipation if isinstance(law, HuntCrossley) else law.stiffness + law.damping
    assert links.values[2] * size == pytest.approx(ends[2][1], abs=1e-10)


def test_contact_longer_than_can_be_followed_is_no_segment():
    rotor, word = Yielding(LAWS[0]).model, Word.of(Kind.SLIDE_FORWARD)
    links = links_of(rotor, word, Start(np.array([[1.1 + 0j, 0.1j]]), np.array([1e6])))
    assert not np.isfinite(links.residual).all()


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_a_guess_at_the_centre_has_no_residual(law):
    rotor, word = Yielding(law, mu=0.3, surface_speed=1.4).model, Word.of(Kind.SLIDE_FORWARD)
    links = links_of(rotor, word, Start(np.array([[0.0, 0.3 + 0.1j]]), np.array([0.2])))
    assert not np.isfinite(links.size)
