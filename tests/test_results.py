"""Results as text: short however large they are, and true."""

from __future__ import annotations

import dataclasses
import enum
import pkgutil
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from machines import PAPER

import carom
from carom.base.outcome import InputError
from carom.base.results import WIDEST, Result, fields_of, in_a_line, in_si
from carom.parameters.formats import format_along


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


FEW = carom.Grid(carom.disturbances.VelocityKick(0.5), (2, 3))
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


def test_sizes_of_whatever_is_found_are_told_in_si_units():
    machine = carom.load("examples/keogh-cole.toml")
    motion = carom.simulate(machine, carom.kick("150 mm/s", "30 deg"), until="0.5 s")
    loudest = motion.contacts.normal_impulse.max()
    assert "(-0.568-0.352i mm), velocity=1.00747+0.581666i (130+75i mm/s)" in repr(motion)  # 150 mm/s at 30 degrees
    assert f"to {loudest:.6g} (" in repr(motion.contacts)
    assert f"to {loudest * 50 * 0.7e-3 * 184.2:.3g} N s)" in repr(motion.contacts)
    assert "normal force 0.758533 (901 N)" in repr(carom.find_equilibria(machine))
    assert "  position       0.896512-0.443019i (0.628-0.31i mm)\n" in repr(carom.find_equilibria(machine)[1])
    kicks = carom.disturbances.VelocityKick.of(machine, "100 mm/s")
    lost = carom.basins.smallest_unrecovered(machine, kicks)
    assert "  largest          0.775555 (100 mm/s)" in repr(lost)
    assert f"  size             {lost.size:.6g} ({lost.size * 0.7 * 184.2:.3g} mm/s)" in repr(lost)
    assert carom.base.results.in_a_line(lost).startswith(f"smallest that does not come back {lost.size:.6g} (5.4")
    blade = carom.basins.smallest_unrecovered(machine, carom.disturbances.BladeLoss(0.5))
    assert "  largest          0.5 (17,500 g mm)" in repr(blade)  # half of 50 kg times 0.7 mm
    ending = carom.find_attractors(machine, carom.disturbances.Sample(kicks, 1), known=False).endings[0]
    assert f"  time       {ending.time:.6g} ({round(ending.time / 0.1842, -1):,.0f} ms)\n" in repr(
        ending
    )  # some 3,000 ms
    basin = carom.map_basins(machine, carom.Grid(kicks, (4, 6)))
    assert repr(basin.share_recovered).startswith("<Share: ")
    assert "c 1,400 N s/m, k 980,000 N/m, e_c 0.3 mm, c_r 0.7 mm, R 40 mm, Ω 1,759 rpm" in repr(basin)
    assert "γ 0.1, ω 0.76" in repr(carom.find_orbits(carom.load("examples/source-paper.toml")))


def test_ranges_are_told_in_the_units_of_people():
    machine = carom.load("examples/keogh-cole.toml")
    plane = carom.bifurcations.Plane("gamma", "speed", (0.1, 0.2), ("1700 rpm", "1850 rpm"))
    assert in_a_line(plane) == "gamma 0.1 to 0.2, speed 1,700 to 1,850 rpm"
    scales = machine.parameters.scales
    # 50 kg times 184.2 rad/s
    assert format_along("gamma", (0.1, 0.2), scales) == "damping 921 to 1,842 N s/m"
    gains = carom.map_gains(machine, FEW, ("stiffness", "damping"), shape=(2, 2))
    assert "plane          stiffness 490,000 to 1,960,000 N/m, damping 700 to 2,800 N s/m\n" in repr(gains)
    assert "present        stiffness 980,000 N/m, damping 1,400 N s/m\n" in repr(gains)
    (point, *_) = carom.find_bifurcations(machine, "speed", ("1700 rpm", "1800 rpm")).points
    assert "  value         1,725.31 rpm\n" in repr(point)
    curve = carom.continue_curve(
        point, carom.bifurcations.Plane("damping", "speed", (500.0, 2000.0), ("1700 rpm", "1850 rpm"))
    )
    assert f"  points         {len(curve.points)}, damping 5" in repr(curve)
    assert " N s/m, speed 1,7" in repr(curve)


def test_along_a_scale_of_the_machine_sizes_are_not_told_in_the_units_of_one_of_them():
    orbit = carom.find_orbits(carom.load("examples/keogh-cole.toml"))["B1,d"]
    slower = carom.continue_orbit(orbit, "speed", ("1740 rpm", "1780 rpm"))
    assert f"values        {len(slower)} from 1,740 to 1,780 rpm\n" in repr(slower)
    assert " ms)" not in repr(slower)
    assert " ms)" in repr(carom.continue_orbit(orbit, "damping", ("1300 N s/m", "1500 N s/m")))


def test_a_machine_shows_what_its_file_says_and_what_follows():
    case = carom.load("examples/tum-test-rig.toml", ["friction=0.2"])
    text = repr(case)
    assert (
        "  damping of the levitation                    500 N s/m (γ = 1.458; given as derivative_gain = 5 A s/m)\n"
        in text
    )
    assert "  radius of the clearance circle               0.39 mm (given as diametral_clearance = 0.78 mm)\n" in text
    assert "  coefficient of friction                      0.2\n" in text
    assert "kicks up to 124 mm/s (default: impact speed of a free fall across the clearance)" in text
    assert "1/Ω = 9.55 ms" in text  # 1,000 rpm
    assert repr(case.machine).splitlines()[1:] == text.splitlines()[1 : len(repr(case.machine).splitlines())]
    assert "speed                1,758.98 rpm (given as 184.2 rad/s)" in repr(carom.load("examples/keogh-cole.toml"))
    plain = repr(carom.load("examples/source-paper.toml"))
    assert "scaled damping                0.1\n" in plain
    assert "units of the equations" not in plain


def test_a_machine_shows_what_is_stated_of_its_bearing(tmp_path):
    file = tmp_path / "<b>.toml"
    stated = '[limits]\nimpulse = "5 N s"\nimpacts = 20\n[survive]\nkick = "50 mm/s"\nshock = "5 g, 11 ms"\nblade_loss = "2000 g mm"\n'
    file.write_text(Path("examples/keogh-cole.toml").read_text("utf-8") + stated, "utf-8")
    case = carom.load(file)
    assert "normal impulse of an impact 5 N s, impacts of a touchdown 20\n" in repr(case)
    assert "kicks up to 50 mm/s; shocks up to 5 g, 11 ms; a loss of a blade of 2,000 g mm\n" in repr(case)
    with pytest.raises(InputError, match=r"^found = Case <b>: an AttractorSet$"):
        carom.basins.share_of_kicks(case)


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


def test_numbers_of_a_document_have_twins_in_si_units_where_the_machine_is_known():
    scales = carom.parameters.Scales(2.0, 1e-3, 100.0)
    document = {"radius": 0.5, "found": None, "bracket": [None, 3.0], "name": "x"}
    twins = in_si(document, scales, "radius", found="velocity", bracket="time")
    assert twins == {"radius_si": 0.5 * scales.length, "found_si": None, "bracket_si": [None, 3.0 * scales.time]}
    assert in_si(document, None, "radius", found="velocity") == {}
    assert fields_of(scales, "mass", unit="velocity", size="length.real") == {"mass": 2.0, "unit": 0.1, "size": 1e-3}
