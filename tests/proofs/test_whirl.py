"""Claims about whirl in lasting contact beside a general integrator of the equations on the wall, and at limits."""

from fractions import Fraction

import machines
import numpy as np
import pytest
from compilation import sized
from scipy.integrate import solve_ivp

from carom.proofs.balls import at_precision
from carom.proofs.hypotheses import hypotheses_of
from carom.proofs.rotor import ProvenRotor
from carom.proofs.steady_lines import steady_line_claims
from carom.proofs.whirl import whirl_claims

DECIMAL = {**machines.DECIMAL, "radius_ratio": "57"}
LONG = 400.0


def claims_of(machine):
    with at_precision(128):
        return {claim.kind: claim for claim in whirl_claims(ProvenRotor(hypotheses_of(machine)))}


def along(machine, name, low, high):
    with at_precision(128):
        options = {"along": name, "from": low, "to": high}
        claims = steady_line_claims(ProvenRotor(hypotheses_of(machine)), options)
        return {claim.kind: claim for claim in claims if claim.about == "whirl"}


def random_machine(random):
    gamma, rho = 10 ** random.uniform(-2, 1), 10 ** random.uniform(-2, 0.5)
    mu, ratio = random.choice((0.03, 0.15, 0.5, 1.5)), random.uniform(1.5, 20.0)
    return {
        "gamma": gamma,
        "omega": random.uniform(0.1, 3.0),
        "rho": rho,
        "phi": 0.0,
        "mu": mu,
        "d": 0.5,
        "radius_ratio": ratio,
    }


class Wall:
    """The planar rotor on a rigid wall: angle from the unbalance and backward speed ``w``, slip forward, backward or none."""

    def __init__(self, machine):
        at = {name: float(value) for name, value in machine.items()}
        self.gamma, self.rho, self.mu, self.s = at["gamma"], at["rho"], at["mu"], at["radius_ratio"]
        self.stiffness = at["omega"] ** 2

    def push(self, x, w):
        return self.rho * np.cos(x) + w * w - self.stiffness

    def need(self, x):
        """Friction force along growing angle of rolling."""
        return self.rho * np.sin(x) - self.gamma * self.s

    def rate(self, slip, x, w):
        if slip == 0:
            return -1 - w, 0.0 * w
        return -1 - w, -self.gamma * w + self.rho * np.sin(x) + slip * self.mu * self.push(x, w)

    def follow(self, x, w, slip, time):
        """The motion until it leaves the wall or time is up: phases ``(slip, times, x, w)`` and whether it left."""
        phases, clock = [], 0.0
        while clock < time and len(phases) < 200:
            events = [lambda _, y: self.push(*y)]
            if slip:
                events.append(lambda _, y, slip=slip: slip * (self.s - y[1]) + 1e-13)
            else:
                events += [
                    lambda _, y, side=side: self.mu * self.push(*y) - side * self.need(y[0]) + 1e-13 for side in (1, -1)
                ]
            for event in events:
                event.terminal, event.direction = True, -1
            path = solve_ivp(
                lambda _, y, slip=slip: self.rate(slip, *y),
                (clock, time),
                (x, w),
                rtol=1e-9,
                atol=1e-10,
                events=events,
            )
            phases.append((slip, path.t, *path.y))
            clock, (x, w) = path.t[-1], path.y[:, -1]
            if path.status == 0:
                break
            if len(path.t_events[0]):
                return phases, True
            if slip:
                w, side = self.s, np.sign(self.need(x))
                slip = 0 if abs(self.need(x)) <= self.mu * self.push(x, w) else -side
            else:
                slip = -1 if len(path.t_events[1]) else 1
        return phases, False


def starting(wall, w):
    return 1 if w < wall.s else -1


def test_rolling_beside_angles():
    random = np.random.default_rng(1)
    angles = np.linspace(0, 2 * np.pi, 4001)
    shown = []
    for _ in range(sized(200, 50, 2000)):
        machine = random_machine(random)
        wall, claim = Wall(machine), claims_of(machine)["rolls"]
        push = wall.push(angles, wall.s)
        spare = min(push.min(), (wall.mu * push - abs(wall.need(angles))).min())
        if abs(spare) > 1e-4 * wall.s**2:
            assert claim.status == ("proven" if spare > 0 else "refuted")
            shown.append(claim.status)
        if claim.status == "proven":
            assert claim.enclosures["least_normal_force"].value == pytest.approx(push.min(), abs=1e-9)
            assert claim.enclosures["spare_friction"].value == pytest.approx(
                (wall.mu * push - abs(wall.need(angles))).min(), abs=1e-3
            )
    assert min(shown.count("proven"), shown.count("refuted")) > len(shown) / 10


def test_slides_faster_than_the_speed_told_end_in_rolling():
    random, followed = np.random.default_rng(2), 0
    while followed < sized(20, 3, 300):
        machine = random_machine(random)
        if followed % 4 == 3:
            machine["gamma"] *= -0.3
        wall, claim = Wall(machine), claims_of(machine)["attracts sliding"]
        if claim.status != "proven":
            continue
        least = claim.enclosures["speed"].value
        for w in (least * 1.001, random.uniform(least, wall.s), random.uniform(wall.s, 3 * wall.s)):
            phases, left = wall.follow(random.uniform(0, 2 * np.pi), w, starting(wall, w), LONG)
            assert not left
            assert [phase[0] for phase in phases] == [starting(wall, w), 0]
        followed += 1


