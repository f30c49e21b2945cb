"""Altered machine files and odd arguments: each is read, or refused in lines that can be printed; nothing else comes out."""

from __future__ import annotations

import random
import re
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest
from compilation import sized

import carom as cm
from carom.base.outcome import CaromError, InputError

FILES = [
    path for path in sorted(Path("examples").glob("*.toml")) if "sweep" not in path.stem and "flexible" not in path.stem
]
VALUES = (
    "0",
    "-1",
    "1e308",
    "nan",
    "-inf",
    '""',
    '"0"',
    '"1e400 m"',
    '"5 um"',
    '"7 kg"',
    "true",
    "[1, 2]",
    "{}",
    '"\\u0000"',
    '"1,5 mm"',
)
UNITS = ("mm", "um", "m", "s", "kg", "N/m", "rpm", "deg", "N s/m", "%")
FACTORS = (1e-12, 1e-3, 0.1, 10.0, 1e3, 1e12)


def changed(name: str, value: str, chance: random.Random) -> str:
    """A line that is different."""
    line = f"{name}={value}"
    factor, unit = chance.choice(FACTORS), chance.choice(UNITS)
    return chance.choice(
        (
            f"{name}= {chance.choice(VALUES)}",
            f"{name}={re.sub('[0-9][0-9.]*', lambda found: repr(float(found[0].rstrip('.')) * factor), value, count=1)}",
            re.sub('(?<=[0-9] )[^0-9"]+(?=")', unit, line),
            "",
            f"{line}\n{line}",
            line[: chance.randrange(len(line))] + chance.choice("[]{}=.#"),
        )
    )


def altered(text: str, chance: random.Random) -> str:
    """A machine file of which one or two lines are different."""
    lines = text.split("\n")
    for _ in range(chance.choice((1, 2))):
        place = chance.choice([number for number, line in enumerate(lines) if re.match("[a-z_]+ *= .*[0-9]", line)])
        name, _, value = lines[place].partition("=")
        lines[place] = changed(name, value, chance)
    return "\n".join(lines)


@pytest.mark.filterwarnings("ignore::carom.base.outcome.CaromWarning")
def test_altered_machine_files_are_read_or_refused(tmp_path):
    chance, outcomes, told = random.Random(1), [], []
    for number in range(sized(200, 200, 6000)):
        (tmp_path / "machine.toml").write_text(altered(FILES[number % len(FILES)].read_text("utf-8"), chance), "utf-8")
        try:
            outcomes.append(cm.load(tmp_path / "machine.toml").parameters is not None)
        except InputError as problem:
            outcomes.append(False)
            told += str(problem).split("\n")
    assert all(map(str.isprintable, told))
    assert 0.1 < np.mean(outcomes) < 0.9


ODD = (
    -1,
    1e300,
    float("nan"),
    1j,
    "",
    "50 mm/s",
    None,
    True,
    [],
    (0.1, 0.2),
    np.zeros((2, 2)),
    np.ma.masked,
    {},
    object(),
    b"x",
)


@pytest.mark.parametrize(
    "name",
    [
        "load",
        "kick",
        "drop",
        "find_equilibria",
        "BaseShock",
        "Grid",
        "open_sweep",
        "continue_orbit",
        "map_basins",
        "settle",
        "attractors.MotionName.of",
        "parameters.Numbers.of",
        "parameters.Parameters.from_attributes",
    ],
)
def test_odd_arguments_are_refused(name):
    """None of these is a machine, a file, or a size of anything."""
    for value in ODD:
        try:
            attrgetter(name)(cm)(value)
        except (CaromError, TypeError):  # of arguments that are missing
            continue
