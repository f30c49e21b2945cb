"""Every question is answered for every machine: each command, with few and short motions."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import pytest

from carom.cli import main

SPEC = importlib.util.spec_from_file_location("matrix", Path(__file__).parents[1] / "tools" / "matrix.py")
MATRIX = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(MATRIX)
CELLS = [(machine, question) for machine in MATRIX.MACHINES for question in MATRIX.questions(machine)]


@pytest.mark.jit_only
@pytest.mark.parametrize(("machine", "question"), CELLS, ids=[f"{question}-{machine}" for machine, question in CELLS])
def test_the_question_is_answered(machine, question, capsys):
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
