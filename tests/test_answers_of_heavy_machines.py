"""Every question is answered for every machine, with few and short motions: those under weight, and those of many states."""

import pytest
from answers import CELLS, check_answer

HEAVY = ("gravity", "hunt-crossley-gravity", "race-gravity", "real", "four-degrees", "tum-flexible-rotor")


@pytest.mark.jit_only
@pytest.mark.parametrize(
    ("question", "machine"),
    [pytest.param(*cell, id="-".join(cell)) for cell in CELLS if cell[1] in HEAVY],
)
def test_the_question_is_answered(question, machine, capsys):
    check_answer(question, machine, capsys)
