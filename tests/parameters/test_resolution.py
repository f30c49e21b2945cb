"""Settings in terms that stand for numbers of a machine, and what a machine remembers of its entries."""

import pickle
import tomllib
from pathlib import Path

import pytest
from machines import machine_file, machine_text
from refusals import error_of

from carom.loading import load
from carom.parameters import MACHINE_FIELDS, TERMS, Machine

REAL = Path("examples/keogh-cole.toml")


# ------------------------------------------------------------------------------------------ settings


IN_TERMS = machine_text("in-terms")


@pytest.fixture
def in_terms():
    return machine_file("in-terms")


def test_a_setting_moves_its_own_field_alone(in_terms):
    before = load(in_terms).machine

    for name, text in [("mass", "60 kg"), ("speed", "3000 rpm"), ("stiffness", "1.2e6 N/m"), ("clearance", "0.8 mm")]:
        after = load(in_terms, [f"{name}={text}"]).machine
        same = set(MACHINE_FIELDS) - {name}
        assert all(getattr(after, other) == getattr(before, other) for other in same)


@pytest.mark.parametrize(
    ("setting", "field"),
    [
        *[("proportional_gain=12000 A/m", "stiffness"), ("negative_stiffness=100 N/mm", "stiffness")],
        *[
            ("derivative_gain=20 A s/m", "damping"),
            ("damping_ratio=0.2", "damping"),
            ("natural_frequency=30 Hz", "stiffness"),
        ],
        *[("unbalance=100 g mm", "eccentricity"), ("balance_grade=G 6.3", "eccentricity"), ("rho=0.1", "eccentricity")],
        ("rotor_diameter=10 cm", "rotor_radius"),
    ],
)
def test_a_term_that_is_set_moves_the_field_it_stands_for(in_terms, setting, field):
    name, _, text = setting.partition("=")
    before, after = load(in_terms).machine, load(in_terms, [setting]).machine

    assert {name for name in MACHINE_FIELDS if getattr(after, name) != getattr(before, name)} == {field}
    if name in TERMS:  # the file with this entry is the same machine
        others = {key: text for key, text in tomllib.loads(IN_TERMS)["machine"].items() if key != name}
        others = {key: text for key, text in others.items() if TERMS.get(key) is None or TERMS[key].sets != field}
        assert Machine(**{**others, name: text}).parameters == load(in_terms, [setting]).parameters


def test_a_factor_that_is_set_moves_what_follows_from_it(in_terms):
    both = load(in_terms, ["force_current_factor=80 N/A"]).machine
    damping = load(in_terms, ["stiffness=1e6 N/m", "force_current_factor=80 N/A"]).machine

    assert (both.stiffness, both.damping) == (2 * (80 * 1e4 - 2.1e5), 2 * 80 * 10.0)
    assert (damping.stiffness, damping.damping) == (1e6, 1600.0)


@pytest.mark.parametrize(
    ("settings_", "start"),
    [
        (["damping_ratio=0.1", "gamma=0.1"], "gamma = 0.1: sets damping, which damping_ratio = 0.1 sets too"),
        (["derivative_gain=3", "damping=3"], "derivative_gain = 3: sets damping, which is set too"),
        (["rated_speed=3 Hz"], "rated_speed = 3 Hz: has no effect without balance_grade"),
        (["proportional_gain=1"], "proportional_gain = 1: gives stiffness = "),
        (["negative_stiffness=1e9"], "proportional_gain = 1e4 A/m: gives stiffness = "),
        (["k_i=3"], "k_i = 3: unknown name in a machine or its parameters; did you mean force_current_factor?"),
    ],
)
def test_settings_in_terms_that_cannot_be_made_are_named(in_terms, settings_, start):
    assert str(error_of(lambda: load(in_terms, settings_))).startswith(start)


def test_a_dimensionless_file_refuses_terms_with_a_remedy():
    paper = REAL.with_name("source-paper.toml")

    assert "set rho instead" in error_of(lambda: load(paper, ["unbalance=3 g mm"])).allowed
    assert "use a file with a [machine] table" in error_of(lambda: load(paper, ["force_limit=3 N"])).allowed


def test_replace_with_texts_is_the_setting_bit_for_bit(in_terms):
    case = load(in_terms)

    for setting in (
        "natural_frequency=22.3 Hz",
        "balance_grade=G 6.3",
        "derivative_gain=12.3 A s/m",
        "damping_ratio=7.7 %",
    ):
        name, _, text = setting.partition("=")
        assert case.replace(**{name: text}).parameters == load(in_terms, [setting]).parameters


# ------------------------------------------------------------------------------------------ what is remembered


def test_a_machine_remembers_what_it_was_given_by(in_terms):
    found = load(in_terms, ["mass=60 kg", "gamma=0.1"]).machine.given

    assert found["eccentricity"] == {"unbalance": "15000 g mm", "mass": "50 kg"}
    assert found["stiffness"]["proportional_gain"] == "1e4 A/m"
    assert found["mass"] == {"mass": "60 kg"}
    assert found["damping"] == {"gamma": "0.1"}
    assert "unbalance_phase" not in found


@pytest.mark.parametrize(
    "settings_",
    [
        *[[], ["mass=60 kg"], ["speed=200 Hz"], ["gamma=0.1"], ["balance_grade=G 6.3"], ["natural_frequency=30 Hz"]],
        *[["stiffness=1e6"], ["force_current_factor=75"], ["force_limit=500 N", "current_limit=5 A"], ["mu=0.3"]],
        ["damping_ratio=0.1", "stiffness=1234567 N/m", "mass=55.5 kg"],
    ],
)
def test_a_machine_in_terms_is_written_and_read_back_in_every_bit(in_terms, tmp_path, settings_):
    found = load(in_terms, settings_).machine
    path = tmp_path / "again.toml"
    path.write_text(found.to_toml(), encoding="utf-8")

    assert load(path).machine == found
    assert pickle.loads(pickle.dumps(found)) == found
    assert pickle.loads(pickle.dumps(found)).given == found.given
    assert hash(load(path).machine) == hash(found)
    if not settings_:
        for line in IN_TERMS.splitlines()[1:]:
            name, _, value = line.partition(" = ")
            shown = value if value.startswith('"') or name == "magnetic_bearings" else repr(float(value))
            assert f"{name} = {shown}  #" in found.to_toml()
