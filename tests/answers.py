"""The cells of the matrix of machines and questions, and what a command answers in each."""

import importlib.util
import json
from pathlib import Path

import pytest

from carom.cli import main

SPEC = importlib.util.spec_from_file_location("matrix", Path(__file__).parents[1] / "tools" / "matrix.py")
MATRIX = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(MATRIX)
CELLS = [(question, machine) for machine in MATRIX.MACHINES for question in MATRIX.questions(machine)]


def check_answer(question, machine, capsys):
    """The command answers, or says in a line that the question has no meaning for the machine."""
    command, *options = MATRIX.questions(machine, small=True)[question]
    code = main([command, str(MATRIX.MACHINES[machine]), *options, "--json"])
    out, err = capsys.readouterr()
    if (machine, question) in MATRIX.WITHOUT_MEANING:
        assert code == 2, out
        assert len(err.splitlines()) == 1
        assert "speed" in err
    else:
        assert code == 0, err
        assert json.loads(out)


HEAVY = ("gravity", "hunt-crossley-gravity", "race-gravity", "real", "four-degrees", "tum-flexible-rotor")


def cells(heavy):
    """Those of machines under weight or of many states, or the others: two files of tests run side by side."""
    return [pytest.param(*cell, id="-".join(cell)) for cell in CELLS if (cell[1] in HEAVY) is heavy]
