"""A new disturbance enters by one class: maps, single motions, and its text."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import carom as cm
from carom.base.outcome import InputError
from carom.disturbances.coordinates import Coordinate, Starts, angle_coordinate, complex_of, displaced
from carom.disturbances.model import Disturbance
from carom.disturbances.single import Part

MACHINE = cm.load("examples/keogh-cole.toml")


@dataclass(frozen=True)
class LetGo(Disturbance):
    """The rotor is held off its place and let go."""

    farthest: float = 0.5
    kind: ClassVar[str] = "let-go"
    measured_in: ClassVar[dict[str, str]] = {"farthest": "length"}
    parts: ClassVar = (Part("distance", "DISTANCE", "length", optional=False), Part("direction", "ANGLE", "angle", 0.0))
    example: ClassVar = "'0.1 mm,30 deg'"

    @property
    def coordinates(self):
        distance = Coordinate("distance", "distance", 0.0, self.farthest, "length", True)
        return distance, angle_coordinate("direction", "direction")

    def starts(self, rotor, *values, instant=0.0) -> Starts:
        distance, direction = values
        place = complex_of(distance * np.cos(direction), distance * np.sin(direction))
        return displaced(rotor, place, np.zeros(place.shape))


def test_it_is_mapped_simulated_read_and_told():
    assert cm.map_basins(MACHINE, cm.Grid(LetGo.of(MACHINE, "0.2 mm"), (4, 6))).share_recovered.total == 24
    one = LetGo.read("0.2 mm, 30 deg", MACHINE)
    rotor, start = one.stages(MACHINE)
    assert start.position == pytest.approx(0.2 / 0.7 * np.exp(1j * np.pi / 6.0), rel=1e-12)
    assert cm.simulate(MACHINE, one, 50.0).final == cm.simulate(rotor, start, 50.0).final
    assert one.echo(rotor).words == "Disturbance, let-go: distance 0.2 mm, direction 30°"
    with pytest.raises(InputError, match=r"^let-go = 1 s: .*a length"):
        LetGo.read("1 s", MACHINE)
