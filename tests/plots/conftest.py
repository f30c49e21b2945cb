"""The machine of the source paper where its motions differ most, and what it does there."""

from types import SimpleNamespace

import pytest
from machines import PAPER, SCALES

import carom


@pytest.fixture(scope="session")
def damped() -> SimpleNamespace:
    """gamma = 0.1: four admissible orbits, of which B1,d is stable."""
    rotor = carom.models.jeffcott(PAPER.replace(scales=SCALES))
    return SimpleNamespace(
        rotor=rotor,
        orbits=carom.find_orbits(rotor),
        equilibria=carom.find_equilibria(rotor),
        scales=SCALES,
        mm=1e3 * SCALES.length,
        ms=1e3 * SCALES.time,
    )


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
