"""A bifurcation diagram and a map of two parameters of the source paper's machine."""

from __future__ import annotations

from workload import source_paper_machine

from carom.bifurcations import Plane, find_bifurcations, map_regions

PLANE = Plane("gamma", "omega", (0.01, 0.4), (0.6, 1.0))


def test_diagram(benchmark):
    benchmark.group = "bifurcation diagram along the damping"
    benchmark(find_bifurcations, source_paper_machine(0.1).parameters, "gamma", (0.02, 0.4))
    benchmark.extra_info.update(who="carom", unit="diagram", units=1)


def test_map(benchmark):
    benchmark.group = "map of damping and stiffness, 24 x 24 points"
    benchmark.pedantic(map_regions, args=(source_paper_machine(0.1).parameters, PLANE), rounds=3)
    benchmark.extra_info.update(who="carom", unit="map", units=1)
