"""The page in a real browser: loaded, dragged, typed into, copied from, restarted, and attacked."""

import pytest
from browsing import DESK, SOON, answered, drag, fits, painted, said, served
from playwright.sync_api import expect

import carom
from carom.explorer.computing.kicks import map_kicks
from carom.explorer.computing.planes import planes_of
from carom.models import jeffcott

pytestmark = pytest.mark.jit_only
MACHINE = "examples/keogh-cole.toml"


def shown_of(page, case):
    """The picture that the page shows when nothing moves, and the share of what must be survived that comes back."""
    kicks, scales = planes_of(case)[0], case.parameters.scales
    found = map_kicks(jeffcott(case.parameters), kicks, 120, 1e-3 * said(page, "carom.basin.message.largest"))
    share = found.share_up_to(kicks.own(kicks.required, scales) * (1.0 + 1e-9))
    return found, f"{100 * share.fraction:.3g} %"


def test_it_loads_and_shows_the_machine(page):
    expect(page).to_have_title("keogh-cole – carom explore")
    answered(page, "table")
    page.wait_for_function("() => carom.basin.message.size === 120")
    found, share = shown_of(page, carom.load(MACHINE))
    expect(page.locator("#share")).to_have_text(share)
    # Below the motions the rings: never touches, must survive, smallest lost.
    expect(page.locator("#legend li")).to_have_count(len(found.endings) + 3)
    assert page.locator("#motions tbody tr").count() >= 7
    assert painted(page, "basin") > len(found.endings)
    for canvas in ("clearance", "beside"):
        page.wait_for_function("slot => carom.flights[slot].now > 0", arg=int(canvas == "beside"))
        assert painted(page, canvas) > 4


def test_dragging_a_slider_moves_the_basin_and_letting_go_refines_it(page):
    drag(page, "damping", (0.55, 0.65, 0.75, 0.85))
    number = said(page, "carom.number")
    assert number > 2
    answered(page, "basin", number)
    page.wait_for_function("() => carom.basin.message.size === 120")
    value = said(page, "carom.controls.value('damping')")
    _, share = shown_of(page, carom.load(MACHINE, [f"damping={value} N s/m"]))
    expect(page.locator("#share")).to_have_text(share)
    answered(page, "diagram", number)
    assert said(page, "carom.begun.parts.cursor.location") == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "part"),
    [
        ("toml", "damping = "),
        ("options", "--set 'damping=2500 N s/m'"),
        ("command", "carom simulate "),
        ("python", "cm.map_basins("),
    ],
)
def test_the_machine_is_copied(page, kind, part):
    page.locator("#box-damping").fill("2500")
    page.keyboard.press("Enter")
    page.wait_for_function("() => carom.panels.exports.options.includes('2500')")
    page.locator(f'[data-copy="{kind}"]').click()
    expect(page.locator("#copied")).to_contain_text("is in the clipboard")
    assert part in said(page, "navigator.clipboard.readText()")


def test_what_was_set_is_in_the_address(open_page):
    page = open_page("#damping=6000+N+s%2Fm&friction=0.1")
    expect(page.locator("#share")).to_have_text("100 %", timeout=SOON)
    expect(page.locator("#box-damping")).to_have_value("6000")
    expect(page.locator("#box-friction")).to_have_value("0.1")
    page.close()


@pytest.mark.parametrize("width", [390, 700, 1280])
def test_nothing_is_wider_than_the_screen(page, width):
    page.set_viewport_size({"width": width, "height": 844})
    answered(page, "table")
    # Figures keep their width for a moment when the window narrows.
    held = "(width) => { for (const part of document.querySelectorAll('.plot > *')) part.style.minWidth = width; return document.documentElement.scrollWidth; }"
    assert page.evaluate(held, "1600px") <= width
    page.evaluate(held, "")
    fits(page, width)
    for name, least in (("basin", 220), ("clearance", 100), ("beside", 100)):
        box = page.locator(f"#{name}").bounding_box()
        assert box["width"] >= least
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width
    page.set_viewport_size(DESK)


def test_a_server_that_stops_and_comes_back(open_page):
    with served(MACHINE) as (first, where):
        page = open_page("#damping=6000+N+s%2Fm", where)
        first.terminate()
        first.wait()
        expect(page.locator("#gone")).to_be_visible(timeout=SOON)
        assert "has stopped" in page.locator("#gone").inner_text()
        with served(MACHINE, int(where.rstrip("/").rpartition(":")[2])):
            page.wait_for_function(
                "() => document.getElementById('gone').hidden && window.carom && carom.basin && carom.basin.message"
            )
            expect(page.locator("#share")).to_have_text("100 %", timeout=SOON)
        page.close()
