"""Bad input: one line that names the field, the value and what is allowed; exit code 2; nothing written."""

import json
import sys
import time
import warnings
import weakref
from pathlib import Path

import pytest
from machines import machine_text

from carom.base.outcome import CaromError, CaromWarning, InputError
from carom.cli import main
from carom.cli.app import BAD_INPUT, FAILURE, INTERRUPTED

MACHINE = machine_text("small")


def test_unreadable_files(refused, tmp_path):
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    for path in (tmp_path, tmp_path / "none.toml", binary, tmp_path / "a" / "b.toml", "\0", ""):
        refused("", "study", path)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--start"),
        (("--start", "0,0,0,0", "--kick", "1"), "--kick"),
        (("--start", "1,2,3"), "RE,IM,VRE,VIM"),
        (("--start", "1.1,0,0,0"), "inside the wall"),
        (("--start", "0,0,1 mm,0"), "--start = 1 mm"),
        (("--kick", "13 mm/s", "--set", "gamma=0.01"), "--kick = 13 mm/s"),
        (("--kick", "1 m/s", "--until", "0"), "--until = 0"),
        (("--kick", "1 m/s", "--until", "2 m"), "--until = 2 m"),
    ],
)
def test_wrong_start(refused, machine, arguments, words):
    refused(words, "simulate", machine, *arguments)


def test_units_need_a_machine(refused, dimensionless):
    for arguments in (("--start", "0.1 mm,0,0,0"), ("--kick", "1 mm/s"), ("--kick", "1 m/s", "--until", "1 s")):
        refused("no scales", "simulate", dimensionless, *arguments)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("stdy",), "stdy"),
        (("study",), "MACHINE"),
        (("study", "a", "b"), "b"),
        (("study", "a", "--nonsense"), "--nonsense"),
        (("study", "a", "--set"), "--set"),
        (("orbits", "MACHINE", "--longest-period", "long"), "--longest-period"),
        (("orbits", "MACHINE", "--longest-period", "0"), "--longest-period"),
    ],
)
def test_wrong_usage(refused, machine, arguments, words):
    refused(words, *(machine if word == "MACHINE" else word for word in arguments))


def test_all_errors_of_a_file_are_told_a_line_each_or_as_objects_of_json(carom, tmp_path):
    path = tmp_path / "machine.toml"
    path.write_text(MACHINE.replace("50 kg", "1 m").replace("184.2", "-1") + 'color = "red"\n', encoding="utf-8")
    command = ("study", path, "--set", "gama=1", "--out", tmp_path / "out")
    code, out, err = carom(*command)

    assert (code, out) == (BAD_INPUT, "")
    assert [line.split(" = ")[0] for line in err.splitlines()] == [
        f"carom: {name}" for name in ("color", "mass", "speed", "gama")
    ]
    code, out, again = carom(*command, "--json")
    document = json.loads(out)
    assert (code, again) == (BAD_INPUT, err)
    assert [f"carom: {entry['message']}" for entry in document["errors"]] == err.splitlines()
    assert document["error"] == document["errors"][0] | {"code": BAD_INPUT}
    assert list(tmp_path.iterdir()) == [path]


def test_an_error_is_an_object_of_json_too(carom, machine):
    code, out, err = carom("simulate", machine, "--kick", "60", "--json")
    error = json.loads(out)["error"]

    assert code == BAD_INPUT
    assert err == f"carom: {error['message']}\n"
    assert (error["field"], error["value"], error["code"]) == ("--kick", "60", BAD_INPUT)
    assert error["message"] == f"--kick = 60: {error['allowed']}"
    assert set(json.loads(out)) == {"error"}


def _while_interrupted(error):
    error.__context__ = KeyboardInterrupt()
    return error


@pytest.mark.parametrize(
    ("problem", "code", "message"),
    [
        (
            ZeroDivisionError("first\nsecond"),
            FAILURE,
            "unexpected ZeroDivisionError, please report it (CAROM_DEBUG=1 shows more): first second",
        ),
        (EOFError("Ran out of input"), FAILURE, "unexpected EOFError, please report it"),
        (ZeroDivisionError("\x1b[31m\u202e\x07\x9b"), FAILURE, "unexpected ZeroDivisionError, please report it"),
        (OSError(28, "No space left on device"), FAILURE, "cannot read or write: No space left on device"),
        (CaromError("no orbit"), BAD_INPUT, "no orbit"),
        (KeyboardInterrupt(), INTERRUPTED, "interrupted"),
        (_while_interrupted(RuntimeError("cannot join thread before it is started")), INTERRUPTED, "interrupted"),
        (InputError("mass", None, "\x1b[31m\u202e"), BAD_INPUT, "mass = nothing given"),
    ],
)
def test_other_failures_are_one_line_and_objects_of_json(monkeypatch, carom, machine, problem, code, message):
    monkeypatch.setattr("carom.loading.load", _raise(problem))
    answer, out, err = carom("study", machine, "--json")
    error = json.loads(out)["error"]

    assert answer == error["code"] == code
    assert error["message"].startswith(message)
    assert err.lstrip("\n") == f"carom: {error['message']}\n"  # the end of data leaves a prompt
    assert err.strip("\n").isprintable()
    assert out.replace("\n", "").isprintable()
    assert carom("study", machine) == (code, "", err)


