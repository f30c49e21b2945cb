"""Values in the terms of a machine's file."""

import math

import numpy as np
import pytest
from compilation import sized

from carom.base.outcome import InputError
from carom.loading import load
from carom.parameters import Case, Machine, Zones, in_terms_of

REAL, PAPER, RIG = (f"examples/{name}.toml" for name in ("keogh-cole", "source-paper", "tum-test-rig"))
REST = {"mass": "50 kg", "speed": "1759 rpm", "friction": 0.15, "restitution": 0.95}
BEARINGS = {"magnetic_bearings": 2, "force_current_factor": "70 N/A", "negative_stiffness": "210 N/mm"}
WAYS = {
    "stiffness": (
        {"stiffness": "980 N/mm"},
        {"natural_frequency": "22 Hz"},
        {"proportional_gain": "10 A/mm", **BEARINGS},
    ),
    "damping": ({"damping": 1400}, {"damping_ratio": "10 %"}, {"derivative_gain": "10 A s/m", **BEARINGS}),
    "eccentricity": (
        {"eccentricity": "0.3 mm"},
        {"unbalance": "9 kg mm"},
        {"balance_grade": "G 16", "rated_speed": "30 Hz"},
    ),
    "rotor_radius": ({"rotor_radius": 0.04}, {"rotor_diameter": "80 mm"}),
    "clearance": ({"clearance": "0.7 mm"}, {"diametral_clearance": "1400 µm"}),
}
PARTNERS = {"gamma": "damping", "omega": "stiffness", "rho": "eccentricity", "radius_ratio": "rotor_radius"}


def case_with(**chosen):
    entries = dict(REST)
    for name, ways in WAYS.items():
        entries |= ways[chosen.get(name, 0)]
    machine = Machine(**entries)
    return Case("machine", machine.parameters, machine, Zones())


def value_of(case, name):
    return getattr(case.parameters if name in case.parameters.as_dict() else case.machine, name)


def changed(case, setting):
    """The case after the text that follows ``--set``."""
    name, _, text = setting.partition("=")
    return case.replace(**{name: text})


@pytest.mark.parametrize(("field", "way"), [(field, way) for field, ways in WAYS.items() for way in range(len(ways))])
def test_settings_read_again_give_the_value_on_the_side_asked_for(field, way):
    case = case_with(**{field: way})
    rng = np.random.default_rng(way)
    names = [field, *(name for name, partner in PARTNERS.items() if partner == field)]
    for _ in range(sized(40, 400)):
        digits = int(rng.integers(2, 13))
        for name in names:
            wanted = value_of(case, name) * 10 ** rng.uniform(-0.9, 0.9)
            if field == "clearance":  # so far that the rotor still fits
                wanted = value_of(case, name) * rng.uniform(0.9, 1.1)
            up, down, nearest = (in_terms_of(case, name, wanted, side, digits) for side in ("up", "down", "nearest"))
            got_up, got_down, got = (value_of(changed(case, one.setting), name) for one in (up, down, nearest))
            assert (got_up, got_down, got) == (up.reached, down.reached, nearest.reached)
            assert got_down <= wanted <= got_up
            assert up.entry == next(iter(WAYS[field][way]))
            # Up and down differ by one unit of the last digit, and the nearest is one of them.
            unit = 10.0 ** (math.floor(math.log10(up.value)) - digits + 1)
            assert up.value - down.value <= 1.001 * unit
            assert nearest.value in (up.value, down.value)


def test_text_unit_and_secondary_terms():
    gains = in_terms_of(case_with(stiffness=2, damping=2), "damping", 50_540.2, "up")
    assert (gains.entry, gains.value, gains.unit) == ("derivative_gain", 361.1, "A s/m")
    assert (gains.text, gains.setting) == ("361.1 A s/m", "derivative_gain=361.1 A s/m")
    ratio = 50_554 / (2 * math.sqrt(980e3 * 50))
    assert gains.beside == ("damping 50,600 N s/m", f"damping ratio {ratio:.3g}")
    spring = in_terms_of(case_with(), "stiffness", 2_494_601.0, "up")
    assert (spring.text, spring.setting, spring.beside) == (
        "2,495 N/mm",
        "stiffness=2495 N/mm",
        (f"natural frequency {math.sqrt(2.495e6 / 50) / math.tau:.3g} Hz",),
    )
    assert in_terms_of(case_with(damping=1), "damping", 2800.0).beside == ("damping 2,800 N s/m",)
    assert in_terms_of(load(REAL), "friction", 0.2).setting == "friction=0.2"
    assert in_terms_of(load(REAL), "stiffness", 2.5e9).text == "2.5×10⁹ N/m"
    assert in_terms_of(load(REAL), "damping", 0.0).setting == "damping=0 N s/m"


@pytest.mark.parametrize(
    ("path", "name", "value", "words"),
    [
        (REAL, "gamma", -0.1, "damping = -921 N s/m: must be a damping"),
        (REAL, "gamma", math.nan, "gamma = nan"),
        (PAPER, "damping", 1.0, "as mass, clearance and speed are not known"),
        (REAL, "derivative_gain", 1.0, "stands for damping"),
        (REAL, "nothing", 1.0, "unknown name"),
    ],
)
def test_what_the_machine_cannot_have_is_refused(path, name, value, words):
    with pytest.raises(InputError, match=words):
        in_terms_of(load(path), name, value)
