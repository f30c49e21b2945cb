"""The film of a drop: what it shows is the motion, and it plays in a browser without any other file."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest

import carom as cm
from carom.motions import drop_loads
from carom.report import write_drop_report
from carom.report.film import MOST, STEP, film_of
from carom.studies import DropStudy

pytestmark = pytest.mark.jit_only
ON_MOUNT = ["touchdown_mount_mass=1", "touchdown_mount_stiffness=2e7", "touchdown_mount_damping=2000"]


@pytest.fixture(scope="module")
def balls():
    case = cm.load("examples/touchdown-balls.toml")
    return case, cm.simulate(case, cm.drop(), "60 ms")


@pytest.fixture(scope="module")
def played(balls):
    _, motion = balls
    return motion, film_of(motion), json.loads(film_of(motion).data)


def test_the_samples_are_those_of_the_motion(played):
    motion, film, data = played
    times = np.array(data["t"]) / (1e3 * motion.rotor.scales.time)
    # Times are written to 1e-5 ms, in which the rotor moves by less than the last digit of a place, or twice that.
    place = np.array(data["x"]) + 1j * np.array(data["y"])
    assert np.abs(place - motion.position(np.minimum(times, motion.time), "fixed")).max() < 2e-5
    loads = cm.motions.drop_loads(motion).planes[0]
    assert data["largest"][0] == pytest.approx(loads.si()["force"], rel=1e-3)
    assert data["t"][data["poster"]] == pytest.approx(1e3 * loads.force_at * motion.rotor.scales.time, abs=1e-5)
    # The shaft turns once per turn, and the race by the integral of its speed.
    assert np.ptp(data["a"]) == pytest.approx(times[-1], abs=1e-3)
    assert data["b"][-1] * motion.rotor.scales.speed == pytest.approx(
        np.trapezoid(np.array(data["q"]) / 20.25e-3, np.array(data["t"]) / 1e3) * motion.rotor.scales.speed, rel=1e-2
    )
    assert len(data["peaks"]) == len(motion.contacts)
    assert film.whole


def test_impacts_on_a_rigid_wall_and_a_bearing_on_a_mount():
    rigid = cm.simulate(cm.load("examples/dropped-rotor.toml"), cm.drop(), "20 ms")
    film = film_of(rigid)
    blows = np.array(json.loads(film.data)["blows"])
    assert len(blows) == len(rigid.contacts)
    assert blows[:, 1] == pytest.approx(rigid.contacts.normal_impulse / rigid.contacts.normal_impulse.max(), abs=1e-5)
    assert film.legend[0][1].startswith("impulse of an impact, up to ")
    soft = cm.simulate(cm.load("examples/touchdown-balls.toml", ON_MOUNT), cm.drop(), "10 ms")
    data = json.loads(film_of(soft).data)
    times = np.array(data["t"]) / (1e3 * soft.rotor.scales.time)
    position, _ = soft.at(np.minimum(times, soft.time))
    mount = position[:, 1] * np.exp(1j * times)
    assert np.abs(np.array(data["mx"]) + 1j * np.array(data["my"]) - mount).max() < 1e-4
    assert np.abs(mount).max() > 0.01


def test_a_film_of_no_contact():
    film = film_of(cm.simulate(cm.load("examples/touchdown-balls.toml"), cm.drop(), "3 ms"))
    assert film.poster == 0
    assert json.loads(film.data)["peaks"] == []
    assert film.legend == []
    assert film.shown == "Shown: the release; nothing is touched."


def test_only_what_can_be_told_apart_is_filmed():
    case = cm.load("examples/touchdown-balls.toml")
    film = film_of(cm.simulate(case, cm.drop(), "400 ms"))
    assert not film.whole
    assert film.course.times[-1] <= 40.0 * math.tau
    assert (
        f"Filmed: the first {float(film.units.time[0] * film.course.times[-1]):.4g} ms, at most 30 contacts"
        in film.caption
    )


def test_what_becomes_too_fast_later_does_not_shorten_the_film_of_what_comes_before():
    """Here the rotor begins to roll backward at eighty times the speed of the shaft when it has bounced for a while."""
    case = cm.load("examples/dropped-rotor.toml", ["friction=0.4", "unbalance=200 g mm"])
    motion = cm.simulate(case, cm.drop(regained_after="40 ms"), "90 ms")
    film, impacts = film_of(motion), motion.parts[0].contacts
    assert not film.whole
    assert len(film.course.times) < 1.1 * MOST
    assert np.abs(np.diff(film.course.place)).max() < 2.0 * STEP
    assert film.course.times[-1] > 0.9 * impacts.time[-1]
    assert "Filmed: the first 2" in film.caption


@pytest.fixture(scope="module")
def page(balls, browser, tmp_path_factory):
    case, motion = balls
    echo = cm.drop().echo_at(cm.models.rotor_of(case), motion.rotor, motion.start, case.gravity)
    path = write_drop_report(
        DropStudy(case, echo, drop_loads(motion)), motion, str(tmp_path_factory.mktemp("film") / "out")
    )
    contexts = []

    def open_page(**options):
        context = browser.new_context(viewport={"width": 1280, "height": 900}, **options)
        contexts.append(context)
        opened, wrong = context.new_page(), []
        opened.on("pageerror", lambda problem: wrong.append(str(problem)))
        opened.goto(path.absolute().as_uri())
        assert wrong == []
        return opened

    yield open_page
    for context in contexts:
        context.close()


def reading(page, name):
    return page.locator(f'[data-reading="{name}"]').inner_text()


def _ends(arrow):
    """Ends of an arrow, y growing downward."""
    return [complex(*map(float, pair)) for pair in re.findall(r"(-?[\d.]+) (-?[\d.]+)", arrow.get_attribute("d"))]


def seconds(page):
    return float(reading(page, "time").split()[0])


def test_it_begins_with_the_largest_force_and_plays_from_the_release(page):
    opened = page()
    assert reading(opened, "normal") == "1,320 N"
    assert reading(opened, "time") == "5.99 ms"
    start, end = _ends(opened.locator(".arrow.normal"))
    assert abs(end - start) == pytest.approx(84.0, abs=0.1)  # inward at full length: here the force is largest
    assert (end - start).imag < -80.0
    start, end = _ends(opened.locator(".arrow.friction"))
    assert (end - start).real < -80.0  # against the surface of the shaft, which at the bottom moves to the right
    said = opened.get_by_text("Shown: the largest force, 5.99 ms after the release.")
    assert said.is_visible()
    play = opened.get_by_role("button", name="Play")
    play.focus()
    opened.keyboard.press("Space")
    opened.wait_for_function("parseFloat(document.querySelector('[data-reading=time]').textContent) > 0.2")
    opened.keyboard.press("Space")
    first = seconds(opened)
    assert not said.is_visible()
    assert opened.get_by_role("button", name="Play").count() == 1
    opened.wait_for_timeout(200)
    assert seconds(opened) == first


def test_slider_and_contacts_lead_to_their_instant(page, balls):
    opened, (_, motion) = page(), balls
    slider = opened.get_by_role("slider", name="Time after the release")
    slider.fill("1000")
    assert reading(opened, "time") == "30 ms"
    assert reading(opened, "slip") == "\N{EN DASH}"
    slider.press("ArrowRight")
    assert reading(opened, "time") == "30.03 ms"
    assert slider.get_attribute("aria-valuetext") == "30.03 ms"
    opened.get_by_role("button", name="Next contact").click()
    peaks = 1e3 * motion.rotor.scales.time * motion.contacts.peak_time
    assert seconds(opened) == pytest.approx(peaks[peaks > 30.03][0], rel=1e-3)
    opened.get_by_role("button", name="Previous contact").click()
    assert seconds(opened) == pytest.approx(peaks[peaks < 30.03][-1], rel=1e-3)


def test_who_wants_no_motion_is_shown_one_contact_after_another(page, balls):
    opened, (_, motion) = page(reduced_motion="reduce"), balls
    opened.get_by_role("button", name="Play").click()
    first = 1e3 * motion.rotor.scales.time * motion.contacts.peak_time[0]
    assert seconds(opened) == 0.0
    opened.wait_for_function("document.querySelector('[data-reading=time]').textContent !== '0 ms'")
    assert seconds(opened) == pytest.approx(first, rel=1e-3)


def test_without_scripts_there_is_no_film(page):
    assert not page(java_script_enabled=False).locator(".film").is_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_on_a_phone(page, scheme):
    opened = page(color_scheme=scheme)
    opened.set_viewport_size({"width": 390, "height": 844})
    assert opened.evaluate("document.documentElement.scrollWidth") == 390
    assert opened.locator(".machine").is_visible()
