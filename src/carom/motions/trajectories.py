"""Motions: a start followed through flights, impacts and lasting contact."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from carom.base.arguments import Count, Reals, Whole, checked
from carom.base.outcome import InputError, Outcome, Phase
from carom.base.results import Result
from carom.core.event_log import EventLog, flying
from carom.core.layout import rub_workspace
from carom.core.rub import fly_or_rub_all, forces_all
from carom.models import Rotor, Subject
from carom.motions.contacts import ContactLog, Impulses, contacts_of, impacts_of, impulses_of
from carom.motions.kinematics import ContactHistory, LastingContact, is_compliant, presses
from carom.motions.starts import State, Until, state_at

if TYPE_CHECKING:
    import xarray

    from carom.parameters import Scales

TOGETHER = 4096
"""Times for which the amplitudes of all modes are known at once, where less is asked for."""
ROUNDING = 1e-12
"""Excess over the range of times, relative to its length, that counts as rounding."""


SEGMENTS = {
    "segment_starts": "segment",
    "segment_phases": "segment plane",
    "segment_limits": "segment axis",
    "event_planes": "event",
    "segment_amplitudes": "segment mode",
    "event_amplitudes": "event mode",
}
"""Arrays of a stage, with their dimensions."""


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(Result):
    """A motion: exact flights and lasting contacts, separated by events.

    Attributes
    ----------
    rotor : Model
    start : State
    outcome : Outcome
        Where it settled, or why it was stopped.
    time : float
        End of the motion in ``1/Ω``.
    final : State
        State at the end.
    multiplicity : int
        Impacts per period if it settled to periodic bouncing; zero otherwise (bouncing with zero is aperiodic).
    segment_starts : ndarray, shape (n + 1,)
        Start time of each segment.  A long contact consists of several.
    segment_phases : ndarray of :class:`~carom.base.outcome.Phase`, shape (n + 1, P)
        Phase of each contact plane.
    event_planes : ndarray of int, shape (n,)
        Contact plane of the event that ends each segment but the last; −1 for a step of flight that changes nothing.
    segment_amplitudes : ndarray of complex, shape (n + 1, N)
        Mode amplitudes at the start of each segment.
    impacts : ndarray of complex, shape (n, N)
        Mode amplitudes at the end of each segment except the last.
    segment_limits : ndarray of int, shape (n + 1, 2L)
        State of both axes of each limited quantity (:mod:`carom.core.limits`).
    plane : int
        Contact plane that positions, contacts and forces refer to; :meth:`seen_at` gives the motion at another.
    begins : float
        Time at which it begins, in ``1/Ω``: times within it count from there.
    earlier : tuple of Trajectory
        The stages before, if it is the last one of several (:func:`carom.models.in_stages`).
    """

    figure: ClassVar[str] = "motion"
    shown: ClassVar[tuple[str, ...]] = (
        "rotor",
        "start",
        "outcome",
        "time",
        "final",
        "multiplicity",
        "contacts",
        "lasting_contacts",
    )

    rotor: Rotor
    start: State
    outcome: Outcome
    time: float
    final: State
    multiplicity: int
    segment_starts: np.ndarray
    segment_phases: np.ndarray
    event_planes: np.ndarray
    segment_amplitudes: np.ndarray
    event_amplitudes: np.ndarray
    segment_limits: np.ndarray
    plane: int = 0
    begins: float = 0.0
    earlier: tuple[Trajectory, ...] = ()

    @property
    def scales(self) -> Scales | None:
        """Scales of what is stated of the contact plane: lengths there are in its own clearance."""
        return self.rotor.system.scales_at(self.plane, self.rotor.scales)

    @property
    def parts(self) -> tuple[Trajectory, ...]:
        """The stages of the motion in chronological order; of most there is one."""
        return *self.earlier, self

    @checked
    def seen_at(self, plane: Whole) -> Trajectory:
        """Return the same motion with the positions, contacts and forces of another contact plane.

        Raises
        ------
        InputError
            There is no such plane.
        """
        if not 0 <= plane < len(self.at_each):
            raise InputError("plane", plane, f"a whole number from 0 to {len(self.at_each) - 1}")
        return self.at_each[plane]

    @cached_property
    def at_each(self) -> tuple[Trajectory, ...]:
        """The same motion seen at each contact plane; kept, because what it knows of its contacts takes time to find."""
        planes = range(self.segment_phases.shape[1])
        return tuple(self if plane == self.plane else dataclasses.replace(self, plane=plane) for plane in planes)

    def since(self, segment: int) -> Trajectory:
        """Return the motion from the start of one of its segments on; its stages before are left out."""
        begun = float(self.segment_starts[segment])
        begins = self.begins + begun
        start = state_at(self.rotor.system, self.segment_amplitudes[segment], begins)
        columns: dict[str, Any] = {name: getattr(self, name)[segment:] for name in SEGMENTS}
        columns["segment_starts"] = columns["segment_starts"] - begun
        return dataclasses.replace(self, start=start, time=self.time - begun, begins=begins, earlier=(), **columns)

    @property
    def durations(self) -> np.ndarray:
        """Duration of each segment, shape (n + 1,)."""
        return np.diff(self.segment_starts, append=self.time)

    @cached_property
    def is_impact(self) -> np.ndarray:
        """Which of the ``n`` events are impacts, bool, shape (n,)."""
        followed = self.segment_starts[1:], self.segment_phases[1:], self.event_planes
        log = EventLog(*followed, self.event_amplitudes, self.segment_amplitudes[1:], self.segment_limits[1:])
        return log.impacts(self.segment_phases[0])

    @cached_property
    def is_landing(self) -> np.ndarray:
        """Which of the ``n`` events complete a chatter (its remaining impulses in one), bool, shape (n,)."""
        before, after = flying(self.segment_phases, self.event_planes)
        rigid = self.rotor.system.arrays.stiffness[self.event_planes] == 0.0
        landing: np.ndarray = before & ~after & rigid
        return landing

    @cached_property
    def contacts(self) -> ContactLog:
        """Log of the contacts at the contact plane: impacts on a rigid touchdown bearing, or contacts with a compliant one."""
        return contacts_of(self)

    @property
    def is_compliant(self) -> bool:
        """Whether the touchdown bearing at the contact plane is compliant."""
        return is_compliant(self.rotor.system, self.plane)

    def impulses(self, events: np.ndarray) -> Impulses:
        """Impulses at all planes in chosen events, bool, shape (n,), in chronological order and that of the planes."""
        return impulses_of(self, np.flatnonzero(events))

    def log_of(self, events: np.ndarray) -> ContactLog:
        """Log of chosen events, bool, shape (n,); of impacts at several planes in one instant each plane has an entry."""
        return impacts_of(self, self.impulses(events))

    @cached_property
    def lasting_contacts(self) -> tuple[LastingContact, ...]:
        """Stretches of sliding and rolling at the contact plane, in chronological order."""
        ends = np.append(self.segment_starts, self.time)
        phases = self.segment_phases[:, self.plane]
        return tuple(
            LastingContact(Phase(int(phases[first])), float(ends[first]), float(ends[last]))
            for first, last in self.stretches()
            if presses(phases[first])
        )

    def stretches(self) -> list[tuple[int, int]]:
        """Segments over which the phase of the contact plane stays the same, each as first and one past the last."""
        changes = np.flatnonzero(np.diff(self.segment_phases[:, self.plane])) + 1
        return list(pairwise([0, *changes, len(self.segment_phases)]))

    @checked
    def at(self, times: Reals) -> tuple[np.ndarray, np.ndarray]:
        """State at given times, exact to rounding; at an impact, the state just after it.

        Parameters
        ----------
        times : array_like
            In ``1/Ω``, within 0 … ``time``.

        Returns
        -------
        position, velocity : ndarray of complex
            ``U`` and ``U̇`` in the co-rotating frame, of the shape of ``times``; for a rotor of ``n > 1`` coordinates with a
            last axis of that length.

        Raises
        ------
        InputError
            A time outside the range followed.
        """
        amplitudes, _ = self.amplitudes_at(np.asarray(times, float))
        return self.rotor.system.state(amplitudes)

    @checked
    def at_plane(self, times: Reals) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of the contact plane and its rate at given times, in its clearances; see :meth:`at`."""
        asked = np.asarray(times, float)
        places = np.empty((2, asked.size), complex)
        # Few at a time: the amplitudes of all modes take far more room than the place of one plane.
        for first in range(0, asked.size, TOGETHER):
            here = slice(first, first + TOGETHER)
            places[:, here] = self.rotor.system.at_plane(self.amplitudes_at(asked.ravel()[here])[0], self.plane)
        position, velocity = places.reshape(2, *asked.shape)
        return position, velocity

    def amplitudes_at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mode amplitudes and phases at given times."""
        flat = times.ravel()
        slack = ROUNDING * self.time
        outside = flat[(flat < -slack) | (flat > self.time + slack)]
        if outside.size:
            raise InputError("times", f"{outside[0]:.10g}", f"times from 0 to {self.time:.10g}, the range followed")
        segment = np.clip(np.searchsorted(self.segment_starts, flat, side="right") - 1, 0, None)
        moved, phases = self.amplitudes_in(segment, flat - self.segment_starts[segment])
        return moved.reshape(*times.shape, moved.shape[1]), phases.reshape(*times.shape, phases.shape[1])

    def amplitudes_in(self, segments: np.ndarray, elapsed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mode amplitudes (..., N) and phases (..., P) in segments (...), at times (...) after the start of each."""
        at, phases = segments.ravel(), self.segment_phases[segments]
        moved = fly_or_rub_all(
            self.rotor.system.arrays,
            self.segment_amplitudes[at],
            self.segment_phases[at],
            self.segment_limits[at],
            np.fmod(self.begins + self.segment_starts[at], 2.0 * np.pi),
            elapsed.ravel(),
            self.workspace(),
        )
        return moved.reshape(*segments.shape, moved.shape[1]), phases

    @cached_property
    def last_amplitudes(self) -> np.ndarray:
        """Mode amplitudes at the end, complex, shape (N,)."""
        last = np.array([len(self.segment_starts) - 1])
        end: np.ndarray = self.amplitudes_in(last, self.time - self.segment_starts[last])[0][0]
        return end

    @property
    def edge_amplitudes(self) -> np.ndarray:
        """Mode amplitudes at the start of each segment and at the end, complex, shape (n + 2, N)."""
        return np.concatenate([self.segment_amplitudes, self.last_amplitudes[None]])

    def ends_of(self, segments: np.ndarray) -> np.ndarray:
        """Mode amplitudes at the end of chosen segments (k,), complex, shape (k, N)."""
        return np.concatenate([self.event_amplitudes, self.last_amplitudes[None]])[segments]

    def workspace(self) -> np.record:
        """Scratch arrays of contact."""
        modes, planes = self.segment_amplitudes.shape[1], self.segment_phases.shape[1]
        return rub_workspace(modes, planes, self.rotor.system.limits)

    @checked
    def forces(self, times: Reals) -> tuple[np.ndarray, np.ndarray]:
        """Normal and friction force of lasting contact at the plane at given times, in ``m c_r Ω²``; zero in flight.

        Returns
        -------
        normal, friction : ndarray
            The normal force presses the rotor inward; friction is positive along growing angle.
        """
        times = np.asarray(times, float)
        return self.forces_of(*self.amplitudes_at(times), times)

    def forces_of(self, amplitudes: np.ndarray, phases: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Normal and friction force at the plane in given amplitudes (..., N) and phases (..., P) at times (...)."""
        flat, shape = amplitudes.reshape(-1, amplitudes.shape[-1]), amplitudes.shape[:-1]
        phases = phases.reshape(len(flat), phases.shape[-1])
        arrays, clocks = self.rotor.system.arrays, self.begins + times.ravel()
        found = forces_all(arrays, flat, phases, clocks, self.workspace())[:, self.plane]
        normal, friction = arrays.masses[self.plane] * found.T
        return normal.reshape(shape), friction.reshape(shape)

    @checked
    def history(self, times: Reals | None = None) -> ContactHistory:
        """Forces, slip and powers of lasting contact at given times, by default those of :meth:`sample`."""
        times = self.sample() if times is None else np.asarray(times, float)
        return ContactHistory.of(self, times)

    @checked
    def to_dataset(self, times: Reals | None = None) -> xarray.Dataset:
        """Course of the motion: places, velocities, phases and contact forces at given times, by default those of :meth:`sample`.

        It is in SI units where the scales are known, in the co-rotating frame, and describes the contact plane.
        """
        from carom.motions.storage import provenance

        if times is not None and np.ndim(times) != 1:
            raise InputError("times", np.shape(times), "times in one dimension")
        course = self.history(times).to_dataset()
        return course.assign_coords(time=course["time"]).assign_attrs(provenance(self), begins=self.begins)

    @checked
    def channels(
        self, every: Until | None = None, nodes: Sequence[Whole] = (), machine: Subject | None = None
    ) -> xarray.Dataset:
        """Histories as sensors would record them, in SI units and the fixed frame; see :func:`carom.motions.channels.channels_of`."""
        from carom.motions.channels import channels_of

        return channels_of(self, every, nodes, machine)

    @checked
    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the motion to a file; see :func:`~carom.motions.storage.save_trajectory`."""
        from carom.motions.storage import save_trajectory

        save_trajectory(self, path)

    @staticmethod
    @checked
    def load(path: str | os.PathLike[str]) -> Trajectory:
        """Read a motion from a file; see :func:`~carom.motions.storage.load_trajectory`."""
        from carom.motions.storage import load_trajectory

        return load_trajectory(path)

    @checked
    def sample(self, count: Count = 2000) -> np.ndarray:
        """Times for plotting: about ``count`` equally spaced ones, every event, and the last instant before each."""
        events = self.segment_starts[1:]
        even = np.linspace(0.0, self.time, count)
        return np.unique(np.concatenate([even, events, np.nextafter(events, 0.0)]))

    def end(self) -> tuple[complex, complex]:
        """Where the contact plane is at the end, in its clearances, and how fast, in the fixed frame."""
        (place,), (rate,) = self.at_plane(np.array([self.time]))
        turn = np.exp(1j * (self.begins + self.time))
        return complex(place * turn), complex((rate + 1j * place) * turn)

    @checked
    def position(self, times: Reals, frame: Literal["rotating", "fixed"] = "rotating") -> np.ndarray:
        """Position of the contact plane in its clearances, ``U`` in the co-rotating or ``Z = U e^{it}`` in the fixed frame.

        Raises
        ------
        InputError
            Another frame is asked for.
        """
        rotating, _ = self.at_plane(times)
        return rotating if frame == "rotating" else rotating * np.exp(1j * (self.begins + np.asarray(times)))

    @checked
    def radius(self, times: Reals) -> np.ndarray:
        """Distance of the contact plane from its bearing centre, in its clearances."""
        radius: np.ndarray = np.abs(self.at_plane(times)[0])
        return radius


def joined(pieces: list[Trajectory]) -> Trajectory:
    """Join pieces of one stage, each of which ends where the next begins, with a segment that has no duration yet."""
    columns: dict[str, Any] = {}
    for name, dimensions in SEGMENTS.items():
        *before, last = (getattr(piece, name) for piece in pieces)
        if dimensions.startswith("segment"):
            before = [each[:-1] for each in before]
        columns[name] = np.concatenate([*before, last])
    return dataclasses.replace(pieces[-1], start=pieces[0].start, **columns)
