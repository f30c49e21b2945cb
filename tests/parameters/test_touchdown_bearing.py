"""The table ``[touchdown]``: what it says, what it refuses in one line, and settings."""

import math

import pytest
from machines import machine_text

import carom as cm
from carom.base.outcome import InputError
from carom.parameters import TouchdownBearing

MACHINE = machine_text("compressor")
SOFT = '[touchdown]\nlaw = "kelvin-voigt"\nstiffness = "1e8 N/m"\n'


def load(tmp_path, touchdown, settings=(), machine=MACHINE):
    path = tmp_path / "machine.toml"
    path.write_text(machine + touchdown)
    return cm.load(path, settings)


def test_a_bearing_of_rollers_with_race_and_mount(tmp_path):
    case = load(
        tmp_path,
        '[touchdown]\nlaw = "hunt-crossley"\nstiffness = "1e9 N/m^(10/9)"\nexponent = "10/9"\ndissipation = "0.3 s/m"\n'
        'race_inertia = "2 kg cm^2"\nrace_drag = "1e-4 N m s"\nmount_mass = "2 kg"\nmount_stiffness = "20 N/um"\nmount_damping = 3000',
    )
    bearing = case.touchdown
    assert bearing == TouchdownBearing(
        "hunt-crossley", 1e9, None, 0.3, None, None, 10 / 9, 2e-4, 1e-4, 2.0, 2e7, 3000.0
    )
    assert ("touchdown bearing", bearing.words) in case.rows()
    assert "restitution" not in dict(case.rows())
    assert "coefficient of restitution" not in dict(case.rows())
    again = load(tmp_path, bearing.to_toml())
    assert again.touchdown == bearing


def test_balls_are_no_parameter_of_the_motion(tmp_path):
    balls = 'damping = 500\nballs = 8\nball_diameter = "6 mm"\nrace_diameter = "40 mm"\nball_modulus = "310 GPa"\n'
    case = load(tmp_path, SOFT + balls, ["touchdown_balls=10"])
    assert (case.touchdown.balls, case.touchdown.ball_diameter, case.touchdown.ball_modulus) == (10, 6e-3, 310e9)
    varied = cm.models.rotor_of(case).varied
    assert "touchdown_stiffness" in varied
    assert not any("ball" in name for name in varied)
    again = load(tmp_path, case.touchdown.to_toml())
    assert again.touchdown == case.touchdown


def test_a_rigid_bearing_is_the_machine_with_its_restitution(tmp_path):
    case = load(tmp_path, '[touchdown]\nlaw = "rigid"\n', machine=MACHINE + "restitution = 0.9\n")
    assert case.touchdown is None
    assert cm.models.rotor_of(case).has_closed_forms


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("damping = 500\nrestitution = 0.9", "restitution = 0.9: must be left out: give damping or restitution, not both"),
        ("", "damping = nothing given"),
        ("damping = 500\ndissipation = 0.3", "dissipation = 0.3: must be left out: the law kelvin-voigt has a damping"),
        ("damping = -500", "damping = -500"),
        ("damping = 500\nexponent = 0.5", "exponent = 0.5: must be a number, > 0 (1 to 2)"),
        ("damping = 500\nmount_mass = 2", "mount_stiffness = nothing given: a mount needs mount_mass and mount_stiffness"),
        ("damping = 500\nmount_damping = 2", "mount_mass = nothing given: a mount needs"),
        ("damping = 500\nrace_drag = 2", "race_inertia = nothing given: a race with drag needs it"),
        ("restitution = 0.9\nrestitution_speed = 0.1", "restitution_speed = 0.1: must be left out: the restitution of kelvin-voigt"),
        ("restitution = 0.9\nmount_mass = 2\nmount_stiffness = 1e7", "restitution = 0.9: must be left out: it is that of the rotor on a fixed"),
        ("damping = 500\nstiffnes = 3", "stiffnes = 3"),
        ("damping = 500\nstarting_torque = 0.1", "race_inertia = nothing given: a torque of the balls needs a race that turns"),
        ('damping = 500\ntemperature = "300 K"', "'K' is not a unit of temperature"),
        ("damping = 500\ncage_mass = 2", "cage_mass = 2: not modelled: balls stay evenly spaced, the cage turns as they roll"),
        ("damping = 500\nmount_mass = 2\nmount_stiffness = 1e7\nmount_loss_factor = 0.1", "mount_loss_frequency = nothing given: a loss factor and the frequency"),
        ("damping = 500\nstribeck_speed = 0.1", "stribeck_speed = 0.1: not modelled: friction is the same at all slip speeds"),
        ("damping = 500\nballs = 8", "ball_diameter = nothing given: the data of balls need balls, ball_diameter, race_diameter"),
        ("damping = 500\nconformity = 0.52", "balls = nothing given: the data of balls need"),
        ("damping = 500\nconformity = 0.5", "conformity = 0.5: must be a number, > 0 (0.501 to 1)"),
    ],
)  # fmt: skip
def test_bad_input_gets_one_line(tmp_path, table, words):
    with pytest.raises(InputError) as caught:
        load(tmp_path, SOFT + table)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value) or "mount" in table or "ball" in words


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ('[touchdown]\nlaw = "kelvin-voigt"\nstiffness = -1e8\ndamping = 5', "stiffness = -100000000.0"),
        ('[touchdown]\nlaw = "lankarani-nikravesh"', "law = lankarani-nikravesh: must be one of rigid, kelvin-voigt, hunt-crossley"),
        ('[touchdown]\nlaw = "hunt-crossley"\nstiffness = 1e8\nrestitution = 0.8', "restitution_speed = nothing given: the restitution of hunt-crossley changes"),
        ('[touchdown]\nlaw = "hunt-crossley"\nstiffness = 1e8\ndamping = 8', "damping = 8.0: must be left out: the law hunt-crossley has a dissipation"),
        ('[touchdown]\nlaw = "rigid"\nstiffness = 1e8', "stiffness = 100000000.0: must be left out: the law of a rigid wall has none"),
    ],
)  # fmt: skip
def test_what_a_law_does_not_have(tmp_path, table, words):
    with pytest.raises(InputError, match=r".*") as caught:
        load(tmp_path, table, machine=MACHINE + ("restitution = 0.9\n" if "rigid" in table else ""))
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"running_torque": 0.1, "load_factor": 0.1},
            "running_torque = 0.1: must be left out: give it or torque_factor",
        ),
        ({"torque_factor": 2}, "viscosity = nothing given: the viscous torque needs it"),
        ({"inner_conductance": 2}, "race_mass = nothing given: temperatures need it"),
    ],
)
def test_what_torque_and_temperature_need(given, words):
    with pytest.raises(InputError, match=words):
        TouchdownBearing(
            "kelvin-voigt", 1e8, 500, race_inertia=1, balls=9, ball_diameter=5e-3, race_diameter=0.03, **given
        )


