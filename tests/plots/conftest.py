"""The machine of the source paper where its motions differ most, and what it does there."""

from types import SimpleNamespace

import pytest

import carom


def _motions(gamma: float) -> SimpleNamespace:
    scales = carom.parameters.Scales(mass=50.0, clearance=0.7e-3, speed=184.2)
    parameters = carom.parameters.Parameters(
        gamma=gamma, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7, scales=scales
    )
    rotor = carom.models.jeffcott(parameters)
    return SimpleNamespace(
        rotor=rotor,
        orbits=carom.find_orbits(rotor),
        equilibria=carom.find_equilibria(rotor),
        scales=scales,
        mm=1e3 * scales.length,
        ms=1e3 * scales.time,
    )


@pytest.fixture(scope="session")
def damped() -> SimpleNamespace:
    """gamma = 0.1: four admissible orbits, of which B1,d is stable."""
    return _motions(0.1)


@pytest.fixture(scope="session")
def weak() -> SimpleNamespace:
    """gamma = 0.05: two pairs of orbits, all virtual but B1,c; the contact-free point is virtual too."""
    return _motions(0.05)


@pytest.fixture(scope="session")
def bouncing(damped):
    """A motion of 60/Omega that bounces and ends when its time is reached."""
    return carom.simulate(damped.rotor, carom.kick(0.35, angle=0.2), until=60.0)


@pytest.fixture(scope="session")
def read() -> SimpleNamespace:
    """Read a figure as a person would: points and lines by their meaning, and the words of the legend."""

    def lines(axes, meaning):
        return [line for line in axes.get_lines() if line.get_gid() == meaning]

    def marked(axes, meaning):
        return sum(len(line.get_xdata()) for line in lines(axes, meaning))

    def legend(figure):
        return [text.get_text() for legend in figure.legends for text in legend.get_texts()]

    return SimpleNamespace(lines=lines, marked=marked, legend=legend)
