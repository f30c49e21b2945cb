"""The planar rotor in a compliant touchdown bearing: units, restitution, mount, names."""

import dataclasses

import numpy as np
import pytest
from machines import PAPER, SCALES

import carom as cm
from carom.base.outcome import InputError
from carom.models import jeffcott, rotor_from
from carom.parameters import TouchdownBearing

ROTOR = jeffcott(dataclasses.replace(PAPER, scales=SCALES))
STIFFNESS = 1e4 * SCALES.stiffness


def of(**entries):
    return jeffcott(ROTOR.parameters, TouchdownBearing(**entries))


def restituted(model, speed):
    """Speed after an impact along the normal of a rotor that floats without any other force, over that before it."""
    alone = jeffcott(model.parameters.replace(rho=0.0, mu=0.0), model.definition.bearing_at(0), levitates=False)
    # In the turning frame a free rotor has the speed of a straight path in the fixed one.
    motion = cm.simulate(alone, cm.State(0.5, speed - 0.5j), 2.0 / speed)
    hits = motion.segment_starts[1:][(motion.segment_phases[1:, 0] != 0) & (motion.segment_phases[:-1, 0] == 0)]
    left = motion.segment_starts[1:][(motion.segment_phases[1:, 0] == 0) & (motion.segment_phases[:-1, 0] != 0)]
    speeds = []
    for time, shift in ((hits[0], -1e-9), (left[0], 1e-9)):
        place, rate = motion.at_plane(np.array([time + shift]))
        speeds.append(float((place.conj() * rate / np.abs(place)).real[0]))
    return -speeds[1] / speeds[0]


@pytest.mark.parametrize("restitution", [0.95, 0.5, 0.1])
def test_restitution_is_that_of_the_file_to_nine_digits(restitution):
    soft = of(law="kelvin-voigt", stiffness=STIFFNESS, restitution=restitution)
    assert restituted(soft, 0.8) == pytest.approx(restitution, abs=1e-9)
    speed = 0.8 * SCALES.velocity
    for exponent in (1.0, 10 / 9, 1.5):
        ball = of(
            law="hunt-crossley",
            stiffness=STIFFNESS,
            restitution=restitution,
            restitution_speed=speed,
            exponent=exponent,
        )
        assert restituted(ball, 0.8) == pytest.approx(restitution, abs=1e-9)


def test_the_law_stays_what_it_is_in_si_units():
    model = of(law="hunt-crossley", stiffness=1e9, dissipation=0.4, exponent=1.5, race_inertia=2e-4, race_drag=1e-4)
    for other in (model, model.replace(gamma=0.2)):
        touchdown = other.equations.touchdowns[0]
        assert touchdown.law.stiffness * SCALES.force / SCALES.length**1.5 == pytest.approx(1e9, rel=1e-14)
        assert touchdown.law.dissipation / SCALES.velocity == pytest.approx(0.4, rel=1e-14)
        assert touchdown.race.inertia * SCALES.mass * SCALES.length**2 == pytest.approx(2e-4, rel=1e-14)
        assert touchdown.race.drag * SCALES.mass * SCALES.length**2 * SCALES.speed == pytest.approx(1e-4, rel=1e-14)


def test_a_stiff_heavy_mount_is_a_fixed_bearing_and_a_light_one_moves():
    entries = {"law": "kelvin-voigt", "stiffness": STIFFNESS, "damping": 0.1 * SCALES.damping}
    fixed = cm.simulate(of(**entries), cm.kick(1.0), 12.0).final
    ends = []
    for factor in (1e2, 1e4):
        mount = {"mount_mass": 50.0 * factor, "mount_stiffness": factor * STIFFNESS}
        ends.append(abs(cm.simulate(of(**entries, **mount), cm.kick(1.0), 12.0).final.position[0] - fixed.position))
    assert ends[1] < 0.02 * ends[0] < 0.02
    moved = of(**entries, mount_mass=5.0, mount_stiffness=0.1 * STIFFNESS, mount_damping=0.0)
    assert moved.system.rest.shape == (2,)
    assert abs(cm.simulate(moved, cm.kick(1.0), 12.0).final.position[1]) > 1e-4


def test_parameters_by_name():
    model = of(law="kelvin-voigt", stiffness=STIFFNESS, restitution=0.9)
    assert {"gamma", "mu", "touchdown_stiffness", "touchdown_restitution"} <= set(model.varied)
    assert not {"d", "restitution", "touchdown_damping"} & set(model.varied)
    assert model.value("touchdown_stiffness") == STIFFNESS
    changed = model.replace(touchdown_stiffness=2.0 * STIFFNESS, mu=0.3)
    assert changed.definition.bearing_at(0).stiffness == 2.0 * STIFFNESS
    assert changed.equations.touchdowns[0].friction == 0.3
    with pytest.raises(InputError, match=r"d = 0\.9"):
        model.replace(d=0.9)
    with pytest.raises(InputError, match="d = nothing given"):
        model.value("d")
    again = rotor_from(changed.attributes())
    assert again == changed
    assert rotor_from({**changed.attributes()}).system.arrays == changed.system.arrays


@pytest.mark.jit_only
@pytest.mark.parametrize(
    "parts",
    [
        {"race_inertia": 2e-3, "race_drag": 1e-4},
        {"mount_mass": 5.0, "mount_stiffness": 2e7, "mount_damping": 3e3},
        {"offset": 5e-5},
    ],
)
def test_a_rigid_wall_may_turn_sit_on_a_mount_and_lie_off_the_centre(parts):
    rotor = of(law="rigid", **parts)
    motion = cm.simulate(rotor, cm.kick("150 mm/s"), 60.0)
    assert len(motion.contacts) > 5
    assert cm.motions.energy_ledger(motion).imbalance < 1e-13
    assert rotor.value("d") == rotor.parameters.d


def test_a_bearing_off_centre_is_met_where_the_levitating_rotor_is_a_clearance_from_its_centre():
    centre = 0.3 * np.exp(0.4j)
    given = {"offset": 0.3 * SCALES.length, "offset_direction": 0.4}
    model = of(law="kelvin-voigt", stiffness=STIFFNESS, restitution=0.9, **given)
    alone = of(law="kelvin-voigt", stiffness=STIFFNESS, restitution=0.9)
    start, velocity = 0.1 - 0.2j, 0.9 + 0.4j
    # At time zero both frames coincide; the bearing's centre turns backward in the turning one.
    motion = cm.simulate(model, cm.State(start - centre, velocity + 1j * centre), 6.0)
    times = np.linspace(0.0, motion.segment_starts[1], 30)
    system = alone.system
    flight = system.fly(np.broadcast_to(system.amplitudes(start, velocity), (30, system.modes)), times)
    path = system.state(flight)[0]
    np.testing.assert_allclose(motion.position(times), path - centre * np.exp(-1j * times), atol=1e-12)
    assert abs(path[-1] - centre * np.exp(-1j * times[-1])) == pytest.approx(1.0, abs=1e-12)
    assert model.system.rest_radius == pytest.approx(alone.system.rest_radius + 0.3, rel=1e-12)
    fallen = model.without_levitation()
    assert fallen.system.forced is None
