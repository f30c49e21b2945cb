"""Many motions in one call end as each does alone, whatever the threads."""

import numpy as np
import pytest
from compilation import COMPILED
from machines import PAPER

import carom
from carom.base.outcome import InputError, Outcome
from carom.motions import Endings, portions, settle

SAME = ("outcomes", "times", "impacts", "multiplicities", "positions", "velocities")


MANY = 40 if COMPILED else 4


def starts(count: int, seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    positions = np.sqrt(rng.uniform(0, 1, count)) * np.exp(2j * np.pi * rng.uniform(0, 1, count))
    positions[::7] /= np.abs(positions[::7])
    velocities = 2 * np.sqrt(rng.uniform(0, 1, count)) * np.exp(2j * np.pi * rng.uniform(0, 1, count))
    return positions, velocities


def assert_same(first: Endings, second: Endings) -> None:
    for name in SAME:
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name), err_msg=name)


@pytest.fixture
def machine() -> carom.parameters.Parameters:
    return PAPER


@pytest.mark.jit_only
def test_impacts_of_motions_that_come_to_levitate_are_counted(machine):
    """Also those since a lane was last looked at."""
    rotor = carom.models.jeffcott(machine.replace(rho=0.2))
    positions, velocities = starts(100)
    together = settle(rotor, carom.State(positions, velocities))
    levitated = np.flatnonzero(together.outcomes == Outcome.LEVITATED)
    assert (together.impacts[levitated] > 1).sum() > 5
    for place in levitated:
        alone = carom.simulate(rotor, carom.State(positions[place], velocities[place]), 2e5, settle=True)
        assert together.impacts[place] == len(alone.contacts)


@pytest.mark.parametrize("until", [1e-3, 1.0, 2.9, 3.1, 50.0])
def test_what_levitates_is_known_to_however_short_the_time(machine, until):
    rotor = carom.models.jeffcott(machine)
    at_rest = carom.State(rotor.equilibrium, 0j)
    alone = carom.simulate(rotor, at_rest, until, settle=True)
    together = settle(rotor, carom.State(at_rest.position, at_rest.velocity), until=until)
    assert together.outcomes == alone.outcome == Outcome.LEVITATED


def test_speeds_that_overflow_are_refused(machine):
    rotor = carom.models.jeffcott(machine)
    with pytest.raises(carom.base.outcome.InputError, match=r"^start velocity.*1e\+12"):
        settle(rotor, carom.State([0.0, 0.1], [1.0, 1e120j]))
    with pytest.raises(carom.base.outcome.InputError, match=r"^start velocity.*1e\+12"):
        carom.simulate(rotor, carom.State(0.0, 1e120), 1.0)
    assert settle(rotor, carom.State(0.1, 1e11)).outcomes not in (Outcome.LEVITATED, Outcome.TIME_REACHED)


@pytest.mark.jit_only
def test_each_ends_as_it_does_alone(machine):
    rotor = carom.models.jeffcott(machine)
    positions, velocities = starts(24 if COMPILED else 2)
    together = settle(rotor, carom.State(positions, velocities))
    for place in range(len(positions)):
        alone = carom.simulate(rotor, carom.State(positions[place], velocities[place]), 2e5, settle=True)
        assert together.outcomes[place] == alone.outcome
        assert together.multiplicities[place] == alone.multiplicity
        # The last digits differ, and with them by how many impacts a state has come near to itself.
        recurs = alone.outcome in (Outcome.BOUNCING, Outcome.MIXED)
        assert together.impacts[place] == pytest.approx(len(alone.contacts), abs=3 if recurs else 0)
    assert len(np.unique(together.outcomes)) == 3 or not COMPILED


@pytest.mark.parametrize("restitution", [0.95, 0.5, 0.0])
def test_each_moves_as_it_does_alone(machine, restitution):
    rotor = carom.models.jeffcott(machine.replace(d=restitution))
    positions, velocities = starts(MANY)
    together = settle(rotor, carom.State(positions, velocities), until=20.0, patience=0)
    for place in range(len(positions)):
        alone = carom.simulate(rotor, carom.State(positions[place], velocities[place]), 20.0)
        assert together.outcomes[place] == alone.outcome == Outcome.TIME_REACHED
        assert together.impacts[place] == len(alone.contacts)
        assert together.positions[place] == pytest.approx(alone.final.position, abs=1e-9)
        assert together.velocities[place] == pytest.approx(alone.final.velocity, abs=1e-9)


def test_threads_and_company_change_nothing(machine):
    rotor = carom.models.jeffcott(machine)
    positions, velocities = starts(MANY)
    one = settle(rotor, carom.State(positions, velocities), threads=1)
    assert_same(one, settle(rotor, carom.State(positions, velocities), threads=3))
    half = settle(rotor, carom.State(positions[::2], velocities[::2]))
    for name in SAME:
        np.testing.assert_array_equal(getattr(one, name)[::2], getattr(half, name), err_msg=name)


@pytest.mark.jit_only
def test_starts_may_have_machines_of_their_own(machine):
    rotors = [carom.models.jeffcott(machine.replace(gamma=gamma)) for gamma in (0.6, 0.4, 0.8)]
    positions, velocities = starts(MANY)
    which = np.arange(MANY) % 3
    mixed = settle(rotors, carom.State(positions, velocities), which=which)
    for number, rotor in enumerate(rotors):
        alone = settle(rotor, carom.State(positions[which == number], velocities[which == number]))
        for name in SAME:
            np.testing.assert_array_equal(getattr(mixed, name)[which == number], getattr(alone, name), err_msg=name)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"position": [0.1, 1.5]}, "start position = .*inside the wall"),
        ({"position": [0.1, np.nan]}, "^start position = .*: finite numbers"),
        ({"velocity": [np.inf, 0.0]}, "^start velocity = .*: finite numbers"),
        ({"time": [0.0, np.inf]}, "^start time = "),
        ({"shaft": (1.0, 0.0)}, "^start races, shaft = "),
        ({"patience": 0}, "until = nothing given"),
        ({"which": [0, 0]}, "which = "),
    ],
)
def test_bad_input_is_named(machine, changes, words):
    given = {"position": [0.1, 0.2], "velocity": [0.0, 0.0], **changes}
    limits = {name: given.pop(name) for name in ("patience", "which") if name in given}
    with pytest.raises(InputError, match=words):
        settle(carom.models.jeffcott(machine), carom.State(**given), **limits)


@pytest.mark.jit_only
def test_whoever_interrupts_its_progress_ends_the_work(monkeypatch):
    """Within one portion too: irregular bouncing that takes seconds ends at the first report."""
    taken, real = [], portions.follow_each

    def counted(*task):
        taken.append(int(real(*task)))
        return taken[-1]

    def interrupt(report):
        raise KeyboardInterrupt

    monkeypatch.setattr(portions, "follow_each", counted)
    rotor = PAPER.replace(gamma=0.2, mu=0.0, d=1.0)
    with pytest.raises(KeyboardInterrupt):
        settle(
            rotor,
            carom.State(carom.models.rotor_of(rotor).equilibrium, np.linspace(0.1, 1.5, 8000)),
            threads=2,
            progress=interrupt,
        )
    assert len(taken) == 2
    assert sum(taken) < 8000


@pytest.mark.jit_only
def test_progress_counts_the_motions_up_to_all_of_them():
    shown = []
    settle(
        PAPER,
        carom.State(0.1, np.linspace(0.1, 0.6, 3000)),
        threads=2,
        progress=lambda report: shown.append(report.share),
    )
    assert shown == sorted(shown)
    assert shown[-1] == 1.0