def test_a_mount_loses_what_its_loss_factor_says():
    """A damper takes ``πcωx²`` in a cycle, a loss factor ``η`` the share ``2πη`` of ``½kx²``."""
    size = {"law": "kelvin-voigt", "stiffness": 1e8, "damping": 5, "mount_mass": 2, "mount_stiffness": 1e7}
    mount = TouchdownBearing(**size, mount_loss_factor=0.2, mount_loss_frequency="150 Hz").mount
    assert math.pi * mount.damping * 2.0 * math.pi * 150.0 == pytest.approx(2.0 * math.pi * 0.2 * 0.5e7, rel=1e-14)
    with pytest.raises(InputError, match=r"mount_damping = 3\.0: must be left out: give it or a loss factor"):
        TouchdownBearing(**size, mount_damping=3, mount_loss_factor=0.2, mount_loss_frequency=150)


def test_a_restitution_of_the_machine_beside_the_law_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"restitution = 0\.9: must be left out: the touchdown bearing is compliant"):
        load(tmp_path, SOFT + "damping = 500\n", machine=MACHINE + "restitution = 0.9\n")
    with pytest.raises(InputError, match=r"restitution = 0\.9: must be left out"):
        load(tmp_path, SOFT + "damping = 500\n", ["restitution=0.9"])
    with pytest.raises(InputError, match="touchdown_stiffness = -1"):
        load(tmp_path, SOFT + "damping = 500\n", ["touchdown_stiffness=-1"])
    with pytest.raises(InputError, match="touchdown"):
        load(tmp_path, SOFT + "damping = 500\n", machine="[dimensionless]\ngamma=0.1\nomega=0.7\nrho=0.4\nphi=0\nmu=0.1\nradius_ratio=50\nd=0.9\n")  # fmt: skip


def test_the_restitution_of_a_rigid_wall_may_stand_in_either_table(tmp_path):
    text = machine_text("restitution-of-a-wall")
    path = tmp_path / "machine.toml"
    path.write_text(text)
    case = cm.load(path)
    assert (case.machine.restitution, case.touchdown.restitution) == (0.8, None)
    with pytest.raises(InputError, match="the restitution of a rigid wall is that of the machine"):
        cm.load(path, ["touchdown_restitution=0.7"])
    path.write_text(text.replace("damping", "restitution = 0.7\ndamping"))
    with pytest.raises(InputError, match=r"^restitution = 0.8: stated in \[machine\] already"):
        cm.load(path)
