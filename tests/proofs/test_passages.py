"""The lemmas about flights of a patch, against single flights by the exponential of a matrix and the impact law in polar coordinates."""

import math
from dataclasses import replace

import numpy as np
import pytest
from compilation import sized
from flint import arb
from scipy.optimize import brentq
from single_flights import Single

from carom.proofs.balls import at_precision
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.kick_cells import box_of
from carom.proofs.lines import LineNumbers
from carom.proofs.moments import FORM
from carom.proofs.passages import Brush, Impact, LeftOpenError, PatchReturn, begin, next_event
from carom.proofs.patches import Held, Patch, PatchDeparture, PlainRotor
from carom.proofs.recoveries import after_brush, after_impact
from carom.proofs.rotor import ProvenRotor
from carom.proofs.sides import Side, responses_by

ROUNDING = 1e-9
"""Of states that single flights reach in double precision, next to grazes too."""
MACHINES = {
    "spindle": (0.0435, 0.1407, 0.004, 0.2, 0.7, 60.0),
    "levitation next to the wall": (0.3, 0.76, 3 / 7, 0.15, 0.95, 57.0),
    "overdamped, slip that may stop": (1.2, 0.5, 0.1, 0.4, 0.5, 0.3),
}


@pytest.fixture(params=MACHINES, ids=str)
def held(request):
    names = ("gamma", "omega", "rho", "mu", "d", "radius_ratio")
    numbers = dict(zip(names, MACHINES[request.param], strict=True))
    with at_precision(64):
        yield Held(ProvenRotor(hypotheses_of({**numbers, "phi": 0.0})).numbers), numbers


def patch(random, from_wall, size):
    """A patch of random states, and some of these."""
    centre = np.array(
        [-random.uniform(0.1, 0.5), random.uniform(-0.3, 0.3)] if from_wall else [10 ** random.uniform(-0.5, 0.5)]
    )
    centre = np.append(centre, random.uniform(-3, 3))
    spans = size * random.uniform(-1, 1, (2, len(centre)))
    rest = size * random.uniform(0, 0.3, len(centre)) * from_wall
    shares, rests = random.uniform(-1, 1, (8, 2)), random.uniform(-1, 1, (8, len(centre)))
    states = centre + shares @ spans + rests * rest
    exact = Patch([arb(x) for x in centre], [[arb(x) for x in span] for span in spans], [arb(x) for x in rest])
    return exact, states


def holds(ball, number):
    return bool((ball + arb(0, ROUNDING)).contains(arb(number)))


@pytest.mark.parametrize("from_wall", [True, False])
def test_mean_value_forms_hold_all_flights(held, from_wall):
    numbers, random = held[1], np.random.default_rng(5)
    for _ in range(sized(6, 2, 60)):
        exact, states = patch(random, from_wall, 0.05)
        departure, time = PatchDeparture(held[0], exact), float(random.uniform(0.1, 6))
        moment = departure.at(arb(time))
        for state in states:
            z, dz = Single(numbers, state).at(time)
            local, step = dz * z.conjugate(), 1e-4
            later, earlier = (Single(numbers, state).at(time + sign * step)[1] for sign in (1, -1))
            bend = (later - earlier) / (2 * step)
            assert holds(moment.height, abs(z) ** 2)
            assert holds(moment.rise, 2 * local.real)
            assert holds(moment.slope, local.real)
            # A difference of second order.
            assert (moment.curve + arb(0, 1e-5)).contains(arb(2 * (abs(dz) ** 2 + (z.conjugate() * bend).real)))


def test_events_happen_to_all_flights_and_none_before(held):
    """Each single flight returns, strikes in the time stated or brushes the wall as it may, and lands in the patch after it."""
    numbers, random, seen = held[1], np.random.default_rng(11), set()
    for number in range(sized(60, 12, 600)):
        exact, states = patch(random, bool(number % 2), 10 ** random.uniform(-4, -1.5))
        departure = PatchDeparture(held[0], exact)
        try:
            event = next_event(departure, begin(departure))
            after = _after(departure, event)
        except LeftOpenError:
            continue
        seen.add(type(event))
        for state in states:
            _check(Single(numbers, state), event, after)
    assert {PatchReturn, Impact} <= seen


def _after(departure, event):
    if isinstance(event, Impact):
        return after_impact(departure, event)
    return after_brush(departure, event) if isinstance(event, Brush) and event.touches else None


def _check(flight, event, after, shares=None):
    end = {PatchReturn: 30.0, Impact: getattr(event, "end", 0), Brush: getattr(event, "end", 0)}[type(event)]
    times = np.linspace(1e-3, end, 400)
    heights = flight.heights(times)
    above = np.flatnonzero(heights > 1)
    if isinstance(event, PatchReturn):
        assert not above.size
        return
    if not above.size:
        assert isinstance(event, Brush)
        assert event.misses
        return
    place = above[0]
    crossing = brentq(lambda t: flight.height(t) - 1, times[place - 1], times[place])
    last = event.end if isinstance(event, Impact) else event.last
    assert event.begin - ROUNDING <= crossing <= last + ROUNDING
    found = flight.after(crossing)
    turned = float(after.centre[2])
    found[2] += 2 * math.pi * round((turned - found[2]) / (2 * math.pi))
    assert all(holds(ball, x) for ball, x in zip(after.box, found, strict=True))
    if shares is not None:
        # What moved it so far along each span moves it so far along that after the impact.
        spans = np.array([[float(x) for x in span] for span in after.spans])
        left = found - shares @ spans[: len(shares)] - [float(x) for x in after.centre]
        others = np.abs(spans[len(shares) :]).sum(axis=0)
        assert (np.abs(left) <= others + [float(rest) + ROUNDING for rest in after.rest]).all()


