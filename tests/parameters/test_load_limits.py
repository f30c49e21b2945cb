"""The table ``[limits]`` of a machine file."""

import re

import pytest
from refusals import assert_refused

from carom.base.outcome import InputError
from carom.loading import load
from carom.parameters import LoadLimits

REAL = "examples/keogh-cole.toml"


def test_values_with_units(write):
    text = '[limits]\nimpulse = "5 N s"\nforce = "2 kN"\npower = "10 kW"\nheat = "0.5 kJ"\nimpacts = 20'
    case = load(write(text))
    assert case.limits == LoadLimits(impulse=5.0, force=2000.0, power=1e4, heat=500.0, impacts=20)
    assert case.limits.given == {"impulse": 5.0, "force": 2000.0, "power": 1e4, "heat": 500.0, "impacts": 20.0}
    assert case.replace(damping=2000.0).limits == case.limits
    assert load(write("[limits]\nforce = 0"), ["friction=0.1"]).limits.given == {"force": 0.0}
    assert load(REAL).limits.given == {}


SOFT = "examples/touchdown-balls.toml"


def test_depth_and_pressure_are_told_in_the_units_of_people(tmp_path):
    case = load(SOFT)
    assert (case.limits.depth, case.limits.pressure) == (50e-6, 4.2e9)
    assert "depth in the bearing 50 µm, ball pressure 4.2 GPa" in dict(case.rows())["limits of the bearing"]
    assert LoadLimits.format("impacts", 3.0) == "3"


def test_written_limits_are_read_as_the_same(write):
    limits = LoadLimits(force=0.1 + 0.2, impacts=3)
    assert load(write(limits.to_toml())).limits == limits
    assert LoadLimits().to_toml() == ""


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ('[limits]\ndepth = "20 um"', "depth = 2e-05: a limit needs a table [touchdown] of a compliant bearing"),
        ("[limits]\npressure = 4e9", "pressure = 4000000000.0: a limit needs balls in the table [touchdown]"),
        ("[limits]\nlife_share = 0.1", "life_share = 0.1: a limit needs dynamic_rating in the table [touchdown]"),
        ("[limits]\ntemperature = '80 °C'", "temperature = 80.0: a limit needs race_mass in the table [touchdown]"),
        ('[limits]\ndepth = "20 GPa"', "depth = 20 GPa: must be a length in m"),
        ('[limits]\nforces = "2 kN"', "forces = 2 kN: unknown name in [limits]; did you mean force?"),
        ('[limits]\nforce = "2 kg"', "force = 2 kg: must be a force in N"),
        ("[limits]\nheat = -1", "heat = -1: must be an energy in J, >= 0"),
        ("[limits]\nimpacts = 2.5", "impacts = 2.5: must be a whole number"),
        ("[[limits]]\nforce = 3", "limits = [{'force': 3}]: must be a table"),
    ],
)
def test_what_cannot_be_a_limit(write, limits, words):
    assert_refused(lambda: load(write(limits)), re.escape(words))


def test_limits_need_a_machine(write):
    with pytest.raises(InputError, match="not allowed beside"):
        load(write("[limits]\nforce = 3.0", "examples/source-paper.toml"))
