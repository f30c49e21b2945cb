"""Rotors that touch the wall of their clearance, and whether they come back.

>>> import carom as cm
>>> machine = cm.load("examples/keogh-cole.toml")
>>> orbits = cm.find_orbits(machine)
>>> motion = cm.simulate(machine, cm.kick(0.4, angle=0.2), 400.0)

Each verb takes a machine, a case, parameters or a model.  Where one takes more than two seconds, a bar appears in a terminal;
``progress=False`` prevents it, and a callable receives each :class:`~carom.base.progress.Progress`.  What is more
special lives in the packages: ``cm.disturbances``, ``cm.basins``, ``cm.bifurcations``, ``cm.closed_forms``, ``cm.plots`` and so on.

Names and packages are loaded when they are first used, so ``import carom`` stays light.  The file ``__init__.pyi`` beside
this one says what they are and where they live, to type checkers and to this module alike.
"""

import ast
from importlib import import_module
from pathlib import Path
from typing import Any


def _homes() -> dict[str, str]:
    """Home of each public name: the module it is defined in, or ``carom`` of a package, ``carom.base`` of a module of it."""
    stub = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    imports = [statement for statement in stub.body if isinstance(statement, ast.ImportFrom)]
    return {alias.name: str(statement.module) for statement in imports for alias in statement.names}


_HOMES = _homes()

__all__ = ["__version__", *_HOMES]  # noqa: PLE0604  (all of them are strings)


def __getattr__(name: str) -> Any:
    """Load a public name on first use (PEP 562) and keep it."""
    value: Any
    if name == "__version__":
        from importlib.metadata import version

        value = version(__name__)
    elif name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    elif _HOMES[name] in (__name__, f"{__name__}.base"):
        value = import_module(f"{_HOMES[name]}.{name}")
    else:
        value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Name what is public, loaded or not."""
    return sorted(__all__)