def boxed(random, numbers, size):
    """A box about a machine in one to three of its numbers: what flights need to know of it, and the numbers at shares of the box."""
    names = random.choice(list(numbers), random.integers(1, 4), replace=False).tolist()
    ends = {name: [numbers[name] * (1 - size), numbers[name] * (1 + size)] for name in names}
    hypotheses = hypotheses_of({**numbers, "phi": 0.0})
    box = box_of(hypotheses, [(name, *(f"double {end!r}" for end in pair)) for name, pair in ends.items()])
    whole = [(0, 0)] * len(names)
    held = Held(box.machines.at(box.values(whole)), middle=box.machines.at(box.middles(whole)), sides=box.sides(whole))

    def at(shares):
        places = zip(ends.items(), shares, strict=True)
        return {
            **numbers,
            **{name: (low + high) / 2 + (high - low) / 2 * share for (name, (low, high)), share in places},
        }

    return held, at, len(names)


def test_events_happen_to_all_flights_of_all_machines_of_a_box(held):
    numbers, random, seen = held[1], np.random.default_rng(17), set()
    for number in range(sized(80, 16, 800)):
        size = 10 ** random.uniform(-4, -1.5)
        of_box, at, count = boxed(random, numbers, size)
        exact, _ = patch(random, bool(number % 2), size)
        along = size * random.uniform(-1, 1, (count, len(exact.centre)))
        bends = [[arb(0)] * len(exact.centre)] * (FORM - 2)
        exact = replace(exact, spans=[*exact.spans, *bends, *([arb(x) for x in span] for span in along)])
        departure = PatchDeparture(of_box, exact)
        try:
            event = next_event(departure, begin(departure))
            after = _after(departure, event)
        except LeftOpenError:
            continue
        seen.add(type(event))
        spans = np.array([[float(x) for x in span] for span in exact.spans])
        for _ in range(8):
            shares = (
                random.uniform(-1, 1, len(spans)) if random.random() < 0.7 else random.choice([-1.0, 1.0], len(spans))
            )
            rest = random.uniform(-1, 1, len(exact.rest)) * [float(x) for x in exact.rest]
            state = [float(x) for x in exact.centre] + shares @ spans + rest
            _check(Single(at(shares[FORM:]), state), event, after, shares)
    assert {PatchReturn, Impact} <= seen


@pytest.mark.parametrize("split", [-0.02, -1e-4, 0.0, 3e-4, 0.5])
def test_responses_are_differentiated_by_damping_and_stiffness(split):
    """Against differences, next to critical damping and away from it."""
    gamma, step = 1.25, 1e-5
    stiffness = gamma**2 / 4 - split

    def responses(damping, stiff, time):
        (c, dc, _), (h, dh, _) = PlainRotor(damping, stiff, 0.0).responses(time)
        return np.array([c, h, dc, dh])

    none = arb(0)
    sides = [Side(arb(1), none, none, none, none, none), Side(none, arb(1), none, none, none, none)]
    with at_precision(64):
        exact = LineNumbers(arb(gamma), arb(stiffness), none, none, none, none)
        for time in (0.1, 0.9, 3.0, 8.0):
            wanted = [
                responses(gamma + step, stiffness, time) - responses(gamma - step, stiffness, time),
                responses(gamma, stiffness + step, time) - responses(gamma, stiffness - step, time),
            ]
            for found, difference in zip(responses_by(exact, sides, arb(time)), wanted, strict=True):
                values = [float(ball.mid()) for ball in (found.place, found.push, found.place_rate, found.push_rate)]
                # The differences have an error of step squared times third derivatives, and of rounding over the step.
                assert values == pytest.approx(difference / (2 * step), abs=1e-7)


def test_a_patch_across_a_graze_has_two_outcomes():
    """Kicks just below and above one that grazes: those that touch do so slowly, the others are inside at the end."""
    numbers = dict(zip(("gamma", "omega", "rho", "mu", "d", "radius_ratio"), MACHINES["spindle"], strict=True))
    whole = np.linspace(1e-3, 30, 4000)
    graze = brentq(lambda speed: Single(numbers, (speed, -1.0)).heights(whole).max() - 1, 0.15, 0.2)
    with at_precision(64):
        held = Held(ProvenRotor(hypotheses_of({**numbers, "phi": 0.0})).numbers)
        exact = Patch([arb(graze), arb(-1)], [[arb(0.0006), arb(0)], [arb(0), arb(0.02)]], [arb(0), arb(0)])
        departure = PatchDeparture(held, exact)
        event = next_event(departure, begin(departure))
        after = after_brush(departure, event)
    assert isinstance(event, Brush)
    assert event.touches
    assert event.misses
    speeds = []
    for speed in np.linspace(graze - 0.0006, graze + 0.0006, 25):
        flight = Single(numbers, (speed, -1.0))
        times = np.linspace(event.begin, event.end, 2000)
        heights = flight.heights(times)
        if heights.max() <= 1:
            continue
        place = np.flatnonzero(heights > 1)[0]
        crossing = brentq(lambda t, f=flight: f.height(t) - 1, times[place - 1], times[place])
        z, dz = flight.at(crossing)
        speeds.append((dz * z.conjugate()).real)
        assert all(holds(ball, x) for ball, x in zip(after.box, flight.after(crossing), strict=True))
    assert 0 < len(speeds) < 25
    assert 0 < max(speeds) <= float(event.fastest) < 2 * max(speeds)
