"""Random machine files in all terms and odd spellings: refused in printable lines, or the machine computed independently."""

import math

import mpmath
import numpy as np
import pytest
from compilation import sized

from carom.base.outcome import InputError
from carom.loading import load
from carom.parameters import Machine

CASES = sized(40, 40, 2000)
TAU = "tau"
# Per name: units with their size in SI units (of a balance grade: in mm/s), and the range of sensible values there.
UNITS = {
    "mass": ({"kg": "1", "g": "1e-3", "t": "1e3", "": "1", "lb": "0.45359237", "kilogram": "1"}, (0.1, 1e4)),
    "damping": ({"N s/m": "1", "N·s/m": "1", "N-s/m": "1", "kg/s": "1", "N s/mm": "1e3", "": "1"}, (1, 1e5)),
    "stiffness": ({"N/m": "1", "N/mm": "1e3", "kN/mm": "1e6", "MN/m": "1e6", "": "1"}, (1e4, 1e8)),
    "eccentricity": ({"mm": "1e-3", "µm": "1e-6", "um": "1e-6", "m": "1", "": "1", "g mm/kg": "1e-6"}, (1e-6, 1e-4)),
    "clearance": ({"mm": "1e-3", "µm": "1e-6", "m": "1", "inch": "0.0254", "": "1"}, (5e-5, 2e-3)),
    "rotor_radius": ({"mm": "1e-3", "cm": "1e-2", "m": "1", "in": "0.0254", "": "1"}, (5e-3, 0.5)),
    "speed": (
        {
            "rpm": "tau/60",
            "Hz": "tau",
            "kHz": "1000*tau",
            "rev/s": "tau",
            "RPM": "tau/60",
            "rev/min": "tau/60",
            "rad/s": "1",
            "r/min": "tau/60",
            "deg/s": "tau/360",
        },
        (50, 5e3),
    ),
    "unbalance_phase": ({"rad": "1", "deg": "tau/360", "°": "tau/360", "": "1"}, (0.01, 6)),
    "friction": ({"": "1", "%": "0.01"}, (0.01, 0.5)),
    "restitution": ({"": "1", "%": "0.01"}, (0.1, 1)),
    "unbalance": (
        {"g mm": "1e-6", "g·mm": "1e-6", "g-mm": "1e-6", "kg m": "1", "kg mm": "1e-3", "gmm": "1e-6"},
        (1e-6, 1e-2),
    ),
    "balance_grade": ({"mm/s": "1", "": "1", "m/s": "1e3", "G": "1"}, (0.4, 4000)),
    "rated_speed": ({"rpm": "tau/60", "Hz": "tau", "rad/s": "1"}, (50, 5e3)),
    "rotor_diameter": ({"mm": "1e-3", "m": "1", "in": "0.0254"}, (1e-2, 1)),
    "diametral_clearance": ({"mm": "1e-3", "µm": "1e-6", "": "1"}, (1e-4, 4e-3)),
    "natural_frequency": ({"Hz": "tau", "rad/s": "1", "rpm": "tau/60", "kHz": "1000*tau"}, (50, 5e3)),
    "damping_ratio": ({"": "1", "%": "0.01"}, (1e-3, 2)),
    "proportional_gain": ({"A/m": "1", "A/mm": "1e3", "mA/µm": "1e3", "": "1"}, (1e3, 1e5)),
    "derivative_gain": ({"A s/m": "1", "As/m": "1", "A·s/m": "1", "mA s/mm": "1", "": "1"}, (1, 100)),
    "force_current_factor": ({"N/A": "1", "kN/A": "1e3", "": "1"}, (20, 500)),
    "negative_stiffness": ({"N/m": "1", "N/mm": "1e3", "": "1"}, (1e3, 1e6)),
    "magnetic_bearings": ({"": "1"}, (1, 4)),
    "force_limit": ({"N": "1", "kN": "1e3"}, (10, 1e4)),
    "current_limit": ({"A": "1", "mA": "1e-3"}, (1, 50)),
}
WAYS = {
    "mass": ("mass",),
    "clearance": ("clearance", "diametral_clearance"),
    "speed": ("speed",),
    "stiffness": ("stiffness", "natural_frequency", "proportional_gain"),
    "damping": ("damping", "damping_ratio", "derivative_gain"),
    "eccentricity": ("eccentricity", "unbalance", "balance_grade"),
    "rotor_radius": ("rotor_radius", "rotor_diameter"),
    "unbalance_phase": ("unbalance_phase",),
    "friction": ("friction",),
    "restitution": ("restitution",),
}
HELPERS = [name for name in UNITS if not any(name in ways for ways in WAYS.values())]
ODD = (
    "",
    " ",
    "nan",
    "-1",
    "1e999 m",
    "G",
    "g 2.5",
    "1,5 mm",
    "0,3",
    "3 Bq",
    "3 1/s",
    "five",
    "G 2.5 G",
    "12 00 rpm",
    "°",
    "3 m**9**9",
)
ODD += (
    "\u202e3 mm",
    "1_000 N",
    "٣ mm",
    "0x10",
    "3 (mm",
    "--3 mm",
    "1e400",
    "3 rad",
    "3 dB",
    "20 degC",
    "1'00 mm",
    "1.000.000 rpm",
)


