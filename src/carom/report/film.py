"""A drop in slow motion: what the film on the page shows."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from markupsafe import Markup

from carom.motions import Trajectory
from carom.motions.contacts import ContactLog
from carom.motions.courses import FOLLOWED, Course, course_of, first_contacts, shown_until
from carom.parameters import Scales
from carom.parameters.formats import shown_in
from carom.studies.wording import Wording

TURNS = 40.0
"""Most turns of the shaft that are filmed."""
STEP = 0.25
"""Most that the rotor centre moves between two samples, in clearances."""
FEWEST, MOST = 1200, 4000
"""Samples of a film; what would take more is filmed for a shorter time."""
SLOWER = (10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
"""How many times slower than the machine a film can be played."""
ROTOR, CLEARANCE, RING, HOUSING, ARROW = SIZES = 112.0, 60.0, 20.0, 26.0, 84.0
"""Radius of the drawn rotor, the drawn clearance, the thickness of race and housing, and the longest arrow, in units of the picture."""


def _units(scales: Scales | None) -> dict[str, tuple[float, str]]:
    """By what to multiply times, lengths, forces, velocities and impulses, and their units: ms, µm, N, m/s; without scales those of the equations."""
    units = {kind: shown_in(kind, scales) for kind in ("time", "length", "force", "velocity", "impulse")}
    if scales is not None:
        units |= {"length": (1e3 * units["length"][0], "µm"), "velocity": (scales.velocity, "m/s")}
    return units


@dataclass(frozen=True)
class Film:
    """A drop at a plane, as the page shows it.

    Attributes
    ----------
    course : Course
        What is filmed.
    units : dict
        By what to multiply sizes of a kind, and the unit.
    magnified : float
        How many times wider than the shaft the clearance is drawn.
    race_radius : float or None
        In clearances; ``None`` if the race does not turn.
    whole : bool
        Whether all is filmed that the figures show.
    """

    course: Course
    units: dict[str, tuple[float, str]]
    magnified: float
    race_radius: float | None
    whole: bool

    @property
    def poster(self) -> int:
        """Sample that is shown before the film is played: the largest force, or the hardest impact."""
        course = self.course
        if course.impacts is None or not len(course.impacts):
            return int(course.force.argmax())
        return int(np.searchsorted(course.times, course.impacts.time[course.impacts.normal_impulse.argmax()]))

    sizes: ClassVar[tuple[float, ...]] = SIZES

    @property
    def reach(self) -> float:
        """Half the side of the picture."""
        moved = 0.0 if self.course.mount is None else float(np.abs(self.course.mount).max())
        rim = 8.0 if self.course.mount is None else 26.0 + CLEARANCE * moved
        return round(ROTOR + CLEARANCE + RING + HOUSING + rim, 1)

    @property
    def slower(self) -> list[tuple[int, bool]]:
        """Paces, with the one in which a turn of the shaft takes nearly a second marked."""
        turn = math.tau * (1.0 if self.course.scales is None else self.course.scales.time)
        best = min(SLOWER, key=lambda pace: abs(math.log(turn * pace)))
        return [(pace, pace == best) for pace in SLOWER]

    @property
    def legend(self) -> list[tuple[str, str]]:
        """Classes and words of the arrows, with the size that the longest shows; nothing where there is no contact."""
        say, course = Wording(self.course.scales), self.course
        lasting = " of lasting contact" if course.impacts is not None else ""
        sizes = [
            ("normal", f"normal force{lasting}", course.force, say.force),
            ("friction", f"friction{lasting}", course.friction, say.force),
        ]
        if course.impacts is not None:
            impacts = [
                ("normal", "impulse of an impact", course.impacts.normal_impulse, say.impulse),
                ("friction", "that of friction", course.impacts.friction_impulse, say.impulse),
            ]
            sizes = [*impacts, *sizes]
        return [
            (name, f"{words}, up to {shown(self._largest(values))}")
            for name, words, values, shown in sizes
            if values.any()
        ]

    @property
    def caption(self) -> str:
        """What is seen, in sentences."""
        sentences = [
            "The drop in slow motion, in the fixed frame.",
            f"Clearance, motion and depth are drawn {self.magnified:.2g} times larger than the shaft.",
            "The dot on the shaft is its unbalance; the thin circle in the middle is the clearance of its centre, with the path over the last turn.",
            "The light mark on the race turns with it." if self.race_radius else "",
            "The bearing moves on its mount." if self.course.mount is not None else "",
            ""
            if self.whole
            else f"Filmed: the first {self._moment(-1)}, at most {FOLLOWED} contacts and {TURNS:.0f} turns of the shaft.",
        ]
        return " ".join(filter(None, sentences))

    def _moment(self, sample: int) -> str:
        """Time of a sample in words."""
        factor, unit = self.units["time"]
        return f"{factor * float(self.course.times[sample]):.4g} {unit}"

    @property
    def shown(self) -> str:
        """What instant the still picture shows."""
        if not self.legend:
            return "Shown: the release, without contact."
        what = "the largest force" if self.course.impacts is None else "the hardest impact"
        return f"Shown: {what}, {self._moment(self.poster)} after the release."

    @property
    def _race_angles(self) -> np.ndarray | None:
        """Angle of the race, from zero at the release."""
        course = self.course
        if course.race is None or self.race_radius is None:
            return None
        steps = 0.5 * (course.race[1:] + course.race[:-1]) * np.diff(course.times) / self.race_radius
        return np.append(0.0, steps.cumsum())

    @property
    def data(self) -> Markup:
        """What the script plays, as JSON: times, places in clearances, forces as shares of the largest, angles in rad."""
        course, units = self.course, self.units
        numbers: dict[str, Any] = {
            "t": np.round(units["time"][0] * course.times, 5),
            "x": np.round(course.place.real, 6),
            "y": np.round(course.place.imag, 6),
            "n": np.round(course.force / self._largest(course.force), 4),
            "f": np.round(course.friction / self._largest(course.friction), 4),
            "v": np.round(units["velocity"][0] * course.slip, 4),
            "a": np.round(np.unwrap(course.unbalance_angles), 3),
            "held": course.held.astype(int),
            "peaks": np.round(units["time"][0] * self._peaks(), 5),
        }
        if course.mount is not None:
            numbers |= {"mx": np.round(course.mount.real, 4), "my": np.round(course.mount.imag, 4)}
        if course.race is not None and self._race_angles is not None:
            numbers |= {"q": np.round(units["velocity"][0] * course.race, 4), "b": np.round(self._race_angles, 3)}
        if course.impacts is not None:
            numbers["impacts"], numbers["hardest"] = self._impacts(course.impacts)
        entries = {name: values.tolist() for name, values in numbers.items()}
        entries |= {
            "poster": self.poster,
            "turn": math.tau * units["time"][0],
            "largest": [units["force"][0] * self._largest(each) for each in (course.force, course.friction)],
            "finer": units["length"][0],
            "units": [unit for _, unit in units.values()],
            "sizes": [ROTOR, CLEARANCE, ARROW],
            "seconds": 1e-3 if course.scales is not None else 1.0,
        }
        return Markup(json.dumps(entries, separators=(",", ":")).replace("<", "\\u003c"))

    def _impacts(self, impacts: ContactLog) -> tuple[np.ndarray, np.ndarray]:
        """Impacts on a rigid wall: time, shares of the largest impulses, and slip, shape (n, 4); and those impulses."""
        sizes = impacts.normal_impulse, impacts.friction_impulse
        hardest = [self._largest(each) for each in sizes]
        shares = (each / largest for each, largest in zip(sizes, hardest, strict=True))
        columns = self.units["time"][0] * impacts.time, *shares, self.units["velocity"][0] * np.abs(impacts.slip_before)
        return np.round(np.transpose(columns), 5), self.units["impulse"][0] * np.array(hardest)

    def _peaks(self) -> np.ndarray:
        """Times of the contacts: of the largest force in each, or of the impacts."""
        course = self.course
        if course.impacts is not None:
            return course.impacts.time
        edges = np.flatnonzero(np.diff(np.concatenate([[0], course.force > 0.0, [0]]).astype(int))).reshape(-1, 2)
        return np.array([course.times[first + course.force[first:last].argmax()] for first, last in edges])

    @staticmethod
    def _largest(values: np.ndarray) -> float:
        return float(np.abs(values).max(initial=0.0)) or 1.0


def film_of(motion: Trajectory) -> Film:
    """Sample a drop at its plane for a film: as much of it as can be seen contact by contact."""
    shown = shown_until(motion)
    until, samples = _sampled(motion, min(shown, first_contacts(motion, FOLLOWED), TURNS * math.tau))
    race = motion.rotor.races[motion.plane]
    return Film(
        course=course_of(motion, until, samples),
        units=_units(motion.scales),
        magnified=CLEARANCE / ROTOR * (float(motion.rotor.system.arrays.surface_speed[motion.plane]) - 1.0),
        race_radius=None if race is None else race.radius,
        whole=until == shown,
    )


def _sampled(motion: Trajectory, until: float) -> tuple[float, int]:
    """How much of a motion the samples of a film can show, at most until a time, and how many it takes.

    A film ends where the plane becomes too fast in the fixed frame, by its speeds at the events of the motion; what comes later does not
    shorten it.
    """
    times, speeds = [0.0], [1.0]
    for part in motion.parts:
        events = np.append(part.segment_starts, part.time)
        place, rate = part.seen_at(motion.plane).at_plane(events)
        times.extend(part.begins + events)
        speeds.extend(np.abs(rate + 1j * place))
    fastest, paths = np.maximum.accumulate(speeds), MOST * STEP
    beyond = int(np.argmax(np.array(times) * fastest > paths)) or len(times) - 1
    until = min(until, max(times[beyond - 1], paths / float(fastest[beyond])))
    at = min(int(np.searchsorted(times, until)), beyond)
    return until, max(FEWEST, min(MOST, math.ceil(until * float(fastest[at]) / STEP)))


@cache
def film_script() -> Markup:
    """The script that plays the films of a page."""
    return Markup(Path(__file__).with_name("film.js").read_text(encoding="utf-8"))