def test_where_whirl_is_absent_none_repeats():
    random, left, rested = np.random.default_rng(5), 0, 0
    while left + rested < sized(40, 6, 600):
        machine = random_machine(random)
        below = claims_of(machine)["absent below"].enclosures["share"]
        share = float(Fraction(below.low)) * random.choice((0.3, 0.9, 0.999))
        slow = {**machine, "gamma": machine["gamma"] / share, "omega": machine["omega"] / share}
        if slow["gamma"] > 1000 or slow["omega"] > 1000:
            continue
        assert claims_of(slow)["absent"].status == "proven"
        wall = Wall(slow)
        w, x = random.uniform(-3, 1.5) * max(wall.s, slow["omega"]), random.uniform(0, 2 * np.pi)
        if wall.push(x, w) <= 0:
            continue
        phases, gone = wall.follow(x, w, starting(wall, w), LONG)
        assert gone or abs(phases[-1][3][-1] + 1) < 1e-5
        left, rested = left + gone, rested + (not gone)
    assert left


def test_threshold_of_the_speed_is_that_of_each_speed():
    """Just below the speed that is named whirl is absent, and just above it that is not shown."""
    random = np.random.default_rng(6)
    for _ in range(sized(40, 10, 400)):
        machine = random_machine(random)
        claims = claims_of(machine)
        if claims["absent below"].status != "proven":
            continue
        share = claims["absent below"].enclosures["share"].value
        for factor, holds in ((1 + 1e-6, False), (1 - 1e-6, True)):
            moved = {
                **machine,
                "gamma": machine["gamma"] / (share * factor),
                "omega": machine["omega"] / (share * factor),
            }
            if moved["gamma"] < 1000 and moved["omega"] < 1000:
                assert (claims_of(moved)["absent"].status == "proven") is holds


@pytest.mark.parametrize(
    ("changes", "kind", "status"),
    [
        # No friction: nothing holds rolling, but for a rotor without unbalance and damping.
        ({"mu": "0"}, "rolls", "refuted"),
        ({"mu": "0", "gamma": "0"}, "rolls", "refuted"),
        ({"mu": "0", "gamma": "0", "rho": "0"}, "rolls", "proven"),
        ({"mu": "0", "gamma": "0", "rho": "0"}, "absent", "refuted"),
        ({"mu": "0", "gamma": "0", "rho": "0"}, "attracts sliding", "undecided"),
        ({"mu": "0"}, "absent below", "proven"),
        ({"mu": "1e-30"}, "rolls", "refuted"),
        ({"mu": "1e-30"}, "absent", "proven"),
        # Just enough friction: μ(s² − ω²) = γs + p with p = 5/4.
        ({"mu": "3/4", "rho": "1", "omega": "1", "radius_ratio": "3", "gamma": "19/12"}, "rolls", "proven"),
        (
            {"mu": "3/4", "rho": "1", "omega": "1", "radius_ratio": "3", "gamma": "19/12"},
            "attracts sliding",
            "undecided",
        ),
        (
            {"mu": "3/4", "rho": "1", "omega": "1", "radius_ratio": "3", "gamma": "1583333333334/1000000000000"},
            "rolls",
            "refuted",
        ),
        # γs = μ(s² − ω²) exactly, without unbalance: the slide of constant speed rolls.
        ({"mu": "3/4", "rho": "0", "omega": "1", "radius_ratio": "3", "gamma": "2"}, "rolls", "proven"),
        ({"mu": "3/4", "rho": "0", "omega": "1", "radius_ratio": "3", "gamma": "2"}, "absent", "refuted"),
        ({"mu": "3/4", "rho": "0.1", "omega": "1", "radius_ratio": "3", "gamma": "2"}, "absent", "undecided"),
        # The wall pulls: s² − ω² = ρ exactly.
        ({"rho": "1", "omega": "2", "radius_ratio": "2", "gamma": "0"}, "rolls", "refuted"),
        ({"rho": "0", "omega": "2", "radius_ratio": "2", "gamma": "0"}, "rolls", "refuted"),
        ({"rho": "1", "omega": "2", "radius_ratio": "2", "gamma": "0"}, "absent", "undecided"),
        ({"gamma": "-0.1"}, "absent below", "undecided"),
        ({"gamma": ("0", "0.2")}, "rolls", "proven"),
        ({"gamma": ("8", "9")}, "rolls", "undecided"),
    ],
)
def test_limits(changes, kind, status):
    assert claims_of({**DECIMAL, **changes})[kind].status == status


def test_fresh_values_along_a_parameter_hold_one_by_one():
    random = np.random.default_rng(7)
    for _ in range(sized(10, 3, 100)):
        machine = random_machine(random)
        for name, high in (("mu", 2.0), ("gamma", 10.0), ("omega", 6.0), ("radius_ratio", 10.0), ("rho", 3.0)):
            low = 0.1
            for kind, claim in along(machine, name, f"double {low}", f"double {high}").items():
                if "from" not in claim.enclosures:
                    continue
                ends = [float(claim.enclosures[end].low) for end in ("from", "to")]
                for value in (*ends, random.uniform(*ends)):
                    assert claims_of({**machine, name: min(max(value, low), high)})[kind].status == "proven"
