"""Every operator and function gives in each lane what NumPy's scalars give, and no lane sees another."""

import itertools
from typing import NamedTuple

import numpy as np
import pytest
from compilation import sized
from lane_programs import for_one, program

from carom.core.layout import WIDTH

UNIT = 2.0**-53
EDGES = (0.0, -0.0, 1.0, -1.0, 2.0, 0.5, -2.5, np.inf, -np.inf, np.nan, 5e-324, 1e-200, 1e200, -1.7e308, 2.0**53)
REALS, COMPLEXES = ("a", "b"), ("z", "w")
REAL_NUMBERS, COMPLEX_NUMBERS = ("f", "n", "2", "0.5"), ("c", "2j")
ARGUMENTS = "a, b, z_re, z_im, w_re, w_im, f, n, c, out"
LOADS = (
    "a, b = load(a, 0), load(b, 0)",
    "z, w = join(load(z_re, 0), load(z_im, 0)), join(load(w_re, 0), load(w_im, 0))",
)


class Case(NamedTuple):
    """An expression; ``size`` is that of its terms, of which some roundings are allowed, or none, and then no infinities."""

    expression: str
    kind: str
    size: str = ""


def kind_of(*operands: str) -> str:
    return "complex" if {*operands} & {*COMPLEXES, *COMPLEX_NUMBERS} else "real"


def pairs(lanes, numbers):
    """Lanes with lanes, lanes with numbers and numbers with lanes."""
    first = [kind[0] for kind in lanes]
    return [*itertools.chain(*(itertools.permutations(kind) for kind in lanes)), *itertools.permutations(first, 2)] + [
        pair for each in first for number in numbers for pair in ((each, number), (number, each))
    ]


def operators() -> list[Case]:
    any_pairs = pairs([REALS, COMPLEXES], [*REAL_NUMBERS, *COMPLEX_NUMBERS])
    real_pairs = pairs([REALS], REAL_NUMBERS)
    cases = [Case(f"{left} {sign} {right}", kind_of(left, right)) for sign in "+-" for left, right in any_pairs]
    cases += [
        Case(
            f"{left} * {right}", kind_of(left, right), f"abs({left}) * abs({right})" * (kind_of(left, right) != "real")
        )
        for left, right in any_pairs
    ]
    cases += [Case(f"{left} / {right}", "real") for left, right in real_pairs]
    signs = ("<", "<=", ">", ">=", "==")
    return cases + [Case(f"{left} {sign} {right}", "condition") for sign in signs for left, right in real_pairs]


def functions() -> list[Case]:
    chosen = [*pairs([REALS, COMPLEXES], [*REAL_NUMBERS, *COMPLEX_NUMBERS]), ("f", "n"), ("2", "c"), ("2j", "0.5")]
    cases = [Case(f"where(a < b, {left}, {right})", kind_of(left, right)) for left, right in chosen]
    for terms in itertools.product(("a", "z", "f", "c"), repeat=3):
        if "z" in terms:
            first, second, third = terms
            cases.append(Case(f"fma({', '.join(terms)})", "complex", f"abs({first}) * abs({second}) + abs({third})"))
    cases.append(Case("fma(n, z, 2)", "complex", "abs(n) * abs(z) + 2"))
    conditions = ("(a < b) & (b < 1.0)", "(a < b) | (b == 1.0)", "~(a < b)", "(a < b) & ~(a > 0.0) | ~(b <= 2)")
    reals = ("-a", "abs(a)", "sqrt(a)", "truncate(a)", "z.real", "z.imag", "-(a + b)")
    complexes = ("-z", "join(a, b)", "z.conjugate()", "join(b, -a).conjugate()")
    return [
        *cases,
        *(Case(expression, "condition") for expression in conditions),
        *(Case(expression, "real") for expression in reals),
        *(Case(expression, "complex") for expression in complexes),
    ]


CASES = [*operators(), *functions()]
AT_ONCE = 20
"""Cases in a kernel: the time to compile one grows faster than its length."""


def lines(first):
    yield from LOADS
    for row, case in enumerate(CASES[first : first + AT_ONCE], first):
        if case.kind == "real":
            yield f"store(out[{row}, 0], 0, {case.expression})"
        elif case.kind == "condition":
            yield f"store(out[{row}, 0], 0, where({case.expression}, 1.0, 0.0))"
        else:
            yield f"value = {case.expression}"
            yield f"store(out[{row}, 0], 0, value.real)"
            yield f"store(out[{row}, 1], 0, value.imag)"


