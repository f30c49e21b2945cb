"""What is refused, and in which words."""

import pytest

from carom.base.outcome import InputError

ALLOWED = {
    "mass": "must be a mass in kg, > 0 (1e-09 to 1e+09)",
    "damping": "must be a damping in N s/m, >= 0 (0, or 1e-30 to 1e+30)",
    "stiffness": "must be a stiffness in N/m, > 0 (1e-30 to 1e+30)",
    "eccentricity": "must be a length in m, >= 0 (0, or 1e-30 to 1e+06)",
    "clearance": "must be a length in m, > 0 (1e-09 to 1000)",
    "rotor_radius": "must be a length in m, > 0 (1e-09 to 1e+06)",
    "speed": "must be an angular speed in rad/s, > 0 (1e-06 to 1e+06)",
    "unbalance_phase": "must be an angle in rad, -1e+06 to 1e+06",
    "friction": "must be a number, 0 to 10",
    "restitution": "must be a number, 0 to 1",
}
"""What each field of a machine may be."""


def error_of(call):
    """The input error a call raises; its message is one printable line."""
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value).isprintable()
    return caught.value


def assert_refused(call, says):
    """A call raises an input error of one line that says this, as a regular expression."""
    with pytest.raises(InputError, match=says) as caught:
        call()
    assert "\n" not in str(caught.value)
