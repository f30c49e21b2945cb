"""Continuation on curves that are known in closed form."""

import math

import numpy as np
import pytest

from carom.continuation import Branch, Equations, Steps, Watch
from carom.continuation import continue_branch as followed


def continue_branch(residual, *start, watches=(), reach=None, **given):
    return followed(Equations(residual, **given), *start, watches=watches, reach=reach)


def circle(u, p):
    return np.array([u[0] ** 2 + p**2 - 1.0])


def cubic(u, p):
    return np.array([u[0] ** 3 - u[0] + p])


def places(branch: Branch, kind: str) -> list[float]:
    return [point.parameter for point in branch.of_kind(kind)]


def gaps(branch: Branch) -> np.ndarray:
    x = np.column_stack([branch.unknowns, branch.parameters])
    return np.linalg.norm(np.diff(x, axis=0), axis=1)


def test_a_branch_ends_on_the_limit_beyond_which_the_equations_are_undefined():
    def line(u, p):
        return np.array([u[0] - 3.0 * p]) if 0.0 <= p <= 1.0 else np.full(1, np.nan)

    def solver(u, p):
        return np.array([3.0 * p]) if 0.0 <= p <= 1.0 else None

    # In scaled unknowns the branch is steep, and close to level in the parameter.
    for size in (1.0, 20.0):
        branch = continue_branch(
            line, np.array([1.2]), 0.4, (0.0, 1.0), slopes=lambda u, p: np.array([[1.0, -3.0]]), solver=solver,
            scales=np.array([1.0, size]),
        )  # fmt: skip
        assert branch.stops == ("parameter limit", "parameter limit")
        assert sorted([branch.parameters[0], branch.parameters[-1]]) == [0.0, 1.0]
        assert np.abs(branch.unknowns[:, 0] - 3.0 * branch.parameters).max() < 1e-12
    (begin, end) = continue_branch(
        line, np.array([0.0]), 0.0, (0.0, 1.0), slopes=lambda u, p: np.array([[1.0, -3.0]]), solver=solver
    ).parameters[[0, -1]]
    assert (begin, end) == (0.0, 1.0)


def test_a_solver_at_fixed_parameter_is_used_away_from_folds():
    calls, solved = [], []

    def counted(u, p):
        calls.append(p)
        return cubic(u, p)

    def solver(u, p):
        solved.append(p)
        roots = np.roots([1.0, 0.0, -1.0, p])
        real = roots[np.abs(roots.imag) < 1e-9].real
        return real[np.argmin(np.abs(real - u[0]))][None]

    watch = Watch("crossing", lambda u, p: u[0] - 0.9)
    with_solver, without = (
        continue_branch(counted, np.array([-1.3]), 0.9, (-2.0, 3.0), watches=[watch], solver=each)
        for each in (solver, None)
    )
    assert len(solved) > 20
    for kind in ("fold", "crossing"):
        assert places(with_solver, kind) == pytest.approx(places(without, kind), abs=1e-12)
    assert with_solver.stops == without.stops
    x, y = with_solver.unknowns[:, 0], with_solver.parameters
    assert np.abs(x**3 - x + y).max() < 1e-11
    none = continue_branch(cubic, np.array([-1.3]), 0.9, (-2.0, 3.0), solver=lambda u, p: None)
    assert np.array_equal(none.parameters, continue_branch(cubic, np.array([-1.3]), 0.9, (-2.0, 3.0)).parameters)


def test_circle_is_a_closed_loop_with_two_folds():
    branch = continue_branch(circle, np.array([1.0]), 0.0, (-2.0, 2.0))
    assert branch.stops == ("closed loop", "closed loop")
    assert sorted(places(branch, "fold")) == pytest.approx([-1.0, 1.0], abs=1e-13)
    assert len(branch.special) == 2
    assert (branch.unknowns[0], branch.parameters[0]) == (branch.unknowns[-1], branch.parameters[-1])
    assert gaps(branch).sum() == pytest.approx(2 * np.pi, rel=1e-3)
    assert np.abs(branch.unknowns[:, 0] ** 2 + branch.parameters**2 - 1.0).max() < 1e-11


def test_an_exact_jacobian_saves_the_differences_and_places_folds_exactly():
    calls = []

    def counted(u, p):
        calls.append(p)
        return cubic(u, p)

    def exact(u, p):
        return np.array([[3.0 * u[0] ** 2 - 1.0, 1.0]])

    counts, folds = [], []
    for jacobian in (None, exact):
        calls.clear()
        scales = np.array([2.0, 3.0])
        branch = continue_branch(counted, np.array([-1.3]), 0.9, (-2.0, 3.0), slopes=jacobian, scales=scales)
        counts.append(len(calls))
        folds.append(sorted(point.unknowns[0] for point in branch.of_kind("fold")))
    assert counts[1] < 0.5 * counts[0]
    assert np.abs(np.abs(folds[1]) - 3.0**-0.5).max() < 1e-14
    assert np.abs(np.abs(folds[0]) - 3.0**-0.5).max() > 1e-13


