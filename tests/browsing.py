"""A real browser for the tests of the page: what it is run with, and what is done in it."""

import os
import shutil
import subprocess
import sys
from contextlib import contextmanager

NAMES = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, NAMES)), None)
MUST = os.environ.get("CAROM_BROWSER") == "required"
"""Whether tests in a browser fail where there is none, instead of being left out."""
OPTIONS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # Other names lead to this machine, as those of an attacker can.
    "--host-resolver-rules=MAP evil.test 127.0.0.1",
)
PROGRAM = """
import sys
from carom.__main__ import run
from carom.explorer.computing.rest import rest_of
from carom.explorer.page import questions
from carom.models import rotor_of
# A study takes seconds; it has tests of its own.  This is what it says of one of the examples.
def judge(case, tell):
    rest_of(rotor_of(case))  # refused where there is no levitation, as a study is
    return {
        "advice": "Change: damping 1,400 N s/m to at least 1,706 N s/m.",
        "lead": "Came back in every trial from what it must survive, vibration in zone C: sampled, not proven.",
        "survived": ("Kick: cannot touch up to 125 mm/s (proven), all tried came back up to 382 mm/s.",),
    }
questions.judge = judge
sys.argv.insert(1, "explore")
sys.exit(run())
"""
DESK = {"width": 1280, "height": 900}
SOON = 300_000
"""Milliseconds after which the page is taken to hang; nothing is judged by how long it takes."""


@contextmanager
def served(machine, port: int = 0, *settings: str):
    """Run the program with a machine file; yield the process and the address it prints."""
    command = [sys.executable, "-c", PROGRAM, str(machine), *settings, "--no-browser", "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            address = process.stdout.readline().strip()
            assert address.startswith("http://127.0.0.1:"), process.stderr.read()
            yield process, address
        finally:
            process.terminate()
            process.communicate()


def answered(page, name: str, number: int = 1) -> None:
    """Wait until the page shows an answer about its machine of this number or a later one."""
    page.wait_for_function("([name, number]) => +document.documentElement.dataset[name] >= number", arg=[name, number])


def fits(page, width: int) -> None:
    """Wait until nothing is wider than the screen; the plots follow a new width of the window a moment later."""
    page.wait_for_function("width => document.documentElement.scrollWidth <= width", arg=width)


def said(page, expression: str):
    return page.evaluate(f"() => {expression}")


def drag(page, name: str, shares: tuple[float, ...]) -> None:
    """Drag a slider to shares of its length, one after another, and let it go at the last."""
    slider = page.locator(f'[data-name="{name}"] .slider')
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    places = [(box["x"] + 9 + share * (box["width"] - 18), box["y"] + box["height"] / 2) for share in shares]
    value = float(slider.input_value()) / 1000
    page.mouse.move(box["x"] + 9 + value * (box["width"] - 18), places[0][1])
    page.mouse.down()
    for place in places:
        page.mouse.move(*place)
        page.wait_for_timeout(30)
    page.mouse.up()


def painted(page, canvas: str) -> int:
    """Number of colours on a canvas."""
    return said(
        page,
        f"(() => {{ const canvas = document.getElementById('{canvas}');"
        "const data = new Uint32Array(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer);"
        "return new Set(data).size; })()",
    )


def point(page, first: float, second: float, *, click: bool = False) -> None:
    """Point at a disturbance, by its components as shares of the largest."""
    canvas = page.locator("#basin")
    canvas.scroll_into_view_if_needed()
    box, scale = canvas.bounding_box(), said(page, "document.getElementById('basin').clientWidth")
    left, edge, below = (2, 2, 14) if scale < 300 else (54, 6, 40)
    span = min(scale - left - edge, scale - below - edge)
    place = (box["x"] + left + span * (first + 1) / 2, box["y"] + edge + span * (1 - second) / 2)
    page.mouse.click(*place) if click else page.mouse.move(*place)


def flown(page, slot: int, first: float, second: float) -> None:
    """Wait until the flight of a disturbance near these shares is shown."""
    page.wait_for_function(
        "([slot, first, second]) => { const { kick } = carom.flights[slot].message, { largest } = carom.basin.message;"
        " return Math.hypot(kick.first / largest - first, kick.second / largest - second) < 0.02; }",
        arg=[slot, first, second],
    )
