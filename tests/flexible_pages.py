"""A flexible machine as the page opens it."""

from __future__ import annotations

from pathlib import Path

import carom
from carom.explorer.computing.exports import Origin

MACHINE = str(Path(__file__).parents[1] / "examples" / "tum-flexible-rotor.toml")


def opened(*settings: str) -> Origin:
    """The rig of Munich."""
    return Origin(MACHINE, settings, carom.load(MACHINE, settings))


def reduced(*settings: str):
    """The same by its vectors."""
    return carom.models.rotor_of(opened(*settings).case).finite_elements
