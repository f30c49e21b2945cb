"""Every question is answered for every machine, with few and short motions: those under weight, and those of many states."""

import pytest
from answers import cells, check_answer


@pytest.mark.jit_only
@pytest.mark.parametrize(("question", "machine"), cells(heavy=True))
def test_the_question_is_answered(question, machine, capsys):
    check_answer(question, machine, capsys)
