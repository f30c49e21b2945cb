"""The interactive page in headless Chromium: a slider step to its new picture, the first paint, and what the server computes."""

from __future__ import annotations

import itertools
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import carom
from carom.explorer.computing.kicked_motion import follow_kick
from carom.explorer.computing.kicks import map_kicks
from carom.explorer.computing.motions import table_of
from carom.explorer.computing.planes import planes_of
from carom.models import jeffcott

MACHINE = Path(__file__).parents[1] / "examples" / "keogh-cole.toml"
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
OPTIONS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-sync",
]
ROUNDS = 30
STEP = """name => new Promise(done => {
  const slider = document.querySelector(`[data-name="${name}"] .slider`);
  window.turn = (window.turn || 0) + 1;
  slider.value = 500 + 5 * (window.turn % 60);
  const arrived = carom.controls.arrived, began = performance.now();
  carom.controls.arrived = (number) => {
    arrived(number);
    if (number < carom.number) return;
    carom.controls.arrived = arrived;
    // The picture is on the screen after the frame in which it was drawn.
    requestAnimationFrame(() => { const channel = new MessageChannel(); channel.port1.onmessage = () => done([performance.now() - began, carom.basin.message.size]); channel.port2.postMessage(0); });
  };
  slider.dispatchEvent(new Event("input"));
})"""
PAINTED = "() => carom && carom.basin && carom.basin.message"


@pytest.fixture(scope="module")
def address():
    command = [sys.executable, "-m", "carom", "explore", str(MACHINE), "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        yield process.stdout.readline().strip()
        process.terminate()


@pytest.fixture(scope="module")
def browser():
    if BROWSER is None:
        pytest.skip("no Chromium on the PATH")
    sync_playwright = pytest.importorskip("playwright.sync_api").sync_playwright
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=BROWSER, args=OPTIONS)
        yield started
        started.close()


@pytest.mark.parametrize("name", ["damping", "speed"])
def test_slider_step(benchmark, browser, address, name):
    """From the event of the slider to the picture on the screen; the goal is a median of 100 ms."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(address)
    page.wait_for_function(PAINTED, timeout=300_000)
    page.locator("#cancel").wait_for(state="hidden", timeout=300_000)
    sizes = []
    for _ in range(10):
        page.evaluate(STEP, name)
    benchmark.group = "slider step to the new picture"
    benchmark.pedantic(lambda: sizes.append(page.evaluate(STEP, name)[1]), rounds=ROUNDS)
    benchmark.extra_info.update(who=f"{name}, {min(sizes)} to {max(sizes)} cells a side", unit="step", units=1)
    page.close()


def test_first_paint(benchmark, browser, address):
    """From the address to the first basin, the server being warm; the goal is 3 s."""
    pages = []

    def load():
        pages.append(browser.new_page(viewport={"width": 1280, "height": 900}))
        pages[-1].goto(address)
        pages[-1].wait_for_function(PAINTED, timeout=300_000)

    load()
    benchmark.group = "first paint"
    benchmark.pedantic(load, setup=lambda: pages.pop().close(), rounds=5)
    benchmark.extra_info.update(who="first basin", unit="load", units=1)
    pages.pop().close()


@pytest.mark.parametrize("what", ["picture of 60 x 60 kicks", "motion", "table of orbits"])
def test_server(benchmark, what):
    """What the server computes for a step, each time for another machine; the goal of motion and table is 30 ms together."""
    case = carom.load(MACHINE)
    kicks, number = planes_of(case)[0], itertools.count(1500)
    work = {
        "picture of 60 x 60 kicks": lambda rotor: map_kicks(rotor, kicks, 60, kicks.usual),
        "motion": lambda rotor: follow_kick(rotor, kicks, 0.6, 0.2),
        "table of orbits": table_of,
    }[what]

    def another():
        return (jeffcott(case.replace(damping=2.0 * next(number)).parameters),), {}

    work(*another()[0])
    benchmark.group = "on the server"
    benchmark.pedantic(work, setup=another, rounds=ROUNDS)
    benchmark.extra_info.update(who=what, unit="step", units=1)
