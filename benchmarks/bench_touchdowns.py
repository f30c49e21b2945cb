"""A whole touchdown with chatter and rub next to one that only bounces, per unit of time; and a drop of a flexible rotor on ball bearings, per second."""

from __future__ import annotations

import dataclasses

import pytest
from workload import source_paper_machine

import carom
from carom.parameters import TouchdownBearing


@pytest.mark.parametrize(("kind", "gamma"), [("carom", 0.1), ("carom, chatter and rub", 0.2)])
def test_touchdown(benchmark, kind, gamma):
    rotor = source_paper_machine(gamma)
    start = carom.State(0.2 + 0.1j, 0.5 + 0.3j)
    motion = carom.simulate(rotor, start, until=150.0)
    assert bool(motion.lasting_contacts) == (gamma == 0.2)
    benchmark.group = "one touchdown to t = 150"
    benchmark(carom.simulate, rotor, start, until=150.0)
    benchmark.extra_info.update(who=kind, unit="unit of time", units=150.0)


def test_drop_on_ball_bearings(benchmark):
    balls = TouchdownBearing(
        "hunt-crossley", dissipation="0.5 s/m", balls=9, ball_diameter="2.5 mm", race_diameter="11 mm"
    )
    machine = carom.rotors.load_machine("examples/tum-flexible-rotor.toml")
    planes = [dataclasses.replace(each, bearing=balls) for each in machine.touchdowns]
    rotor = dataclasses.replace(machine, touchdowns=planes).model
    loads = carom.motions.follow_loads(rotor, carom.drop(), "1 s")
    assert 360.0 < loads.planes[0].si()["force"] < 380.0
    benchmark.group = "one second of a drop on ball bearings"
    benchmark(carom.motions.follow_loads, rotor, carom.drop(), "1 s")
    benchmark.extra_info.update(who="carom, motion and loads", unit="second", units=1.0)
