"""The document of a page, without a browser."""

from __future__ import annotations

import json
import re
import threading
from pathlib import Path

import pytest

import carom
from carom.explorer.background import SupersededError
from carom.explorer.computing.exports import Origin

bokeh = pytest.importorskip("bokeh", reason="needs the extra carom[explore]")

from bokeh.document import Document  # noqa: E402
from bokeh.resources import Resources  # noqa: E402

from carom.explorer.page import document as documents  # noqa: E402
from carom.explorer.page.document import fill, write_page  # noqa: E402
from carom.explorer.page.figures import looks, make_figures  # noqa: E402
from carom.explorer.page.models import Answers  # noqa: E402
from carom.explorer.page.scripts import PICTURES, SCRIPTS, joined  # noqa: E402
from carom.plots import LOOKS  # noqa: E402

MACHINE = str(Path(__file__).parents[3] / "examples" / "keogh-cole.toml")
FILES = Path(documents.__file__).parent / "files"


@pytest.fixture
def filled():
    document = Document()
    session = fill(document, Origin(MACHINE, (), carom.load(MACHINE)), threading.Event())
    yield document
    session.close()


@pytest.fixture(scope="module")
def page():
    return written(carom.load(MACHINE))


def written(case):
    return write_page(Origin(MACHINE, (), case), Resources(mode="server", root_url=""))


def test_it_holds_the_figures_and_what_browser_and_server_share(filled):
    assert [root.name for root in filled.roots] == ["history", "section", "diagram"]
    assert {model.name for model in filled.select({"name": "requests"})} == {"requests"}
    assert {model.name for model in filled.select({"name": "answers"})} == {"answers"}
    filled.validate()


def test_only_wishes_come_back_from_the_browser(filled):
    back = {type(model).__name__ for model in filled.models if model.syncable}
    assert back == {"Requests", "Answers"}


def test_answers_to_a_page_that_is_gone_end_the_work():
    document = Document()
    session = fill(document, Origin(MACHINE, (), carom.load(MACHINE)), threading.Event())
    document.callbacks.destroy()
    with pytest.raises(SupersededError):
        session.cancel()
    session.close()


def test_the_page_has_a_place_for_each_figure_of_any_session(filled, page):
    (roots,) = re.findall(r'"roots":(\{[^}]*\})', page)
    assert list(json.loads(roots)) == [root.id for root in filled.roots]
    for place in json.loads(roots).values():
        assert f'id="{place}"' in page


def test_the_page_has_a_slider_and_a_box_for_every_control(filled, page):
    assert re.findall(r'data-name="(\w+)"', page) == [
        "stiffness",
        "damping",
        "speed",
        "eccentricity",
        "friction",
        "restitution",
    ]
    assert page.count('<input class="slider" type="range"') == page.count('<input class="box"') == 6
    assert "keogh-cole – carom explore" in filled.title


def test_names_of_machines_are_not_taken_for_markup():
    case = carom.load(MACHINE)
    strange = type(case)('<script>alert("x")</script>', case.parameters, case.machine, case.zones)
    assert "<script>alert" not in written(strange)


def test_every_script_is_on_the_page_and_nothing_is_fetched_from_elsewhere(page):
    assert {path.name for path in FILES.glob("*.js")} == set(SCRIPTS)
    for name in SCRIPTS:
        lines = (FILES / name).read_text(encoding="utf-8").splitlines()
        for line in lines:
            assert line.startswith("import ") or line.removeprefix("export ") in page
    assert not re.findall(r"https?://", page)


def test_the_scripts_use_only_what_the_page_and_the_answers_have(page):
    scripts = "\n".join((FILES / name).read_text(encoding="utf-8") for name in SCRIPTS)
    for name in re.findall(r'\bat\("([\w-]+)"\)', scripts):
        assert f'id="{name}"' in page, name
    shown = re.search(r"const shows = \{(.*?)\};", scripts, flags=re.DOTALL)[1]
    assert set(re.findall(r"(\w+): \[", shown)) == set(
        Answers.properties()
        - {"name", "tags", "syncable", "subscribed_events", "js_event_callbacks", "js_property_callbacks"}
    )
    parts = make_figures().parts
    for name in re.findall(r"\bparts\.(\w+)", scripts):
        assert name in parts or name in ("push",), name


def test_scripts_that_draw_know_no_page():
    text = joined(PICTURES, exporting=True)
    assert not re.findall(r"\bcarom\.\w|getElementById|querySelector|^import ", text, flags=re.MULTILINE)
    assert {"basinPicture", "flight"} <= set(re.findall(r"^export const (\w+)", text, flags=re.MULTILINE))
    assert "export" not in re.sub(r"//.*", "", joined(PICTURES))


def test_colours_are_those_of_the_figures(page):
    found = json.loads(re.search(r"window\.carom_looks = (\{.*?\});", page)[1])
    assert found == looks()
    assert found["forward"] == LOOKS["forward"].colour


def test_no_file_of_the_page_is_long():
    for path in FILES.iterdir():
        assert path.read_text(encoding="utf-8").count("\n") < 400, path.name
