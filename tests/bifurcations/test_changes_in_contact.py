"""Where lasting contact changes its kind within a periodic motion: located, with the orbit on the other side."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from compilation import sized
from machines import PAPER

from carom import simulate
from carom.bifurcations import Bifurcation, OrbitBranch, Plane, continue_curve
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


def labels(word: Word) -> list[str]:
    return [segment.kind.label for segment in word]


def is_one_turn_of(told: list[str], wanted: list[str]) -> bool:
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
def changes(case: tuple[Parameters, str, float, float]) -> tuple[Bifurcation, ...]:
    special = [point for point in branch(*case).special if point.kind in KINDS and point.admissible]
    return tuple(sorted(special, key=lambda point: point.value))


def inside(found: OrbitBranch, point: Bifurcation) -> int:
    """Side on which the orbit is a motion."""
    away = found.values[found.admissible] - point.value
    away = away[np.abs(away) > 1e-7]
    return int(np.sign(away[np.abs(away).argmin()]))


@pytest.mark.parametrize("case", BRANCHES)
def test_the_changes_are_located_once_each(case):
    assert [point.kind for point in changes(case)] == [kind for kind, _ in EXPECTED[case[0]]]
    values = np.array([point.value for point in changes(case)])
    assert np.diff(values).min(initial=1.0) > 1e-3
    special = [point.value for point in branch(*case).special]
    # Nothing else, such as the fold of a root, is told of the same place.
    assert all((np.abs(np.array(special) - value) < 1e-6).sum() <= 2 for value in values)


@pytest.mark.parametrize("case", BRANCHES)
def test_fresh_motions_have_the_word_of_their_side(case):
    rng = np.random.default_rng(4)
    for point, (_, beyond) in zip(changes(case), EXPECTED[case[0]], strict=True):
        held = inside(branch(*case), point)
        before = setting_out(point.orbit)
        for distance in rng.uniform([2e-5, 2e-4], [2e-4, 1e-3]):
            for side in (-1, 1):
                value = point.value * (1.0 + side * distance)
                machine = point.orbit.rotor.parameters.replace(**{case[1]: value})
                begins = State(before.position * (1.0 - 1e-4), before.velocity * (1.0 + 1e-4 * rng.normal()))
                wanted = labels(point.orbit.word) if side == held else beyond.split()
                told = happens(machine, begins, point.orbit.period)
                assert is_one_turn_of(told, wanted), (told, wanted)


@pytest.mark.parametrize("case", BRANCHES)
def test_from_the_other_side_the_same_border_is_found(case):
    for point, (_, wanted) in zip(changes(case), EXPECTED[case[0]], strict=True):
        held = inside(branch(*case), point)
        value = point.value * (1.0 - held * 5e-3)
        machine = point.orbit.rotor.parameters.replace(**{case[1]: value})
        beyond = settled(machine, setting_out(point.orbit))
        assert beyond is not None
        assert is_one_turn_of(labels(beyond.word), wanted.split())
        low, high = sorted((value * (1.0 - held * 1e-3), point.value * (1.0 + held * 5e-3)))
        again = continue_orbit(beyond, case[1], (low, high)).special
        near = [found.value for found in again if found.kind in KINDS]
        assert near
        # A slope of zero at the border, as that of the slip of small bounces, is found to the root of rounding.
        assert min(abs(found - point.value) for found in near) < 1e-8


FOLDS = PAPER.replace(omega=0.8759, rho=0.4157, mu=0.5124, d=0.2930, gamma=0.07576, radius_ratio=1.1445)
"""The slip of an unstable orbit touches zero where the rolling of a stable one shrinks to nothing: both vanish."""


@cache
def vanishing() -> tuple[Bifurcation, int]:
    orbits = (settled(FOLDS, start) for start in starts(1, 60))
    orbit = next(each for each in orbits if each is not None and str(each.word) == "lift land slide+ roll slide+")
    found = continue_orbit(orbit, "mu", (0.48, 0.53))
    (point,) = [each for each in found.special if each.kind == "cone-limit"]
    return point, inside(found, point)


def test_fresh_motions_beyond_go_to_another_motion():
    point, held = vanishing()
    side = -held
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
    point = changes(BRANCHES[1])[0]
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
