"""What was done to a rotor, in a sentence: sizes in the units of people, velocities in the fixed frame."""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carom.base.results import in_si
from carom.parameters import MACHINE_FIELDS, Scales
from carom.parameters.formats import format_angle, format_quantity, number


@dataclass(frozen=True)
class Echo:
    """One disturbance as it was taken.

    Attributes
    ----------
    kind : {"kick", "shock", "blade-loss", "start", "drop", "unbalance"}
    words : str
        Such as ``"Kick: 60 mm/s at 30°"``, and from where its angles count.
    sizes : mapping of str to (float, str)
        Each size in units of the equations, with its property of :class:`~carom.parameters.Scales`; empty for angles.
    """

    kind: str
    words: str
    sizes: Mapping[str, tuple[float, str]]

    def document(self, scales: Scales | None) -> dict[str, object]:
        """Return it as plain data, with sizes in SI units too where the scales are known."""
        document: dict[str, Any] = {"kind": self.kind, "words": self.words}
        for name, (value, scale) in self.sizes.items():
            document[name] = value
            if scale:
                document |= in_si(document, scales, **{name: scale})
        return document


def angles_words(phase: float, when: str = "") -> str:
    """From where angles count: the real axis of the co-rotating frame, from which the phase of the unbalance counts too."""
    return f"angles are measured from the x axis that turns with the shaft{when}, in the sense of rotation (unbalance at {format_angle(phase)})"


def echo_of_unbalance(eccentricity: float, interval: tuple[float, float], scales: Scales) -> Echo:
    """The unbalance at every speed of a range, by the eccentricity in clearances and speeds in rad/s."""
    shown = MACHINE_FIELDS["speed"]
    low, high = (f"{number(shown.in_usual_unit(speed), 6)} {shown.usual_unit}" for speed in interval)
    words = f"Unbalance: {format_quantity(eccentricity, 'unbalance', scales)}, eccentricity {format_quantity(eccentricity, 'length', scales)}, at speeds from {low} to {high}"
    sizes = {"unbalance": (eccentricity, "unbalance"), "eccentricity": (eccentricity, "length")}
    ends = zip(("lowest_speed", "highest_speed"), interval, strict=True)
    return Echo("unbalance", words, {**sizes, **{name: (speed / scales.speed, "speed") for name, speed in ends}})


def moving(place: complex, rate: complex, scales: Scales | None) -> Echo:
    """A displacement and its rate in the frame that turns with the shaft; the velocity is stated in the fixed frame."""
    speed = rate + 1j * place
    distance = format_quantity(abs(place), "length", scales)
    at = f"{distance} from the bearing centre at {format_angle(cmath.phase(place))}"
    moves = f"moving at {format_quantity(abs(speed), 'velocity', scales)} towards {format_angle(cmath.phase(speed))} in the fixed frame"
    return Echo(
        "start",
        f"{at}, {moves}",
        {
            "radius": (abs(place), "length"),
            "angle": (cmath.phase(place), ""),
            "speed": (abs(speed), "velocity"),
            "direction": (cmath.phase(speed), ""),
        },
    )


def in_both_units(value: float, kind: str, scales: Scales | None) -> str:
    """Write a size in units of the machine, and in brackets in those of the equations."""
    own = format_quantity(value, kind, None, 4)
    return own if scales is None else f"{format_quantity(value, kind, scales, 4)} ({own})"


def eccentricity_words(value: float, scales: Scales | None) -> str:
    """Write an eccentricity given in clearances, with the unbalance that it is if the mass is known."""
    own = format_quantity(value, "length", None, 5)
    if scales is None:
        return own
    return f"{format_quantity(value, 'length', scales, 5)} ({own}, {format_quantity(value, 'unbalance', scales, 5)})"
