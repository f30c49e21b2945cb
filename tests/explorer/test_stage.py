"""The pictures of the page in a real browser: two flights, the ring, the range, what is undone and kept, and what moves by itself."""

import pytest
from browsing import answered, flown, point, said
from playwright.sync_api import expect

pytestmark = pytest.mark.jit_only
MACHINE = "examples/balanced-rotor.toml"


def test_pointing_and_clicking_fly_what_comes_back_as_1_and_what_is_lost_as_2(page):
    answered(page, "beside", said(page, "carom.number"))
    before = said(page, "carom.flights[0].message.kick")
    point(page, 0.0, 0.6, click=True)
    flown(page, 1, 0.0, 0.6)
    expect(page.locator("#beside-title")).to_have_text("does not come back")
    assert said(page, "carom.flights[0].message.kick") == before
    point(page, 0.05, -0.1)
    flown(page, 0, 0.05, -0.1)
    expect(page.locator("#motion-title")).to_have_text("comes back")
    assert said(page, "carom.basin.kicks.length") == 2
    page.wait_for_function("() => carom.motion === carom.flights[0] && carom.motion.now > 0")
    answered(page, "exports", 0)


def pull(page, share: float, *, done: bool = True) -> None:
    """Pull the ring to a share of the largest."""
    ring = said(page, "carom.basin.ring / carom.basin.message.largest")
    point(page, 0.0, ring)
    page.mouse.down()
    point(page, 0.0, (ring + share) / 2)
    point(page, 0.0, share)
    if done:
        page.mouse.up()


def test_the_smallest_lost_kick_is_a_ring_that_can_be_pulled(page):
    answered(page, "loss", said(page, "carom.number"))
    page.wait_for_function("() => carom.basin.ring === carom.begun.answers.loss.size")
    expect(page.locator("#legend")).to_contain_text("smallest kick that does not come back: 67.9 mm/s")
    expect(page.locator("#legend")).to_contain_text("must survive 100 mm/s")
    expect(page.locator("#ring-note")).to_contain_text("100 % of the kicks inside the ring come back")
    kicks = said(page, "carom.basin.kicks")
    pull(page, 0.8)
    size = said(page, "carom.basin.ring")
    assert size == pytest.approx(0.8 * said(page, "carom.basin.message.largest"), rel=0.02)
    # What a click would do is not done.
    assert said(page, "carom.basin.kicks") == kicks
    share, cells = said(page, "carom.basin.shareWithin(carom.basin.ring)")
    assert 0.1 < share < 0.7
    assert cells > 100
    expect(page.locator("#ring-note")).to_contain_text(f"{100 * share:.3g} % of the kicks inside")
    page.wait_for_function("() => location.hash.includes('ring=')")
    page.locator("#basin").focus()
    page.keyboard.press("-")
    page.wait_for_function("size => carom.basin.ring < size", arg=size)
    page.locator("#reset").click()
    expect(page.locator("#legend")).to_contain_text("smallest kick that does not come back: 67.9 mm/s")


def test_each_step_is_undone_and_all_of_them_reset(page):
    expect(page.locator("#box-damping")).to_have_value("1400")
    empty = said(page, "location.hash")
    page.locator("#box-damping").fill("2500")
    page.keyboard.press("Enter")
    page.locator("#box-friction").fill("0.1")
    page.keyboard.press("Enter")
    number = said(page, "carom.number")
    answered(page, "basin", number)
    page.locator("#undo").click()
    expect(page.locator("#box-friction")).to_have_value("0.15")
    expect(page.locator("#box-damping")).to_have_value("2500")
    answered(page, "basin", number + 1)
    assert said(page, "carom.controls.value('friction')") == 0.15
    # The browser's own way back, and forth.
    page.evaluate("history.back()")
    expect(page.locator("#box-damping")).to_have_value("1400")
    page.evaluate("history.forward()")
    expect(page.locator("#box-damping")).to_have_value("2500")
    page.locator("#reset").click()
    expect(page.locator("#box-damping")).to_have_value("1400")
    assert said(page, "location.hash") == empty == ""
    page.locator("#basin").focus()
    page.keyboard.press("Control+z")
    expect(page.locator("#box-damping")).to_have_value("2500")


def test_the_address_is_a_link_to_machine_and_kicks(page, open_page):
    page.locator("#box-damping").fill("1500")
    page.keyboard.press("Enter")
    answered(page, "beside", said(page, "carom.number"))
    point(page, 0.6, -0.5, click=True)
    page.wait_for_function("() => location.hash.includes('other=')")
    kicks = said(page, "carom.basin.kicks")
    page.locator('[data-copy="link"]').click()
    expect(page.locator("#copied")).to_contain_text("is in the clipboard")
    link = said(page, "navigator.clipboard.readText()")
    assert link == page.url
    again = open_page("#" + link.partition("#")[2])
    expect(again.locator("#box-damping")).to_have_value("1500")
    again.wait_for_function("() => carom.basin.kicks.length === 2 && carom.flights.every((one) => one.message)")
    for shown, kick in zip(said(again, "carom.flights.map((one) => one.message.kick)"), kicks, strict=True):
        # Four digits.
        assert [shown["first"], shown["second"]] == pytest.approx([kick["first"], kick["second"]], rel=1e-3)
    again.close()