def size_of(unit):
    """Size of a unit as an exact rational, perhaps times a full turn."""
    with mpmath.workprec(300):
        value = mpmath.mpf(1)
        factor, *rest = unit.replace("1000*tau", "tau*1000").split("*")
        for part in (factor, *rest):
            top, _, bottom = part.partition("/")
            value *= 2 * mpmath.mp.pi if top == TAU else mpmath.mpf(top)
            value /= mpmath.mpf(bottom) if bottom else 1
        return value


def spelled(rng, name):
    """A random value as text, and the number that it means with 300 bits."""
    units, (low, high) = UNITS[name]
    unit = str(rng.choice(list(units)))
    size = size_of(units[unit])
    wanted = float(math.exp(rng.uniform(math.log(low), math.log(high))) / size)
    if name == "magnetic_bearings":
        wanted = rng.integers(1, 5)
    digits = (
        f"{wanted:.{rng.integers(1, 12)}g}" if rng.random() < 0.7 or name == "magnetic_bearings" else f"{wanted:.6f}"
    )
    if name in ("friction", "restitution") and float(digits) * float(size) > 1:
        digits = "0.5"
    with mpmath.workprec(300):
        number = mpmath.mpf(digits) * size
    whole, _, rest = digits.partition(".")
    if len(whole) > 3 and whole.isdigit() and rng.random() < 0.7:
        gap = str(rng.choice([" ", "'", "\u202f", "\u00a0", "’"]))
        if unit in ("rpm", "r/min") and rng.random() < 0.5:
            gap = ","
        head = len(whole) % 3
        groups = [whole[:head]] * bool(head) + [whole[at : at + 3] for at in range(head, len(whole), 3)]
        digits = gap.join(groups) + ("." + rest if rest else "")
    if unit == "G":
        return f"G{rng.choice(['', ' '])}{digits}", number
    return f"{digits}{rng.choice(['', ' ', '  ']) if unit else ''}{unit}", number


def double(number):
    """The nearest double, as a number of 300 bits."""
    with mpmath.workprec(300):
        return mpmath.mpf(repr(float(number)))


def computed(numbers):
    """Fields of the machine by formulas of this test, each the nearest double."""
    with mpmath.workprec(300):
        n = double(numbers.get("magnetic_bearings", mpmath.mpf(1)))
        m, speed = double(numbers["mass"]), double(numbers["speed"])
        factor, pull = (double(numbers.get(name, 0)) for name in ("force_current_factor", "negative_stiffness"))
        found = {name: numbers[name] for name in ("friction", "restitution")}
        found |= {"mass": m, "speed": speed, "unbalance_phase": numbers.get("unbalance_phase", 0)}
        half = {"clearance": "diametral_clearance", "rotor_radius": "rotor_diameter"}
        found |= {name: numbers[name] if name in numbers else numbers[twice] / 2 for name, twice in half.items()}
        if "natural_frequency" in numbers:
            found["stiffness"] = m * numbers["natural_frequency"] ** 2
        elif "proportional_gain" in numbers:
            found["stiffness"] = n * (factor * numbers["proportional_gain"] - pull)
        else:
            found["stiffness"] = numbers["stiffness"]
        if "damping_ratio" in numbers:
            found["damping"] = 2 * numbers["damping_ratio"] * mpmath.sqrt(double(found["stiffness"]) * m)
        else:
            gain = n * factor * numbers.get("derivative_gain", 0)
            found["damping"] = numbers.get("damping", gain)
        if "unbalance" in numbers:
            found["eccentricity"] = numbers["unbalance"] / m
        elif "balance_grade" in numbers:
            found["eccentricity"] = numbers["balance_grade"] / 1000 / double(numbers.get("rated_speed", speed))
        else:
            found["eccentricity"] = numbers["eccentricity"]
        return {name: float(value) for name, value in found.items()}


