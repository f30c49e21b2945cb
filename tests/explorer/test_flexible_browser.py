"""The page of a flexible machine, in a real browser."""

import re

import pytest
from browsing import answered, drag, painted, said
from playwright.sync_api import expect

pytestmark = pytest.mark.jit_only
MACHINE = "examples/tum-flexible-rotor.toml"


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
