"""Machines and starts of all kinds for hypothesis to draw."""

import cmath
import math

from compilation import sized
from hypothesis import settings
from hypothesis import strategies as st

from carom.motions.starts import State
from carom.parameters import Parameters

MANY = settings(max_examples=sized(50, 15, 150))
"""How many motions to draw; fewer without the compiler."""
EVENTS = sized(500, 50)
"""Events to follow each through."""


@st.composite
def machines(draw, **fixed):
    """Parameters of a machine with an equilibrium not far outside the wall; fixed ones as given."""
    drawn = {
        "gamma": st.one_of(st.just(0.0), st.floats(1e-3, 3.0)),
        "omega": st.floats(0.2, 2.5),
        "rho": st.one_of(st.just(0.0), st.floats(1e-3, 1.2)),
        "phi": st.floats(-math.pi, math.pi),
        "mu": st.one_of(st.just(0.0), st.floats(1e-3, 1.0)),
        "d": st.one_of(st.sampled_from([0.0, 1.0]), st.floats(0.05, 0.99)),
        "radius_ratio": st.floats(0.5, 100.0),
    }
    values = {name: fixed[name] if name in fixed else draw(strategy) for name, strategy in drawn.items()}
    stiffness = complex(values["omega"] ** 2 - 1.0, values["gamma"])
    if abs(stiffness) * 10.0 < max(values["rho"], 0.1):
        values["omega"] = 0.5
    return Parameters(**values)


@st.composite
def starts(draw):
    """A state inside the wall or on it."""
    radius = draw(st.one_of(st.just(1.0), st.floats(0.0, 0.999)))
    speed = draw(st.floats(0.0, 5.0))
    return State(
        cmath.rect(radius, draw(st.floats(-math.pi, math.pi))), cmath.rect(speed, draw(st.floats(-math.pi, math.pi)))
    )
