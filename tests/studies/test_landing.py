"""Loads beside each other and how far they are from their limits."""

import math
from dataclasses import replace

import pytest

import carom as cm
from carom.motions import follow_loads
from carom.studies import DropStudy
from carom.studies.drops import release
from carom.studies.landing import Accepted, bearing_words, load_columns

pytestmark = pytest.mark.jit_only


def dropped(path, **limits):
    case = replace(cm.load(path), limits=cm.parameters.LoadLimits(**limits))
    rotor, state, echo = release(case, cm.drop())
    return DropStudy(case, echo, follow_loads(rotor, state, "20 ms"))


def test_loads_and_margins():
    found = dropped("examples/touchdown-balls.toml", force="1 kN", depth="50 um", impacts=0)
    (plane,) = found.loads.planes
    columns = dict(load_columns(found))
    assert columns["peak force"] == ["1,320 N"]
    assert columns["load of a ball"] == [f"{plane.catalogue.ball_load:.0f} N"]
    force, impacts, depth = map(Accepted.of, found.checks)
    assert force == ("normal force", "1,320 N", "1,000 N", "31.8 % above", "exceeded")
    assert depth[3:] == ("67.4 %", "kept so far")
    assert impacts.verdict == "exceeded"
    margins = {check.name: check.margin for check in found.checks}
    assert margins["depth"] == 1.0 - plane.si()["depth"] / 50e-6
    assert margins["impacts"] == -math.inf


def test_of_several_bearings_each_has_a_column():
    found = dropped("tests/machine_files/four-degrees.toml", impulse="1 N s")
    assert all(len(cells) == 2 for _, cells in load_columns(found))
    assert [Accepted.of(check).name for check in found.checks] == [
        f"normal impulse of an impact, bearing {n}" for n in (1, 2)
    ]
    assert bearing_words(found)[1].startswith("radial clearance 0.25 mm, friction 0.15; rigid")
