"""Results as text: short however large they are, and true."""

from __future__ import annotations

import dataclasses
import enum
import pkgutil
from importlib import import_module

import numpy as np
import pytest
from machines import PAPER

import carom
from carom.results import WIDEST, Result, in_a_line


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
        (np.bool_(False), "no"),
        (12, "12"),
        (np.int64(-3), "-3"),
        (1.0 / 3.0, "0.333333"),
        (1.5 - 0.25j, "1.5-0.25i"),
        ("many\n words", "many words"),
        (Colour.DARK_RED, "dark red"),
        (np.array([]), "empty"),
        (np.array([1.0, 2.5]), "1, 2.5"),
        (np.array([True, False]), "yes, no"),
        (np.arange(12).reshape(3, 4), "3 x 4 numbers from 0 to 11"),
        (np.array([np.nan, 1.0, 2.0, np.inf, 3.0]), "5 numbers from 1 to 3"),
        (np.full(7, np.nan), "7 numbers, none finite"),
        (np.ones(9, complex), "9 complex numbers"),
        (np.array(["a"] * 5), "5 values"),
        ((), "none"),
        ((0.1, 0.2), "0.1, 0.2"),
        (tuple(range(6)), "6: 0, 1, 2, 3, 4, 5"),
        ({"lost": 0.25, "kept": 0.75}, "lost 0.25, kept 0.75"),
        ({}, "none"),
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


def test_in_a_notebook_it_is_a_table_without_markup_from_names():
    html = FOUND._repr_html_()
    assert html.startswith("<table><caption>Found</caption>")
    assert "&lt;one&gt;" in html
    assert "<one>" not in html


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


def test_text_of_what_is_found_is_short():
    orbits = carom.find_orbits(PAPER)
    motion = carom.simulate(PAPER, carom.kick(0.8), 100.0)
    diagram = carom.find_bifurcations(PAPER, "gamma", (0.06, 0.2))
    endings = carom.settle(PAPER, np.full(5, 0.1j), np.linspace(0.0, 1.0, 5) + 0j)
    for result in (
        orbits,
        *orbits,
        motion,
        motion.contacts,
        diagram,
        endings,
        *diagram.orbits,
        carom.find_equilibria(PAPER)[0],
    ):
        text = repr(result)
        assert text.startswith(type(result).__name__)
        assert len(text.splitlines()) <= 20
        assert max(map(len, text.splitlines())) <= WIDEST + 40
        assert "object at 0x" not in text
    last = orbits["B1,d"]
    words = f"B1,d      period {last.period:.6g}, radial speed {last.radial_speed:.6g}, stable, admissible"
    assert words in repr(orbits)
    assert "period-doubling, B1,d" in repr(diagram)
    assert repr(endings).splitlines()[1] == "  motions   5"
