"""The overhung gyroscopic rotor in a frictionless ring: its bouncing orbits, and their families through flights that vanish.

In the frame that turns ``z″ = iΩ(Jp−2)z′ − 2ζz′ + (Ω²(1−Jp) − 1 − 2iζΩ)z + mεΩ² − β max(0, 1−1/|z|)z``.  Published with a smoothed ring:
a doubling at Ω = 4.8624 and a fold at 3.3526; with the ring as it is they are at 4.861960 and 3.354404.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.bifurcations.followed import Followed
from carom.bifurcations.simulated import continue_simulated
from carom.models import KelvinVoigt, LinearEquations, Rotor, Touchdown
from carom.orbits.closing import close
from carom.orbits.flow import FlowBudget
from carom.orbits.names import CountedName

MASS, ECCENTRICITY, POLAR, DAMPING, RING = 0.9, 0.353, 0.143, 0.01, 10.0


def rotor_at(speed):
    """The rotor in units of the speed: times are in ``1/Ω``."""
    equations = LinearEquations(
        mass=np.array([[1.0]]),
        damping=np.array([[2.0 * DAMPING / speed - 1j * (POLAR - 2.0)]]),
        stiffness=np.array([[1.0 / speed**2 - (1.0 - POLAR) + 2j * DAMPING / speed]]),
        forcing=np.array([MASS * ECCENTRICITY]),
        touchdowns=[Touchdown((1.0,), KelvinVoigt(RING / speed**2, 0.0), 0.0, 1.0, farthest=10.0)],
        scales=cm.parameters.Scales(1.0, 1.0, speed),
    )
    return Rotor(equations)


PUBLISHED = {
    1.9910696141: (True, 2, [-0.53055, 0.00040, -0.00024, -0.31702]),
    2.6173523: (True, 2, [-0.39738, 0.48784, -0.38677, -0.31505]),
    2.02456529: (False, 1, [0.00560, 0.00384, 0.22722, -0.33093]),
    2.63683104: (False, 2, [-0.02317, -0.01332, -0.20453, 0.35583]),
}
"""Periods at the speed 5 in the time of the publication; whether the orbit is stable, its contacts, and about the state where its radius is least."""


def orbit_of(period):
    """Orbit with a published period, from a state to few digits."""
    _, _, (x, y, speed, across) = PUBLISHED[period]
    motion = cm.simulate(rotor_at(5.0), cm.State(complex(x, y), complex(speed, across)), 6.0 * period)
    return close(motion, 0.0, 5.0 * period)


@pytest.mark.parametrize("period", PUBLISHED)
def test_published_periods_are_found(period):
    orbit = orbit_of(period)
    stable, contacts, _ = PUBLISHED[period]
    digits = len(str(period).partition(".")[2])
    assert orbit.period / 5.0 == pytest.approx(period, abs=0.51 * 10.0**-digits)
    assert (orbit.stable, orbit.impacts) == (stable, contacts)


def test_a_family_is_followed_where_a_flight_vanishes_and_doubles():
    branch = continue_simulated(orbit_of(1.9910696141), "speed", (4.85, 5.3))
    doubling = min(branch.special, key=lambda point: abs(point.value - 4.86196))
    assert (doubling.kind, round(doubling.value, 5)) == ("period-doubling", 4.86196)
    assert any(point.kind == "grazing" and abs(point.value - 5.2787) < 1e-4 for point in branch.special)
    assert {each.impacts for each in branch.orbits} == {1, 2}
    names = CountedName(0, 1, "rolling"), CountedName(2 * doubling.orbit.impacts, 1)
    known = [SimpleNamespace(name=name, passes=lambda *_: False) for name in names]
    followed = Followed(branch.axis, (4.85, 4.88), 8, (), virtual=False, budget=FlowBudget(), found=known)
    followed.leave([doubling])
    doubled = followed.found[-1]
    named = [doubled, *doubled.orbits, *doubled.special, *(point.orbit for point in doubled.special)]
    assert {each.name for each in named} == {replace(names[1], number=2)}
    assert [followed._numbered(replace(names[0], kind=kind)) for kind in ("rolling", "whirl")] == [
        "rolling 2",
        "whirl 1",
    ]
    assert doubled.orbits[0].period == pytest.approx(2.0 * doubling.period, rel=0.02)
    grazing = next(point for point in branch.special if point.kind == "grazing")
    with pytest.raises(InputError, match="a period doubling"):
        cm.bifurcations.switch(grazing)
