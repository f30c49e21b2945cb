"""Results as text: short however large they are, and true."""

import dataclasses
import enum
import pkgutil
from importlib import import_module

import numpy as np
import pytest

import carom
from carom.base.results import WIDEST, Result, in_a_line, in_si, record


class Colour(enum.Enum):
    DARK_RED = 1


@dataclasses.dataclass(frozen=True)
class Pair:
    name: str
    size: float
    rule: object = None


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Found(Result):
    name: str
    values: np.ndarray
    pairs: tuple[Pair, ...]
    call: object = len

    def __len__(self):
        return len(self.pairs)


FOUND = Found("<one>", np.arange(1e6), (Pair("a", 1.0), Pair("b", 2.0)))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "none"),
        (True, "yes"),
        (12, "12"),
        (1.0 / 3.0, "0.333333"),
        (1.5 - 0.25j, "1.5-0.25i"),
        ("many\n words", "many words"),
        (Colour.DARK_RED, "dark red"),
        (np.array([]), "empty"),
        (np.array([1.0, 2.5]), "1, 2.5"),
        (np.arange(12).reshape(3, 4), "3 x 4 numbers from 0 to 11"),
        (np.array([np.nan, 1.0, 2.0, np.inf, 3.0]), "5 numbers from 1 to 3"),
        (np.full(7, np.nan), "7 numbers, none finite"),
        (np.ones(9, complex), "9 complex numbers"),
        ((), "none"),
        ((0.1, 0.2), "0.1, 0.2"),
        (tuple(range(6)), "6: 0, 1, 2, 3, 4, 5"),
        ({"lost": 0.25, "kept": 0.75}, "lost 0.25, kept 0.75"),
        (Pair("a", 2.0), "Pair(name=a, size=2)"),
        ((Pair("a", 2.0), Pair("b", 1.0)), "a, b"),
        ((np.ones(2), np.ones(3)), "2 of ndarray"),
        (FOUND, "Found of 2"),
    ],
    ids=str,
)
def test_a_value_takes_one_line(value, text):
    assert in_a_line(value) == text


def test_long_text_is_cut():
    text = in_a_line("x" * 1000)
    assert len(text) == WIDEST
    assert text.endswith("…")


def test_a_result_lists_its_attributes():
    assert repr(FOUND).splitlines() == [
        "Found",
        "  name    <one>",
        "  values  1000000 numbers from 0 to 999999",
        "  pairs   a, b",
    ]


def every_result():
    modules = [
        module.name for module in pkgutil.walk_packages(carom.__path__, "carom.") if "__main__" not in module.name
    ]
    for module in modules:
        for value in vars(import_module(module)).values():
            if isinstance(value, type) and issubclass(value, Result) and value.__module__ == module:
                yield value


def test_no_result_falls_back_to_the_text_of_a_dataclass():
    found = list(every_result())
    assert len(found) > 40
    for kind in found:
        assert kind.__repr__ is Result.__repr__, kind
        assert all(hasattr(kind, name) or name in {f.name for f in dataclasses.fields(kind)} for name in kind.shown), (
            kind
        )


def test_speeds_and_times_of_a_machine_in_si_units_are_told_beside_the_numbers():
    machine = carom.load("examples/keogh-cole.toml")
    orbits = carom.find_orbits(machine)
    orbit = orbits["B1,d"]
    # 0.7 mm times 184.2 rad/s
    period, speed = f"{orbit.period / 0.1842:.3g} ms", f"{0.7 * 184.2 * orbit.radial_speed:.3g} mm/s"

    assert f"period {orbit.period:.6g} ({period}), radial speed {orbit.radial_speed:.6g} ({speed})" in repr(orbits)
    assert f"period         {orbit.period:.6g} ({period})\n" in repr(orbit)
    assert f"radial_speed   {orbit.radial_speed:.6g} ({speed})\n" in repr(orbit)
    assert "  time              100 (543 ms)\n" in repr(carom.simulate(machine, carom.kick(0.8), 100.0))
    diagram = carom.find_bifurcations(machine, "speed", ("1700 rpm", "1800 rpm"))
    assert "from 1700 to 1800 rpm" in repr(diagram)
    assert "1725.31 rpm  boundary-equilibrium, levitation" in repr(diagram)


def test_a_machine_shows_what_its_file_says_and_what_follows():
    case = carom.load("examples/tum-test-rig.toml", ["friction=0.2"])
    text = repr(case)
    assert "  radius of the clearance circle               0.39 mm (given as diametral_clearance = 0.78 mm)\n" in text
    assert repr(case.machine).splitlines()[1:] == text.splitlines()[1 : len(repr(case.machine).splitlines())]
    assert "speed                1,758.98 rpm (given as 184.2 rad/s)" in repr(carom.load("examples/keogh-cole.toml"))
    plain = repr(carom.load("examples/source-paper.toml"))
    assert "scaled damping                0.1\n" in plain
    assert "units of the equations" not in plain


def test_numbers_of_a_document_have_twins_in_si_units_where_the_machine_is_known():
    scales = carom.parameters.Scales(2.0, 1e-3, 100.0)
    document = {"radius": 0.5, "found": None, "bracket": [None, 3.0], "name": "x"}
    twins = in_si(document, scales, radius="length", found="velocity", bracket="time")
    assert twins == {"radius_si": 0.5 * scales.length, "found_si": None, "bracket_si": [None, 3.0 * scales.time]}
    assert in_si(document, None, radius="length") == {}
    assert record(scales, "mass unit=velocity size=length.real") == {"mass": 2.0, "unit": 0.1, "size": 1e-3}