NEEDED = {
    "simulate": ("--kick", "50 mm/s"),
    "bifurcations": ("--along", "gamma", "--from", "0.1", "--to", "0.2"),
    "regions": ("--plane", "gamma,omega"),
}
"""Options that a command needs."""
WRONG = {
    "study": ("--kick", "6"),
    "simulate": ("--shock", "6"),
    "orbits": ("--impacts", "0"),
    "attractors": ("--starts", "0"),
    "prove": ("--impacts", "0"),
    "response": ("--from", "5"),
    "bifurcations": ("--seed", "x"),
    "regions": ("--x", "1"),
    "basins": ("--grid", "x"),
}
"""An option of each command with a value that is not allowed."""


@pytest.mark.parametrize("command", WRONG)
def test_every_error_of_every_command_is_an_object_of_json(carom, machine, tmp_path, command):
    broken, wrong = tmp_path / "broken.toml", tmp_path / "wrong.toml"
    broken.write_text("[machine\nmass=")
    wrong.write_text('[machine]\nmass = "5 kgs"\n')
    needed = NEEDED.get(command, ())
    tried = [
        (broken, *needed),
        (wrong, *needed),
        (tmp_path / "none.toml", *needed),
        (machine, *needed, *WRONG[command]),
        (machine, *needed, "--nonsense"),
        (machine, *needed, "--set", "mass"),
        (machine, *needed, "--out", broken / "below"),
        needed,
    ]
    for given in tried:
        if command == "orbits" and "--out" in given:
            continue
        code, out, err = carom(command, *given, "--json")
        assert code == BAD_INPUT, given
        assert "error" in json.loads(out), given
        assert err.startswith("carom: ")


def test_wrong_usage_is_an_object_of_json(carom, machine):
    code, out, err = carom("orbits", machine, "--impacts", "no", "--json")
    error = json.loads(out)["error"]

    assert (code, error["field"], error["value"], error["allowed"]) == (BAD_INPUT, None, None, None)
    assert err == f"carom: {error['message']}\n"


@pytest.mark.parametrize("option", ["--csv", "--netcdf"])
def test_logs_that_cannot_be_written(refused, machine, option, tmp_path, monkeypatch):
    monkeypatch.setattr("carom.motions.simulation.simulate", _raise(AssertionError("simulated in vain")))
    special = [path for path in ("/dev/null", "/proc/log") if Path(path).parent.is_dir()]
    for path in (tmp_path, tmp_path / "none" / "log", tmp_path / ("x" * 300), "", "a\0b", *special):
        refused(option, "simulate", machine, "--kick", "1 mm/s", "--until", "1", option, path)
    assert list(tmp_path.iterdir()) == []


def test_directories_that_cannot_be_written(refused, machine, tmp_path):
    file = tmp_path / "file"
    file.write_text("mine", encoding="utf-8")
    for path in (file, file / "below", "", " ", "a\0b"):
        refused("--out", "study", machine, "--out", path)
    assert file.read_text(encoding="utf-8") == "mine"
    assert list(tmp_path.iterdir()) == [file]


# ------------------------------------------------------------------------------------------------ other failures


def _raise(error):
    def fail(*_, **__):
        raise error

    return fail


def test_warning_is_one_line_and_no_error(monkeypatch, carom, machine):
    def warn(*_, **__):
        warnings.warn("the disk\nis full", CaromWarning, stacklevel=1)
        raise InputError("machine file", "m.toml", "must be another one")

    monkeypatch.setattr("carom.loading.load", warn)
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        _, _, err = carom("study", machine)

    assert err == "carom: the disk is full\ncarom: machine file = m.toml: must be another one\n"


def test_unexpected_error_shows_more_on_demand(monkeypatch, machine):
    monkeypatch.setattr("carom.loading.load", _raise(ZeroDivisionError("why")))
    monkeypatch.setenv("CAROM_DEBUG", "1")

    with pytest.raises(ZeroDivisionError, match="why"):
        main(["study", machine])


def test_interrupt_in_a_place_that_hands_nothing_on(monkeypatch, carom, machine):
    """Python ignores what is raised in the callback of a weak reference."""

    def interrupted(*_):
        class Thing:
            pass

        thing = Thing()
        reference = weakref.ref(thing, _raise(KeyboardInterrupt))
        del thing
        for _ in range(2000):
            time.sleep(0.01)
        return reference

    monkeypatch.setattr("carom.loading.load", interrupted)
    hook = sys.unraisablehook

    assert carom("study", machine)[:2] == (INTERRUPTED, "")
    assert sys.unraisablehook is hook
