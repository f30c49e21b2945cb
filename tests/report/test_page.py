"""The report: everything in one file, nothing fetched, nothing broken."""

import html.parser
import json
import re
from dataclasses import replace

import pytest
from machines import PAPER
from studies import study_once

from carom.loading import load
from carom.report import report_page, write_report
from carom.report.figures import pictures
from carom.studies.questions import about
from carom.studies.summaries import survived_rows

pytestmark = pytest.mark.jit_only


class Page(html.parser.HTMLParser):
    """Collects identifiers, references, open tags and text."""

    VOID = frozenset(("meta", "link", "br", "img", "hr", "input", "path", "use"))

    def __init__(self, text):
        super().__init__()
        self.identifiers, self.references, self.tags, self.open, self.words = [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag not in self.VOID:
            self.open.append(tag)
        self._look(attributes)

    def handle_startendtag(self, tag, attributes):
        self.tags.append(tag)
        self._look(attributes)

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.words.append(data)

    def _look(self, attributes):
        for name, value in attributes:
            if name == "id":
                self.identifiers.append(value)
            elif name in ("href", "xlink:href", "src"):
                self.references.append(value)
            else:
                self.references += [f"#{target}" for target in re.findall(r"url\(#([^)]+)\)", value or "")]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    example = "examples/keogh-cole.toml"
    result = study_once(load(example))
    shown = []
    path = write_report(
        result, str(tmp_path_factory.mktemp("report")), progress=lambda report: shown.append(report.share)
    )
    assert shown == sorted(shown)
    return result, path, path.read_text(encoding="utf-8")


def test_every_symbol_of_a_report_is_a_formula(written):
    for page in (written[2], report_page(study_once(PAPER), [])):
        page = re.sub(r"<code>--set.*?</code>", "", page)  # to be pasted as it is
        words = " ".join(Page(page).words)
        assert not re.search(r"[ceFik]_(max|[rcis])|Omega", words)
        assert not re.search(r"\d (N|mm|m)/?s?\b", words)


def test_page_is_well_formed_and_self_contained(written):
    _, _, text = written
    page = Page(text)

    assert page.open == []
    assert len(page.identifiers) == len(set(page.identifiers))
    inside = [reference for reference in page.references if not reference.startswith("data:image/png")]
    assert all(reference.startswith("#") for reference in inside)
    assert {reference[1:] for reference in inside} <= set(page.identifiers)
    assert "script" not in page.tags
    assert "link" not in page.tags
    assert not re.search(r"@import|url\((?!#)", text)


def test_page_shows_the_study(written):
    result, _, text = written
    words = re.sub(r"\s+", " ", "".join(Page(text).words))

    for part in ("3,408 N s/m", "zone D", "901 N", "Scope", "F1 has 2 roots", "carom 0."):
        assert part in words
    assert result.verdict.lead in words
    shown = {fact.label: fact.text for fact in about(result.facts, "Verdict")}
    for label in ("Must survive", "Coexisting"):
        assert shown[label][1:] in words
    for fact in about(result.facts, "Recommendation"):
        assert fact.text[1:] in words
    for row in survived_rows(result):
        assert all(cell in words for cell in row)
    assert text.count("<svg") == len(pictures(result))
    assert "`" not in words
    assert "{{" not in text
    assert "{%" not in text


@pytest.mark.parametrize("gamma", [3.0, pytest.param(0.1, marks=pytest.mark.deep)])
def test_same_study_gives_the_same_bytes(gamma, tmp_path):
    result = study_once(PAPER.replace(gamma=gamma))
    places = [write_report(result, str(tmp_path / name)).parent for name in ("once", "again")]

    once, again = ({file.name: file.read_bytes() for file in place.rglob("*") if file.is_file()} for place in places)
    assert once == again


def test_names_are_escaped(written):
    result, _, _ = written
    named = replace(result, case=replace(result.case, name="<b>&"))

    text = report_page(named, [])
    assert "<b>&" not in text
    assert "&lt;b&gt;&amp;" in text


def test_figures_are_svg_and_png(written, monkeypatch, tmp_path):
    result, _, _ = written
    monkeypatch.setattr("carom.report.page.pictures", lambda study: pictures(study)[:1])
    write_report(result, str(tmp_path))
    assert {file.name for file in (tmp_path / "figures").iterdir()} == {"basins.svg", "basins.png"}
    assert json.loads((tmp_path / "study.json").read_text(encoding="utf-8"))["figures"] == [
        "figures/basins.svg",
        "figures/basins.png",
    ]


def bottom(page, selector):
    return page.evaluate("chosen => document.querySelector(chosen).getBoundingClientRect().bottom", selector)


def test_the_first_screen_and_the_first_printed_page_hold_the_answer(written, browser):
    _, path, _ = written
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(path.absolute().as_uri())
    assert bottom(page, ".page") <= 900
    assert page.evaluate("document.documentElement.scrollHeight") <= 7100
    page.set_viewport_size({"width": 390, "height": 844})
    assert bottom(page, ".page figure") <= 844
    assert page.evaluate("document.querySelector('.change').getBoundingClientRect().top") <= 844
    page.set_viewport_size({"width": 688, "height": 1020})  # A4 without its margins: 182 mm by 270 mm
    page.emulate_media(media="print")
    assert bottom(page, ".page") <= 1020
    page.close()
