"""The page of a compliant touchdown bearing, in a real browser."""

from __future__ import annotations

import pytest
from browsing import DESK, answered, drag, fits, flown, point, said, served
from playwright.sync_api import expect

pytestmark = pytest.mark.jit_only
MACHINE = """
[machine]
mass = "50 kg"
damping = "3000 N s/m"
stiffness = "9.8e5 N/m"
eccentricity = "0.3 mm"
clearance = "0.7 mm"
rotor_radius = "40 mm"
speed = "184.2 rad/s"
friction = 0.15

[touchdown]
law = "kelvin-voigt"
stiffness = "1e8 N/m"
restitution = 0.8
"""


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    path = tmp_path_factory.mktemp("machine") / "soft.toml"
    path.write_text(MACHINE, encoding="utf-8")
    with served(path) as (_, found):
        yield found


def test_it_shows_forces_and_names_what_is_left_out(page):
    answered(page, "hardest", said(page, "carom.number"))
    expect(page.locator("#hardest")).to_contain_text(" N")
    expect(page.locator("#diagram-words")).to_have_count(0)
    expect(page.locator("#argument")).to_contain_text("carom orbits searches them")
    expect(page.locator("#motions tbody tr")).to_have_count(3)
    expect(page.locator("#beside-words")).to_contain_text("largest depth ")
    for width in (390, DESK["width"]):
        page.set_viewport_size({"width": width, "height": 844})
        fits(page, width)
    page.set_viewport_size(DESK)


def test_the_stiffness_of_the_bearing_can_be_dragged_and_typed(page):
    expect(page.locator("#box-touchdown_stiffness")).to_have_value("1e8")
    drag(page, "touchdown_stiffness", (0.3, 0.2))
    answered(page, "motion", said(page, "carom.number"))
    assert 1e7 < said(page, "carom.controls.value('touchdown_stiffness')") < 1e8
    page.locator("#box-touchdown_stiffness").fill("300 MN/m")
    page.locator("#box-touchdown_stiffness").press("Enter")
    page.wait_for_function("() => carom.controls.value('touchdown_stiffness') === 3e8")
    expect(page.locator("#problem")).to_be_hidden()


def test_the_axis_and_the_circle_hold_a_rotor_deep_in_the_wall(page):
    page.locator("#box-touchdown_stiffness").fill("1e6")
    page.locator("#box-touchdown_stiffness").press("Enter")
    answered(page, "beside", said(page, "carom.number"))
    point(page, 0.0, 0.9, click=True)
    active = said(page, "carom.basin.active")
    flown(page, active, 0.0, 0.9)
    radii = f"(({{ x, y }}) => Array.from(x, (part, at) => Math.hypot(part, y[at])))(carom.flights[{active}].message)"
    deepest = max(said(page, radii))
    assert deepest > 1.2
    page.wait_for_function("deepest => carom.begun.parts.distances_y.end >= deepest", arg=deepest)
    marks = said(page, "Array.from(carom.begun.parts.struck.data.r)")
    assert marks
    assert all(1.03 < mark < said(page, "carom.begun.parts.distances_y.end") for mark in marks)
