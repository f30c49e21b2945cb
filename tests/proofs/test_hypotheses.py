"""The numbers of a proof are those that were given, to the last digit."""

from fractions import Fraction
from pathlib import Path

import pytest

from carom.base.outcome import InputError
from carom.loading import load
from carom.proofs.hypotheses import Hypotheses, hypotheses_of

PAPER = {"gamma": "0.1", "omega": "0.76", "rho": "3/7", "phi": "0.21", "mu": "0.15", "d": "0.95", "radius_ratio": "57"}
KEOGH = "examples/keogh-cole.toml"


def rational(hypotheses, *names):
    return hypotheses.rational(*names)


def test_decimals_fractions_and_doubles_are_exact():
    numbers = hypotheses_of({**PAPER, "mu": 0.15, "d": Fraction(19, 20)})

    assert rational(numbers, "gamma", "omega_squared", "rho") == (Fraction(1, 10), Fraction(361, 625), Fraction(3, 7))
    assert rational(numbers, "mu", "d") == (Fraction(0.15), Fraction(19, 20))
    assert Fraction(0.15) != Fraction("0.15")


def test_machine_file_is_read_by_its_text_and_a_case_by_its_doubles():
    by_text, by_doubles = hypotheses_of(KEOGH), hypotheses_of(load(KEOGH))

    speed = Fraction("184.2")
    assert rational(by_text, "gamma", "rho") == (Fraction(1400) / (50 * speed), Fraction(3, 7))
    assert rational(by_text, "omega_squared") == (Fraction(980_000) / (50 * speed**2),)
    assert rational(by_doubles, "gamma") == (Fraction(load(KEOGH).parameters.gamma),)


def test_settings_replace_what_follows_from_the_machine():
    numbers = hypotheses_of(KEOGH, ["damping=2000 N s/m", "mu=0.2"])

    assert rational(numbers, "gamma", "mu") == (Fraction(2000) / (50 * Fraction("184.2")), Fraction(1, 5))


def test_turns_a_minute_keep_their_pi():
    number = hypotheses_of(KEOGH, ["speed=1759 rpm"]).numbers["omega_squared"]

    assert number.turns == -2
    assert number.rational is None
    assert float(number.low) / 3.141592653589793**2 == pytest.approx(
        load(KEOGH, ["speed=1759 rpm"]).parameters.omega ** 2, rel=1e-14
    )


def test_intervals_contain_their_machines():
    box = hypotheses_of({**PAPER, "gamma": ("0.1", "0.2"), "omega": (0.5, 0.75)})

    assert not box.exact
    assert str(box.numbers["gamma"]) == "[1/10, 1/5]"
    assert (box.numbers["omega_squared"].low, box.numbers["omega_squared"].high) == (Fraction(1, 4), Fraction(9, 16))


def test_document_reads_back_and_a_changed_digit_is_refused():
    document = hypotheses_of(KEOGH, ["gamma=0.1"]).document()
    assert Hypotheses.from_document(document).numbers == hypotheses_of(KEOGH, ["gamma=0.1"]).numbers

    for changed in (
        {**document, "values": {**document["values"], "stiffness": "9.81e5 N/m"}},
        {**document, "exact": {**document["exact"], "mu": "3/21"}},
        {**document, "table": "other"},
        {**document, "values": {**document["values"], "mass": 50}},
        {"table": "machine"},
    ):
        with pytest.raises(InputError, match="hypotheses"):
            Hypotheses.from_document(changed)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"gamma": "1/0"}, "gamma = 1/0"),
        ({"omega": "1e-999999999"}, "out of range"),
        ({"gamma": "9" * 300}, "too long"),
        ({"gamma": "double 1_0"}, "not a number"),
        ({"gamma": "double ٣"}, "not a number"),
        ({"gamma": ("0.2", "0.1")}, "must increase"),
        ({"rho": "-0.1"}, "rho = -0.1"),
        ({"d": "1.0000000000000000001"}, "out of range"),
        ({"speed": "1"}, "unknown name"),
    ],
)
def test_numbers_that_cannot_be_used_are_named(changes, words):
    with pytest.raises(InputError, match=words):
        hypotheses_of({**PAPER, **changes})


def test_missing_number_is_named():
    with pytest.raises(InputError, match="mu = nothing given"):
        hypotheses_of({name: text for name, text in PAPER.items() if name != "mu"})


def test_unit_that_is_not_exact_is_refused():
    with pytest.raises(InputError, match="cannot be converted exactly"):
        hypotheses_of(KEOGH, ["stiffness=5600 lbf/in"])


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ('[touchdown]\nlaw = "rigid"\nrace_inertia = "1e-4 kg m^2"', "touchdown = .*race"),
        ('[drive]\npolar_inertia = "1e-3 kg m^2"', "touchdown = "),
        ("", "limits = a control force of at most 300 N"),
    ],
)
def test_what_moves_otherwise_than_the_theorems_assume_is_refused(tmp_path, tables, says):
    """A race that turns, a shaft that is braked, and bearings that give no more than their limit."""
    text = Path("examples/keogh-cole.toml").read_text(encoding="utf-8")
    (tmp_path / "machine.toml").write_text(f"{text}\n{tables}\n", encoding="utf-8")
    with pytest.raises(InputError, match=says):
        hypotheses_of(tmp_path / "machine.toml", [] if tables else ["force_limit=300 N"])