def chosen(rng):
    """Names of a file: mostly one way for each field with what it needs, sometimes too many or too few."""
    names = [str(rng.choice(ways)) for ways in WAYS.values()]
    gains = {"proportional_gain", "derivative_gain"} & set(names)
    if gains or rng.random() < 0.2:
        names += ["force_current_factor", "negative_stiffness"]
        names += [name for name in ("current_limit",) if rng.random() < 0.3]
    if rng.random() < 0.2:
        names.append("force_limit")
    if {"force_current_factor", "force_limit"} & set(names) and rng.random() < 0.5:
        names.append("magnetic_bearings")
    if "balance_grade" in names and rng.random() < 0.5:
        names.append("rated_speed")
    if rng.random() < 0.2:
        names.remove("unbalance_phase")
    sound = True
    if rng.random() < 0.25:
        sound = False
        for _ in range(rng.integers(1, 3)):
            if rng.random() < 0.5:
                names.append(str(rng.choice(list(UNITS))))
            else:
                names.pop(rng.integers(len(names)))
    return list(dict.fromkeys(rng.permutation(names).tolist())), sound


def read(path, settings):
    """The machine of a file, or the error, which is printable line by line."""
    try:
        return load(path, settings).machine, None
    except InputError as problem:
        lines = str(problem).split("\n")
        assert len(lines) <= 21
        assert all(line.isprintable() and " = " in line for line in lines)
        return None, str(problem)


def test_random_files_are_refused_in_lines_or_are_the_machine_computed_independently(tmp_path):
    rng = np.random.default_rng(35)
    path, accepted, refused = tmp_path / "random.toml", 0, 0
    for _ in range(CASES):
        names, sound = chosen(rng)
        spelling = {name: spelled(rng, name) for name in names}
        texts = {name: text for name, (text, _) in spelling.items()}
        odd = rng.random() < 0.15
        if odd:
            texts[str(rng.choice(names))] = str(rng.choice(ODD))
        content = "".join(f"{name} = '''{text}'''\n" for name, text in texts.items())
        path.write_text(f"[machine]\n{content}", encoding="utf-8")
        machine, problem = read(path, [])
        if machine is None:
            refused += 1
            ranges = any(
                words in problem
                for words in ("gives rho", "gives gamma", "gives omega", "gives radius_ratio", "gives stiffness")
            )
            assert odd or not sound or ranges, (problem, content)
            continue
        accepted += 1
        if odd:
            continue  # the test below says which of them are read as what they say
        expected = computed({name: number for name, (_, number) in spelling.items()})
        assert {name: getattr(machine, name) for name in expected} == expected, content
        path.write_text(machine.to_toml(), encoding="utf-8")
        assert load(path).machine == machine
        settings_are_the_machine_they_say(rng, path, machine)
    assert accepted > CASES // 3
    assert refused > CASES // 10


def settings_are_the_machine_they_say(rng, path, machine):
    """One random setting moves what it sets and what follows from it, and nothing else; or it is refused in a line."""
    name = str(rng.choice(list(UNITS)))
    text, number = spelled(rng, name)
    after, _ = read(path, [f"{name}={text}"])
    if after is None:
        return
    fields = [field for field, ways in WAYS.items() if name in ways]
    moved = {field for field in WAYS if getattr(after, field) != getattr(machine, field)}
    if fields:
        assert moved <= set(fields)
        kept = {field: double(getattr(machine, field)) for field in WAYS if field not in fields}
        bearing = {key: getattr(machine, key) for key in HELPERS[1:]}
        kept |= {key: double(value) for key, value in bearing.items() if value is not None}
        if "rated_speed" in machine.given.get("eccentricity", {}):
            return
        expected = computed({**kept, name: number})
        assert getattr(after, fields[0]) == expected[fields[0]]
    elif name.endswith("limit"):
        assert not moved
    else:
        assert moved <= {"stiffness", "damping", "eccentricity"}


@pytest.mark.parametrize("name", UNITS)
def test_odd_texts_are_read_as_what_they_say_or_refused(name):
    entries = {field: spelled(np.random.default_rng(1), field)[0] for field in WAYS}
    field = next((field for field, ways in WAYS.items() if name in ways), None)
    entries = {key: value for key, value in entries.items() if key != field}
    entries |= {"force_current_factor": "90 N/A", "negative_stiffness": "1e5 N/m"}
    if name == "rated_speed":
        del entries["eccentricity"]
        entries["balance_grade"] = "G 2.5"
    for text in ODD:
        # The only odd texts that say something: an angle, and a number below zero as one.
        if name == "unbalance_phase" and text in ("-1", "3 rad"):
            Machine(**{**entries, name: text})
            continue
        with pytest.raises(InputError) as caught:
            Machine(**{**entries, name: text})
        assert all(line.isprintable() for line in str(caught.value).split("\n"))
