"""Which motions come to the limit of magnetic bearings: against the force by the states of the motions."""

import json

import numpy as np
import pytest
from machines import machine_of

from carom import find_attractors, load, simulate
from carom.base.files import as_json
from carom.disturbances import KickPlane, Sample
from carom.parameters import Case, Parameters, Scales, Zones
from carom.studies.study_data import bearing_demand

KEOGH = "examples/keogh-cole.toml"


def test_without_limits_nothing_is_said():
    found = find_attractors(KEOGH_PARAMETERS, Sample(KickPlane(0.01), 2), known=False)
    assert bearing_demand(load(KEOGH), found) is None


KEOGH_PARAMETERS = load(KEOGH).parameters
QUIET = Parameters(0.5, 0.76, 3 / 7, 0.21, 0.0, 0.95, 400 / 7, Scales(50.0, 0.7e-3, 184.2))
BEARING_NUMBERS = {"magnetic_bearings": 2, "force_current_factor": 70.0, "negative_stiffness": 2.1e5}


@pytest.mark.jit_only
def test_disturbances_that_come_to_a_limit_are_counted_and_whether_they_come_back():
    machine = machine_of(QUIET).replace(force_limit="500 N", **BEARING_NUMBERS)
    case = Case("limited", QUIET, machine, Zones())
    found = find_attractors(case, Sample(KickPlane(1.0), 12), known=False)

    demand = bearing_demand(case, found)

    assert demand.control.force == 1000.0
    asked = []
    for ending in found.disturbances:
        motion = simulate(case, ending.start.state, max(ending.time, 1e-6))
        position, velocity = motion.at(motion.sample(5000))
        turned = motion.sample(5000) + ending.start.state.time
        place, speed = position * np.exp(1j * turned), (velocity + 1j * position) * np.exp(1j * turned)
        pull = machine.negative_stiffness * 2 / case.parameters.scales.stiffness
        force = ((QUIET.omega**2 + pull) * place + QUIET.gamma * speed) * case.parameters.scales.force
        asked.append(max(np.abs(force.real).max(), np.abs(force.imag).max()) > 1000.0)
    assert (demand.at_limit, demand.total) == (sum(asked), 12)
    text = demand.words
    assert "a control force of at most 1,000 N along each axis against a negative stiffness of 420,000 N/m" in text
    assert f"{sum(asked)} of 12 disturbances reach this limit" in text
    assert json.loads(as_json(demand.document()))["disturbances"]["at_limit"] == sum(asked)
