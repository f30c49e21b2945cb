"""Every question is answered for every machine, with few and short motions: those without weight, of few states."""

import pytest
from answers import cells, check_answer


@pytest.mark.jit_only
@pytest.mark.parametrize(("question", "machine"), cells(heavy=False))
def test_the_question_is_answered(question, machine, capsys):
    check_answer(question, machine, capsys)
