"""Damaged files and options: accepted, or refused in printable lines; never a traceback.

What is accepted is read as what it says: ``tests/parameters/test_terms_at_random.py`` and ``tests/sweeps/test_sweep_file.py``.
"""

from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import typer
from compilation import sized

from carom.base.outcome import InputError
from carom.cli import main
from carom.loading import load
from carom.sweeps import load_sweep

EXAMPLES = Path(__file__).parents[2] / "examples"
CASES = sized(40, 40, 500)
"""Of each of three kinds: machine files, sweep files, options."""
HOSTILE = (
    *(
        b"\0",
        b"\x1b[31m",
        b"\x07",
        b"\xff",
        b"\xc3\x28",
        b"\xed\xa0\x80",
        b"\r",
        b"\t",
        b"\\u001b[2J",
        b"\\u202e",
        b"\\",
        b'"',
    ),
    *(
        "\u202e".encode(),
        "\u2028".encode(),
        "５０".encode(),
        "µ".encode(),
        b"\xef\xbb\xbf",
        b"\\n",
        b"'''",
        b'"""',
        b"#",
        b"=",
    ),
)
VALUES = (
    *(b"[]", b"{}", b"true", b"2026-01-01", b"nan", b"inf", b"-1", b"0", b"-0.0", b'""', b'" "', b"[1, 2]", b"{a = 1}"),
    *(
        b"1e400",
        b"1e308",
        b"1e-400",
        b"9" * 400,
        b"9" * 5000,
        b"0x" + b"f" * 5000,
        b'"1e400 kg"',
        b'"1e-400 m"',
        b"1_000.5",
    ),
    *(
        b'"5 kg"',
        b'"5 mm"',
        b'"5 rpm"',
        b'"5 deg"',
        b'"5"',
        b'"5 m**9**9"',
        b'"5 degC"',
        b'"five"',
        b"5 kg",
        b"0o17",
        b"[[1]]",
    ),
    *(b"[" * 400 + b"]" * 400, b"{a=" * 60 + b"1" + b"}" * 60, b'"' + b"x" * 5000 + b'"', b"1.5", b"3", b'"3 N s/m"'),
)
ENCODINGS = ("utf-16", "utf-16-le", "utf-32", "latin-1", "utf-7", "cp037")


def damaged(data, rng):
    """The bytes of a file after one to three damages."""
    for _ in range(rng.integers(1, 4)):
        data = DAMAGES[rng.integers(len(DAMAGES))](data, rng)
    return data


def _cut(data, rng):
    return data[: rng.integers(len(data) + 1)]


def _flip(data, rng):
    data = bytearray(data or b" ")
    for _ in range(rng.integers(1, 4)):
        data[rng.integers(len(data))] ^= 1 << rng.integers(8)
    return bytes(data)


def _insert(data, rng):
    place = rng.integers(len(data) + 1)
    return data[:place] + HOSTILE[rng.integers(len(HOSTILE))] + data[place:]


def _lines(data, rng, change):
    lines = data.split(b"\n")
    places = [place for place, line in enumerate(lines) if b"=" in line and not line.startswith(b"#")]
    if len(places) > 1:
        change(lines, *rng.choice(places, 2, replace=False))
    return b"\n".join(lines)


def _swap_keys(data, rng):
    def change(lines, first, second):
        (one, _, its), (other, _, theirs) = lines[first].partition(b"="), lines[second].partition(b"=")
        lines[first], lines[second] = other + b"=" + its, one + b"=" + theirs

    return _lines(data, rng, change) if b"=" in data else data


def _double(data, rng):
    return _lines(data, rng, lambda lines, first, second: lines.insert(second, lines[first]))


def _drop(data, rng):
    return _lines(data, rng, lambda lines, first, _: lines.pop(first))


def _retype(data, rng):
    def change(lines, first, _):
        lines[first] = lines[first].partition(b"=")[0] + b"= " + VALUES[rng.integers(len(VALUES))]

    return _lines(data, rng, change)


def _rename(data, rng):
    def change(lines, first, _):
        name = (b"color", b'"\\u001b[31m"', b"a." * rng.integers(1, 5000) + b"a", b"''", b'"x y"', b"mass", b"kind")[
            rng.integers(7)
        ]
        lines[first] = name + b" =" + lines[first].partition(b"=")[2]

    return _lines(data, rng, change)


def _unquote(data, rng):
    return _lines(data, rng, lambda lines, first, _: lines.__setitem__(first, lines[first].replace(b'"', b"")))


def _encode(data, rng):
    return data.decode("utf-8", "replace").encode(ENCODINGS[rng.integers(len(ENCODINGS))], "replace")


def _end_lines(data, rng):
    return data.replace(b"\n", (b"\r\n", b"\r", b"\n\n", b"\x0b", b"\x85")[rng.integers(5)])


def _mark(data, _):
    return b"\xef\xbb\xbf" + data


DAMAGES = (
    _cut,
    _flip,
    _flip,
    _insert,
    _insert,
    _swap_keys,
    _double,
    _drop,
    _retype,
    _retype,
    _retype,
    _rename,
    _unquote,
)
DAMAGES += (_encode, _end_lines, _mark)


