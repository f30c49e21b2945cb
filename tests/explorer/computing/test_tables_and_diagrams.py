"""Table of motions, and diagram along a slider."""

import numpy as np
import pytest

import carom
from carom.explorer.computing.controls import controls_of
from carom.explorer.computing.diagrams import diagram_along
from carom.explorer.computing.motions import table_of
from carom.models import jeffcott

MACHINE = "examples/keogh-cole.toml"


@pytest.fixture(scope="module")
def case():
    return carom.load(MACHINE)


@pytest.fixture(scope="module")
def diagram(case):
    (control,) = (one for one in controls_of(case) if one.name == "damping")
    return diagram_along(jeffcott(case.parameters), control)


def test_the_table_has_every_orbit_with_its_multipliers(case):
    table, orbits = table_of(jeffcott(case.parameters)), carom.find_orbits(case)
    rows = {row["name"]: row for row in table["rows"]}
    for orbit in orbits:
        row = rows[f"orbit {orbit.name}"]
        assert row["state"] == ("stable" if orbit.stable else "unstable")
        assert row["multipliers"].startswith(f"{orbit.multipliers.spectral_radius:.3g}")
    assert table["argument"] == orbits.argument
    assert rows["levitation"]["state"] == "stable"


def test_the_diagram_has_the_orbits_of_the_machine(case, diagram):
    orbits = [orbit for orbit in carom.find_orbits(case) if orbit.admissible]
    assert orbits
    speed = 1e3 * case.parameters.scales.velocity
    for orbit in orbits:
        lines = [line for line in diagram["lines"] if line["kind"] == ("stable" if orbit.stable else "unstable")]
        # Points of a branch lie some per cent of the range apart.
        near = min(
            np.nanmin(
                np.hypot((line["x"] - 1400.0) / 7000.0, (line["y"] - speed * orbit.radial_speed) / diagram["top"])
            )
            for line in lines
        )
        assert near < 0.03


def test_special_points_are_those_of_the_library(case, diagram):
    found = carom.find_bifurcations(case, "damping", (280.0, 7000.0))
    np.testing.assert_allclose(diagram["points"]["x"], [point.value for point in found.points], rtol=1e-9)
    assert set(diagram["points"]["words"]) >= {"period doubling, B1,d", "fold of synchronous rubs"}
