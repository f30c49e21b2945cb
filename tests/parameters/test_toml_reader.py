"""The text of a file: depth, quotes, and nothing of it that reaches a terminal."""

from pathlib import Path

import pytest

from carom.base.outcome import InputError, MultipleInputError
from carom.loading import load

REAL = Path("examples/keogh-cole.toml").read_text(encoding="utf-8")


@pytest.fixture
def error_of(tmp_path):
    """The input error of a machine file with this content, and of settings; every line of it is printable."""

    def read(content, *settings, name="rotor.toml"):
        path = tmp_path / name
        path.write_text(content, encoding="utf-8")
        with pytest.raises(InputError) as caught:
            load(path, settings)
        assert all(line.isprintable() for line in str(caught.value).split("\n"))
        return caught.value

    return read


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ("x = " + "[" * 5000, 1),
        ("[machine]\n" + "a." * 5000 + "a = 1", 2),
        ("[" + "a." * 5000 + "a]", 1),
        ("[" + "'a' . " * 5000 + "a]", 1),
        ("x = " + "{a=" * 5000, 1),
        ("x = 1\ny = " + "[" * 17 + "1" + "]" * 17, 2),
    ],
)
def test_deep_nesting_is_refused(error_of, content, line):
    error = error_of(content)

    assert error.field == "machine file"
    assert error.allowed == f"must be valid TOML of at most 16 levels; line {line} is nested too deeply"


def test_text_without_quotes_is_named_all_of_it(error_of):
    content = REAL.replace('"50 kg"', "50 kg").replace('"184.2 rad/s"', "1759 rpm").replace("0.15", "…")
    error = error_of(content)

    assert isinstance(error, MultipleInputError)
    assert [(one.field, one.value) for one in error.errors] == [
        ("mass", "50 kg"),
        ("speed", "1759 rpm"),
        ("friction", "…"),
    ]
    line = content.split("\n").index(next(line for line in content.split("\n") if line.startswith("mass"))) + 1
    assert f'must stand in quotes if it is text or has a unit: mass = "50 kg" (line {line} of' in str(error)


def test_all_errors_are_told_at_once(error_of):
    content = REAL.replace("0.15", "-1").replace("speed =", "spede =").replace('"50 kg"', '"50 m"')
    content = content.replace("[0.3, 0.4, 0.5]", "3")
    content = 'title = "mine"\n' + content.replace("\nclearance", '\ncolor = "red" #') + "\nlimit = 4\n"
    error = error_of(content, "gama=1", "restitution=2", "mass=1 s", "x")

    file = ["title", "limit", "limits", "color", "spede", "clearance", "mass", "friction"]
    assert sorted(one.field for one in error.errors) == sorted([*file, "--set", "gama"])
    assert (error.field, error.value) == ("title", "mine")
    assert str(error).split("\n") == [str(one) for one in error.errors]


@pytest.mark.parametrize(
    "text", ["\x1b[31m", "a\nb", "\u202egnp", "\x07", "\x9b1m", "\u2028", "\x00", "\ud800", "\x7f"]
)
def test_no_control_character_of_an_input_is_in_its_error(error_of, text, tmp_path):
    error_of(REAL, f"{text}=3", f"gamma={text}", f"mass=3 k{text}g", text)
    with pytest.raises(InputError) as caught:
        load(tmp_path / f"{text}.toml")
    assert str(caught.value).isprintable()
    if text != "\ud800":  # which TOML refuses itself
        quoted = '"' + "".join(sign if sign.isprintable() else f"\\u{ord(sign):04x}" for sign in text) + '"'
        for content in (f"{REAL}\n{quoted} = {quoted}", f"[{quoted}]\n{REAL}", REAL.replace('"50 kg"', quoted)):
            error_of(content)
