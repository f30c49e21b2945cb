"""One motion has one name: what the page of the names rules out is not written for people anywhere."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

PAGE = Path("docs/reference/motions.md")
PACKAGES = ("plots", "cli", "report", "studies", "sweeps", "explorer")


def ruled_out() -> list[str]:
    (listed,) = re.findall(r"Not written for people: (.*?)\.\n", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    return [name.removesuffix("um") for name in re.findall(r'"([^"]+)"', listed.replace("\n", " "))]


def texts(path: Path) -> Iterator[str]:
    """The texts of a module without its docstrings, also the parts of formatted ones."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    silent = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in silent:
            yield node.value


def test_the_page_rules_names_out():
    assert {"contact-free motion", "rub equilibri"} <= set(ruled_out())


@pytest.mark.parametrize("package", PACKAGES)
def test_no_text_for_people_has_a_name_that_is_ruled_out(package):
    found = [
        (str(path), text)
        for path in Path("src/carom", package).rglob("*.py")
        for text in texts(path)
        if any(name in text.lower() for name in ruled_out())
    ]
    assert not found
