"""The page of a flexible machine, in a real browser."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from browsing import DESK, answered, drag, fits, painted, point, said
from playwright.sync_api import expect

pytestmark = pytest.mark.jit_only
MACHINE = Path(__file__).parents[2] / "examples" / "tum-flexible-rotor.toml"


@pytest.fixture
def page(one_page):
    """The page as it is after loading; the picture of kicks goes on being filled in meanwhile."""
    one_page.bring_to_front()
    one_page.locator("#reset").click()
    for answer in ("levitating", "motion"):
        answered(one_page, answer, said(one_page, "carom.number"))
    return one_page


def test_it_loads_and_shows_both_bearings_and_the_kicks(page):
    expect(page.locator("#headline")).to_contain_text("It levitates")
    expect(page.locator("#whirls tbody tr")).to_have_count(10)
    expect(page.locator("#places tbody tr")).to_have_count(4)
    answered(page, "basin", said(page, "carom.number"))
    assert painted(page, "basin") > 4
    page.wait_for_function("() => carom.flights.length === 4 && carom.flights.every((one) => one.now > 0)")
    expect(page.locator('[data-of-slot="beside"][data-bearing="1"]')).to_contain_text(
        re.compile(r"contacts?; largest force [\d,]+ N")
    )


def test_dragging_a_gain_changes_the_answer_at_once(page):
    before = page.locator("#whirls").inner_text()
    drag(page, "derivative", (0.55, 0.65, 0.8))
    answered(page, "levitating", said(page, "carom.number"))
    assert page.locator("#whirls").inner_text() != before
    # What contact does is pale until it is known of this machine.
    answered(page, "motion", said(page, "carom.number"))
    page.wait_for_function("() => !document.querySelector('#motion-card').classList.contains('old')")
    assert said(page, "carom.controls.settings.derivative").endswith(" A s/m")


def test_a_gain_that_does_not_hold_the_rotor_is_said(page):
    page.locator("#box-proportional").fill("1500")
    page.keyboard.press("Enter")
    expect(page.locator("#headline")).to_contain_text("It does not levitate")
    expect(page.locator("#motion-words")).to_contain_text("No disturbance is followed")
    expect(page.locator("#sentence")).to_contain_text("No disturbance is followed")
    expect(page.locator("#clear")).to_have_text("–")


def test_single_bearings_follow_what_is_set_of_all(page):
    page.locator("details summary").click()
    page.locator("#box-proportional_2").fill("4500")
    page.keyboard.press("Enter")
    expect(page.locator("#box-proportional")).to_have_attribute("placeholder", "differ")
    drag(page, "proportional", (0.55,))
    page.wait_for_function("() => !('proportional_2' in carom.controls.settings)")
    expect(page.locator("#box-proportional_2")).to_have_value(
        said(page, "String(carom.controls.value('proportional'))")
    )
    page.locator("details summary").click()


def test_a_kick_that_is_clicked_is_followed_and_kept_in_the_address(page):
    for answer in ("basin", "motion", "beside"):
        answered(page, answer, said(page, "carom.number"))
    point(page, -0.15, 0.05, click=True)
    page.wait_for_function("() => location.hash.includes('kick=-')")
    page.wait_for_function("() => carom.motion.message.kick.second > 0")
    expect(page.locator("#motion-words")).to_contain_text(re.compile(r"A kick of [\d.]+ mm/s at "))
    assert re.search(r"--kick '[\d.]+ mm/s,", said(page, "carom.panels.exports.command"))


def test_it_fits_a_narrow_screen_too(page):
    page.set_viewport_size({"width": 390, "height": 800})
    fits(page, 390)
    page.set_viewport_size(DESK)
    fits(page, DESK["width"])
