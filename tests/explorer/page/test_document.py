"""The document of a page, without a browser."""

from __future__ import annotations

import json
import re
import threading
from pathlib import Path

import pytest
from bokeh.document import Document
from bokeh.resources import Resources

import carom
from carom.explorer.background import SupersededError
from carom.explorer.computing.exports import Origin
from carom.explorer.page import document as documents
from carom.explorer.page.document import fill, write_page
from carom.explorer.page.figures import FIGURES, looks, make_figures
from carom.explorer.page.models import Answers
from carom.explorer.page.questions import Questions
from carom.explorer.page.scripts import PAGE, PICTURES, joined
from carom.explorer.page.view import SLOTS
from carom.plots import LOOKS

EXAMPLES = Path(__file__).parents[3] / "examples"
MACHINE, OF_ROTOR = str(EXAMPLES / "keogh-cole.toml"), str(EXAMPLES / "tum-flexible-rotor.toml")
KINDS = {"planar": MACHINE, "flexible": OF_ROTOR}
FILES = Path(documents.__file__).parent / "files"


@pytest.fixture(params=KINDS)
def kind(request):
    return request.param


@pytest.fixture
def filled(kind):
    document, path = Document(), KINDS[kind]
    session = fill(document, Origin(path, (), carom.load(path)), threading.Event())
    yield document
    session.close()


@pytest.fixture(scope="module")
def pages():
    return {kind: written(carom.load(path)) for kind, path in KINDS.items()}


@pytest.fixture
def page(pages, kind):
    return pages[kind]


def written(case):
    return write_page(Origin(MACHINE, (), case), Resources(mode="server", root_url=""))


def test_it_holds_the_figures_and_what_browser_and_server_share(filled, kind):
    figures = {
        "planar": ["distances", "section", "response", "diagram"],
        "flexible": ["distances", "section", "forces", "response"],
    }
    assert [root.name for root in filled.roots] == figures[kind]
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


def test_the_page_has_a_slider_and_a_box_for_every_control(pages):
    page = pages["planar"]
    assert re.findall(r'data-name="(\w+)"', page) == [
        "speed",
        "eccentricity",
        "stiffness",
        "damping",
        "friction",
        "restitution",
    ]
    assert page.count('<input class="slider" type="range"') == page.count('<input class="box"') == 6
    assert "<title>keogh-cole – carom explore" in page


def test_the_page_of_a_flexible_machine_has_a_flight_for_each_touchdown_bearing_and_folds_single_parts(pages):
    page = pages["flexible"]
    assert re.findall(r'data-slot="(\d)" data-plane="(\d)"', page) == [("0", "0"), ("0", "1"), ("1", "0"), ("1", "1")]
    whole, folded = page.split('<details class="folded">')
    assert re.findall(r'data-name="(\w+)"', whole) == [
        "speed", "unbalance", "proportional", "integral", "derivative", "filter_time", "delay",
        "clearance", "friction", "touchdown_stiffness", "touchdown_dissipation",
    ]  # fmt: skip
    assert set(re.findall(r'data-name="proportional_(\d)"', folded)) == {"1", "2"}


def test_names_of_machines_are_not_taken_for_markup():
    case = carom.load(MACHINE)
    strange = type(case)('<script>alert("x")</script>', case.parameters, case.machine, case.zones)
    assert "<script>alert" not in written(strange)


def test_every_script_is_on_the_page_and_nothing_is_fetched_from_elsewhere(page, kind):
    assert {path.name for path in FILES.glob("*.js")} == {*PAGE}
    for name in PAGE:
        lines = (FILES / name).read_text(encoding="utf-8").splitlines()
        for line in lines:
            assert line.startswith("import ") or line.removeprefix("export ") in page
    assert not re.findall(r"https?://", page)


def test_the_scripts_use_only_what_the_page_and_the_answers_have(page, kind):
    scripts = "\n".join((FILES / name).read_text(encoding="utf-8") for name in PAGE)
    optional = {"prove", "proven", "places", "told", "response-keys", "forces-words", "diagram-words", "along"}
    for name in set(re.findall(r'\bat\("([\w-]+)"\)', scripts)) - (
        optional if kind == "flexible" else {"forces-words"}
    ):
        assert f'id="{name}"' in page, name
    machine = Questions(Origin(KINDS[kind], (), carom.load(KINDS[kind])))
    tasks = (*machine.long.values(), *machine.on_request.values())
    answered = {"state", "reply", "exports", *machine.quick, *(task.answer for task in tasks)}
    shown = set(re.findall(r'carom\.on\("(\w+)"', scripts)) | set(SLOTS)
    assert shown == answered | {"diagram"}  # which a flexible machine has not
    assert shown <= set(Answers.properties())
    parts = make_figures(tuple(FIGURES)).parts
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
