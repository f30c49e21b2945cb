import numpy as np
import pytest

from carom.base.outcome import CaromError
from carom.base.roots import bracketed_root, narrowed, sign_change


def test_bracketed_root():
    functions = (np.cos, lambda x: x**9 - 1e-3, lambda x: np.expm1(20 * (x - 0.7)), lambda x: np.cbrt(x - 1.1))
    for function in functions:
        root = bracketed_root(function, 0.0, 2.0)
        assert function(root - 1e-14) * function(root + 1e-14) <= 0.0
    assert bracketed_root(lambda x: x, 0.0, 1.0) == 0.0
    assert bracketed_root(lambda x: x - 1.0, 0.0, 1.0) == 1.0
    with pytest.raises(CaromError, match="no sign change"):
        bracketed_root(np.cosh, -1.0, 1.0)


def test_a_bracketed_root_is_sought_inside_the_bracket():
    """The secant from a value that is far smaller than the other reaches beyond the end by a rounding error."""
    random = np.random.default_rng(0)
    for high, above in random.random((200, 2)):
        seen: list[float] = []

        def function(x, high=high, above=above, seen=seen):
            seen.append(x)
            return -1e-30 if x <= 0.0 else above if x >= high else above * x / high

        bracketed_root(function, 0.0, high)
        assert min(seen) >= 0.0
        assert max(seen) <= high


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_sign_change_next_to_where_a_function_begins(mirror):
    ends = sorted((0.0, 2.0 * mirror))

    def beginning(x):
        return mirror * x - 0.3 if mirror * x > 0.29999 else np.nan

    low, high = sign_change(beginning, *ends)
    assert beginning(low) * beginning(high) < 0.0
    assert sign_change(lambda x: beginning(x) + 0.1, *ends) is None
    assert sign_change(np.cosh, *ends) is None
    assert sign_change(lambda x: np.nan, *ends) is None
    assert sign_change(lambda x: x - mirror, *ends) == tuple(ends)


def test_narrowed_to_neighbours_between_which_the_sign_changes():
    places = np.linspace(0.0, 1.0, 17).tolist()
    for root in (0.01, 0.3, 0.999):
        low, high = narrowed(lambda x, root=root: x - root, places)
        assert low < root < high
        assert high - low == pytest.approx(1.0 / 16.0)
    low, high = narrowed(lambda x: x - 0.5 if x > 0.4 else np.nan, places)
    assert low < 0.4 < high
