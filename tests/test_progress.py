"""One kind of report of everything that takes long, and a bar."""

import io
import threading

import pytest
import rich.progress
from machines import PAPER
from rich.console import Console
from sweep_tasks import Drawn, plan_of

import carom
from carom import basins
from carom.disturbances import Grid, Sample, VelocityKick
from carom.progress import Progress, Reporter, _told, bar

KICKS = Grid(VelocityKick(0.5), (4, 6))
DAMPED = PAPER.replace(gamma=0.65, mu=0.0)
"""Every disturbance of this machine comes back at once."""

start = rich.progress.Progress.start

LONG = {
    "simulate": lambda **given: carom.simulate(PAPER, carom.kick(0.35), 20.0, **given),
    "settle": lambda **given: carom.settle(PAPER, [0.1, 0.2j], [0.3, 0.4j], **given),
    "find_attractors": lambda **given: carom.find_attractors(PAPER, count=4, known=False, **given),
    "find_bifurcations": lambda **given: carom.find_bifurcations(PAPER, "gamma", (0.1, 0.12), **given),
    "map_regions": lambda **given: carom.map_regions(
        PAPER, carom.bifurcations.Plane("gamma", "omega", (0.1, 0.12), (0.75, 0.77)), grid=2, **given
    ),
    "map_basins": lambda **given: carom.map_basins(PAPER, KICKS, **given),
    "map_gains": lambda **given: carom.map_gains(PAPER, KICKS, ("omega", "gamma"), shape=(2, 2), **given),
    "smallest_loss": lambda **given: basins.smallest_loss(PAPER, VelocityKick(0.5), directions=8, sizes=8, **given),
    "find_orbits": lambda **given: carom.find_orbits(PAPER, impacts=2, guesses=30, **given),
    "find_recovery": lambda **given: carom.studies.find_recovery(
        DAMPED, "gamma", [Sample(VelocityKick(0.5), 20)], within=(0.5, 2.0), **given
    ),
}


@pytest.mark.jit_only
@pytest.mark.parametrize("verb", LONG)
def test_reports_are_of_one_kind_and_grow_to_one(verb):
    told = []
    LONG[verb](progress=told.append)
    assert all(type(report) is Progress and report.step for report in told)
    shares = [report.share for report in told]
    assert shares == sorted(shares)
    assert shares[0] >= 0.0
    assert shares[-1] == pytest.approx(1.0)


def test_a_sweep_reports_in_the_same_way(tmp_path):
    told = []
    carom.run_sweep(plan_of(Drawn(), chunk=5), tmp_path / "s.zarr", workers=1, threads=True, progress=told.append)
    assert [type(report) for report in told] == [Progress, Progress]
    assert told[-1].share == 1.0


def test_true_shows_a_bar(monkeypatch):
    shown = []
    monkeypatch.setattr(rich.progress.Progress, "update", lambda _, task, **state: shown.append(state))
    assert carom.settle(PAPER, [0.1, 0.2j], [0.3, 0.4j], progress=True).outcomes.size == 2
    assert shown[-1] == {"completed": 1.0, "description": "following starts"}


@pytest.mark.parametrize("wish", [None, False])
def test_nothing_is_shown_unless_asked_for(wish, capfd):
    carom.settle(PAPER, [0.1], [0.3], progress=wish)
    assert capfd.readouterr() == ("", "")


def test_a_bar_appears_after_a_moment_and_shows_words_as_they_are(monkeypatch):
    screen = Console(file=io.StringIO(), width=80, force_terminal=True)
    monkeypatch.setattr(carom.progress, "PATIENCE", 0.0)
    drawn = threading.Event()
    monkeypatch.setattr(rich.progress.Progress, "start", lambda shown: (start(shown), drawn.set()))
    with bar("loading", screen) as tell:
        tell(0.5, "drawing [bold]")
        assert drawn.wait(60)
    assert "drawing [bold]" in screen.file.getvalue()


def test_parts_report_shares_of_the_whole():
    told = []
    tell = Reporter(told.append)
    part = tell.part(0.2, 0.6, "searching")
    Reporter.of(part, "what the inner function would say")(0.5)
    Reporter.of(tell.part(0.6, 1.0), "its own words")(1.0)
    part.part(0.5, 1.0)(0.0, "more")
    assert told == [
        Progress(pytest.approx(0.4), "searching"),
        Progress(pytest.approx(1.0), "its own words"),
        Progress(pytest.approx(0.4), "more"),
    ]


@pytest.mark.parametrize(
    ("share", "elapsed", "said"),
    [
        (0.0, 20.0, "drawing"),
        (0.4, 0.2, "40 %: drawing"),
        (0.4, 8.0, "40 %, 5 %/s, 12 s left: drawing"),
        (0.001, 10.0, "0 %, 0.01 %/s, 2.8 h left: drawing"),
        (1.0, 10.0, "100 %: drawing"),
    ],
)
def test_share_rate_and_time_left(share, elapsed, said):
    assert _told(share, elapsed, "drawing") == said


def test_words_that_say_what_is_left_stay_alone():
    assert _told(0.5, 10.0, "8 of 64 points, 0.5 points/s, 2 min left") == "8 of 64 points, 0.5 points/s, 2 min left"
