"""Windows of single-impact orbits between two values at which all orbits are known."""

import numpy as np
import pytest

from carom.bifurcations import orbit_windows
from carom.models import Jeffcott
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
            for orbit in orbits_within_reach(Jeffcott(parameters.replace(**{parameter: value})))
            if orbit.admissible
        ]
        assert orbits
        assert any(orbit.stable for orbit in orbits) == stable

    found = orbit_windows(parameters, parameter, (low, high))

    whole = [(low, high)]
    assert [(window.low.value, window.high.value) for window in found.possible] == whole
    assert [(window.low.value, window.high.value) for window in found.stable] == (whole if stable else [])
