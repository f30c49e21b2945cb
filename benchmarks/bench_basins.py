"""Basins: starts of the source paper's machine to their stated outcome, and what its dampings cost."""

from __future__ import annotations

import pytest
from workload import source_paper_machine

import carom
from carom.basins import map_basins

STARTS = 4000


@pytest.mark.parametrize(
    ("who", "gamma"), [("carom", 0.1), ("carom, most starts rub", 0.2), ("carom, all levitate", 0.6)]
)
def test_basin(benchmark, who, gamma):
    """Positions even over the clearance, speeds up to 2; one thread."""
    rotor = source_paper_machine(gamma)
    plan = carom.disturbances.Sample(carom.disturbances.AnyState(2.0), STARTS, seed=1)
    found = map_basins(rotor, plan, threads=1)
    assert found.unresolved == 0
    benchmark.group = "a basin"
    benchmark(map_basins, rotor, plan, threads=1)
    benchmark.extra_info.update(who=who, unit="start", units=STARTS)


def test_smallest_kick(benchmark):
    rotor = source_paper_machine(0.152)
    found = carom.basins.smallest_unrecovered(rotor, carom.disturbances.VelocityKick(), threads=1)
    benchmark.group = "the smallest kick that is lost"
    benchmark(carom.basins.smallest_unrecovered, rotor, carom.disturbances.VelocityKick(), threads=1)
    benchmark.extra_info.update(who="carom", unit="kick tried", units=found.tried)


def test_shocks(benchmark):
    """States at the end of shocks, contacts in the pulse included."""
    rotor = source_paper_machine(0.152)
    plan = carom.Grid(carom.BaseShock(2.5, 0.9), (20, 24))
    plan.starts(rotor)
    benchmark.group = "shocks of the base"
    benchmark(plan.starts, rotor)
    benchmark.extra_info.update(who="carom", unit="shock", units=plan.count)
