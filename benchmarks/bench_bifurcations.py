"""A bifurcation diagram and a map of two parameters of the source paper's machine."""

from __future__ import annotations

from workload import source_paper_machine

from carom.bifurcations import Plane, continue_orbit, find_bifurcations, map_regions
from carom.bifurcations.words import continue_word
from carom.orbits import find_orbits

PLANE = Plane("gamma", "omega", (0.01, 0.4), (0.6, 1.0))


def test_diagram(benchmark):
    benchmark.group = "bifurcation diagram along the damping"
    benchmark(find_bifurcations, source_paper_machine(0.1).parameters, "gamma", (0.02, 0.4))
    benchmark.extra_info.update(who="carom", unit="diagram", units=1)


def test_map(benchmark):
    benchmark.group = "map of damping and stiffness, 24 x 24 points"
    benchmark.pedantic(map_regions, args=(source_paper_machine(0.1).parameters, PLANE), rounds=3)
    benchmark.extra_info.update(who="carom", unit="map", units=1)


def test_branch_closed_form(benchmark):
    orbit = find_orbits(source_paper_machine(0.1))["B1,d"]
    benchmark.group = "branch of B1,d along the damping, per orbit"
    branch = benchmark(continue_orbit, orbit, "gamma", (0.06, 0.17))
    benchmark.extra_info.update(who="carom, closed form", unit="orbit", units=len(branch))


def test_branch_by_shooting(benchmark):
    orbit = find_orbits(source_paper_machine(0.1))["B1,d"]
    benchmark.group = "branch of B1,d along the damping, per orbit"
    branch = benchmark.pedantic(continue_word, args=(orbit, "gamma", (0.06, 0.17)), rounds=3)
    benchmark.extra_info.update(who="carom, multiple shooting", unit="orbit", units=len(branch))


def test_branch_of_two_impacts(benchmark):
    branch = continue_orbit(find_orbits(source_paper_machine(0.1))["B1,d"], "gamma", (0.075, 0.11))
    (doubling,) = [point for point in branch.special if point.kind == "period-doubling"]
    benchmark.group = "branch of two impacts along the damping, per orbit"
    doubled = benchmark.pedantic(doubling.switch, args=((0.078, 0.09),), rounds=3)
    benchmark.extra_info.update(who="carom, multiple shooting", unit="orbit", units=len(doubled))
