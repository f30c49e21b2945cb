"""The machine of the page if no file is given."""

from __future__ import annotations

from pathlib import Path

NAME = "balanced-rotor.toml"


def example_file() -> Path:
    """The example machine: shipped inside the package, in a checkout the file of its folder ``examples``."""
    package = Path(__file__).resolve().parents[1]
    shipped = package / "examples" / NAME
    return shipped if shipped.exists() else package.parents[1] / "examples" / NAME
