"""The figure for notebooks: what it sends and takes, and how it is drawn in a real browser, without a notebook."""

import base64
import queue
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.base.outcome import CaromError
from carom.explorer.notebook import encoded

MACHINE = carom.load("examples/keogh-cole.toml")
SOON = 120
"""Seconds after which the figure is taken to hang; nothing is judged by how long it takes."""
HOST = Path(__file__).with_name("notebook.html").read_text(encoding="utf-8")


@contextmanager
def shown(made):
    """A figure, which keeps what it sends."""
    made.sent = queue.Queue()
    made.send = lambda content, buffers=None: made.sent.put((content, buffers))
    yield made
    made.close()


@pytest.fixture
def figure():
    """A figure, and what it sends."""
    with shown(carom.explorer.explore(MACHINE)) as made:
        yield made


def ask(figure, name, **value):
    figure._handle_custom_msg({"name": name, "value": value}, [])


def answer(figure, wanted, **having):
    """The next answer of a kind with these entries."""
    while True:
        content, buffers = figure.sent.get(timeout=SOON)
        value = content["value"]
        if content["name"] == wanted and all(value[name] == entry for name, entry in having.items()):
            return value, buffers


def test_arrays_of_a_message_become_buffers():
    buffers = []
    message = {"a": np.array([1.5, 2.0], np.float32), "b": [{"c": np.array([[1, 2]], np.uint8)}], "d": np.float64(0.5)}
    assert encoded(message | {"e": np.inf, "f": "x", "g": (True, None)}, buffers) == {
        "a": {"buffer": 0, "type": "float32"},
        "b": [{"c": {"buffer": 1, "type": "uint8"}}],
        "d": 0.5,
        "e": None,
        "f": "x",
        "g": [True, None],
    }
    assert buffers == [np.array([1.5, 2.0], np.float32).tobytes(), b"\x01\x02"]


@pytest.mark.jit_only
def test_a_figure_sends_the_picture_and_the_motion_after_each_kick(figure):
    ask(figure, "machine", number=1, settings={}, held=False, along="")
    coarse, _ = answer(figure, "basin")
    fine, buffers = answer(figure, "basin", size=120)
    assert coarse["size"] < 120
    assert len(buffers[fine["cells"]["buffer"]]) == 120 * 120
    ask(figure, "kick", number=1, slot=0, first=82.9, second=0.0, chosen=True)
    motion, buffers = answer(figure, "motion", kick={"first": 82.9, "second": 0.0})
    assert motion["words"].startswith("A kick of 82.9 mm/s at ")
    x = np.frombuffer(buffers[motion["planes"][0]["x"]["buffer"]], np.float32)
    assert x[0] == pytest.approx(carom.find_equilibria(MACHINE)[0].position.real, abs=1e-6)  # single precision


def test_without_the_extra_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    carom.explorer.notebook._figure_class.cache_clear()
    with pytest.raises(CaromError, match=r'need anywidget; install it with: pip install "carom\[notebook\]"$'):
        carom.explorer.explore(MACHINE)


def hosted(browser, figure, colours):
    """A page that shows a figure as a notebook does, and a function that hands over what is sent until an answer has come."""
    context = browser.new_context(viewport={"width": 900, "height": 700}, reduced_motion="reduce")
    page = context.new_page()
    page.problems = []
    page.on("pageerror", lambda problem: page.problems.append(str(problem)))
    page.expose_function("ask", lambda content: figure._handle_custom_msg(content, []))
    page.set_content(HOST.replace("COLOURS", colours))
    page.evaluate("(text) => start(text)", figure._esm)

    def until(wanted, **having):
        """Hand over what is sent, up to an answer of a kind, or whatever comes next."""
        ends = time.monotonic() + SOON
        while True:
            while figure.sent.empty():
                assert time.monotonic() < ends, f"no answer {wanted}"
                page.wait_for_timeout(10)  # what the browser asks for is taken meanwhile
            content, buffers = figure.sent.get()
            texts = [base64.b64encode(one).decode() for one in buffers or ()]
            page.evaluate("([content, texts]) => deliver(content, texts)", [content, texts])
            value = content["value"]
            if wanted in (content["name"], None) and all(value[name] == entry for name, entry in having.items()):
                return value

    return page, until


@pytest.mark.jit_only
def test_a_click_on_the_picture_shows_the_motion_from_that_kick(browser, figure):
    page, until = hosted(browser, figure, "background: #fff; color: #000")
    words = page.locator("#beside-0-words")
    assert page.locator("#sentence").inner_text() == "Loading the kernels …"
    picture = until("basin", size=120)
    stated = [item.split(" ") for item in page.locator("#legend li").all_inner_texts()]
    assert [" ".join(row[:-2]) for row in stated] == [ending["words"] for ending in picture["endings"]]
    assert page.locator("#sentence").inner_text() == picture["sentence"]
    while not words.inner_text():
        until(None)
    before, box = words.inner_text(), page.locator("#basin").bounding_box()
    # Left of it and below are 54 and 40 pixels for the scales, on the other sides 6.
    span = min(box["width"] - 60, box["height"] - 46)
    page.mouse.click(box["x"] + 54 + 0.75 * span, box["y"] + 6 + 0.5 * span)
    stated = until("beside")
    assert stated["kick"]["first"] == pytest.approx(0.5 * picture["largest"], abs=0.01 * picture["largest"])  # a pixel
    assert stated["kick"]["second"] == pytest.approx(0.0, abs=0.01 * picture["largest"])
    assert words.inner_text().endswith(
        stated["words"].strip() + ("" if stated["whole"] else " Its beginning is shown.")
    )
    assert words.inner_text() != before
    page.keyboard.press("ArrowUp")
    step = pytest.approx(stated["kick"]["second"] + 0.02 * picture["largest"], abs=0.005 * picture["largest"])
    while until("beside")["kick"]["second"] != step:  # answers to the pointer on its way may come first
        pass
    page.evaluate("end()")
    assert page.evaluate("takers.size") == 0
    assert page.problems == []