def assert_printable(text, most=21):
    lines = text.split("\n")
    assert 1 <= len(lines) <= most
    for line in lines:
        assert line.isprintable()
        assert " = " in line or "more errors" in line


# ------------------------------------------------------------------------------------------ files


@pytest.mark.parametrize("example", ["keogh-cole.toml", "source-paper.toml"])
def test_damaged_machine_files_are_read_or_refused(tmp_path, example):
    rng, path, accepted = np.random.default_rng([1, len(example)]), tmp_path / "m.toml", 0
    whole = (EXAMPLES / example).read_bytes()
    for number in range(CASES // 2):
        path.write_bytes(damaged(whole, rng))
        try:
            case = load(path)
        except InputError as problem:
            assert_printable(str(problem))
            continue
        accepted += 1
        assert case.name == "m", number

    assert CASES // 50 <= accepted <= CASES // 3


@pytest.mark.parametrize("example", ["sweep-contact.toml", "sweep-gains.toml", "sweep-speed.toml"])
def test_damaged_sweep_files_are_read_or_refused(tmp_path, example):
    rng, path, accepted = np.random.default_rng([2, len(example)]), tmp_path / "s.toml", 0
    whole = (EXAMPLES / example).read_bytes()
    for machine in EXAMPLES.glob("*.toml"):
        (tmp_path / machine.name).write_bytes(machine.read_bytes())
    for _ in range(CASES // 2):
        path.write_bytes(damaged(whole, rng))
        try:
            load_sweep(path)
        except InputError as problem:
            assert_printable(str(problem))
            continue
        accepted += 1

    assert CASES // 50 <= accepted <= CASES // 3


# ------------------------------------------------------------------------------------------ options

LINES = (
    ("orbits", "MACHINE", "--longest-period", "25 ms"),
    ("orbits", "MACHINE", "--set", "damping=2000 N s/m"),
    ("orbits", "MACHINE", "--set", "gamma=0.1"),
    ("simulate", "MACHINE", "--start", "0.3 mm,0,5 mm/s,0.1", "--until", "2 s"),
    ("simulate", "MACHINE", "--kick", "50 mm/s,30 deg"),
    ("basins", "MACHINE", "--kick", "50 mm/s", "--grid", "60x60"),
    ("basins", "MACHINE", "--shock", "20 g, 5 ms", "--starts", "1000"),
    (
        "basins",
        "MACHINE",
        "--gains",
        "16x16",
        "--plane",
        "stiffness,damping",
        "--x",
        "5e5 N/m,2e6 N/m",
    ),
    ("bifurcations", "MACHINE", "--along", "speed", "--from", "3000 rpm", "--to", "1000 rpm"),
    ("regions", "MACHINE", "--plane", "speed,damping", "--x", "100 rad/s,300 rad/s", "--y", "500 N s/m,4000 N s/m"),
)


@pytest.fixture
def nothing_computed(monkeypatch):
    """Commands end with exit code 0 where they would begin to compute."""

    def accepted(*_, **__):
        raise typer.Exit(0)

    for home, name in (
        ("motions.simulation", "simulate"),
        ("basins", "map_basins"),
        ("closed_forms.equilibria", "find_equilibria"),
        ("bifurcations", "find_bifurcations"),
        ("bifurcations", "map_regions"),
    ):
        monkeypatch.setattr(import_module(f"carom.{home}"), name, accepted)


EVIL = "\x1b[31m\u202e\n\x07\x9b\u2028"


@pytest.mark.usefixtures("nothing_computed")
@pytest.mark.parametrize("line", LINES, ids=" ".join)
def test_no_control_character_of_an_option_is_told(carom, machine, line):
    for place in range(len(line)):
        words = [machine if word == "MACHINE" else word for word in (*line[:place], EVIL, *line[place + 1 :])]
        code, out, err = carom(*words)
        assert (code, out) == (2, ""), words
        assert err.endswith("\n")
        assert err[:-1].isprintable()


@pytest.mark.usefixtures("nothing_computed")
def test_damaged_options_are_accepted_or_refused(carom, machine, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rng, accepted = np.random.default_rng(3), 0
    for number in range(CASES):
        words = list(LINES[number % len(LINES)])
        place = rng.integers(2, len(words))
        words[place] = damaged(words[place].encode(), rng).decode("utf-8", "surrogateescape")
        code, out, err = carom(*(machine if word == "MACHINE" else word for word in words))

        assert (code, out) in ((0, ""), (2, "")), words
        accepted += code == 0
        if code == 0:
            assert err == ""
        else:
            assert err.endswith("\n")
            for line in err[:-1].split("\n"):
                assert line.isprintable()
                assert line.startswith("carom: ")
            assert "carom: unexpected" not in err

    assert list(tmp_path.iterdir()) == []
    assert CASES // 50 <= accepted <= CASES // 2


# ------------------------------------------------------------------------------------------ processes


def test_main_refuses_a_file_named_in_another_encoding(tmp_path, capsys):
    """As a system may hand it over: with a byte that is no UTF-8."""
    assert main(["orbits", str(tmp_path / "\udcff\x1b.toml")]) == 2
    assert capsys.readouterr().err[:-1].isprintable()
