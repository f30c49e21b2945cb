"""The film of a drop: what it shows is the motion, and it plays in a browser without any other file."""

import json
import re

import numpy as np
import pytest

import carom as cm
from carom.motions import drop_loads
from carom.report import write_drop_report
from carom.report.film import film_of
from carom.studies import DropStudy

pytestmark = pytest.mark.jit_only
ON_MOUNT = ["touchdown_mount_mass=1", "touchdown_mount_stiffness=2e7", "touchdown_mount_damping=2000"]


@pytest.fixture(scope="module")
def balls():
    case = cm.load("examples/touchdown-balls.toml")
    return case, cm.simulate(case, cm.drop(), "60 ms")


def test_the_samples_are_those_of_the_motion(balls):
    _, motion = balls
    played = motion, film_of(motion), json.loads(film_of(motion).data)
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
    blows = np.array(json.loads(film.data)["impacts"])
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


def test_without_scripts_there_is_no_film(page):
    assert not page(java_script_enabled=False).locator(".film").is_visible()
