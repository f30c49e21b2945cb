"""Tables of motions show every state that a motion can have."""

from __future__ import annotations

from typing import get_args

from rich.console import Console

from carom.cli.tables import _motions
from carom.studies.summaries import MotionRow, State


def test_every_state_of_a_motion_is_shown():
    rows = [MotionRow(f"motion {place}", state) for place, state in enumerate(get_args(State))]
    console = Console(width=100)
    with console.capture() as shown:
        console.print(_motions(rows, "Motions", console.width))
    lines = shown.get().splitlines()
    for row in rows:
        assert any(row.name in line and row.state in line for line in lines)
