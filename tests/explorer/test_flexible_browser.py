"""The page of a flexible machine, in a real browser."""

import re

import pytest
from browsing import answered, painted, said
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
