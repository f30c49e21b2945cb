"""Tables of motions show every state that a motion can have."""

from typing import get_args

from linear_rotors import single
from rich.console import Console
from yielding_walls import with_walls

import carom as cm
from carom.cli.tables import print_motions, print_parts
from carom.models import KelvinVoigt
from carom.studies.summaries import MotionRow, State


def test_every_state_of_a_motion_is_shown():
    rows = [MotionRow(f"motion {place}", state) for place, state in enumerate(get_args(State))]
    console = Console(width=100)
    with console.capture() as shown:
        print_motions(console, "Motions", rows)
    lines = shown.get().splitlines()
    for row in rows:
        assert any(row.name in line and row.state in line for line in lines)


def test_contacts_with_a_wall_that_gives_way_are_rows():
    case = cm.load("examples/keogh-cole.toml")
    rotor = with_walls(single(1), KelvinVoigt(1e4, 3.0), case.parameters.scales)
    motion = cm.simulate(rotor, cm.State(0.2, 1.0), 8.0)
    console = Console(width=160)
    with console.capture() as shown:
        print_parts(console, case, motion, "start")
    text = shown.get()
    assert f": {len(motion.contacts)} contacts." in text
    assert "depth " in text
    assert "after the start" in text
    assert text.count("forward slip") == len(motion.contacts)
