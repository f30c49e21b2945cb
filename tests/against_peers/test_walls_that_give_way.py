"""Motions on compliant walls against an integrator that shares nothing with the package."""

import dataclasses

import compliant_reference as reference
import numpy as np
import pytest
from compilation import sized
from linear_rotors import single, tilting

import carom as cm
from carom.base.outcome import Phase
from carom.models import HuntCrossley, KelvinVoigt

NAMES = {
    Phase.FLIGHT: reference.AWAY,
    Phase.FORWARD_SLIP: reference.FORWARD,
    Phase.BACKWARD_SLIP: reference.BACKWARD,
    Phase.ROLLING: reference.ROLLING,
    Phase.SEPARATED: reference.SEPARATED,
}
PROMISED = 1e-9
"""Error of a contact, in clearances."""


def drawn_law(random):
    """A law per mass felt at the plane: all kinds, from soft to hard, from elastic to overdamped."""
    stiffness = 10.0 ** random.uniform(2.0, 5.0)
    if random.random() < 0.5:
        return KelvinVoigt(stiffness, 2.0 * random.choice([0.0, 0.02, 0.4, 1.5]) * np.sqrt(stiffness))
    return HuntCrossley(stiffness, random.choice([0.0, 0.1, 0.5, 2.0]), random.choice([1.0, 10 / 9, 1.5]))


def machine(random, base):
    """A rotor with drawn walls, friction and surface speeds, and the same for the reference."""
    model, planes = base.model, []
    for number, (touchdown, felt) in enumerate(zip(model.equations.touchdowns, base.felt, strict=True)):
        law, friction = drawn_law(random), random.choice([0.0, 0.1, 0.5, 2.0])
        surface = 1.0 + random.choice([10.0 ** random.uniform(-3.0, -0.3), 10.0 ** random.uniform(0.0, 1.5)])
        if isinstance(law, KelvinVoigt):
            own = KelvinVoigt(law.stiffness * felt, law.damping * felt)
            other = reference.KelvinVoigt(law.stiffness, law.damping)
        else:
            own = HuntCrossley(law.stiffness * felt, law.dissipation, law.exponent)
            other = reference.HuntCrossley(law.stiffness, law.dissipation, law.exponent)
        changed = dataclasses.replace(touchdown, law=own, friction=friction, surface_speed=surface)
        touchdowns = [*model.equations.touchdowns[:number], changed, *model.equations.touchdowns[number + 1 :]]
        model = model.replace(touchdowns=touchdowns)
        planes.append(reference.Plane(touchdown.plane, other, friction, surface))
    return model, reference.Rotor(
        model.equations.mass, model.equations.damping, model.equations.stiffness, model.equations.forcing, planes
    )


def events_of(motion):
    """Time, plane and phase of each change."""
    changed = np.argwhere(np.diff(motion.segment_phases, axis=0) != 0)
    phases = motion.segment_phases[1:]
    return [(motion.segment_starts[k + 1], plane, NAMES[Phase(int(phases[k, plane]))]) for k, plane in changed]


def one_sense(events, model):
    """The same without changes of the sense of slip where there is no friction, which are none in the package."""
    kept, last = [], {}
    for time, plane, phase in events:
        if phase == reference.BACKWARD and model.equations.touchdowns[plane].friction == 0.0:
            phase = reference.FORWARD
        if last.get(plane) != phase:
            kept.append((time, int(plane), phase))
        last[plane] = phase
    return kept


@pytest.mark.parametrize(
    "base",
    [single(planes=1), tilting(planes=1), tilting(planes=2)],
    ids=["one", "tilts", "tilts on two"],
)
def test_motions_are_those_of_the_reference(base):
    seen, n = set(), len(base.mass)
    for seed in range(sized(6, 1, deep=60)):
        random = np.random.default_rng([seed, n, len(base.planes)])
        model, other = machine(random, base)
        place, speed = random.normal(size=(2, n, 2)) @ [1.0, 1.0j]
        place *= 0.7 / np.abs(model.equations.planes @ place).max()
        speed *= random.uniform(1.0, 6.0) / np.abs(model.equations.planes @ speed).max()
        start = cm.State(place, speed) if n > 1 else cm.State(complex(place[0]), complex(speed[0]))
        motion = cm.simulate(model, start, 1.2)
        expected = reference.follow(other, place, speed, 1.2)
        events = events_of(motion)
        others = one_sense([(each.time, each.plane, each.phase) for each in expected.events], model)
        assert [each[1:] for each in events] == [each[1:] for each in others]
        np.testing.assert_allclose([each[0] for each in events], [each[0] for each in others], rtol=0.0, atol=PROMISED)
        np.testing.assert_allclose(
            motion.final.position, expected.position if n > 1 else expected.position[0], rtol=0.0, atol=PROMISED
        )
        seen |= {phase for _, _, phase in events}
    assert seen >= {reference.FORWARD, reference.AWAY}
