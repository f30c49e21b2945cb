"""Windows of single-impact orbits between two values at which all orbits are known."""

import numpy as np
import pytest
from compilation import sized

from carom.bifurcations import orbit_windows
from carom.models import jeffcott
from carom.orbits.single_impact import orbits_within_reach
from carom.parameters import Parameters

WITHOUT_REBOUND = Parameters(
    gamma=0.42, omega=0.5708421012463507, rho=0.28690883112681587, phi=-1.52, mu=1.0174969331844883, d=0.0, radius_ratio=47.6
)  # fmt: skip
CLOSE_SPEEDS = Parameters(gamma=0.15715, omega=0.16442, rho=0.3795, phi=-1.99, mu=0.0, d=0.07446, radius_ratio=22.8)


@pytest.mark.parametrize(
    ("parameters", "parameter", "low", "high", "stable"),
    [
        # Without rebound the rotor leaves the wall with no radial speed, which is no maximum of the radius.
        pytest.param(WITHOUT_REBOUND, "gamma", 0.09159475986188183, 0.10073332466865814, False, id="without-rebound"),
        pytest.param(WITHOUT_REBOUND, "gamma", 0.13399259144935746, 0.1473612599456155, False, id="without-rebound-2"),
        # Newton's method leads from each of two close orbits to the other one, and only one of them is stable.
        pytest.param(CLOSE_SPEEDS, "omega", 0.17663982650734147, 0.1852888640726634, True, id="close-speeds"),
    ],
)
def test_an_orbit_that_is_there_at_all_values_has_one_window(parameters, parameter, low, high, stable):
    for value in np.linspace(low, high, 7):
        orbits = [
            orbit
            for orbit in orbits_within_reach(jeffcott(parameters.replace(**{parameter: value})))
            if orbit.admissible
        ]
        assert orbits
        assert any(orbit.stable for orbit in orbits) == stable

    found = orbit_windows(parameters, parameter, (low, high))

    whole = [(low, high)]
    assert [(window.low.value, window.high.value) for window in found.possible] == whole
    assert [(window.low.value, window.high.value) for window in found.stable] == (whole if stable else [])


@pytest.mark.parametrize("seed", range(sized(3, 1, 40)))
def test_windows_of_frictionless_machines_end_inside_the_range(seed):
    random = np.random.default_rng(seed)
    parameters = Parameters(
        gamma=10.0 ** random.uniform(-1.5, 0.0),
        omega=10.0 ** random.uniform(-0.4, 0.3),
        rho=random.uniform(0.3, 0.9),
        phi=random.uniform(-3.0, 3.0),
        mu=0.0,
        d=random.choice([random.uniform(0.0, 1.0), 1.0]),
        radius_ratio=10.0 ** random.uniform(0.5, 2.0),
    )
    boundary = np.sqrt(max(1.0 - np.sqrt(max(parameters.rho**2 - parameters.gamma**2, 0.0)), 0.01))
    values = boundary * 1.05 ** (np.arange(3) - random.random())

    found = orbit_windows(parameters, "omega", values.tolist())

    for window in (*found.possible, *found.stable):
        assert values[0] <= window.low.value < window.high.value <= values[-1]
        assert "vanishing-period" not in (window.low.kind, window.high.kind)  # ∂F₁/∂ω is zero at T = 0


def test_a_period_that_vanishes_is_found_by_the_closed_form():
    """With ``d = 1``, ``F₁ = (1 + d)T(2μ − γ)/12 + …``: a period vanishes at γ = 2μ, where ``ṙ`` does not exceed the height of a flight."""
    parameters = Parameters(gamma=0.12, omega=0.8, rho=0.4, phi=0.3, mu=0.0622, d=1.0, radius_ratio=30.0)

    found = orbit_windows(parameters, "gamma", np.geomspace(0.11, 0.14, 4).tolist())

    (end,) = {end for window in found.possible for end in (window.low, window.high) if end.kind == "vanishing-period"}
    assert end.value == pytest.approx(2.0 * parameters.mu, rel=1e-7)
