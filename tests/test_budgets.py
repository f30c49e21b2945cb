"""Lines of code of each package, sizes of files and functions, and annotations that say nothing, stay within limits.

Lines without docstrings, comments and empty ones count.  A limit is lowered when the code gets lighter; it is raised only with a line in
``docs/decisions/budgets.md`` that says what was bought.
"""

import ast
import io
import tokenize
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "carom"
LIMITS = {
    "parameters base": 3633,
    "models": 2364,
    "core": 6469,
    "motions disturbances": 4645,
    "orbits bifurcations closed_forms continuation": 6418,
    "basins attractors": 2331,
    "studies": 3461,
    "cli plots report": 5743,
    "rotors": 4346,
    "proofs": 5907,
    "explorer": 2055,
    "fitting": 945,
    "sweeps": 1399,
    "reproductions": 1268,
}
TESTS, ANY = 38_923, 291
LONGEST_FILE, LONGEST_FUNCTION, MOST_PARAMETERS = 400, 80, 8
DECLARATIONS = {"entry"}
"""Functions whose parameters are what a field or a machine is declared by, each by its name."""
SKIPPED = (
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
)


@cache
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


def lines_of_code(path: Path) -> int:
    text = path.read_text(encoding="utf-8")
    quoted = {
        line
        for node in ast.walk(parsed(path))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        for line in range(node.lineno, node.end_lineno + 1)
    }
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    held = {line for each in tokens if each.type not in SKIPPED for line in range(each.start[0], each.end[0] + 1)}
    return len(held - quoted)


def lines_in(directory: Path) -> int:
    return sum(map(lines_of_code, directory.rglob("*.py")))


@pytest.mark.parametrize("packages", LIMITS)
def test_packages_stay_within_their_limits(packages):
    assert sum(lines_in(PACKAGE / name) for name in packages.split()) <= LIMITS[packages]


def test_every_package_has_a_limit():
    assert sorted(" ".join(LIMITS).split()) == sorted(each.parent.name for each in PACKAGE.glob("*/__init__.py"))


def test_tests_stay_within_their_limit():
    assert lines_in(ROOT / "tests") <= TESTS


def functions():
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                yield path, node


def test_files_and_functions_are_short():
    """Functions of the core are kernels, which are compiled into their caller and may be longer."""
    files = [
        path for path in PACKAGE.rglob("*.py") if len(path.read_text(encoding="utf-8").splitlines()) > LONGEST_FILE
    ]
    long = [
        f"{path.relative_to(PACKAGE)}: {node.name}"
        for path, node in functions()
        if path.parts[len(PACKAGE.parts)] != "core" and node.end_lineno - node.body[0].end_lineno > LONGEST_FUNCTION
    ]
    assert not files + long


def test_functions_have_few_parameters():
    """Those of commands are their options."""
    many = {
        node.name
        for path, node in functions()
        if path.parts[len(PACKAGE.parts)] not in ("core", "cli")
        and len({each.arg for each in node.args.args + node.args.kwonlyargs} - {"self", "cls"}) > MOST_PARAMETERS
    }
    assert many == DECLARATIONS


def test_annotations_say_something():
    vague = sum(
        isinstance(each, ast.Name) and each.id == "Any"
        for path in PACKAGE.rglob("*.py")
        for each in ast.walk(parsed(path))
    )
    assert vague <= ANY