@pytest.mark.parametrize("start", [(0.0, 1.0), (0.0, -1.0), (0.6, 0.8), (1e-9, 1.0)])
def test_circle_from_any_start(start):
    branch = continue_branch(circle, np.array([start[0]]), start[1], (-2.0, 2.0))
    assert branch.stops == ("closed loop", "closed loop")
    assert gaps(branch).sum() == pytest.approx(2 * np.pi, rel=1e-3)
    assert np.ptp(branch.parameters) == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("beginning", [0.12, 0.29, 0.299999])
def test_zero_next_to_where_a_function_begins_is_found(beginning):
    """Whichever way the branch is followed, and where the function has one sign there is nothing to find."""
    watches = [
        Watch("zero", lambda u, p: p - 0.3 if p > beginning else np.nan),
        Watch("none", lambda u, p: p - beginning + 0.1 if p > beginning else np.nan),
    ]
    for start in (-0.9, 0.9):
        branch = continue_branch(lambda u, p: u - p, np.array([start]), start, (-1.0, 1.0), watches=watches)
        assert places(branch, "zero") == pytest.approx([0.3], abs=1e-13)
        assert places(branch, "none") == []


def test_hysteresis_reaches_both_limits_exactly():
    fold = 2.0 / 3.0 / np.sqrt(3.0)
    watch = Watch("passes 0.3", lambda u, p: u[0] - 0.3)
    branch = continue_branch(cubic, np.array([-1.3]), 1.3**3 - 1.3, (-2.0, 3.0), watches=[watch])
    assert branch.stops == ("parameter limit", "parameter limit")
    assert {branch.parameters[0], branch.parameters[-1]} == {-2.0, 3.0}
    assert sorted(places(branch, "fold")) == pytest.approx([-fold, fold], abs=1e-12)
    (crossing,) = branch.of_kind("passes 0.3")
    assert crossing.parameter == pytest.approx(0.3 - 0.3**3, abs=1e-13)
    before = int(crossing.place)
    low, high = sorted(branch.unknowns[before : before + 2, 0])
    assert low <= 0.3 <= high


def test_cusp_unfolds_into_two_folds_that_meet():
    """``u³ − bu + p``: folds at ``p = ±2(b/3)^{3/2}`` for b > 0 and none for b < 0."""
    for width in (1e-2, 1.0):
        start = 1.4 * width - 1.4**3
        branch = continue_branch(lambda u, p, b=width: np.array([u[0] ** 3 - b * u[0] + p]), [1.4], start, (-3, 3))
        fold = 2 * (width / 3) ** 1.5
        assert sorted(places(branch, "fold")) == pytest.approx([-fold, fold], abs=1e-11)
    branch = continue_branch(lambda u, p: np.array([u[0] ** 3 + 0.1 * u[0] + p]), np.array([0.0]), 0.0, (-3, 3))
    assert branch.special == ()


def test_a_branch_goes_straight_through_a_pitchfork():
    branch = continue_branch(lambda u, p: np.array([u[0] * (u[0] ** 2 - p)]), np.array([0.0]), -0.5, (-1.0, 1.0))
    assert np.abs(branch.unknowns).max() < 1e-12
    assert branch.parameters[[0, -1]].tolist() == [-1.0, 1.0]


def test_transcritical_branches_cross_and_are_kept_apart():
    def residual(u, p):
        return np.array([u[0] * (p - u[0])])

    flat = continue_branch(residual, np.array([0.0]), -0.7, (-1.0, 1.0))
    steep = continue_branch(residual, np.array([0.7]), 0.7, (-1.0, 1.0))
    assert np.abs(flat.unknowns).max() < 1e-10
    assert np.abs(steep.unknowns[:, 0] - steep.parameters).max() < 1e-10


def test_isola_is_followed_round():
    def residual(u, p):
        return np.array([(p - 0.5) ** 2 / 0.09 + (u[0] - 2.0) ** 2 / 4.0 - 1.0])

    branch = continue_branch(residual, np.array([4.0]), 0.5, (-1.0, 2.0))
    assert branch.stops == ("closed loop", "closed loop")
    assert sorted(places(branch, "fold")) == pytest.approx([0.2, 0.8], abs=1e-12)


@pytest.mark.parametrize(("edge", "other"), [(-1.0, 2.0), (2.0, -1.0)])
def test_start_on_the_edge_walks_inward_only(edge, other):
    branch = continue_branch(lambda u, p: np.array([u[0] - p**2]), np.array([edge**2]), edge, (-1.0, 2.0))
    assert sorted(branch.parameters[[0, -1]]) == [-1.0, 2.0]
    assert len(np.unique(branch.parameters)) == len(branch)
    assert other in branch.parameters


def test_watch_that_ends_the_branch():
    watch = Watch("wall", lambda u, p: 0.25 - u[0], at_zero="end")
    branch = continue_branch(lambda u, p: np.array([u[0] - p]), np.array([0.0]), 0.0, (-1.0, 1.0), watches=[watch])
    assert branch.stops == ("parameter limit", "wall")
    assert branch.parameters[-1] == pytest.approx(0.25, abs=1e-13)
    assert [point.kind for point in branch.special] == ["wall"]


