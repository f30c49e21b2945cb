"""Requests of a page and the answers to them, without a browser."""

from __future__ import annotations

import queue
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest

import carom
from carom.explorer.computing.exports import Origin
from carom.explorer.computing.judgement import Loss
from carom.explorer.page import questions
from carom.explorer.page import session as sessions
from carom.explorer.page.session import Session

MACHINE = str(Path(__file__).parents[3] / "examples" / "keogh-cole.toml")
SOON = 120.0
"""Seconds after which an answer is taken to be missing."""


class Page:
    """A session whose answers are kept."""

    def __init__(self, ready: threading.Event) -> None:
        self.told: queue.Queue = queue.Queue()
        self.seen: list[tuple[str, object]] = []
        origin = Origin(MACHINE, (), carom.load(MACHINE))
        self.session = Session(origin, lambda name, value: self.told.put((name, value)), ready)

    def until(self, name, fits=lambda value: True):
        """Wait for an answer."""
        while True:
            found, value = self.told.get(timeout=SOON)
            self.seen.append((found, value))
            if found == name and fits(value):
                return value

    def numbered(self, name, number):
        return self.until(name, lambda value: value["number"] == number)


@pytest.fixture
def page(monkeypatch):
    monkeypatch.setattr(questions, "COARSE", 8)
    monkeypatch.setattr(questions, "COARSEST", 4)
    monkeypatch.setattr(questions, "FINE", 10)
    # A study takes seconds; the verdict has a test of its own.
    monkeypatch.setattr(
        questions,
        "judge",
        lambda case, tell: SimpleNamespace(lead="It may not.", advice="Change: damping.", survived=("Kick: no.",)),
    )
    ready = threading.Event()
    ready.set()
    opened = Page(ready)
    yield opened
    opened.session.close()


def request(number, held=False, along="", **settings):
    return {"number": number, "settings": settings, "held": held, "along": along}


@pytest.mark.jit_only
def test_a_machine_is_answered_with_everything(page):
    page.session.show(request(1, damping="2500 N s/m"))
    page.until("state", lambda state: state["kind"] == "idle")
    answers = {}
    for name, value in page.seen:
        answers.setdefault(name, []).append(value)
    assert [basin["size"] for basin in answers["basin"]] == [8, 10]
    assert {name for name, values in answers.items() if values[-1] and values[-1].get("number") == 1} >= {
        "levitating", "basin", "motion", "beside", "table", "response", "loss", "hardest", "diagram", "verdict",
    }  # fmt: skip
    assert answers["verdict"][-1] == {
        "lead": "It may not.",
        "advice": "Change: damping.",
        "survived": ["Kick: no."],
        "number": 1,
    }
    assert answers["diagram"][-1]["name"] == "damping"
    assert "2500.0 N s/m" in answers["exports"][-1]["toml"]
    assert answers["reply"][-1]["text"] == ""


def test_while_a_slider_is_held_only_what_is_quick_is_done(page):
    page.session.show(request(1, held=True, damping="2500"))
    basin = page.numbered("basin", 1)
    assert basin["size"] <= 8
    page.numbered("table", 1)
    assert {name for name, _ in page.seen} == {"reply", "levitating", "motion", "beside", "table", "basin"}


def test_while_a_slider_moves_on_only_the_picture_is_computed(page, monkeypatch):
    monkeypatch.setattr(sessions, "PAUSE", 2 * SOON)
    for number, damping in enumerate(("2000", "2500"), start=1):
        page.session.show(request(number, held=True, damping=damping))
        page.numbered("basin", number)
    page.session.show(request(3, damping="3000"))
    page.numbered("table", 3)
    assert [value["number"] for name, value in page.seen if name in ("motion", "table")] == [3, 3]


def test_the_picture_is_as_fine_as_it_can_follow_the_hand(page):
    page.session.questions._cost = 1.0
    page.session.show(request(1, held=True))
    assert page.numbered("basin", 1)["size"] == 4


def test_a_wrong_value_changes_nothing_and_the_page_goes_on(page):
    page.session.show(request(1, held=True, damping="a lot"))
    problem = page.until("reply")
    assert problem["names"] == ["damping"]
    assert problem["text"].startswith("damping = a lot: must be a damping in N s/m")
    page.session.show(request(2, held=True, damping="2000"))
    reply = page.until("reply")
    assert (reply["number"], reply["shown"], reply["text"], reply["names"]) == (2, 2, "", [])
    assert page.numbered("basin", 2)["levitates"]


