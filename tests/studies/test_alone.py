"""Where levitation is alone: nothing else is found inside by fresh samples, and what is named is found just outside."""

import math

import numpy as np
import pytest
from machines import random_parameters

from carom.attractors import DisturbanceSet
from carom.attractors.naming import name_motions
from carom.closed_forms.equilibria import find_equilibria
from carom.models import Jeffcott
from carom.motions.ensembles import settle
from carom.orbits.single_impact import orbits_within_reach
from carom.outcome import Outcome
from carom.parameters import Machine, Parameters
from carom.studies.advice import advise
from carom.studies.alone import levitation_alone
from carom.studies.orbit_ranges import single_impact_ranges
from carom.studies.ranges import steady_range

README = Machine.load("examples/keogh-cole.toml").parameters
WHIRLS = (Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
SMALL = Parameters(gamma=0.12, omega=0.217, rho=0.149, phi=0.345, mu=0.239, d=0.99, radius_ratio=0.0425)
"""A rotor smaller than its clearance: orbits whose impacts stop the slip, which are not listed, outlast all others."""

pytestmark = pytest.mark.jit_only


def ranges_of(parameters, gain):
    return (
        steady_range(parameters, "contact-free", gain),
        steady_range(parameters, "rub", gain),
        *single_impact_ranges(parameters, gain),
    )


def ends_of(rotor, count, seed):
    return settle(rotor, *DisturbanceSet(count, seed).starts(rotor)[:2])


def known_motions(rotor):
    """Names of the admissible motions other than levitation."""
    names = {orbit.name for orbit in orbits_within_reach(rotor) if orbit.admissible}
    rubs = [rub for rub in find_equilibria(rotor)[1:] if rub.status == "admissible" and rub.normal_force > 1e-9]
    return names | ({"rub"} if rubs else set())


def check_inside(parameters, found, random, values, count):
    """Neither orbits nor a fresh sample of disturbances find anything but levitation, and whirl where it is said."""
    for span in found.spans:
        low, high = math.log(span.low.value * (1 + 1e-7)), math.log(span.high.value * (1 - 1e-7))
        for value in np.exp(random.uniform(low, high, values)).tolist():
            rotor = Jeffcott(parameters.replace(**{found.gain: value}))
            where = (parameters, found.gain, value)
            assert find_equilibria(rotor)[0].status == "admissible", where
            assert not known_motions(rotor), (where, known_motions(rotor))
            ends = ends_of(rotor, count, int(random.integers(1 << 30)))
            whirls = np.isin(ends.outcomes, WHIRLS)
            others = ~ends.recovered & ~whirls
            assert not others.any(), (where, np.unique(ends.outcomes[others]), ends.multiplicities[others])
            if not any(value in part for part in found.whirl):
                assert not whirls.any(), (where, int(whirls.sum()))


def check_outside(parameters, found):
    """Just beyond each end there is the motion that it names, or levitation has gone."""
    met = {(met.motion, met.value): met for met in found.met}
    for span in found.spans:
        for edge, outward in ((span.low, -1.0), (span.high, 1.0)):
            if edge.kind == "simulated":
                (one,) = [
                    m
                    for m in met.values()
                    if m.motion == edge.motion and 0 <= outward * (m.value / edge.value - 1) < 2e-3
                ]
                rotor = Jeffcott(parameters.replace(**{found.gain: one.value}))
                ends = settle(rotor, one.position, one.velocity)
                assert name_motions(rotor, ends)[1] == (one.motion,)
            elif edge.kind:
                rotor = Jeffcott(parameters.replace(**{found.gain: edge.value * (1 + outward * 2e-6)}))
                gone = find_equilibria(rotor)[0].status != "admissible"
                assert gone or known_motions(rotor), (parameters, found.gain, edge)


def test_the_readme_machine_is_left_alone_above_a_damping_and_above_a_stiffness():
    random = np.random.default_rng(5)
    found = [levitation_alone(README, gain, ranges_of(README, gain), 200) for gain in ("gamma", "omega")]
    damping, stiffness = found

    (span,) = damping.spans
    assert span.low.value * README.scales.damping == pytest.approx(3408.0, abs=0.5)
    (span,) = stiffness.spans
    assert span.low.value**2 * README.scales.stiffness == pytest.approx(2.376e6, rel=1e-3)
    for entry in found:
        assert entry.without_whirl == entry.spans
        check_inside(README, entry, random, 4, 200)
        check_outside(README, entry)


def test_stiffness_that_leaves_the_readme_machine_alone():
    """At 3.0e6 N/m everything comes back, where the study once said that no stiffness would do."""
    value = math.sqrt(3.0e6 / README.scales.stiffness)
    found = levitation_alone(README, "omega", ranges_of(README, "omega"), 100)
    assert any(value in span for span in found.without_whirl)
    assert ends_of(Jeffcott(README.replace(omega=value)), 1000, 77).recovered.all()


def test_a_range_is_cut_back_where_simulation_finds_more():
    found = levitation_alone(SMALL, "gamma", ranges_of(SMALL, "gamma"), 200)
    structural = ranges_of(SMALL, "gamma")
    known = [span.high.value for entry in structural[1:3] for span in entry.spans]
    assert (found.spans[-1].low.kind, found.spans[-1].low.motion) == ("simulated", "1-impact bouncing")
    assert found.spans[-1].low.value > max(known, default=0.0)
    check_outside(SMALL, found)
    check_inside(SMALL, found, np.random.default_rng(8), 4, 300)


def test_advice_is_the_least_change_and_stands_up_to_a_fresh_sample():
    ranges = [entry for gain in ("gamma", "omega") for entry in ranges_of(README, gain)]
    alone = tuple(
        levitation_alone(README, gain, tuple(r for r in ranges if r.gain == gain), 100) for gain in ("gamma", "omega")
    )
    first, second = advise(README, alone, tuple(ranges))

    assert (first.gain, second.gain) == ("omega", "gamma")
    assert first.change == pytest.approx(1.05 * 2.4248, rel=1e-3)
    assert second.change == pytest.approx(1.05 * 3408.0 / 1400.0, rel=1e-3)
    for advice in (first, second):
        assert advice.alone
        assert (advice.returned.count, advice.returned.total) == (2000, 2000)
        assert ends_of(Jeffcott(README.replace(**{advice.gain: advice.value})), 1000, 99).recovered.all()


def test_no_advice_where_nothing_needs_to_change():
    parameters = README.replace(gamma=0.5)
    ranges = ranges_of(parameters, "gamma")
    assert advise(parameters, (levitation_alone(parameters, "gamma", ranges, 50),), ranges) == ()


def test_no_answer_where_orbits_were_not_searched():
    parameters = README.replace(gamma=0.0)
    assert levitation_alone(parameters, "omega", ranges_of(parameters, "omega")) is None


@pytest.mark.deep
@pytest.mark.parametrize("seed", range(50))
def test_random_machines_have_nothing_but_levitation_where_it_is_said_to_be_alone(seed):
    random = np.random.default_rng(1000 + seed)
    parameters = random_parameters(random, gamma=float(10 ** random.uniform(-1.5, 0.0)))
    for gain in ("gamma", "omega"):
        found = levitation_alone(parameters, gain, ranges_of(parameters, gain))
        if found is not None:
            check_outside(parameters, found)
            check_inside(parameters, found, random, 20, 1000)
