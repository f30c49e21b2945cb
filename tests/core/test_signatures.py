"""Types of operations are inferred once."""

import operator

import pytest
from numba.core.typing.context import BaseContext

from carom.core.layout import kernel

pytestmark = pytest.mark.jit_only


@kernel
def _area(width, height):
    return width * height + width.real


@kernel
def _volume(area, depth):
    return area * depth + depth.real


def test_the_types_of_an_operation_are_inferred_once_for_all_kernels(monkeypatch):
    asked = []
    resolve = BaseContext.resolve_function_type

    def asks(context, function, args, keywords):
        asked.append(getattr(function, "typing_key", function))
        return resolve(context, function, args, keywords)

    monkeypatch.setattr(BaseContext, "resolve_function_type", asks)
    assert _area(2.0, 3.0) == 8.0
    asked.clear()
    assert _volume(6.0, 4.0) == 28.0
    assert not {operator.mul, operator.add} & set(asked)


@pytest.mark.parametrize("factor", [2, 2.0, 2j])
def test_other_types_have_signatures_of_their_own(factor):
    assert _area(3.0, factor) == 3.0 * factor + 3.0
    assert _area(factor, 3.0) == 3.0 * factor + factor.real
