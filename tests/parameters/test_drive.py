"""The table ``[drive]``: what it says and what it refuses in one line; and a drop that brakes the shaft."""

import re

import pytest
from machines import machine_text
from refusals import assert_refused

import carom as cm
from carom.parameters import Drive

MACHINE = machine_text("compressor") + "[gravity]\n"
SOFT = '[touchdown]\nlaw = "kelvin-voigt"\nstiffness = "1e8 N/m"\ndamping = "5000 N s/m"\n'


def load(tmp_path, *tables):
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE + "".join(tables))
    return cm.load(path)


def test_a_drop_brakes_the_shaft_and_a_drive_holds_it(tmp_path):
    case = load(tmp_path, SOFT, '[drive]\npolar_inertia = "4.5e-3 kg m^2"\n')
    assert case.drive == Drive(4.5e-3, 0.0)
    assert ("drive", case.drive.words) in case.rows()
    motion = cm.simulate(case, cm.drop(), "0.3 s")
    speed = motion.final.shaft[0]
    assert 0.3 < speed < 0.999
    # What friction takes from the angular momentum of the shaft: R times its impulse.
    touches, scales = motion.contacts, motion.rotor.scales
    taken = -0.025 * float(touches.friction_impulse.sum()) * scales.impulse
    assert 4.5e-3 * scales.speed * (1.0 - speed) == pytest.approx(taken, rel=1e-6)
    # In this wall rotor and bearing never part while the rotor is in its place, so the torque acts all the time.
    damped = '[touchdown]\nlaw = "hunt-crossley"\nstiffness = "1e8 N/m"\ndissipation = "1 s/m"\n'
    driven = load(tmp_path, damped, '[drive]\npolar_inertia = "4.5e-3 kg m^2"\ntorque = "0.5 N m"\n')
    other = cm.simulate(driven, cm.drop(), "0.02 s")
    touches, turned = other.contacts, 1.0 - other.final.shaft[0]
    braked = -0.025 * float(touches.friction_impulse.sum()) * scales.impulse
    given = 0.5 * float(touches.duration.sum()) * scales.time
    assert given > 0.01 * braked
    assert 4.5e-3 * scales.speed * turned == pytest.approx(braked - given, rel=1e-6)
    again = cm.models.rotor_from(motion.rotor.attributes())
    assert again.attributes() == motion.rotor.attributes()
    assert load(tmp_path, SOFT, case.drive.to_toml()).drive == case.drive


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ((SOFT, "[drive]\n"), "polar_inertia = nothing given"),
        ((SOFT, "[drive]\npolar_inertia = -1\n"), "polar_inertia = -1"),
        ((SOFT, "[drive]\npolar_inertia = 1\ntorqe = 2\n"), "torqe = 2"),
    ],
)
def test_bad_input_gets_one_line(tmp_path, tables, words):
    assert_refused(lambda: load(tmp_path, *tables), re.escape(words))
