"""Second derivatives at the wall, and the forms made with them, against single flights in double precision."""

from dataclasses import replace

import numpy as np
import pytest
from compilation import sized
from flint import arb
from scipy.optimize import brentq
from single_flights import Single

from carom.proofs.balls import at_precision
from carom.proofs.bends import second_derivatives
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.passages import Impact, LeftOpenError, begin, bounce, next_event
from carom.proofs.patches import Held, Patch, PatchDeparture
from carom.proofs.recoveries import after_impact
from carom.proofs.rotor import ProvenRotor

NAMES = ("gamma", "omega", "rho", "mu", "d", "radius_ratio")
MACHINES = {
    "paper": (0.3, 0.76, 3 / 7, 0.15, 0.95, 57.0),
    "spindle": (0.0435, 0.1407, 0.004, 0.2, 0.7, 60.0),
    "no friction": (0.2, 0.9, 0.3, 0.0, 0.6, 5.0),
}
STEP = 1e-3
"""Of differences: their error is about its square, times fourth derivatives of some hundreds."""
ROUNDING = 1e-8
"""Of states after several single flights in double precision, each at most a few times as far off as the one before."""


@pytest.fixture(params=MACHINES, ids=str)
def held(request):
    numbers = dict(zip(NAMES, MACHINES[request.param], strict=True))
    with at_precision(64):
        yield Held(ProvenRotor(hypotheses_of({**numbers, "phi": 0.0})).numbers), numbers


def patch(centre, size, random):
    """A patch about a state, with two spans."""
    spans = size * random.uniform(-1, 1, (2, len(centre)))
    exact = Patch([arb(x) for x in centre], [[arb(x) for x in span] for span in spans], [arb(0)] * len(centre))
    return exact, spans


def struck(departure):
    """The next strike; ``None`` for flights that do something else."""
    try:
        event = bounce(departure) or next_event(departure, begin(departure))
    except LeftOpenError:
        return None
    return event if isinstance(event, Impact) else None


def crossing(numbers, state, strike):
    """When a single flight crosses."""
    single = Single(numbers, state)
    return brentq(lambda t: single.height(t) - 1, strike.begin - 1e-6, strike.end + 1e-6, xtol=1e-14, rtol=1e-14)


def before(numbers, state, strike):
    """``a``, ``b`` and ``ψ⁺`` of a single flight at the wall, before the impact."""
    single, time = Single(numbers, state), crossing(numbers, state, strike)
    z, dz = single.at(time)
    local = dz * (z / abs(z)).conjugate()
    return np.array([local.real, local.imag, single.psi + time - np.angle(z)])


def states(random):
    """States that leave the wall or levitation."""
    while True:
        yield np.array([-random.uniform(0.1, 0.5), random.uniform(0.6, 1.2), random.uniform(-3, 3)])
        yield np.array([10 ** random.uniform(-0.5, 0.3), random.uniform(-3, 3)])


def test_second_derivatives_are_those_of_single_flights(held):
    numbers, random, seen = held[1], np.random.default_rng(3), 0
    for centre in states(random):
        exact, _ = patch(centre, 1e-7, random)
        departure = PatchDeparture(held[0], exact)
        strike = struck(departure)
        if strike is None or not departure.plain(strike.end)[1] > 0.3:
            continue
        seen += 1
        wide = replace(strike, begin=strike.begin - 0.05, end=strike.end + 0.05)
        time = arb(crossing(numbers, centre, strike))
        found = second_derivatives(departure, time, arb(strike.begin).union(arb(strike.end)))
        size = len(centre)
        for i in range(size):
            for j in range(i, size):
                one, other = STEP * np.eye(size)[i], STEP * np.eye(size)[j]
                ends = [
                    before(numbers, centre + s * one + t * other, wide) for s, t in ((1, 1), (1, -1), (-1, 1), (-1, -1))
                ]
                about = (ends[0] - ends[1] - ends[2] + ends[3]) / (4 * STEP**2)
                for squares, value in zip(found, about, strict=True):
                    assert abs(float(squares[i, j].at.mid()) - value) < 1e-3 * (1 + abs(value)) ** 2
                    assert squares[i, j].every.contains(squares[i, j].at.mid())
        if seen == sized(8, 4, 60):
            return


def test_flights_stay_in_the_forms_over_many_impacts(held):
    """Corners, edges and others of a patch, followed one by one, land in its image after each impact."""
    numbers, random, most = held[1], np.random.default_rng(8), 0
    source = states(random)
    for _ in range(sized(12, 5, 100)):
        centre = next(source)
        exact, spans = patch(centre, 10 ** random.uniform(-4, -2), random)
        shares = np.vstack([random.uniform(-1, 1, (8, 2)), [[1, 1], [1, -1], [-1, 1], [-1, -1], [1, 0], [0, -1]]])
        singles, impacts = centre + shares @ spans, 0
        while impacts < 20:
            departure = PatchDeparture(held[0], exact)
            strike = struck(departure)
            if strike is None:
                break
            try:
                exact = after_impact(departure, strike)
            except LeftOpenError:
                break
            impacts += 1
            singles = [Single(numbers, state).after(crossing(numbers, state, strike)) for state in singles]
            for state in singles:
                for ball, number in zip(exact.box[:2], state, strict=False):
                    assert (ball + arb(0, ROUNDING)).contains(arb(number))
                turn = (exact.box[2] - arb(state[2])) / (2 * arb.pi())
                assert (turn - turn.mid().floor() + arb(0, ROUNDING)).contains_integer()
        most = max(most, impacts)
    assert most > 3
