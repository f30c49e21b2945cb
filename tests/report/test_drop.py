"""The page of a drop stands alone and says what the numbers say."""

import re
from dataclasses import replace

import pytest

import carom as cm
from carom.motions import drop_loads
from carom.report import write_drop_report
from carom.studies import DropStudy

pytestmark = pytest.mark.jit_only


@pytest.fixture(scope="module")
def dropped():
    case = cm.load("examples/touchdown-balls.toml")
    motion = cm.simulate(case, cm.drop(), "20 ms")
    echo = cm.drop().echo_at(cm.models.rotor_of(case), motion.rotor, motion.start, case.gravity)
    limited = cm.parameters.LoadLimits(force="1 kN", pressure="4.2 GPa")
    return DropStudy(replace(case, name="<b>drop</b>", limits=limited), echo, drop_loads(motion)), motion


@pytest.fixture(scope="module")
def page(dropped, tmp_path_factory):
    path = write_drop_report(*dropped, str(tmp_path_factory.mktemp("drop") / "out"))
    return path.read_text(encoding="utf-8")


def test_it_needs_no_other_file(page):
    assert not re.search(r"<(?:link|img|iframe)\b|<script[^>]* src", page)
    assert not re.search(r'(?:src|href)="(?!#)', page)
    # Two figures, and the film.
    assert page.count("<svg") == 3
    identifiers = re.findall(r' id="([^"]+)"', page)
    assert len(identifiers) == len(set(identifiers))


def test_it_says_what_was_found(page, dropped):
    found = dropped[0]
    text = re.sub(r"<[^>]+>", "", page).replace("\N{NO-BREAK SPACE}", " ")
    assert found.headline in text
    for _, rows in found.tables:
        for label, shown in rows:
            assert label in text
            assert shown in text
    assert "<strong>normal force: 1,320" in page.replace("\N{NO-BREAK SPACE}", " ")
    assert "<b>drop</b>" not in page
    assert "&lt;b&gt;drop&lt;/b&gt;" in page
