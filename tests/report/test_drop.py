"""The page of a drop stands alone and says what the numbers say."""

import re
from dataclasses import replace

import pytest

import carom as cm
from carom.motions import drop_loads, follow_loads
from carom.report import write_drop_report
from carom.studies import DropStudy
from carom.studies.drops import release

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
    assert not re.search(r'(?:src|href)="(?!#|data:)', page)
    # Three figures, and the film.
    assert page.count("<svg") == 4
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
    assert "Touchdown bearing: radial clearance 0.25 mm, friction 0.15; hunt-crossley" in text
    assert "1 of 2 stated limits kept up to the end of what was followed." in " ".join(text.split())
    assert "<strong>normal force: 1,320" in page.replace("\N{NO-BREAK SPACE}", " ")
    assert "<b>drop</b>" not in page
    assert "&lt;b&gt;drop&lt;/b&gt;" in page


@pytest.mark.parametrize(
    ("path", "words"),
    [
        (
            "examples/dropped-rotor.toml",
            "A rotor that moves parallel to itself of 5 kg, in 1 radial touchdown bearing.",
        ),
        ("tests/machine_files/four-degrees.toml", "A rigid rotor of 12 kg on 2 magnetic bearings, in 2 radial"),
        ("examples/tum-flexible-rotor.toml", "A flexible rotor of 3.273 kg on 2 magnetic bearings, in 2 radial"),
    ],
)
def test_every_kind_of_machine_has_its_landing_report(path, words, tmp_path):
    case = cm.load(path)
    rotor, state, echo = release(case, cm.drop())
    found = DropStudy(case, echo, follow_loads(rotor, state, "10 ms"))
    page = write_drop_report(found, cm.simulate(rotor, state, "10 ms"), str(tmp_path)).read_text(encoding="utf-8")
    text = " ".join(re.sub(r"<[^>]+>", "", page).replace("\N{NO-BREAK SPACE}", " ").split())
    assert words in text
    assert "Nothing to accept against: no limits are stated." in text
    assert "clauses not cited" in text
