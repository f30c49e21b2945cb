"""Periodic motions of any machine, closed on the flow that the simulator follows.

A period begins in a flight, or where the motion rests on walls for long; what happens in it is read from the simulated motion.  The state
there and, where nothing stands in the fixed frame, the period are the unknowns of Newton's method; else the period is a whole number of turns.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from carom.base.arguments import Reals
from carom.base.outcome import Phase
from carom.base.results import Result
from carom.models import Rotor
from carom.motions.starts import State
from carom.motions.trajectories import Trajectory
from carom.orbits.flow import BEND, TURN, Flow
from carom.orbits.happenings import Extremes, Happening, extremes_of, happenings, word_of
from carom.orbits.maps import Multipliers, Section
from carom.orbits.names import CountedName
from carom.parameters import Scales

SAME_ORBIT_RTOL = 1e-5
"""Distance of two orbits, relative to one plus their size, below which they are the same."""
THROUGHOUT = {Phase.FORWARD_SLIP: "slides forward", Phase.BACKWARD_SLIP: "slides backward", Phase.ROLLING: "rolls"}
"""What an orbit does in which no event happens."""


@dataclass(frozen=True, eq=False, repr=False)
class SimulatedOrbit(Result):
    """A periodic motion of any machine: races that turn, limits that are met, several bearings that touch at a time.

    Attributes
    ----------
    rotor : Rotor
    name : CountedName
    start : State
        Where the period begins, between two events.
    period : float
        In ``1/Ω``.
    multipliers : Multipliers
        Factors by which small disturbances grow in a period, without the one of a delay where nothing stands in the fixed frame; of a rotor
        of many states the leading ones.
    complete : bool
        Whether these are all.
    repeats : float or None
        Time of which the period is a multiple; ``None`` if it could have any.
    """

    shown: ClassVar[tuple[str, ...]] = ("rotor", "name", "segments", "period", "turns", "start", "extremes", "stable")

    rotor: Rotor
    name: Any
    start: State
    period: float
    multipliers: Multipliers
    complete: bool
    repeats: float | None
    rests: tuple[tuple[int, bool], ...] = ()

    reason: ClassVar[str] = ""
    admissible: ClassVar[bool] = True

    @property
    def flow(self) -> Flow:
        """The flow that it is a closed path of."""
        return Flow(self.rotor, self.start.time, self.rests)

    @cached_property
    def motion(self) -> Trajectory:
        """One period."""
        motion = self.flow.follow(Flow.vector(self.start), self.period)
        if motion is None:
            raise RuntimeError("the motion of an orbit is followed to its end")
        return motion

    @property
    def departure(self) -> State:
        """State where the period begins."""
        return self.start

    def plot(self, *args: Any, **options: Any) -> Any:
        """Draw one period of it in the touchdown bearing of its first event, as :func:`carom.plots.motion` draws any motion."""
        return self.trajectory().seen_at(self.leading_plane).plot(*args, **options)

    def trajectory(self, periods: float = 1.0) -> Trajectory:
        """Follow it by simulation, from where its period begins."""
        from carom.motions.simulation import simulate

        return simulate(self.rotor, self.start, periods * self.period)

    def path(self, times: Reals, plane: int) -> np.ndarray:
        """Displacement at a contact plane, in its clearance and in the frame of the shaft, at times since the beginning of a period, in ``1/Ω``."""
        return self.motion.seen_at(plane).at_plane(np.mod(times, self.period))[0]

    @cached_property
    def happenings(self) -> tuple[Happening, ...]:
        """What happens in a period, from the fastest impact at a wall on."""
        found = happenings(self.motion)
        impacts = [place for place, each in enumerate(found) if each.begins_contact]
        if not impacts:
            return tuple(found)
        speeds = [self.section_of(found[place]).radial_speed for place in impacts]
        first = impacts[int(np.argmax(speeds))]
        return (*found[first:], *found[:first])

    @property
    def segments(self) -> str:
        """The same as text."""
        if word := word_of(self.happenings):
            return word
        lasting = sorted(set(self.motion.segment_phases.ravel().tolist()) & set(THROUGHOUT))
        return f"{' and '.join(THROUGHOUT[phase] for phase in lasting)} throughout" if lasting else "no event"

    @property
    def word(self) -> str:
        """The same: what happens is no word of impacts at one touchdown bearing."""
        return self.segments

    @property
    def flies(self) -> bool:
        """Whether it only bounces, without lasting contact."""
        return bool((self.motion.segment_phases == Phase.FLIGHT).all())

    @property
    def impacts(self) -> int:
        """Impacts in a period, without those of a chatter."""
        return sum(each.begins_contact for each in self.happenings)

    @property
    def turns(self) -> int | None:
        """Turns of the shaft in a period, where it must be whole turns."""
        return round(self.period / TURN) if self.repeats == TURN else None

    @property
    def stable(self) -> bool:
        """Whether small disturbances die out."""
        return self.multipliers.stable

    def section_of(self, happening: Happening) -> Section:
        """Place and speed of the plane of an event just before it."""
        plane = self.leading_plane if happening.limits else happening.place
        position, velocity = self.rotor.system.at_plane(self.motion.event_amplitudes[happening.event], plane)
        return Section.from_state(complex(position), complex(velocity))

    @property
    def leading_plane(self) -> int:
        """Contact plane of the first event; where there is none, that which touches."""
        if self.happenings and not self.happenings[0].limits:
            return self.happenings[0].place
        return int(np.argmax((self.motion.segment_phases != Phase.FLIGHT).any(axis=0)))

    @cached_property
    def section(self) -> Section:
        """Place and speed at the first event; where there is none, at the start, of the plane that touches."""
        if self.happenings:
            return self.section_of(self.happenings[0])
        position, velocity = self.rotor.system.at_plane(self.motion.segment_amplitudes[0], self.leading_plane)
        return Section.from_state(complex(position), complex(velocity))

    @property
    def contacts(self) -> list[tuple[str, int, float, Section]]:
        """Kind, contact plane (of a limit its number) and time since the first of each happening, and the state there."""
        begun = self.happenings[0].time if self.happenings else 0.0
        places = [each.place // 2 if each.limits else each.place for each in self.happenings]
        each_with = zip(self.happenings, places, strict=True)
        return [
            (each.label, place, (each.time - begun) % self.period, self.section_of(each)) for each, place in each_with
        ]

    @property
    def impulse(self) -> float:
        """Largest normal impulse of a contact in the period at the plane of the first event, in ``m c_r Ω``; ``nan`` without any."""
        impulses = self.motion.seen_at(self.leading_plane).contacts.normal_impulse
        return float(impulses.max()) if len(impulses) else np.nan

    @property
    def impact_speeds(self) -> np.ndarray:
        """``ṙ`` of the fastest impact in ``c_r Ω``, shape (1,)."""
        return np.array([self.radial_speed])

    def moved(
        self, flow: Flow, vector: np.ndarray, period: float, multipliers: np.ndarray, name: CountedName
    ) -> SimulatedOrbit:
        """Another closed path that repeats as this one does."""
        at = flow.state(vector), period, Multipliers(multipliers, BEND**2)
        return SimulatedOrbit(flow.rotor, name, *at, complete=True, repeats=self.repeats, rests=flow.rests)

    @property
    def radial_speed(self) -> float:
        """``ṙ`` just before the first event in ``c_r Ω``."""
        return self.section.radial_speed

    @property
    def angle(self) -> float:
        """``θ`` there in rad."""
        return self.section.angle

    @property
    def angular_speed(self) -> float:
        """``θ̇`` there in ``Ω``."""
        return self.section.angular_speed

    @property
    def scales(self) -> Scales | None:
        """Scales of what is stated of the plane of the first event: lengths there are in its own clearance."""
        return self.rotor.system.scales_at(self.leading_plane, self.rotor.scales)

    @cached_property
    def extremes(self) -> Extremes:
        """Largest radius, depth and force."""
        return extremes_of(self.motion)

    @cached_property
    def impact_states(self) -> np.ndarray:
        """States just before the impacts at walls, complex, shape (k, 2n)."""
        events = [each.event for each in self.happenings if each.begins_contact]
        return self.rotor.system.states_of(self.motion.event_amplitudes[events])


def same_simulated(first: SimulatedOrbit, second: SimulatedOrbit) -> bool:
    """Whether two orbits are the same, wherever their periods begin."""
    if abs(first.period - second.period) > SAME_ORBIT_RTOL * first.period or first.impacts != second.impacts:
        return False
    if first.impacts:
        size = SAME_ORBIT_RTOL * (1.0 + float(np.abs(first.impact_states).max()))
        places = range(len(first.impact_states))
        return any(np.abs(np.roll(first.impact_states, -k, axis=0) - second.impact_states).max() < size for k in places)
    apart = np.abs(np.subtract(first.extremes, second.extremes)).max()
    return bool(apart < SAME_ORBIT_RTOL * (1.0 + max(first.extremes)))