class Given(NamedTuple):
    a: np.ndarray
    b: np.ndarray
    z: np.ndarray
    w: np.ndarray
    f: float
    n: int
    c: complex

    def lane(self, number):
        """What one lane is given."""
        return {
            name: value[number] if isinstance(value, np.ndarray) else value for name, value in self._asdict().items()
        }


def draw(random, edges):
    """Numbers of all sizes and both signs, some of them equal; with ``edges``, also what is no ordinary number."""

    def reals():
        values = random.normal(size=WIDTH) * 10.0 ** random.uniform(-3, 3, WIDTH)
        values = np.where(random.random(WIDTH) < 0.2, random.integers(-2, 3, WIDTH), values)
        return np.where(random.random(WIDTH) < 0.7, random.choice(EDGES, WIDTH), values) if edges else values

    z, w = np.empty((2, WIDTH), np.complex128)
    z.real, z.imag, w.real, w.imag = reals(), reals(), reals(), reals()
    first, second = reals(), reals()
    second = np.where(random.random(WIDTH) < 0.2, first, second)
    number = float(random.choice(EDGES)) if edges else float(random.normal())
    return Given(first, second, z, w, number, int(random.integers(-3, 4)), complex(*random.normal(size=2)))


@pytest.fixture(scope="module")
def compute():
    """All cases with what they are given."""
    kernels = [program(ARGUMENTS, lines(first)) for first in range(0, len(CASES), AT_ONCE)]

    def results(given):
        a, b, z, w, *numbers = given
        parts = [part.copy() for part in (z.real, z.imag, w.real, w.imag)]
        out = np.zeros((len(CASES), 2, WIDTH))
        with np.errstate(all="ignore"):
            for compiled in kernels:
                compiled(a, b, *parts, *numbers, out)
        return out

    return results


@pytest.mark.parametrize("edges", [False, True])
def test_each_lane_is_as_one_number(compute, edges):
    random = np.random.default_rng(20 + edges)
    cases = [(case, for_one(case.expression), for_one(case.size or "0.0")) for case in CASES]
    for _ in range(sized(12, 4)):
        given = draw(random, edges)
        results = compute(given)
        for lane in range(WIDTH):
            one = given.lane(lane)
            with np.errstate(all="ignore"):
                values = np.array([complex(expected(**one)) for _, expected, _ in cases])
                sizes = np.array([float(size(**one)) for _, _, size in cases])
                close = np.isclose(
                    results[:, :, lane],
                    np.stack([values.real, values.imag], axis=1),
                    rtol=0.0,
                    atol=8 * UNIT * sizes[:, None],
                    equal_nan=True,
                ).all(axis=1)
            for row in np.flatnonzero(~close):
                case = cases[row][0]
                # A real factor has no imaginary part here; NumPy's is zero, and times infinity no number.
                stated = f"{case.expression} with {one}: {results[row, :, lane]}, not {values[row]}"
                assert case.size, stated
                assert edges, stated


def test_what_is_no_number_is_in_no_order(compute):
    given = draw(np.random.default_rng(1), edges=False)
    none = given._replace(a=np.full(WIDTH, np.nan))
    results = compute(none)
    for row, case in enumerate(CASES):
        if case.kind == "condition" and case.expression in {f"a {sign} b" for sign in ("<", "<=", ">", ">=", "==")}:
            assert not results[row].any()
        if case.expression == "where(a < b, b, a)":
            assert np.isnan(results[row, 0]).all()
        if case.expression == "where(a < b, a, b)":
            np.testing.assert_array_equal(results[row, 0], given.b)


def test_no_lane_sees_another(compute):
    random = np.random.default_rng(30)
    given = draw(random, edges=True)
    undisturbed = compute(given)
    for lane in range(WIDTH):
        other = draw(random, edges=True)
        arrays = {name: getattr(given, name).copy() for name in ("a", "b", "z", "w")}
        for name, values in arrays.items():
            values[lane] = getattr(other, name)[lane]
        disturbed = compute(given._replace(**arrays))
        company = np.arange(WIDTH) != lane
        assert disturbed[..., company].tobytes() == undisturbed[..., company].tobytes()
        assert disturbed[..., lane].tobytes() != undisturbed[..., lane].tobytes()
