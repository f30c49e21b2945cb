"""Chunks cover the grid once, and what a point gives depends on the point alone."""

import dataclasses
import math

import numpy as np
import pytest
from sweep_tasks import Drawn, Failing, basins_plan, plan_of

from carom.basins import share_of_kicks
from carom.loading import load
from carom.sweeps.chunk import compute_chunk, failed_chunk
from carom.sweeps.plan import cut
from carom.sweeps.studies import StudyTask
from carom.sweeps.variables import Status


@pytest.mark.parametrize("chunk", [1, 2, 3, 5, 7, 12, 100, None])
@pytest.mark.parametrize("shape", [(7,), (4, 5), (3, 1, 4)])
def test_chunks_cover_the_grid_once(shape, chunk):
    plan = basins_plan()
    axis = plan.axes[0]
    axes = tuple(dataclasses.replace(axis, count=count, given=(0.1, 0.2)) for count in shape)
    plan = dataclasses.replace(plan, axes=axes, chunk_shape=cut(shape, plan.task, chunk))
    covered = np.zeros(shape, int)
    points = []
    for number in range(plan.chunks):
        covered[plan.region(number)] += 1
        points += plan.points_of(number)
        assert plan.size(number) <= (chunk or math.inf)

    assert (covered == 1).all()
    assert sorted(points) == list(np.ndindex(*shape))


def test_seeds_of_points_differ_and_do_not_depend_on_chunks():
    plans = [plan_of(Drawn(), chunk=chunk) for chunk in (1, 3)]
    draws = [{point: plan.seed_of(point).generate_state(2).tolist() for point in np.ndindex(10)} for plan in plans]

    assert draws[0] == draws[1]
    assert len({tuple(draw) for draw in draws[0].values()}) == 10
    assert plan_of(Drawn(), seed=6).seed_of((0,)).generate_state(2).tolist() != draws[0][(0,)]


def test_chunk_depends_on_its_arguments_alone():
    plan = plan_of(Drawn())
    first, second = compute_chunk(plan, 3), compute_chunk(plan, 3)

    assert first.arrays.keys() == {"value", "draw", "status"}
    for name, values in first.arrays.items():
        np.testing.assert_array_equal(values, second.arrays[name])
    np.testing.assert_array_equal(first.arrays["status"], Status.DONE)
    np.testing.assert_array_equal(first.arrays["value"], plan.axes[0].values[6:8])


def test_failing_point_is_recorded_and_the_others_go_on():
    plan = plan_of(Failing(above=0.45), chunk=5)
    chunk = compute_chunk(plan, 0)

    np.testing.assert_array_equal(chunk.arrays["status"], [Status.DONE] * 4 + [Status.FAILED])
    np.testing.assert_array_equal(chunk.arrays["value"], [0.1, 0.2, 0.30000000000000004, 0.4, np.nan])
    assert chunk.arrays["draw"][4] == -1
    (failure,) = chunk.failures
    error = "ZeroDivisionError: damping is too large"
    assert failure == {"point": [4], "values": {"gamma": 0.5}, "error": error}


def test_chunk_lost_with_its_worker_fails_at_all_points():
    chunk = failed_chunk(plan_of(Drawn()), 4, "gone")

    assert (chunk.arrays["status"] == Status.FAILED).all()
    assert [failure["point"] for failure in chunk.failures] == [[8], [9]]


@pytest.mark.jit_only
def test_study_tells_what_the_functions_tell():
    source_paper = load("examples/source-paper.toml")
    import carom

    task = StudyTask(24, source_paper.zones.limits, has_scales=False)
    seed = np.random.SeedSequence(3)
    found = task.evaluate(source_paper, seed)
    rotor = carom.models.jeffcott(source_paper.parameters)
    attractors = carom.find_attractors(rotor, seed=int(seed.generate_state(1)[0]), count=24)

    assert found.keys() == {variable.name for variable in task.variables}
    # The source paper: at this damping B1,d is the only stable orbit; three others exist or are virtual.
    assert (found["levitates"], found["stable_orbits"], found["orbits_complete"]) == (True, 1, True)
    assert found["orbits"] == sum(orbit.admissible for orbit in carom.find_orbits(rotor))
    assert found["levitation_radius"] == abs(rotor.equilibrium)
    assert found["recovered"] == share_of_kicks(attractors).fraction


def test_si_variables_are_there_with_scales():
    keogh_cole = load("examples/keogh-cole.toml")
    task = StudyTask(0, keogh_cole.zones.limits, has_scales=True)
    found = task.evaluate(keogh_cole, np.random.SeedSequence(3))
    names = {variable.name: variable for variable in task.variables}

    assert found.keys() == names.keys()
    assert found["levitation_radius_si"] == found["levitation_radius"] * 0.7e-3
    assert names["levitation_radius_si"].attributes["units"] == "m"
    assert names["zone"].attributes["flag_meanings"] == "A B C D"
