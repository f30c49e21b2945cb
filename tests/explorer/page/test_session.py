"""Requests of a page and the answers to them, without a browser."""

import queue
import threading

import pytest

import carom
from carom.explorer.computing.exports import Origin
from carom.explorer.page import questions
from carom.explorer.page.session import Session

MACHINE = "examples/keogh-cole.toml"
SOON = 120.0
"""Seconds after which an answer is taken to be missing."""


class Page:
    """A session whose answers are kept."""

    def __init__(self, ready: threading.Event) -> None:
        self.stated: queue.Queue = queue.Queue()
        self.seen: list[tuple[str, object]] = []
        origin = Origin(MACHINE, (), carom.load(MACHINE))
        self.session = Session(origin, lambda name, value: self.stated.put((name, value)), ready)

    def until(self, name, fits=lambda value: True):
        """Wait for an answer."""
        while True:
            found, value = self.stated.get(timeout=SOON)
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
        lambda case, tell: {"lead": "It may not.", "advice": "Change: damping.", "survived": ["Kick: no."]},
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


def test_a_wrong_value_changes_nothing_and_the_page_goes_on(page):
    page.session.show(request(1, held=True, damping="a lot"))
    problem = page.until("reply")
    assert problem["names"] == ["damping"]
    assert problem["text"].startswith("damping = a lot: must be a damping in N s/m")
    page.session.show(request(2, held=True, damping="2000"))
    reply = page.until("reply")
    assert (reply["number"], reply["shown"], reply["text"], reply["names"]) == (2, 2, "", [])
    assert page.numbered("basin", 2)["levitates"]


def test_a_kick_is_followed(page):
    page.session.kick({"number": 1, "slot": 1, "first": 82.8532135767, "second": -41.4266067884})
    motion = page.until("beside")
    assert motion["kick"] == {"first": 82.8532135767, "second": -41.4266067884}
    assert motion["words"].startswith("A kick of 92.6 mm/s at 185° ends in regular bouncing; hardest impulse")


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
    none = {"size": 0.0, "value": "none found", "remark": ""}
    monkeypatch.setattr(questions, "find_loss", lambda rotor, plane, largest, tell: none)
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
        return {"words": "every kick comes back", "share": "100 %", "open": []}

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