def test_a_page_that_begins_with_a_wrong_value_shows_the_machine_without_it(page):
    page.session.show(request(1, held=True, damping="a lot", friction="0.1"))
    reply = page.until("reply")
    assert (reply["shown"], reply["names"]) == (1, ["damping"])
    assert (reply["values"]["damping"], reply["values"]["friction"]) == (1400.0, 0.1)
    assert page.numbered("basin", 1)["levitates"]


def test_a_wrong_value_leaves_what_is_shown_and_other_sliders_still_move(page):
    page.session.show(request(1, held=True, damping="2500"))
    page.session.show(request(2, held=True, damping="a lot"))
    page.session.show(request(3, held=True, damping="a lot", friction="0.1"))
    values = [page.numbered("reply", number)["values"] for number in (1, 2, 3)]
    assert [value["damping"] for value in values] == [2500.0] * 3
    assert [value["friction"] for value in values] == [values[0]["friction"]] * 2 + [0.1]
    assert page.numbered("basin", 3)["levitates"]


def test_a_wrong_value_does_not_swallow_what_is_being_computed(page, monkeypatch):
    begun, go_on = threading.Event(), threading.Event()

    def slow(rotor, plane, largest, tell):
        begun.set()
        go_on.wait(SOON)
        tell(carom.base.progress.Progress(1.0, "found"))
        return Loss(None, "none found", "")

    monkeypatch.setattr(questions, "find_loss", slow)
    page.session.show(request(1))
    assert begun.wait(SOON)
    page.session.show(request(2, damping="a lot"))
    assert page.numbered("reply", 2)["shown"] == 1
    go_on.set()
    assert page.numbered("loss", 1)["value"] == "none found"
    assert page.numbered("verdict", 1)["lead"] == "It may not."


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [("speed", "20 Hz", 1200.0), ("speed", "1 759 rpm", 1759.0), ("eccentricity", "300 um", 0.3), ("stiffness", "980 N/mm", 980_000.0)],
)  # fmt: skip
def test_what_is_typed_is_told_in_the_unit_of_its_slider(page, name, text, value):
    page.session.show(request(1, held=True, **{name: text}))
    assert page.until("reply")["values"][name] == pytest.approx(value, rel=1e-11)  # as many digits are told


def test_a_machine_whose_orbits_cannot_be_computed_is_told_as_such(page, monkeypatch):
    def refuse(rotor):
        raise carom.base.outcome.CaromError("no orbits; change the damping")

    monkeypatch.setattr(questions, "table_of", refuse)
    page.session.show(request(1, held=True))
    assert page.numbered("basin", 1)["size"]
    assert page.numbered("table", 1)["refused"] == "no orbits; change the damping"


def test_a_machine_that_cannot_levitate_is_shown(page):
    page.session.show(request(1, held=True, damping="300"))
    basin = page.numbered("basin", 1)
    assert not basin["levitates"]
    assert basin["sentence"] == "It cannot levitate with these values. The kicks disturb the synchronous rub."
    assert basin["harmless"] == 0.0


def test_a_kick_is_followed(page):
    page.session.kick({"number": 1, "slot": 1, "first": 82.8532135767, "second": -41.4266067884})
    motion = page.until("beside")
    assert motion["kick"] == {"first": 82.8532135767, "second": -41.4266067884}
    assert motion["words"].startswith("A kick of 92.6 mm/s at 185° ends in regular bouncing; hardest impulse")


@pytest.mark.parametrize("first", [1e15, float("nan"), float("inf"), "a lot", None, True])
def test_what_is_no_kick_is_not_followed(page, first):
    page.session.kick({"number": 1, "slot": 0, "first": first, "second": 0.0})
    page.session.kick({"number": 2, "slot": 7, "first": 1.0, "second": 0.0})
    page.session.kick({"number": 3, "slot": 0, "first": 10.0, "second": 0.0})
    assert page.until("motion")["kick"]["first"] == 10.0


def test_a_chosen_kick_is_in_the_program_that_can_be_copied(page):
    page.session.kick({"number": 1, "slot": 1, "first": 82.8532136, "second": 0.0, "chosen": True})
    exports = page.until("exports")
    assert 'cm.kick("82.8532136 mm/s", ' in exports["python"]
    assert "--kick '82.8532136 mm/s,21" in exports["command"]


@pytest.mark.jit_only
def test_both_kicks_of_a_picture_end_differently(page):
    page.session.show(request(1, held=True, eccentricity="0.15 mm"))
    back, lost = page.numbered("motion", 1), page.numbered("beside", 1)
    assert back["outcome"] == "levitated"
    assert lost["outcome"] != "levitated"


