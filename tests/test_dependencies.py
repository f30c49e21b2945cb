"""What the package imports is what it says it depends on."""

import ast
import re
import sys
import tomllib
from pathlib import Path

import carom

SOURCE = Path(carom.__file__).parent
PROJECT = SOURCE.parents[1] / "pyproject.toml"
MODULES = {"google-crc32c": "google_crc32c", "python-flint": "flint", "ross-rotordynamics": "ross"}
BROUGHT = {
    "markupsafe": "jinja2",
    "tornado": "bokeh",
    "IPython": "a notebook",
}
"""Modules that come with something else, which is there where they are imported."""


def test_every_import_is_a_dependency_or_belongs_to_an_extra():
    project = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]
    always = project["dependencies"]
    optional = [each for extra in project["optional-dependencies"].values() for each in extra]
    known = {MODULES.get(name, name) for each in [*always, *optional] for name in re.findall(r"^[\w-]+", each)}
    imported = set()
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                imported.add(node.module.split(".")[0])
    assert imported - set(sys.stdlib_module_names) - known - set(BROUGHT) == {"carom"}
