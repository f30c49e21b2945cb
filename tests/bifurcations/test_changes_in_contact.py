"""Where lasting contact changes its kind within a periodic motion: located, with the orbit on the other side."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

from carom import simulate
from carom.bifurcations import Bifurcation, Border, OrbitBranch, Plane, continue_curve, examine_border
from carom.bifurcations.neighbours import is_other, setting_out
from carom.bifurcations.words import continue_orbit
from carom.models import jeffcott
from carom.motions import State
from carom.orbits.orbit import Orbit
from carom.orbits.recognising import orbit_of_motion, orbit_of_whirl
from carom.orbits.shooting import Start, links_of
from carom.orbits.word import Kind, Word
from carom.outcome import InputError, Outcome, Phase
from carom.parameters import Parameters

pytestmark = pytest.mark.jit_only

NAMES = {Phase.FLIGHT: "lift", Phase.FORWARD_SLIP: "slide+", Phase.BACKWARD_SLIP: "slide-", Phase.ROLLING: "roll"}
KINDS = ("slide-stop", "cone-limit", "lift-off")
ROLLS = PAPER.replace(omega=0.9376, rho=0.7131, mu=0.4424, d=0.4001, gamma=0.03278, radius_ratio=1.382)
"""A chatter that ends rolling; with less and with more friction it ends sliding, in opposite directions."""
SLIDES = PAPER.replace(omega=0.4784, rho=0.7436, mu=0.4653, d=0.3529, gamma=0.08837, radius_ratio=1.213)
"""A chatter that ends sliding, which shrinks to nothing."""
TOUCHES = PAPER.replace(omega=0.8629, rho=0.3678, mu=0.5628, d=0.1683, gamma=0.04482, radius_ratio=1.049)
"""Sliding stops and begins again in the same direction."""
WHIRLS = PAPER.replace(omega=0.8056, rho=1.179, mu=0.3776, d=0.6437, gamma=0.06085, radius_ratio=1.773)
"""Permanent contact that rolls and slides either way."""
LIFTS = PAPER.replace(omega=0.4954, rho=0.8683, mu=0.5791, d=0.6296, gamma=0.1443, radius_ratio=1.427)
"""Permanent contact whose least normal force vanishes while it slides."""


def settled(machine: Parameters, start: State) -> Orbit | None:
    """Orbit that a motion settles on, with lasting contact in each period."""
    motion = simulate(machine, start, settle=True, patience=2000)
    if motion.outcome is Outcome.MIXED:
        return orbit_of_motion(motion)
    if motion.outcome not in (Outcome.BACKWARD_WHIRL, Outcome.ROLLING):
        return None
    after = simulate(machine, motion.final, 60.0)
    angles = np.unwrap(np.angle(after.at_plane(np.linspace(20.0, 60.0, 4001))[0]))
    return orbit_of_whirl(after, 80.0 * np.pi / abs(angles[-1] - angles[0]))


def happens(machine: Parameters, start: State, period: float) -> list[str]:
    """What happens in one period of a motion after sixty, read from its phases alone; impacts of a chatter are left out."""
    motion = simulate(machine, start, 62.5 * period)
    told = []
    for k in np.flatnonzero(motion.segment_starts[1:] > 60.0 * period):
        before, after = (Phase(int(each)) for each in motion.segment_phases[k : k + 2, 0])
        if before != after:
            told += ["land"] * (before is Phase.FLIGHT) + [NAMES[after]]
    # What has happened once comes again after a period, which is less than the time looked at.
    again = next(k for k in range(1, len(told)) if told[k:] == told[: len(told) - k])
    return told[:again]


def is_one_turn_of(told: list[str], word: Word) -> bool:
    wanted = [segment.kind.label for segment in word]
    return len(told) == len(wanted) and any(told[k:] + told[:k] == wanted for k in range(len(told)))


def starts(seed: int, count: int) -> list[State]:
    rng = np.random.default_rng(seed)
    return [State(0.9 * np.exp(1j * rng.uniform(0.0, 6.3)), complex(*rng.normal(size=2))) for _ in range(count)]


@cache
def branch(machine: Parameters, along: str, low: float, high: float) -> OrbitBranch:
    found = (settled(machine, start) for start in starts(0, 60))
    return continue_orbit(next(each for each in found if each is not None), along, (low, high))


BRANCHES = (
    (ROLLS, "mu", 0.3, 0.65),
    (SLIDES, "gamma", 0.08, 0.11),
    (TOUCHES, "gamma", 0.04, 0.07),
    (WHIRLS, "mu", 0.3, 0.42),
    (LIFTS, "mu", 0.38, 0.6),
)
EXPECTED = {
    ROLLS: [("slide-stop", "lift land slide+ roll slide+"), ("slide-stop", "lift land slide- roll slide+")],
    SLIDES: [("slide-stop", "lift land roll slide+")],
    TOUCHES: [("cone-limit", "lift land slide+")],
    WHIRLS: [("lift-off", "lift land slide+ slide- roll slide+"), ("cone-limit", "roll slide+ roll slide-")],
    LIFTS: [("lift-off", "lift land slide+ roll slide+")],
}


@cache
def borders(case: tuple[Parameters, str, float, float]) -> tuple[Border, ...]:
    special = [point for point in branch(*case).special if point.kind in KINDS and point.admissible]
    return tuple(examine_border(point) for point in sorted(special, key=lambda point: point.value))


@pytest.mark.parametrize("case", BRANCHES)
def test_the_changes_are_located_once_each_with_the_word_beyond(case):
    assert [border.point.kind for border in borders(case)] == [kind for kind, _ in EXPECTED[case[0]]]
    for border, (_, wanted) in zip(borders(case), EXPECTED[case[0]], strict=True):
        assert border.word is not None
        assert is_one_turn_of(wanted.split(), border.word)
    values = np.array([border.point.value for border in borders(case)])
    assert np.diff(values).min(initial=1.0) > 1e-3
    special = [point.value for point in branch(*case).special]
    # Nothing else, such as the fold of a root, is told of the same place.
    assert all((np.abs(np.array(special) - value) < 1e-6).sum() <= 2 for value in values)


def test_departures_that_a_chatter_hides_are_not_told_apart():
    border = borders(BRANCHES[2])[0]
    verdicts = [
        replace(border, departures=departures).verdict
        for departures in (
            (4e-6, 1e-6, 3e-7, 4e-7, 3e-7),
            (9e-7, 8e-7, 9e-7, 7e-7, 8e-7),
            (4e-6, 5e-7, 1e-2, 5e-3, 2e-3),
        )
    ]
    assert verdicts == ["continuous", "undecided", "undecided"]


@pytest.mark.parametrize("case", BRANCHES)
def test_the_neighbour_lies_beyond_and_the_change_is_continuous(case):
    for border in borders(case):
        assert border.beyond is not None
        assert border.alongside is None
        assert border.beyond.admissible
        assert border.beyond.stable
        value = getattr(border.beyond.rotor.parameters, case[1])
        assert (value - border.point.value) * border.inside < 0.0
        assert border.verdict == "continuous"
        # Of first order in the distance: beside these borders nothing has the slope of a root.
        slope = np.polyfit(np.log(border.distances[:3]), np.log(border.departures[:3]), 1)[0]
        assert slope == pytest.approx(1.0, abs=0.03)  # 0.022 of second order


@pytest.mark.parametrize("case", BRANCHES)
def test_fresh_motions_have_the_word_of_their_side(case):
    """Other starts, near and far, and other distances than those of the examination."""
    rng = np.random.default_rng(4)
    for border in borders(case):
        point = border.point
        before = setting_out(point.orbit)
        for distance in rng.uniform([2e-5, 2e-4], [2e-4, 1e-3]):
            for side in (-1, 1):
                value = point.value * (1.0 + side * distance)
                machine = point.orbit.rotor.parameters.replace(**{case[1]: value})
                begins = State(before.position * (1.0 - 1e-4), before.velocity * (1.0 + 1e-4 * rng.normal()))
                wanted = point.orbit.word if side == border.inside else border.word
                assert wanted is not None
                told = happens(machine, begins, point.orbit.period)
                assert is_one_turn_of(told, wanted), (told, str(wanted))


@pytest.mark.parametrize("case", BRANCHES)
def test_from_the_other_side_the_same_border_is_found(case):
    for border in borders(case):
        point = border.point
        value = point.value * (1.0 - border.inside * 5e-3)
        machine = point.orbit.rotor.parameters.replace(**{case[1]: value})
        beyond = settled(machine, setting_out(point.orbit))
        assert beyond is not None
        assert border.word is not None
        assert not is_other(beyond.word, border.word)
        low, high = sorted((value * (1.0 - border.inside * 1e-3), point.value * (1.0 + border.inside * 5e-3)))
        again = continue_orbit(beyond, case[1], (low, high)).special
        near = [found.value for found in again if found.kind in KINDS]
        assert near, border.words
        # A slope of zero at the border, as that of the slip of small bounces, is found to the root of rounding.
        assert min(abs(found - point.value) for found in near) < 1e-8


FOLDS = PAPER.replace(omega=0.8759, rho=0.4157, mu=0.5124, d=0.2930, gamma=0.07576, radius_ratio=1.1445)
"""The slip of an unstable orbit touches zero where the rolling of a stable one shrinks to nothing: both vanish."""


@cache
def vanishing() -> Border:
    orbits = (settled(FOLDS, start) for start in starts(1, 60))
    orbit = next(each for each in orbits if each is not None and str(each.word) == "lift land slide+ roll slide+")
    (point,) = [each for each in continue_orbit(orbit, "mu", (0.48, 0.53)).special if each.kind == "cone-limit"]
    return examine_border(point)


def test_both_orbits_may_end_where_rolling_between_slides_shrinks_to_nothing():
    border = vanishing()
    assert border.beyond is None
    assert border.alongside is not None
    assert str(border.alongside.word) == "lift land slide+"
    assert not border.alongside.stable
    assert border.verdict == "jump"
    assert "both end there" in border.words
    # A disturbed motion leaves the orbit without rolling, by its multiplier in each period.
    orbit = border.alongside
    start, growth = setting_out(orbit), float(np.abs(orbit.multipliers.values).max())
    motion = simulate(orbit.rotor, State(start.position, start.velocity * (1.0 - 1e-10)), 12.0 * orbit.period)
    here = np.array([start.position, start.velocity])
    apart = np.array([np.abs(np.array(motion.at(np.array(k * orbit.period))) - here).max() for k in range(13)])
    assert growth > 1.5
    # What is left along the orbit does not grow, and after twelve periods is a two hundredth of the rest.
    assert apart[12] / apart[11] == pytest.approx(growth, rel=0.005)


def test_fresh_motions_beyond_go_to_another_motion():
    point, side = vanishing().point, -vanishing().inside
    before, rng = setting_out(point.orbit), np.random.default_rng(9)
    for distance in rng.uniform([1e-6, 1e-5, 1e-4], [1e-5, 1e-4, 5e-4]):
        for sign, stays in ((side, False), (-side, True)):
            machine = point.orbit.rotor.parameters.replace(mu=point.value * (1.0 + sign * distance))
            start = State(before.position, before.velocity * (1.0 + 1e-7 * rng.normal()))
            motion = simulate(machine, start, 200.0 * point.orbit.period)
            lifts = motion.segment_phases[:-1, 0] != Phase.FLIGHT
            lifts &= motion.segment_phases[1:, 0] == Phase.FLIGHT
            place = motion.rotor.system.states_of(motion.arrivals)[np.flatnonzero(lifts)[-1]]
            apart = np.abs(place - point.orbit.nodes[point.orbit.word.kinds == Kind.LIFT][0]).max()
            assert (apart < 10.0 * distance) if stays else (apart > 0.1)


@pytest.mark.parametrize(("case", "kind"), [(BRANCHES[4], "lift-off"), (BRANCHES[3], "cone-limit")])
def test_points_of_a_curve_are_found_again_along_one_parameter(case, kind):
    point = next(each for each in branch(*case).special if each.kind == kind and each.admissible)
    machine = point.orbit.rotor.parameters
    plane = Plane("gamma", "mu", (0.93 * machine.gamma, 1.07 * machine.gamma), (0.95 * machine.mu, 1.05 * machine.mu))
    curve = continue_curve(point, plane)
    assert set(curve.stops) == {"edge of the plane"}
    for gamma, mu in curve.points[1 : -1 : sized(5, 2, 9)].tolist():
        found = (
            settled(machine.replace(gamma=gamma, mu=mu * share), setting_out(point.orbit)) for share in (1.001, 0.999)
        )
        orbit = next(each for each in found if each is not None and not is_other(each.word, point.orbit.word))
        again = continue_orbit(orbit, "mu", (0.98 * mu, 1.02 * mu)).special
        assert min(abs(each.value - mu) for each in again if each.kind == kind) < 1e-11


def test_a_landing_without_slip_is_not_followed_in_two_parameters():
    point = borders(BRANCHES[1])[0].point
    with pytest.raises(InputError, match="without chatter"):
        continue_curve(point, Plane("gamma", "mu", (0.05, 0.15), (0.4, 0.5)))


def test_contact_that_runs_away_backward_in_time_is_not_followed_for_ever():
    orbit = branch(*BRANCHES[1]).orbits[0]
    durations = orbit.durations.copy()
    durations[2] = -1e3
    links = links_of(orbit.rotor, orbit.word, Start(orbit.nodes, durations))
    assert not np.isfinite(links.size)


def slip_after_chatter(share: float, restitution: float, friction: float) -> int:
    """Phase after a low chatter that begins without slip, where the pull along the wall has a share of the limit of friction."""
    machine = PAPER.replace(omega=0.5, rho=0.6, gamma=0.02, d=restitution, mu=friction, radius_ratio=0.6)
    # At rest in the fixed frame but for rolling: the pull −γ(1 + θ̇) − ρ sin x and the force ρ cos x + (1 + θ̇)² − ω² depend on the angle.
    turn = 1.0 - jeffcott(machine).system.contacts[0].wall.surface_speed
    angles = np.linspace(-np.pi, np.pi, 20_001)
    push = machine.rho * np.cos(angles) + turn**2 - machine.omega**2
    pull = -machine.gamma * turn - machine.rho * np.sin(angles)
    wanted = np.abs(pull - share * friction * push)
    angle = float(angles[np.argmin(np.where(push > 0.1, wanted, np.inf))]) + machine.phi
    position = np.exp(1j * angle)
    motion = simulate(machine, State(position, (-1e-5 + 1j * (turn - 1.0)) * position), 0.01)
    return int(motion.segment_phases[motion.segment_phases[:, 0] > Phase.FLIGHT][0, 0])


@pytest.mark.parametrize("restitution", [0.1, 0.4, 0.7])
def test_small_bounces_cease_to_stop_the_slip_before_the_limit_of_rolling(restitution):
    """At the share ``(1 + d)/2`` of the limit of friction, from simulations alone."""
    half = 0.5 * (1.0 + restitution)
    for friction in (0.2, 0.5):
        assert slip_after_chatter(half - 0.01, restitution, friction) == Phase.ROLLING
        assert slip_after_chatter(half + 0.01, restitution, friction) == Phase.FORWARD_SLIP


@cache
def attacked() -> list[tuple[Bifurcation, Border]]:
    """Borders of orbits of random machines."""
    rng, found = np.random.default_rng(11), []
    while len(found) < sized(8, 60, 2):
        ranges = (0.2, 1.0), (0.1, 0.9), (0.1, 0.7), (0.05, 0.6), (0.02, 0.3), (0.3, 8.0)
        names = ("omega", "rho", "mu", "d", "gamma", "radius_ratio")
        machine = PAPER.replace(**{name: float(rng.uniform(*ends)) for name, ends in zip(names, ranges, strict=True)})
        orbit = settled(machine, State(0.9 * np.exp(1j * rng.uniform(0.0, 6.3)), complex(*rng.normal(size=2))))
        if orbit is None or orbit.word.flies:
            continue
        points = continue_orbit(orbit, "mu", (0.8 * machine.mu, 1.25 * machine.mu)).special
        found += [(point, examine_border(point)) for point in points if point.kind in KINDS and point.admissible]
    return found


def test_borders_of_random_machines_have_what_they_claim():
    told = 0
    for point, border in attacked():
        for side, orbit in zip((-1, 1), border.neighbours, strict=True):
            if orbit is None:
                continue
            told += 1
            assert (orbit.rotor.parameters.mu - point.value) * side > 0.0
            start = setting_out(orbit)
            motion = simulate(orbit.rotor, start, orbit.period)
            apart = abs(motion.final.position - start.position) + abs(motion.final.velocity - start.velocity)
            # An instant of another contact at the beginning may be part of the slip below which a chatter is not resolved.
            assert apart < 1e-6
            if border.verdict == "continuous" and side == -border.inside and orbit.stable:
                machine = point.orbit.rotor.parameters.replace(mu=point.value * (1.0 - border.inside * 3e-5))
                fresh = happens(machine, State(start.position * (1.0 - 1e-5), start.velocity), orbit.period)
                assert is_one_turn_of(fresh, orbit.word), (fresh, str(orbit.word))
    assert told >= len(attacked()) - 1


@pytest.mark.parametrize("case", [BRANCHES[0], BRANCHES[3], BRANCHES[4]])
def test_margins_inside_contact_are_the_lowest_of_dense_samples(case):
    """Minima of the normal force, the slip and the distance from the limits of friction, from states of a simulation."""
    for orbit in branch(*case).orbits[::6]:
        if not orbit.admissible:
            continue
        friction, plane = orbit.rotor.parameters.mu, orbit.rotor.system.contacts[0]
        motion = simulate(orbit.rotor, setting_out(orbit), 2.2 * orbit.period)
        lowest = {"pressing": np.inf, "sliding": np.inf, "cone": np.inf}
        for first, last in motion.stretches():
            ends = np.append(motion.segment_starts, motion.time)
            phase = Phase(int(motion.segment_phases[first, 0]))
            if phase is Phase.FLIGHT or ends[last] - ends[first] < 1e-3:
                continue
            times = np.linspace(ends[first] + 1e-6, ends[last] - 1e-6, 4001)
            normal, grip = motion.forces(times)
            position, velocity = motion.at_plane(times)
            slip = plane.wall.surface_speed + (np.conj(position) * velocity).imag
            courses = {"pressing": [normal]}
            if phase is Phase.ROLLING:
                courses["cone"] = [friction * normal - grip, friction * normal + grip]
            else:
                courses["sliding"] = [slip if phase is Phase.FORWARD_SLIP else -slip]
            for name, values in ((name, each) for name, all_ in courses.items() for each in all_):
                inside = np.flatnonzero((values[1:-1] < values[:-2]) & (values[1:-1] < values[2:])) + 1
                lowest[name] = min(lowest[name], values[inside].min(initial=np.inf))
        # A chatter may land with less slip, and rolling may begin nearer to its limit, than inside.
        assert orbit.margins.pressing == pytest.approx(lowest["pressing"], abs=1e-6)
        for name in ("sliding", "cone"):
            assert getattr(orbit.margins, name) <= lowest[name] + 1e-6
