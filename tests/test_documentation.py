"""What the documentation says by hand, against the code: `make docs` does not notice what is missing."""

import ast
import re
import shlex
import tomllib
from importlib import import_module
from pathlib import Path

import pytest
from typer.main import get_command

import carom
from carom.base.outcome import Outcome
from carom.cli.app import app
from carom.proofs import hypotheses_of
from carom.proofs.families import FAMILIES, KICKS
from carom.proofs.kick_cells import DISC, REFUTED, read
from carom.proofs.kick_claims import claims_of
from carom.proofs.kick_discs import KickDisc

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


@pytest.mark.parametrize("name", [name for name, home in carom._HOMES.items() if home not in ("carom", "carom.base")])
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


def test_claims_that_are_explained_are_made():
    """Those in italics in the table of what can be claimed of a machine."""
    page = (DOCS / "howto" / "what-is-proven.md").read_text(encoding="utf-8")
    named = [
        name
        for row in re.findall(r"^\| (\*[^|]+) \|", page, flags=re.MULTILINE)
        for name in re.findall(r"\*([^*]+)\*", row)
    ]
    made = {claim.name for claim in carom.prove(ROOT / "examples" / "source-paper.toml")}
    made |= {f"states {kind}" for kind in ("recover", "all recover", "lost")}
    sizes = {"kicks": "1", "shocks": "1, 1", "unbalance steps": "1"}
    machine = hypotheses_of(ROOT / "examples" / "source-paper.toml", ["gamma=0.3"])
    for about, family in FAMILIES.items():
        # Claims as they would be if all of the disc were refuted, which nobody asks here.
        made |= {claim.name for claim in claims_of(KickDisc(family, machine, sizes[about], 1), {DISC: REFUTED})}
    box = KickDisc(KICKS, machine, "1", 1, (("mu", "0.1", "0.2"),))
    made |= {claim.name for claim in claims_of(box, read("p0t", 1))}
    assert len(named) > 10
    assert set(named) <= made


# ------------------------------------------------------------------------------------------------ commands and code

PAGES = [
    ROOT / "README.md",
    *(
        page
        for page in sorted(DOCS.rglob("*.md"))
        if not {"generated", "decisions"} & set(page.relative_to(DOCS).parts)
    ),
]
PLACEHOLDERS = {"M.toml", "MACHINE.toml", "SWEEP.toml"}


def command_lines() -> list[str]:
    """All command lines of carom on the pages, in blocks and between backticks, without comments."""
    found = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        found += re.findall(r"^ *(?:\$ )?(carom [a-z-]+ [^\n]*)$", text, flags=re.MULTILINE)
        found += re.findall(r"`(carom [a-z-]+ [^`\n]*)`", text)
        found += re.findall(r"""(?:run|terminal)\(\s*'(carom [^'\n]*)'""", text)
    whole = [
        line
        for line in found
        if (".toml" in line or line.startswith("carom paper")) and not re.search("…|[.]{3}", line)
    ]
    return sorted({re.sub(r" +[#>] .*$", "", line).strip() for line in whole})


@pytest.mark.parametrize("line", command_lines())
def test_command_line_on_a_page_is_understood(line, tmp_path, monkeypatch):
    """Every option is one of the command's and has a value that it takes; nothing is computed."""
    _, name, *words = shlex.split(line)
    command = get_command(app).commands[name]
    monkeypatch.chdir(tmp_path)
    for place in ("my-machine.toml", *PLACEHOLDERS):
        (tmp_path / place).write_text("")
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    with command.make_context(name, words):
        pass


def test_command_lines_are_found_on_many_pages():
    lines = command_lines()
    assert len(lines) > 25
    assert {shlex.split(line)[1] for line in lines} == set(get_command(app).commands)


def test_every_command_has_a_heading():
    page = (DOCS / "reference" / "command-line.md").read_text(encoding="utf-8")
    headings = re.findall(r"^## carom ([\w-]+)$", page, flags=re.MULTILINE)
    assert sorted(headings) == sorted(get_command(app).commands)


def test_python_that_is_shown_is_run():
    """A block of Python on a page is a cell, which `make docs` executes."""
    for page in PAGES:
        blocks = re.findall(r"^```python\n(.*?)^```$", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        assert not blocks, f"{page.relative_to(ROOT)}: {blocks[0][:80]}"


PACKAGES = [path.parent for path in (ROOT / "src" / "carom").rglob("__init__.py")]


@pytest.mark.parametrize("package", PACKAGES, ids=lambda package: package.name)
def test_a_package_with_a_table_of_its_modules_lists_all(package):
    text = ast.get_docstring(ast.parse((package / "__init__.py").read_text(encoding="utf-8"))) or ""
    modules = {path.stem for path in package.glob("*.py") if path.stem != "__init__"}
    listed = {name for name in modules if f"``{name}``" in text}
    assert listed == modules or not listed or "====" not in text
