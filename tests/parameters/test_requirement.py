"""What a machine must survive: the table ``[survive]``, options and defaults."""

import re
from dataclasses import replace

import pytest
from refusals import assert_refused

from carom.base.outcome import InputError
from carom.loading import load
from carom.models import jeffcott
from carom.parameters import Required, Requirement, Scales, Shock, usual_kick

REAL, PAPER = "examples/keogh-cole.toml", "examples/source-paper.toml"
FIVE_G = 49.03325


def test_usual_kick_is_a_fall_through_the_diametral_clearance():
    scales = load(REAL).parameters.scales
    # Fall from rest through twice 0.7 mm: t = sqrt(2 h / g), v = g t.
    height, gravity = 2 * 0.7e-3, 9.80665
    speed = gravity * (2 * height / gravity) ** 0.5
    assert usual_kick(scales) * scales.velocity == pytest.approx(speed, rel=1e-15)  # a few roundings
    assert usual_kick(None) == 1.0


@pytest.mark.parametrize("factor", [0.1, 3.0])
def test_usual_kick_in_si_units_does_not_depend_on_speed_and_mass(factor):
    slow, fast = Scales(2.0, 0.25e-3, 300.0), Scales(2.0 * factor, 0.25e-3, 300.0 * factor)
    kicks = [usual_kick(scales) * scales.velocity for scales in (slow, fast)]
    assert kicks[0] == pytest.approx(kicks[1], rel=1e-15)  # a few roundings


def test_table_is_in_si_units(write):
    case = load(write('[survive]\nkick = "100 mm/s"\nshock = "5 g, 6 ms"\nblade_loss = "20 kg mm"'))
    assert case.requirement == Requirement(0.1, Shock(FIVE_G, 0.006), 0.02, "file")
    assert load(write('[survive]\nshock = "50 m/s²"')).requirement == Requirement(
        None, Shock(50.0, 0.011), None, "file"
    )
    # The rotor weighs 50 kg; the decimals are multiplied exactly: 50 * 0.0001 in doubles would do here, 50 * 0.0007 not.
    assert load(write('[survive]\nblade_loss = "0.7 mm"')).requirement.blade_loss == 0.035
    assert load(REAL).requirement == Requirement() == Requirement(source="file")
    assert Requirement().source == "default"


def test_dimensionless_table_has_plain_numbers(write):
    case = load(write('[survive]\nkick = 0.4\nshock = "0.5, 3"\nblade_loss = 0.6', PAPER))
    assert case.requirement == Requirement(0.4, Shock(0.5, 3.0), 0.6, "file")
    assert case.requirement.own(None) == Required(0.4, Shock(0.5, 3.0), 0.6)
    assert load(PAPER).requirement.own(None) == Required(1.0, None, None)


def test_changes_of_the_machine_are_checked():
    case = replace(load(REAL), requirement=Requirement(blade_loss=1.0))
    with pytest.raises(
        InputError, match=r"blade_loss = 1\.0: gives a change of the eccentricity of 2000 clearances, which must be"
    ):
        case.replace(clearance=1e-5)


def test_sizes_in_si_units_stay_when_the_machine_changes(write):
    text = '[survive]\nkick = "100 mm/s"\nshock = "5 g"\nblade_loss = "0.4 mm"'
    settings = ["speed=600 rpm", "clearance=0.5 mm", "mass=20 kg", "gamma=0.2"]
    for case in (load(write(text)), load(write(text), settings), load(write(text)).replace(speed="600 rpm", mass=20)):
        scales = case.parameters.scales
        own = case.requirement.own(scales)
        assert case.requirement == Requirement(0.1, Shock(FIVE_G, 0.011), 0.02, "file")
        back = own.kick * scales.velocity, own.shock.peak * scales.acceleration, own.shock.duration * scales.time
        assert back == pytest.approx((0.1, FIVE_G, 0.011), rel=1e-15)  # two roundings each
        assert own.blade_loss * scales.unbalance == pytest.approx(0.02, rel=1e-15)
    assert load(write(text), settings).requirement.own(scales).blade_loss == pytest.approx(0.02 / 20 / 0.7e-3)


def test_written_requirements_are_read_as_the_same(write):
    one = Requirement(0.1 + 0.2, Shock(49.03325000000001, 1 / 3), 1e-7 / 3, "file")
    assert load(write(one.to_toml())).requirement == one
    other = Requirement(0.1 + 0.2, Shock(1 / 3, 1e5 / 3), 2 / 3, "file")
    assert load(write(other.to_toml(has_scales=False), PAPER)).requirement == other
    assert Requirement().to_toml() == ""


@pytest.mark.parametrize(
    ("survive", "words"),
    [
        ('shocks = "5 g"', "shocks = 5 g: unknown name in [survive]; did you mean shock?"),
        ("kick = 0.1", "[survive] kick = 0.1: must be a velocity in m/s"),
        ('kick = "60"', "this has no unit: write 60 mm/s or 60 m/s"),
        ('kick = "0 mm/s"', "[survive] kick = 0 mm/s: must be above 0"),
        ('kick = "0,06 m/s"', "decimals take a point, not a comma: write 0.06 m/s"),
        ('shock = "5 g, 11"', "[survive] shock = 11: must be a time in s"),
        ('shock = "5 g,"', "[survive] shock = '': must be a time in s"),
        ('shock = "5 g, 11 ms, 3"', '[survive] shock = 5 g, 11 ms, 3: must be PEAK, DURATION, such as "5 g, 11 ms"'),
        ('shock = "1,5 g, 11 ms"', "[survive] shock = 1,5 g, 11 ms: must be PEAK, DURATION"),
        ('shock = ["5 g", "11 ms"]', "[survive] shock = ['5 g', '11 ms']: must be an acceleration"),
        ("blade_loss = 2", "this has no unit: write 2 g mm or 2 kg m"),
        (
            'blade_loss = "50 kg m"',
            "[survive] blade_loss = 50.0: gives a change of the eccentricity of 1428.57 clearances, which must be",
        ),
    ],
)
def test_bad_tables_are_refused_in_one_line(write, survive, words):
    assert_refused(lambda: load(write(f"[survive]\n{survive}")), re.escape(words))


def test_python_reads_text_for_any_machine():
    case = load(REAL)
    for subject in (case, case.machine, case.parameters, jeffcott(case.parameters)):
        assert Requirement.of(subject, kick="100 mm/s", blade_loss="0.1 mm") == Requirement(0.1, None, 0.005, "option")
    with pytest.raises(InputError, match="a Machine, a Case"):
        Requirement.of(case.parameters.scales)
    assert Requirement.of(load(PAPER), kick=0.3) == Requirement(0.3)
    with pytest.raises(InputError, match=r"kick = 0\.1: .*: write 0\.1 mm/s or 0\.1 m/s"):
        Requirement.of(case, kick=0.1)
