"""What the documentation says by hand, against the code: `make docs` does not notice what is missing."""

from __future__ import annotations

import re
import tomllib
from importlib import import_module
from pathlib import Path

import pytest

import carom
from carom.outcome import Outcome

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
API = (DOCS / "reference" / "api.md").read_text(encoding="utf-8")
ENTRIES = re.findall(r"^   (carom\.[\w.]+)$", API, flags=re.MULTILINE)


def find(path: str) -> object:
    """The object of a dotted name below the package."""
    value: object = carom
    for name in path.split(".")[1:]:
        module = getattr(value, "__name__", "")
        if not hasattr(value, name):
            import_module(f"{module}.{name}")
        value = getattr(value, name)
    return value


@pytest.mark.parametrize("name", [name for name, home in carom._HOMES.items() if home != "carom"])
def test_every_public_name_is_in_the_reference(name):
    assert f"carom.{name}" in ENTRIES


@pytest.mark.parametrize("path", ENTRIES)
def test_every_entry_of_the_reference_exists_and_says_what_it_is(path):
    assert find(path).__doc__


def test_no_entry_twice():
    assert len(set(ENTRIES)) == len(ENTRIES)


@pytest.mark.parametrize("outcome", Outcome, ids=lambda outcome: outcome.label)
def test_every_outcome_is_in_the_contact_contract(outcome):
    assert f"`{outcome.label}`" in (DOCS / "contact-contract.md").read_text(encoding="utf-8")


def test_limits_that_are_explained_exist():
    page = (DOCS / "numerics.md").read_text(encoding="utf-8")
    named = re.findall(r'^    "([a-z_.]+)\.([A-Z_]+)": "', page, flags=re.MULTILINE)
    assert len(named) > 10
    for home, name in named:
        assert hasattr(import_module(f"carom.{home}"), name), f"carom.{home}.{name}"


def test_files_that_are_pointed_to_exist():
    pages = [page for page in DOCS.rglob("*.md") if "generated" not in page.parts]
    assert len(pages) > 20
    for page in pages:
        for path in re.findall(r"`((?:tests|examples|docs|tools)/[\w./-]+)`", page.read_text(encoding="utf-8")):
            assert (ROOT / path).exists(), f"{page.name}: {path}"


def test_the_map_of_modules_is_that_of_the_layers():
    """In `CONTRIBUTING.md`, from the lowest layer up: what `make layers` checks against the tree."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    (layers,) = [
        contract["layers"]
        for contract in project["tool"]["importlinter"]["contracts"]
        if contract.get("containers") == ["carom"]
    ]
    listed = re.findall(r"^\| `(\w+)` \|", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert [*listed, "__main__"] == layers[::-1]


def test_tests_that_mutants_are_tried_with_exist():
    program = (ROOT / "tools" / "mutants").read_text(encoding="utf-8")
    named = set(re.findall(r'"((?:\w+/)*test_\w+\.py)"', program))
    assert len(named) > 8
    assert [name for name in sorted(named) if not (ROOT / "tests" / name).exists()] == []
