"""The names `import carom` offers, and that offering them costs nothing."""

import ast
import importlib.metadata
import inspect
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import carom


def run(code: str) -> str:
    """Standard output of a fresh interpreter: what is loaded here must not matter."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("name", carom._HOMES)
def test_public_name_is_defined_in_its_home(name):
    value = getattr(carom, name)

    assert not isinstance(value, ModuleType)
    assert f"{value.__module__}.".startswith(f"carom.{carom._HOMES[name]}.")
    assert value.__name__ == name


def test_subpackage_is_a_module():
    assert inspect.ismodule(carom.plots)


def test_version_is_the_installed_one():
    assert carom.__version__ == importlib.metadata.version("carom")


def test_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="module 'carom' has no attribute 'sumulate'"):
        carom.sumulate  # noqa: B018


def test_dir_lists_every_public_name_before_it_is_loaded():
    assert run("import carom; print(sorted(carom.__all__) == dir(carom))") == "True"


def test_type_checkers_see_the_same_names():
    tree = ast.parse(Path(carom.__file__).read_text(encoding="utf-8"))
    block = next(node for node in tree.body if isinstance(node, ast.If))
    imports = [node for node in block.body if isinstance(node, ast.ImportFrom)]

    seen = {(node.module, alias.name, alias.asname) for node in imports for alias in node.names}

    homes = {(f"carom.{home}", name, name) for name, home in carom._HOMES.items()}
    assert seen == homes | {("carom", name, name) for name in carom._SUBPACKAGES}


def test_import_loads_nothing_heavy():
    heavy = ("h5netcdf", "matplotlib", "numba", "numpy", "pandas", "pint", "pydantic", "rich", "typer", "xarray")

    assert run(f"import sys, carom; print([name for name in {heavy} if name in sys.modules])") == "[]"


def test_function_is_not_hidden_by_the_module_of_its_name():
    """Whatever was imported before, and how: each time the package is imported anew, other packages are kept."""
    ways = [
        "import carom",
        "import carom; carom.{name}",
        "import carom.{name}",
        "from carom import {name}",
        "from carom.{name} import {name}",
        "import carom.orbits, carom.report, carom.cli",
        "import importlib; importlib.import_module('carom.{name}')",
        "import carom, carom.{name}, importlib, sys; importlib.reload(sys.modules['carom.{name}'])",
    ]
    look = "import carom; from carom import {name} as direct; import sys; print("
    look += "type(carom.{name}).__name__, type(direct).__name__, type(sys.modules['carom.{name}']).__name__)"
    forget = "for loaded in [name for name in sys.modules if name.split('.')[0] == 'carom']: del sys.modules[loaded]"
    blocks = [f"{way}\n{look}\n{forget}".format(name=name) for name in ("equilibria", "study") for way in ways]

    assert run("\n".join(blocks)).splitlines() == ["function function module"] * 16


def test_package_runs_as_a_command():
    done = subprocess.run([sys.executable, "-m", "carom", "--help"], capture_output=True, text=True, check=False)

    assert done.returncode == 0, done.stderr
    assert "study" in done.stdout