def test_another_branch_that_crosses_is_avoided():
    """``u = 20p + 300p²``, ``v = p``, crossed at a small angle by ``v = p = 0`` with any ``u``."""

    def residual(u, p):
        return np.array([u[1] * (u[0] - 20.0 * p - 300.0 * p**2), u[1] - p])

    start, still = np.array([20.0 * 0.06 + 300.0 * 0.06**2, 0.06]), lambda u, p: abs(u[1]) - 1e-9
    strayed = continue_branch(residual, start, 0.06, (-0.07, 0.07))
    assert np.ptp(strayed.unknowns[np.abs(strayed.parameters) < 1e-9, 0]) > 10.0
    branch = continue_branch(residual, start, 0.06, (-0.07, 0.07), watches=[Watch("line", still, at_zero="avoid")])
    assert branch.stops == ("parameter limit", "parameter limit")
    assert branch.special == ()
    values = branch.parameters
    assert branch.unknowns[:, 0] == pytest.approx(20.0 * values + 300.0 * values**2, abs=1e-9)


def test_most_points_and_step_too_small():
    few = continue_branch(circle, np.array([1.0]), 0.0, (-2, 2), steps=Steps(most_points=5))
    assert few.stops == ("most points", "most points")
    assert len(few) == 9
    corner = continue_branch(lambda u, p: np.array([u[0] - abs(p - 0.2)]), np.array([0.2]), 0.0, (-1, 1))
    assert corner.stops == ("parameter limit", "step too small")
    assert corner.parameters[-1] == pytest.approx(0.2, abs=1e-5)


def test_a_pole_is_no_zero_where_rounding_makes_it_one():
    pole = Watch("pole", lambda u, p: 1.0 / (p - 0.123) if abs(p - 0.123) > 1e-13 else 0.0)
    steep = Watch("steep", lambda u, p: math.copysign(abs(p - 0.3) ** 0.5, p - 0.3))
    branch = continue_branch(lambda u, p: np.array([u[0] - p]), np.array([0.0]), 0.0, (-1, 1), watches=[pole, steep])
    (point,) = branch.special
    assert (point.kind, point.parameter) == ("steep", pytest.approx(0.3, abs=1e-13))


def test_jumps_and_missing_values_are_no_zeros():
    jump = Watch("jump", lambda u, p: 1.0 if p > 0.1 else -1.0)
    pole = Watch("pole", lambda u, p: 1.0 / (p - 0.13))
    absent = Watch("absent", lambda u, p: np.nan if abs(p) < 0.5 else p)
    branch = continue_branch(
        lambda u, p: np.array([u[0] - p]), np.array([0.0]), 0.0, (-1, 1), watches=[jump, pole, absent]
    )
    assert branch.special == ()


def test_a_limit_that_cannot_be_located_is_not_stepped_over():
    """Just beyond the limit the equations are not defined, and further on they are: no point is moved to the limit."""

    def residual(u, p):
        return np.array([np.nan if 1.0 < p < 1.01 else u[0] - p**2])

    branch = continue_branch(residual, np.array([0.25]), 0.5, (0.0, 1.0), steps=Steps(first=0.05, largest=0.05))
    assert branch.parameters.max() <= 1.0
    assert branch.unknowns[:, 0] == pytest.approx(branch.parameters**2, abs=1e-9)
    assert branch.stops == ("parameter limit", "end of domain")


def test_steps_may_grow_along_an_asymptote():
    """``u p = 1`` up to ``u = 100``: in proportion to ``u`` the steps are few, and special points are where they were."""

    def reach(u):
        return max(1.0, abs(float(u[0])))

    watch = Watch("thirty", lambda u, p: float(u[0]) - 30.0)
    found = [
        continue_branch(
            lambda u, p: np.array([u[0] * p - 1.0]), np.array([1.0]), 1.0, (0.01, 2.0), watches=[watch], reach=grows
        )
        for grows in (None, reach)
    ]
    even, grown = found
    assert len(grown) < 0.2 * len(even)
    assert places(grown, "thirty") == pytest.approx([1.0 / 30.0], abs=1e-14)
    largest = Steps().largest * np.maximum(1.0, grown.unknowns[:, 0])
    assert (gaps(grown) <= 1.05 * np.maximum(largest[:-1], largest[1:])).all()


@pytest.mark.parametrize("error", [-1e-12, 0.0, 1e-12])
def test_a_branch_that_begins_on_a_limit_does_not_leave_it(error):
    inside = Watch("edge", lambda u, p: 1.0 - u[0], at_zero="limit")

    branch = continue_branch(lambda u, p: u - p, np.array([1.0 + error]), 1.0 + error, (0.0, 3.0), watches=[inside])

    assert branch.parameters.max() <= 1.0 + 1e-9
    assert branch.parameters.min() == pytest.approx(0.0, abs=1e-12)
    assert branch.stops == ("parameter limit", "edge")
