"""One kind of report of everything that takes long, and a bar."""

import io
import sys
import threading
from types import SimpleNamespace
from typing import ClassVar

import pytest
import rich.console
import rich.progress
from machines import PAPER
from sweep_tasks import Drawn, plan_of

import carom
from carom import basins
from carom.base.progress import Progress, Reporter, shows_progress
from carom.disturbances import Grid, Sample, VelocityKick

KICKS = Grid(VelocityKick(0.5), (4, 6))
DAMPED = PAPER.replace(gamma=0.65, mu=0.0)
"""Every disturbance of this machine comes back at once."""

start = rich.progress.Progress.start

LONG = {
    "simulate": lambda **given: carom.simulate(PAPER, carom.kick(0.35), 20.0, **given),
    "settle": lambda **given: carom.settle(PAPER, carom.State([0.1, 0.2j], [0.3, 0.4j]), **given),
    "find_attractors": lambda **given: carom.find_attractors(PAPER, count=4, known=False, **given),
    "find_bifurcations": lambda **given: carom.find_bifurcations(PAPER, "gamma", (0.1, 0.12), **given),
    "map_regions": lambda **given: carom.map_regions(
        PAPER, carom.bifurcations.Plane("gamma", "omega", (0.1, 0.12), (0.75, 0.77)), grid=2, **given
    ),
    "map_basins": lambda **given: carom.map_basins(PAPER, KICKS, **given),
    "map_gains": lambda **given: carom.map_gains(PAPER, KICKS, {"omega": 2, "gamma": 2}, **given),
    "smallest_unrecovered": lambda **given: basins.smallest_unrecovered(
        PAPER, VelocityKick(0.5), directions=8, sizes=8, **given
    ),
    "find_orbits": lambda **given: carom.find_orbits(PAPER, impacts=2, guesses=30, **given),
    "find_recovery": lambda **given: carom.studies.find_recovery(
        DAMPED, "gamma", [Sample(VelocityKick(0.5), 20)], within=(0.5, 2.0), **given
    ),
}


@pytest.mark.jit_only
@pytest.mark.parametrize("verb", LONG)
def test_reports_are_of_one_kind_and_grow_to_one(verb):
    shown = []
    LONG[verb](progress=shown.append)
    assert all(type(report) is Progress and report.step for report in shown)
    shares = [report.share for report in shown]
    assert shares == sorted(shares)
    assert shares[0] >= 0.0
    assert shares[-1] == pytest.approx(1.0)


def test_a_sweep_reports_in_the_same_way(tmp_path):
    shown = []
    carom.run_sweep(plan_of(Drawn(), chunk=5), tmp_path / "s.zarr", workers=1, threads=True, progress=shown.append)
    assert [type(report) for report in shown] == [Progress, Progress]
    assert shown[-1].share == 1.0


class AtOnce:
    """A timer that does not wait, and keeps how long it was to."""

    waits: ClassVar[list[float]] = []

    def __init__(self, patience, function):
        self.waits.append(patience)
        self.start = function

    def cancel(self):
        pass


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def terminal(monkeypatch):
    """An error stream that someone watches, and bars that appear at once."""
    monkeypatch.delenv("CAROM_PROGRESS", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(carom.base.progress, "Timer", AtOnce)
    stream = Terminal()
    # Not the stream itself, which pytest sets anew before the test.
    monkeypatch.setattr(carom.base.progress, "sys", SimpleNamespace(stderr=stream, modules=sys.modules))
    monkeypatch.setattr(rich.console.Console, "file", stream)
    return stream


@shows_progress
def inner(*, progress=None):
    Reporter.of(progress, "the part")(0.5)


@shows_progress
def outer(*, progress=None):
    Reporter.of(progress, "the whole")(0.5)
    inner()


def test_where_someone_watches_one_bar_appears_by_itself_and_leaves_nothing(terminal):
    outer()
    text = terminal.getvalue()
    assert " 50%" in text
    assert "the whole" in text
    assert "the part" not in text
    assert text.endswith("\x1b[1A\x1b[2K")  # up to the line of the bar, which is erased


@pytest.mark.parametrize(
    "why", ["not wanted", "by nobody", "in another thread", "in another process", "by the environment"]
)
def test_no_bar_appears_where_it_is_not_wanted_or_not_seen(why, terminal, monkeypatch):
    if why == "by nobody":
        monkeypatch.setattr(terminal, "isatty", lambda: False)
    if why == "in another process":
        monkeypatch.setattr(carom.base.progress, "current_process", lambda: SimpleNamespace(name="LokyProcess-1"))
    if why == "by the environment":
        monkeypatch.setenv("CAROM_PROGRESS", "0")
    if why == "in another thread":
        thread = threading.Thread(target=outer)
        thread.start()
        thread.join()
    else:
        outer(progress=False if why == "not wanted" else None)
    assert terminal.getvalue() == ""


def test_parts_report_shares_of_the_whole():
    shown = []
    tell = Reporter(shown.append)
    part = tell.part(0.2, 0.6, "searching")
    Reporter.of(part, "what the inner function would say")(0.5)
    Reporter.of(tell.part(0.6, 1.0), "its own words")(1.0)
    part.part(0.5, 1.0)(0.0, "more")
    assert shown == [
        Progress(pytest.approx(0.4), "searching"),
        Progress(pytest.approx(1.0), "its own words"),
        Progress(pytest.approx(0.4), "more"),
    ]
