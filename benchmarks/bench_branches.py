"""Branches of orbits with one impact a period and more, and a curve in two parameters."""

from __future__ import annotations

import pytest
from workload import source_paper_machine

from carom.bifurcations import Bifurcation, Plane, continue_curve, continue_orbit, switch
from carom.orbits import find_orbits

PER_ORBIT = "branch along the damping, per orbit"


def doubling() -> Bifurcation:
    branch = continue_orbit(find_orbits(source_paper_machine(0.1))["B1,d"], "gamma", (0.075, 0.11))
    (point,) = [point for point in branch.special if point.kind == "period-doubling"]
    return point


@pytest.mark.parametrize("impacts", [1, 2, 3, 6])
def test_branch(benchmark, impacts):
    benchmark.group = PER_ORBIT
    if impacts == 1:
        arguments = find_orbits(source_paper_machine(0.1))["B1,d"], "gamma", (0.06, 0.17)
    else:
        found = find_orbits(source_paper_machine(0.083), impacts=impacts)
        arguments = found[f"P{impacts},1"], "gamma", (0.0828, 0.0835)
    branch = benchmark.pedantic(continue_orbit, args=arguments, rounds=5, warmup_rounds=1)
    benchmark.extra_info.update(who=f"carom, impacts: {impacts}", unit="orbit", units=len(branch))


def test_curve_of_two_impacts(benchmark):
    (grazing,) = [point for point in switch(doubling(), (0.081, 0.0845)).special if point.kind == "grazing"]
    benchmark.group = "curve in two parameters, per point"
    plane = Plane("gamma", "omega", (0.05, 0.15), (0.74, 0.78))
    curve = benchmark.pedantic(continue_curve, args=(grazing, plane), rounds=3)
    benchmark.extra_info.update(who="multiple shooting, 2 impacts", unit="point", units=len(curve.points))