@pytest.mark.parametrize(("kind", "unit"), [("shock", "g"), ("blade-loss", "g mm"), ("kick", "mm/s"), ("rain", "mm/s")])
def test_the_view_says_what_is_shown_and_how_far(page, kind, unit):
    view = {"kind": kind, "largest": 7.5, "kicks": [[1.0, 2.0], [3.0, -4.0]]}
    page.session.show({**request(1, held=True, eccentricity="0.15 mm"), "view": view})
    basin = page.numbered("basin", 1)
    assert (basin["unit"], basin["largest"]) == (unit, pytest.approx(7.5, rel=1e-12))
    motion, beside = page.numbered("motion", 1), page.numbered("beside", 1)
    assert [one["kick"] for one in (motion, beside)] == [{"first": 1.0, "second": 2.0}, {"first": 3.0, "second": -4.0}]


@pytest.mark.parametrize(
    "view",
    [
        None,
        3,
        {"largest": -1.0},
        {"largest": "far"},
        {"kicks": [[1.0]]},
        {"kicks": [[1.0, None], [0, 0]]},
        {"kicks": 4},
    ],
)
def test_a_view_that_cannot_be_read_is_chosen_for_the_machine(page, view):
    page.session.show({**request(1, held=True), "view": view})
    basin = page.numbered("basin", 1)
    assert basin["largest"] == pytest.approx(basin["opening"], rel=1e-12)
    assert page.numbered("motion", 1)["words"].startswith("A kick of ")


@pytest.mark.jit_only
def test_a_diagram_is_kept_while_only_its_own_slider_moves(page, monkeypatch):
    made, real = [], questions.picture_along
    monkeypatch.setattr(questions, "picture_along", lambda *given: made.append(given[1].name) or real(*given))
    for number, settings in enumerate(
        [{"damping": "2000"}, {"damping": "2500"}, {"damping": "2500", "friction": "0.2"}], start=1
    ):
        page.session.show(request(number, along="damping", **settings))
        page.numbered("diagram", number)
    assert made == ["damping", "damping"]


def test_what_takes_long_can_be_stopped_and_goes_on(page, monkeypatch):
    begun = threading.Event()

    def endless(rotor, plane, largest, tell):
        begun.set()
        while True:
            tell(carom.base.progress.Progress(0.5, "still looking"))

    monkeypatch.setattr(questions, "find_loss", endless)
    page.session.show(request(1))
    assert begun.wait(SOON)
    page.until("state", lambda state: state["kind"] == "working" and state["words"] == "still looking")
    page.session.cancel()
    page.until("state", lambda state: state["kind"] == "cancelled")
    monkeypatch.setattr(questions, "find_loss", lambda rotor, plane, largest, tell: Loss(None, "none found", ""))
    page.session.resume()
    assert page.numbered("loss", 1)["value"] == "none found"
    page.until("state", lambda state: state["kind"] == "idle")
    # The picture was fine before the work was stopped, and is not made again.
    assert [value["size"] for name, value in page.seen if name == "basin"] == [8, 10]
    page.session.show(request(2, held=True))
    assert page.numbered("basin", 2)


def test_two_pages_do_not_know_of_each_other(page):
    other = Page(page.session._ready)
    page.session.show(request(1, held=True, damping="2500"))
    other.session.show(request(1, held=True, damping="3500"))
    first, second = page.numbered("basin", 1), other.numbered("basin", 1)
    other.session.close()
    assert first["share"] != second["share"]


def test_a_page_waits_for_the_kernels_and_says_so():
    ready = threading.Event()
    waiting = Page(ready)
    waiting.session.kick({"slot": 0, "first": 0.1, "second": 0.0})
    assert waiting.until("state") == {"kind": "compiling"}
    ready.set()
    assert waiting.until("motion")["outcome"]
    waiting.session.close()


@pytest.mark.jit_only
def test_what_is_wished_is_done_only_then_and_for_the_machine_shown(page, monkeypatch):
    asked = []

    def find(rotor, plane, largest, tell):
        asked.append((plane.name, largest))
        return SimpleNamespace(words="every kick comes back", share="100 %", open=[])

    monkeypatch.setattr(questions, "find_proven", find)
    page.session.show(request(1))
    page.until("state", lambda state: state["kind"] == "idle")
    assert not asked
    page.session.wish({"name": "unknown"})
    page.session.wish({"name": "proven", "count": 1})
    assert page.numbered("proven", 1)["words"] == "every kick comes back"
    page.until("state", lambda state: state["kind"] == "idle")
    ((name, largest),) = asked
    basin = [value for answer, value in page.seen if answer == "basin"][-1]
    assert (name, basin["kind"]) == ("kick", "kick")
    assert basin["largest"] == pytest.approx(1e3 * largest * page.session._shown.subject.rotor.scales.velocity)
