"""The report: everything in one file, nothing fetched, nothing broken."""

import html.parser
import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from studies import study_once

from carom.parameters import Parameters, load
from carom.report import report_page, write_report
from carom.report.figures import pictures

SOURCE = Parameters(gamma=0.1, omega=0.76, rho=3 / 7, phi=0.21, mu=0.15, d=0.95, radius_ratio=400 / 7)

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
    example = Path(__file__).parents[2] / "examples" / "keogh-cole.toml"
    result = study_once(load(example))
    told = []
    path = write_report(
        result, str(tmp_path_factory.mktemp("report")), progress=lambda report: told.append(report.share)
    )
    assert told == sorted(told)
    return result, path, path.read_text(encoding="utf-8")


def test_page_is_well_formed_and_self_contained(written):
    _, _, text = written
    page = Page(text)

    assert page.open == []
    assert len(page.identifiers) == len(set(page.identifiers))
    assert all(reference.startswith("#") for reference in page.references)
    assert {reference[1:] for reference in page.references} <= set(page.identifiers)
    assert "script" not in page.tags
    assert "link" not in page.tags
    assert not re.search(r"@import|url\((?!#)", text)


def test_page_shows_the_study(written):
    result, _, text = written
    words = re.sub(r"\s+", " ", "".join(Page(text).words))

    for part in ("3,408 N s/m", "zone D", "901 N", "What is covered, and what is not", "F1 has 2 roots", "carom 0."):
        assert part in words
    assert result.verdict.headline.split("(")[0] in words
    assert text.count("<svg") == len(pictures(result))
    assert "<code>carom basins</code> looks for the smallest" in text
    assert "`" not in words
    assert "{{" not in text
    assert "{%" not in text


def test_figures_are_files_too(written):
    result, path, _ = written
    names = {picture.name for picture in pictures(result)}

    assert names >= {"overview", "period-condition", "multipliers", "disturbance-rolling-backward-whirl"}
    assert names >= {f"{kind}-{orbit.name.replace(',', '')}" for kind in ("orbit", "radius") for orbit in result.orbits}
    files = {file.name for file in (path.parent / "figures").iterdir()}
    assert files == {f"{name}.svg" for name in names}
    listed = json.loads((path.parent / "study.json").read_text(encoding="utf-8"))["figures"]
    assert {f"figures/{name}" for name in files} == set(listed)


@pytest.mark.parametrize("gamma", [3.0, pytest.param(0.1, marks=pytest.mark.deep)])
def test_same_study_gives_the_same_bytes(gamma, tmp_path):
    result = study_once(SOURCE.replace(gamma=gamma))
    places = [write_report(result, str(tmp_path / name)).parent for name in ("once", "again")]

    once, again = ({file.name: file.read_bytes() for file in place.rglob("*") if file.is_file()} for place in places)
    assert once == again


def test_names_are_escaped(written):
    result, _, _ = written
    named = replace(result, case=replace(result.case, name="<b>&"))

    text = report_page(named, [])
    assert "<b>&" not in text
    assert "&lt;b&gt;&amp;" in text


@pytest.mark.parametrize(
    "parameters",
    [
        pytest.param(SOURCE.replace(gamma=0.0), marks=pytest.mark.deep),
        SOURCE.replace(rho=0.0, mu=0.0),
        SOURCE.replace(gamma=3.0),
    ],
)
def test_any_machine_has_a_report(parameters, tmp_path):
    text = write_report(study_once(parameters), str(tmp_path / "out")).read_text(encoding="utf-8")

    page = Page(text)
    assert page.open == []
    assert len(page.identifiers) == len(set(page.identifiers))
    assert "nan" not in re.sub(r"<svg.*?</svg>", "", text, flags=re.DOTALL)
