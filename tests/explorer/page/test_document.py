"""The document of a page, without a browser."""

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
from carom.explorer.page.figures import FIGURES, make_figures
from carom.explorer.page.models import Answers
from carom.explorer.page.questions import Questions
from carom.explorer.page.scripts import PAGE
from carom.explorer.page.view import SLOTS

MACHINE, OF_ROTOR = "examples/keogh-cole.toml", "examples/tum-flexible-rotor.toml"
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
    optional = {"prove", "proven", "places", "stated", "response-keys", "forces-words", "diagram-words", "along"}
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
    parts = make_figures(tuple(FIGURES))[1]
    for name in re.findall(r"\bparts\.(\w+)", scripts):
        assert name in parts or name in ("push",), name
