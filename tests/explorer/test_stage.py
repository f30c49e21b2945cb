"""The pictures of the page in a real browser: two flights, the ring, the range, what is undone and kept, and what moves by itself."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from browsing import DESK, answered, fits, flown, point, said
from playwright.sync_api import expect

from carom.explorer.computing.kicks import TRIED

pytestmark = pytest.mark.jit_only
MACHINE = Path(__file__).parents[2] / "examples" / "balanced-rotor.toml"


def test_pointing_and_clicking_fly_what_comes_back_as_1_and_what_is_lost_as_2(page):
    answered(page, "beside", said(page, "carom.number"))
    before = said(page, "carom.flights[0].message.kick")
    point(page, 0.0, 0.6, click=True)
    flown(page, 1, 0.0, 0.6)
    expect(page.locator("#beside-title")).to_have_text("is lost")
    assert said(page, "carom.flights[0].message.kick") == before
    point(page, 0.05, -0.1)
    flown(page, 0, 0.05, -0.1)
    expect(page.locator("#motion-title")).to_have_text("comes back")
    assert said(page, "carom.basin.kicks.length") == 2
    page.wait_for_function("() => carom.motion === carom.flights[0] && carom.motion.now > 0")
    answered(page, "exports", 0)


def test_both_flights_are_played_again(page):
    answered(page, "beside", said(page, "carom.number"))
    page.wait_for_function("() => carom.flights.every((one) => one.message && one.now > 0)")
    page.locator("#replay").click()
    page.wait_for_function("() => carom.flights.every((one) => one.running)")
    page.locator('input[name="frame"][value="fixed"]').check()
    assert said(page, "carom.flights.map((one) => one.frame)") == ["fixed", "fixed"]
    page.locator('input[name="frame"][value="rotating"]').check()


def test_arrow_keys_move_the_kick(page):
    answered(page, "motion", said(page, "carom.number"))
    active = said(page, "carom.basin.active")
    before = said(page, f"carom.basin.kicks[{active}].first")
    page.locator("#basin").focus()
    page.keyboard.press("ArrowRight")
    page.wait_for_function(
        "([active, before]) => carom.flights[active].message.kick.first > before", arg=[active, before]
    )


def test_it_opens_on_a_green_core_with_arms_and_on_a_kick_that_returns_beside_one_that_is_lost(page):
    answered(page, "beside", said(page, "carom.number"))
    expect(page.locator("#motion-title")).to_have_text("comes back")
    expect(page.locator("#beside-title")).to_have_text("is lost")
    back, lost = said(page, "carom.basin.kicks")
    largest, smallest = said(page, "[carom.basin.message.largest, carom.basin.message.lost_size]")
    sizes = [(kick["first"] ** 2 + kick["second"] ** 2) ** 0.5 for kick in (back, lost)]
    assert abs(sizes[0] - sizes[1]) < largest / TRIED  # the width of a ring
    # The first is in an arm: beyond kicks that are lost, and in the picture.
    assert smallest < sizes[0] < largest
    share = said(page, "carom.basin.message.endings.find((one) => one.back).share")
    assert 0.1 < share < 0.5


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


@pytest.mark.parametrize(("kind", "unit", "noun"), [("shock", "g", "shock"), ("blade-loss", "g mm", "loss")])
def test_shocks_and_losses_of_a_blade_have_a_range_of_their_own(page, kind, unit, noun):
    page.locator("#kind").select_option(kind)
    number = said(page, "carom.number")
    for answer in ("basin", "motion", "beside", "loss"):
        answered(page, answer, number)
    assert said(page, "[carom.basin.message.kind, carom.basin.message.unit]") == [kind, unit]
    expect(page.locator("#range-words")).to_contain_text(f" {unit}")
    expect(page.locator("#lost-title")).to_have_text(f"smallest {noun} that does not come back")
    expect(page.locator("#lost")).to_contain_text(unit)
    expect(page.locator("#motion-words")).to_contain_text(f" {unit}")
    before = said(page, "carom.basin.message.largest")
    page.locator("#range").focus()
    page.keyboard.press("PageDown")
    page.wait_for_function("before => carom.basin.message.largest < before", arg=before)
    page.wait_for_function(
        "kind => location.hash.includes(`show=${kind}`) && location.hash.includes('range=')", arg=kind
    )


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


def test_on_a_phone_pictures_and_sentence_stay_in_sight_above_the_sliders(page):
    page.set_viewport_size({"width": 390, "height": 844})
    answered(page, "verdict", said(page, "carom.number"))
    fits(page, 390)
    page.locator('[data-name="restitution"] .slider').scroll_into_view_if_needed()
    said(page, "(document.getElementById('controls').scrollIntoView({ block: 'end' }), 0)")
    boxes = {name: page.locator(f"#{name}").bounding_box() for name in ("sentence", "basin", "clearance", "beside")}
    ends = {name: box["y"] + box["height"] for name, box in boxes.items()}
    assert 0 <= boxes["sentence"]["y"] < ends["sentence"] <= min(boxes[name]["y"] for name in ("basin", "clearance"))
    assert max(ends.values()) < 0.5 * 844
    # Basin on the left, both flights above each other on the right.
    assert boxes["basin"]["x"] + boxes["basin"]["width"] <= boxes["clearance"]["x"]
    assert ends["clearance"] <= boxes["beside"]["y"]
    page.set_viewport_size(DESK)


def test_damping_moves_by_itself_until_anything_is_touched(browser, address):
    context = browser.new_context(viewport=DESK)
    page = context.new_page()
    page.goto(address)
    page.wait_for_function("() => window.carom && carom.sweep && carom.sweep.state === 'moving'")
    expect(page.locator("#sweeping")).to_be_visible()
    page.wait_for_function("() => carom.controls.value('damping') > 1600 && carom.basin.message.number > 3")
    page.keyboard.press("Shift")
    assert said(page, "carom.sweep.state") == "over"
    expect(page.locator("#sweeping")).to_be_hidden()
    expect(page.locator("#box-damping")).to_have_value("1400")
    assert said(page, "location.hash") == ""
    number = said(page, "carom.number")
    answered(page, "verdict", number)
    page.wait_for_function("() => carom.begun.answers.state.kind === 'idle'")
    assert said(page, "[carom.number, carom.sweep.state]") == [number, "over"]
    context.close()


def test_nothing_moves_by_itself_where_motion_is_not_wished_or_a_link_was_followed(browser, address):
    for options, link in (({"reduced_motion": "reduce"}, ""), ({}, "#damping=1500")):
        context = browser.new_context(viewport=DESK, **options)
        page = context.new_page()
        page.goto(address + link)
        page.wait_for_function("() => window.carom && carom.sweep && carom.sweep.state === 'over'")
        assert said(page, "carom.number") == 1
        context.close()


def test_the_address_keeps_from_where_the_flights_are_seen(page, open_page):
    page.get_by_label("seen from outside").check()
    again = open_page(said(page, "location.hash"))
    assert said(again, "carom.flights.map((one) => one.frame)") == ["fixed", "fixed"]
    again.close()
    page.locator("#reset").click()
    expect(page.get_by_label("turns with the shaft")).to_be_checked()
    assert said(page, "carom.flights.map((one) => one.frame)") == ["rotating", "rotating"]


def luminance(colour: str) -> float:
    """Relative luminance of WCAG 2.2, of ``#rrggbb`` or ``rgb(r, g, b)``."""
    numbers = re.findall("[0-9a-f]{2}", colour) if colour.startswith("#") else re.findall(r"\d+", colour)
    parts = [int(one, 16 if colour.startswith("#") else 10) / 255.0 for one in numbers[:3]]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_what_is_told_of_before_a_change_says_so_and_can_be_read(page, scheme):
    page.emulate_media(color_scheme=scheme)
    page.evaluate(
        "() => { document.getElementById('headline').textContent = 'It levitates.'; document.getElementById('headline').classList.add('old'); carom.panels.pale('hardest', true); }"
    )
    said_so = "[getComputedStyle(document.getElementById('headline'), '::before'), getComputedStyle(document.getElementById('hardest').parentNode.querySelector('h3'), '::after')].map((one) => one.content)"
    assert all("efore the change" in words for words in said(page, said_so))
    for name in ("headline", "hardest", "hardest-remark"):
        ink, opacity = said(
            page,
            f"[getComputedStyle(document.getElementById('{name}')).color, getComputedStyle(document.getElementById('{name}')).opacity]",
        )
        for paper in ("--paper", "--card"):
            under = luminance(said(page, f"getComputedStyle(document.documentElement).getPropertyValue('{paper}')"))
            low, high = sorted((luminance(ink), under))
            assert opacity == "1"
            assert (high + 0.05) / (low + 0.05) >= 4.5  # level AA
    page.emulate_media(color_scheme="light")
    page.evaluate("() => carom.panels.pale('hardest', false)")
