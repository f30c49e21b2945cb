"""One motion has one name: what the page of the names rules out is not written for people anywhere."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from carom.base.outcome import DRIFTING_RUB, IRREGULAR_BOUNCING, REGULAR_BOUNCING, STEADY_WORDS, Outcome

PAGE = Path("docs/reference/motions.md")
PACKAGES = ("plots", "cli", "report", "studies", "sweeps", "explorer")
NAMING = (*PACKAGES, "attractors", "basins", "bifurcations", "disturbances", "motions", "orbits")
"""Packages whose texts take the names of motions from their home; statements of proofs and of papers are texts of their own."""
TOLD_APART = (
    *STEADY_WORDS.values(),
    DRIFTING_RUB,
    IRREGULAR_BOUNCING,
    REGULAR_BOUNCING,
    *(Outcome(code).words for code in range(20, 26)),
)
"""All names of motions."""


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


def texts_of(package: str) -> list[str]:
    return [text for path in Path("src/carom", package).rglob("*.py") for text in texts(path)]


def test_the_page_rules_names_out():
    assert {"contact-free motion", "rub equilibri"} <= set(ruled_out())


@pytest.mark.parametrize("package", PACKAGES)
def test_no_text_for_people_has_a_name_that_is_ruled_out(package):
    assert not [text for text in texts_of(package) if any(name in text.lower() for name in ruled_out())]


def is_written_out(text: str) -> bool:
    """Whether a text is a name, perhaps with an adjective or as a plural, or a sentence with a name of several words; no heading."""
    plain = re.sub(r"^(the |a |no |un|stable |periodic |virtual |[0-9]*-impact )+", "", text.strip())
    codes = [outcome.label for outcome in Outcome]
    return any(
        (" " in name and name in text.lower())
        or (name not in codes and re.fullmatch(rf"{name}s?( virtual)?[:,.]?", plain) is not None)
        or re.fullmatch(rf"([0-9]*-impact )?{name} (on|with rub)", plain) is not None
        for name in TOLD_APART
    )


@pytest.mark.parametrize("package", NAMING)
def test_names_of_motions_have_one_home(package):
    assert not [text for text in texts_of(package) if is_written_out(text)]
