"""Named parameters of linear rotors, against the planar rotor and the matrices of the fixed frame."""

import numpy as np
import pytest
from linear_rotors import planar_rotor, touchdowns
from machines import PAPER, SCALES

from carom.base.outcome import InputError
from carom.models import Rotor, axis, from_matrices, jeffcott
from carom.parameters import Scales

MASS = np.array([[2.0, 0.3], [0.3, 1.5]])
DAMPING = np.array([[0.4, 0.1j], [-0.1j, 0.6]])
STIFFNESS = np.array([[1.2, 0.2], [0.2, 2.0]])
GYROSCOPIC = np.diag([0.0, 0.7])
FORCING = np.array([0.4 + 0.1j, 0.05])
TRANSLATION = np.array([1.0, 0.25])


def planar(parameters) -> Rotor:
    return planar_rotor(
        parameters.gamma,
        parameters.omega**2,
        parameters.rho * np.exp(1j * parameters.phi),
        touchdowns([[1.0]], [parameters.mu], [parameters.d], [parameters.radius_ratio + 1.0]),
        scales=parameters.scales,
    )


def rotor(**changes) -> Rotor:
    """A rotor with two coordinates and two planes."""
    given = {"mass": MASS, "damping": DAMPING, "stiffness": STIFFNESS, "gyroscopic": GYROSCOPIC, "forcing": FORCING}
    given |= {"touchdowns": touchdowns([[1.0, 0.5], [1.0, -0.4]], [0.1, 0.2], [0.9, 0.9], [30, 40])}
    return from_matrices(**(given | {"translation": TRANSLATION, "scales": SCALES} | changes))


def assert_alike(got: Rotor, expected: Rotor) -> None:
    assert got.equations.touchdowns == expected.equations.touchdowns
    for name in ("mass", "damping", "stiffness", "forcing"):
        found, own = getattr(got.equations, name), getattr(expected.equations, name)
        np.testing.assert_allclose(found, own, rtol=1e-14, atol=1e-15, err_msg=name)
    assert got.scales == expected.scales


def whole(matrix: np.ndarray) -> float:
    return float((TRANSLATION @ matrix @ TRANSLATION).real)


@pytest.mark.parametrize("name", jeffcott(PAPER.replace(scales=SCALES)).varied)
def test_one_coordinate_has_the_parameters_of_the_planar_rotor(name):
    machine = jeffcott(PAPER.replace(scales=SCALES))
    linear = planar(machine.parameters)
    if name not in linear.varied:
        assert name in ("mass", "damping", "stiffness", "eccentricity", "clearance", "rotor_radius")
        return
    along = axis(linear, name)
    assert along == axis(machine, name), "one definition of each parameter"
    assert along.value(linear) == pytest.approx(along.value(machine), rel=1e-14)
    value = 0.9 * along.value(machine)
    got = along.move(linear, value)
    assert_alike(got, planar(along.move(machine, value).parameters))
    assert along.value(got) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize("factor", [0.3, 1.0, 2.5])
def test_damping_stiffness_and_unbalance_are_multiplied_as_a_whole(factor):
    given = rotor()
    gamma, omega = whole(DAMPING) / whole(MASS), np.sqrt(whole(STIFFNESS) / whole(MASS))
    force = TRANSLATION @ FORCING / whole(MASS)
    assert [given.value(name) for name in ("gamma", "omega", "rho", "phi", "speed")] == pytest.approx(
        [gamma, omega, abs(force), np.angle(force), SCALES.speed], rel=1e-14
    )
    assert_alike(given.replace(gamma=factor * gamma), rotor(damping=factor * DAMPING))
    assert_alike(given.replace(omega=factor * omega), rotor(stiffness=factor**2 * STIFFNESS))
    assert_alike(given.replace(rho=factor * abs(force)), rotor(forcing=factor * FORCING))
    turned = FORCING * np.exp(1j * (factor - np.angle(force)))
    assert_alike(given.replace(phi=factor), rotor(forcing=turned))
    assert_alike(given.replace(unbalance_phase=f"{factor} rad"), rotor(forcing=turned))
    speed = factor * SCALES.speed
    expected = rotor(
        damping=DAMPING / factor, stiffness=STIFFNESS / factor**2, scales=Scales(SCALES.mass, SCALES.clearance, speed)
    )
    assert_alike(given.replace(speed=speed), expected)


def test_planes_together_and_one_by_one():
    given = rotor()

    def at_planes(name, **changes):
        return [getattr(each.wall(1.0), name) for each in given.replace(**changes).equations.touchdowns]

    assert at_planes("friction", friction=0.3) == at_planes("friction", mu=0.3) == [0.3, 0.3]
    assert at_planes("friction", mu_2=0.3) == [0.1, 0.3]
    assert at_planes("surface_speed", radius_ratio_1=50.0) == [51.0, 40.0]
    assert at_planes("restitution", d=0.5) == [0.5, 0.5]
    assert [given.value(name) for name in ("mu_1", "mu_2", "d", "radius_ratio_2")] == [0.1, 0.2, 0.9, 39.0]
    assert axis(given, "mu_2").field.words == "coefficient of friction at touchdown bearing 2"
    assert "mu_1" not in planar(PAPER).varied
    with pytest.raises(InputError, match="mu_1, mu_2 are those of each plane"):
        given.value("mu")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"gama": 0.1}, "did you mean gamma"),
        ({"mu_3": 0.1}, "unknown name"),
        ({"d": 1.2}, "d = 1.2: must be a number, 0 to 1"),
        ({"omega": 0.0}, "omega = 0.0: must be"),
        ({"gamma": "much"}, "gamma = much: must be"),
    ],
)
def test_values_that_cannot_be_set(changes, words):
    with pytest.raises(InputError, match=words):
        rotor().replace(**changes)
