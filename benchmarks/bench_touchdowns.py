"""A whole touchdown with chatter and rub next to one that only bounces, per unit of time."""

from __future__ import annotations

import pytest
from workload import source_paper_machine

import carom


@pytest.mark.parametrize(("kind", "gamma"), [("carom", 0.1), ("carom, chatter and rub", 0.2)])
def test_touchdown(benchmark, kind, gamma):
    rotor = source_paper_machine(gamma)
    start = carom.State(0.2 + 0.1j, 0.5 + 0.3j)
    motion = carom.simulate(rotor, start, until=150.0)
    assert bool(motion.lasting_contacts) == (gamma == 0.2)
    benchmark.group = "one touchdown to t = 150"
    benchmark(carom.simulate, rotor, start, until=150.0)
    benchmark.extra_info.update(who=kind, unit="unit of time", units=150.0)
