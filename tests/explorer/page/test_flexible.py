"""Requests of the page of a flexible machine and the answers to them, without a browser."""

from __future__ import annotations

import queue
import re
import threading

import pytest
from flexible_pages import opened

from carom.explorer.computing import flexible_kicks as kicks
from carom.explorer.page import flexible
from carom.explorer.page.session import Session

SOON = 240.0
"""Seconds after which an answer is taken to be missing."""
pytestmark = pytest.mark.jit_only


class Page:
    """A session whose answers are kept."""

    def __init__(self) -> None:
        self.told, self.seen, ready = queue.Queue(), [], threading.Event()
        ready.set()
        self.session = Session(opened("gravity=0"), lambda name, value: self.told.put((name, value)), ready)

    def until(self, name, fits=lambda value: True):
        """Wait for an answer."""
        while True:
            found, value = self.told.get(timeout=SOON)
            self.seen.append((found, value))
            if found == name and fits(value):
                return value

    def has(self, name):
        """Wait for an answer unless it has come."""
        if name not in dict(self.seen):
            self.until(name)

    def numbered(self, name, number):
        return self.until(name, lambda value: value["number"] == number)


@pytest.fixture
def page(monkeypatch):
    monkeypatch.setattr(kicks, "CELLS", 9)
    monkeypatch.setattr(kicks, "TIMES", (1.0,))
    # Computing it takes seconds; it has a test of its own.
    monkeypatch.setattr(flexible, "told_more", lambda reduced, tell: {"Accuracy": ("An estimate.",)})
    kicks.opening_size.cache_clear()
    found = Page()
    yield found
    found.session.close()
    kicks.opening_size.cache_clear()


def request(number, held=False, view=None, **settings):
    return {"number": number, "settings": settings, "held": held, "along": "", "view": view or {}}


def test_a_machine_is_answered_with_everything_and_the_picture_is_filled_in(page):
    page.session.show(request(1, derivative="6"))
    page.until("state", lambda state: state["kind"] == "idle")
    page.has("motion")
    answers = {}
    for name, value in page.seen:
        answers.setdefault(name, []).append(value)
    assert set(answers) == {"reply", "levitating", "exports", "motion", "state", "basin", "told"}
    assert answers["levitating"][-1]["holds"]
    pictures = answers["basin"]
    counts = [int(re.search(r": (\d+) followed", each["share_remark"])[1]) for each in pictures]
    assert counts == sorted(counts)
    assert [each["coarse"] for each in pictures] == [*[True] * (len(pictures) - 2), False, False]
    assert all(each["lost"] == "–" and each["lost_size"] == 0.0 for each in pictures if each["coarse"])
    assert counts[0] < counts[-1] == (pictures[-1]["cells"] != 255).sum()
    assert [name for name, _ in page.seen].index("told") > [name for name, _ in page.seen].index("basin")
    assert "--set 'derivative=6 A s/m'" in answers["exports"][-1]["options"]
    assert len(answers["motion"][-1]["planes"]) == 2


def test_while_a_slider_is_held_no_kicks_are_followed_for_the_picture(page):
    page.session.show(request(1, held=True, proportional="6000"))
    assert page.numbered("levitating", 1)["holds"]
    page.has("motion")
    assert {name for name, _ in page.seen} == {"reply", "levitating", "motion"}


def test_a_machine_that_does_not_levitate_is_shown_as_such(page):
    page.session.show(request(1, delay="2"))
    assert page.numbered("levitating", 1)["lead"].startswith("It does not levitate")
    assert page.numbered("basin", 1)["refused"].startswith("No kick is followed")
    page.session.show(request(2, unbalance="4 kg mm"))
    assert page.numbered("motion", 2)["refused"].startswith("No kick is followed")
    page.session.show(request(3))
    assert page.numbered("levitating", 3)["holds"]


def test_values_tell_where_parts_differ(page):
    page.session.show(request(1, held=True, proportional="6000", proportional_2="5500"))
    values = page.until("reply")["values"]
    assert (values["proportional"], values["proportional_1"], values["proportional_2"]) == (None, 6000.0, 5500.0)


def test_a_wrong_value_is_named_and_the_rest_is_shown(page):
    page.session.show(request(1, held=True, friction="much", derivative="6"))
    reply = page.until("reply")
    assert (reply["names"], reply["values"]["derivative"], reply["values"]["friction"]) == (["friction"], 6.0, 0.15)


def test_a_kick_is_followed_as_it_is_asked_for(page):
    page.session.kick({"number": 1, "slot": 0, "first": 30.0, "second": 40.0, "chosen": True})
    motion = page.until("motion")
    assert motion["kick"] == {"first": 30.0, "second": 40.0}
    assert motion["words"].startswith("A kick of 50 mm/s at 53.1°")
    page.session.kick({"number": 2, "slot": 1, "first": 1.0, "second": 0.0})  # there is one kick only
    page.session.show(request(1, held=True, view={"kicks": [[5.0, 0.0]], "largest": 12.0}))
    assert page.numbered("motion", 1)["kick"] == {"first": 5.0, "second": 0.0}
    assert "--kick '50 mm/s,53.1301024 deg'" in next(value for name, value in page.seen if name == "exports")["command"]


def test_a_kick_stays_the_same_in_its_unit_when_the_speed_changes(page):
    page.session.show(request(1, held=True, speed="1500", view={"kicks": [[20.0, 0.0]]}))
    assert page.numbered("motion", 1)["words"].startswith("A kick of 20 mm/s at 0°")
