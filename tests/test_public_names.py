"""The names `import carom` offers, and that offering them costs nothing."""

import ast
import importlib.metadata
import inspect
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import carom

MODULES = ("carom", "carom.base")
"""Homes of names that are modules."""


def run(code: str) -> str:
    """Standard output of a fresh interpreter: what is loaded here must not matter."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("name", [name for name, home in carom._HOMES.items() if home not in MODULES])
def test_public_name_is_defined_in_its_home(name):
    value = getattr(carom, name)

    assert not inspect.ismodule(value)
    assert f"{value.__module__}.".startswith(f"{carom._HOMES[name]}.")
    assert value.__name__ == name


@pytest.mark.parametrize("name", [name for name, home in carom._HOMES.items() if home in MODULES])
def test_package_is_a_module(name):
    assert inspect.ismodule(getattr(carom, name))


def test_what_stands_at_the_root_can_be_taken_in_at_a_glance():
    names = [name for name, home in carom._HOMES.items() if home not in MODULES]
    assert len(names) <= 21


def test_version_is_the_installed_one():
    assert carom.__version__ == importlib.metadata.version("carom")


def test_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'carom' has no attribute 'sumulate'"):
        carom.sumulate  # noqa: B018


def test_dir_lists_every_public_name_before_it_is_loaded():
    assert run("import carom; print(sorted(carom.__all__) == dir(carom))") == "True"


def test_import_loads_nothing_heavy():
    heavy = ("h5netcdf", "matplotlib", "numba", "numpy", "pandas", "pint", "pydantic", "rich", "typer", "xarray")

    assert run(f"import sys, carom; print([name for name in {heavy} if name in sys.modules])") == "[]"


def test_only_packages_list_their_names():
    modules = [path for path in Path(carom.__file__).parent.rglob("*.py") if path.name != "__init__.py"]
    assert [path for path in modules if re.search("^__all__", path.read_text(encoding="utf-8"), re.MULTILINE)] == []


def test_no_function_shadows_a_module():
    """In no package: a name that is a module once it is imported, and a function before, is neither."""
    packages = [path.parent for path in Path(carom.__file__).parent.rglob("__init__.py")]
    for package in packages:
        modules = {path.stem for path in package.glob("*.py")} | {
            path.parent.name for path in package.glob("*/__init__.py")
        }
        tree = ast.parse((package / "__init__.py").read_text(encoding="utf-8"))
        imported = {
            alias.asname or alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names
        }
        assert not imported & modules, package


def test_package_runs_as_a_command():
    done = subprocess.run([sys.executable, "-m", "carom", "--help"], capture_output=True, text=True, check=False)

    assert done.returncode == 0, done.stderr
    assert "study" in done.stdout


@pytest.mark.parametrize(
    "script", sorted(Path(__file__).parents[1].glob("benchmarks/*.py")), ids=lambda path: path.stem
)
def test_what_a_benchmark_imports_exists(script):
    """Benchmarks are run by hand, long after a name that they use may have gone."""
    for statement in ast.walk(ast.parse(script.read_text(encoding="utf-8"))):
        if isinstance(statement, ast.ImportFrom) and str(statement.module).startswith("carom"):
            home = import_module(str(statement.module))
            for one in statement.names:
                assert hasattr(home, one.name) or import_module(f"{home.__name__}.{one.name}")
