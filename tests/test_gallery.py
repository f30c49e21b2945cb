"""The gallery: numbered scripts, each with a title and a figure.  `make docs` runs all of them."""

import ast
import os
import re
import runpy
from pathlib import Path

import pytest
from matplotlib.figure import Figure

GALLERY = Path(__file__).parent.parent / "examples" / "gallery"
SCRIPTS = sorted(GALLERY.glob("*.py"))
CHEAP = ("01_equilibria", "09_energy_ledger", "12_one_orbit")


def listing() -> set[str]:
    """All files below the examples, but what Python itself writes."""
    return {str(path) for path in GALLERY.parent.rglob("*") if "__pycache__" not in path.parts}


def test_examples_are_numbered_without_gaps():
    assert len(SCRIPTS) >= 30
    assert [int(path.stem[:2]) for path in SCRIPTS] == list(range(1, len(SCRIPTS) + 1))
    assert len({path.stem[3:] for path in SCRIPTS}) == len(SCRIPTS)


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_example_has_a_title_an_introduction_and_a_figure(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    title, line, _, first, *_ = ast.get_docstring(tree).splitlines()
    assert title.startswith(f"{int(path.stem[:2])}. ")
    assert line == "=" * len(title)
    assert first
    targets = [target for node in tree.body if isinstance(node, ast.Assign) for target in node.targets]
    named = {target.id for target in targets if isinstance(target, ast.Name)}
    assert "figure" in named
    compile(tree, path, "exec")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_example_says_before_its_figure_what_to_see(path):
    before, _, _ = path.read_text(encoding="utf-8").partition("\nfigure = ")
    (block,) = re.findall(r"^# What to see: .*(?:\n#.*)*", before, re.MULTILINE)
    assert len(block.split()) > 12


@pytest.mark.jit_only
@pytest.mark.parametrize(
    "path",
    [path if path.stem in CHEAP else pytest.param(path, marks=pytest.mark.deep) for path in SCRIPTS],
    ids=lambda path: path.stem,
)
def test_example_runs_draws_and_writes_nothing(path, monkeypatch, capsys):
    monkeypatch.chdir(GALLERY)
    before = listing()
    names = runpy.run_path(os.fspath(path), run_name="__main__")
    assert isinstance(names["figure"], Figure)
    assert capsys.readouterr().out or "print" not in path.read_text(encoding="utf-8")
    assert listing() == before
