"""Docstrings of the reference: their examples run, and what they point to exists."""

import doctest
import inspect
import re

import pytest
from test_documentation import ENTRIES, ROOT, find

import carom

ROOT_NAMES = [f"carom.{name}" for name, home in carom._HOMES.items() if home not in ("carom", "carom.base")]
LONG = ("carom.study", "carom.map_regions")


def text_of(path: str) -> str:
    """Docstring of a name, without indentation."""
    return inspect.getdoc(find(path)) or ""


WITH_EXAMPLES = [path for path in ENTRIES if ">>>" in text_of(path) and not inspect.ismodule(find(path))]


@pytest.mark.parametrize("path", ROOT_NAMES)
def test_root_name_has_examples_and_says_what_else_to_see(path):
    text = text_of(path)
    assert re.search(r"^See Also\n-{8}$", text, flags=re.MULTILINE)
    assert re.search(r"^Examples\n-{8}$", text, flags=re.MULTILINE)
    assert ">>> import carom as cm" in text


@pytest.mark.parametrize("path", [path for path in ENTRIES if "See Also" in text_of(path)])
def test_what_a_docstring_points_to_is_in_the_reference(path):
    (listed,) = re.findall(r"^See Also\n-{8}\n((?:carom\..*\n?)+)", text_of(path), flags=re.MULTILINE)
    for line in listed.splitlines():
        for name in line.partition(" : ")[0].split(", "):
            assert name in ENTRIES, name
            assert find(name)


def test_many_names_have_examples():
    assert len(WITH_EXAMPLES) > 30


@pytest.mark.jit_only
@pytest.mark.parametrize(
    "path", [pytest.param(path, marks=pytest.mark.deep) if path in LONG else path for path in WITH_EXAMPLES]
)
def test_examples_of_a_docstring_run(path, monkeypatch):
    monkeypatch.chdir(ROOT)
    test = doctest.DocTestParser().get_doctest(text_of(path), {}, path, None, None)
    shown: list[str] = []
    result = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test, out=shown.append)
    assert result.attempted
    assert not result.failed, "".join(shown)
