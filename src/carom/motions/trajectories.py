"""Motions: a start followed through flights, impacts and lasting contact."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple

import numpy as np

from carom.arguments import Count, Reals, Whole, checked
from carom.core.advance import advance
from carom.core.event_log import EventLog, flying
from carom.core.layout import rub_workspace, workspace
from carom.core.rub import fly_or_rub_all, forces_all
from carom.models import Model, Subject, Trigger, model_of, stages_of
from carom.motions.blows import Blows, blows_of
from carom.motions.contacts import ContactHistory, ContactLog, LastingContact
from carom.motions.settling import (
    LOW_FOR,
    PATIENCE,
    REPEATING,
    fresh_memory,
    longest_time,
    low_interval,
    may_be_low,
    settled,
)
from carom.motions.starts import Kick, State, Until, amplitudes_of, time_until
from carom.outcome import InputError, Outcome, Phase
from carom.progress import Reporter, ShowProgress, shows_progress
from carom.results import Result

if TYPE_CHECKING:
    import xarray

ROUNDING = 1e-12
"""Excess over the range of times, relative to its length, that counts as rounding."""
CHUNK = 4096
"""Events per kernel call; between calls progress is reported."""


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
    segment_phases : ndarray of :class:`~carom.outcome.Phase`, shape (n + 1, P)
        Phase of each contact plane.
    event_planes : ndarray of int, shape (n,)
        Contact plane of the event that ends each segment but the last; −1 for a step of flight that changes nothing.
    segment_amplitudes : ndarray of complex, shape (n + 1, N)
        Mode amplitudes at the start of each segment.
    arrivals : ndarray of complex, shape (n, N)
        Mode amplitudes at the end of each segment except the last.
    plane : int
        Contact plane that positions, contacts and forces refer to; :meth:`seen_at` gives the motion at another.
    begins : float
        Time at which it begins, in ``1/Ω``: times within it count from there.
    earlier : tuple of Trajectory
        The stages before, if it is the last one of several (:class:`carom.models.Staged`).
    """

    rests_on: ClassVar[tuple[str, ...]] = ("mora2014", "brent1980")

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

    rotor: Model
    start: State
    outcome: Outcome
    time: float
    final: State
    multiplicity: int
    segment_starts: np.ndarray
    segment_phases: np.ndarray
    event_planes: np.ndarray
    segment_amplitudes: np.ndarray
    arrivals: np.ndarray
    plane: int = 0
    begins: float = 0.0
    earlier: tuple[Trajectory, ...] = ()

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
        planes = self.segment_phases.shape[1]
        if not 0 <= plane < planes:
            raise InputError("plane", plane, f"a whole number from 0 to {planes - 1}")
        return dataclasses.replace(self, plane=plane)

    @cached_property
    def is_impact(self) -> np.ndarray:
        """Which of the ``n`` events are impacts, bool, shape (n,)."""
        followed = self.segment_starts[1:], self.segment_phases[1:], self.event_planes
        log = EventLog(*followed, self.arrivals, self.segment_amplitudes[1:])
        return log.impacts(self.segment_phases[0])

    @cached_property
    def is_landing(self) -> np.ndarray:
        """Which of the ``n`` events complete a chatter (its remaining impulses in one), bool, shape (n,)."""
        before, after = flying(self.segment_phases, self.event_planes)
        return before & ~after

    @cached_property
    def contacts(self) -> ContactLog:
        """Log of the impacts at the contact plane."""
        return self._log(self.blows(self.is_impact).at(self.plane))

    def blows(self, events: np.ndarray) -> Blows:
        """Impulses at all planes in chosen events, bool, shape (n,), in chronological order and that of the planes."""
        return blows_of(
            self.rotor.system,
            np.flatnonzero(events),
            self.event_planes[events],
            self.segment_phases[:-1][events] != Phase.FLIGHT,
            self.arrivals[events],
            self.segment_amplitudes[1:][events],
        )

    def log_of(self, events: np.ndarray) -> ContactLog:
        """Log of chosen events, bool, shape (n,); of impacts at several planes in one instant each plane has an entry."""
        return self._log(self.blows(events))

    def _log(self, blows: Blows) -> ContactLog:
        system, times = self.rotor.system, self.segment_starts[1:][blows.events]
        before = system.at_planes(self.arrivals[blows.events], blows.planes)
        after = system.at_planes(self.segment_amplitudes[1:][blows.events], blows.planes)
        return ContactLog.from_states(self.rotor, times, blows, before, after)

    @cached_property
    def lasting_contacts(self) -> tuple[LastingContact, ...]:
        """Stretches of sliding and rolling at the contact plane, in chronological order."""
        ends = np.append(self.segment_starts, self.time)
        phases = self.segment_phases[:, self.plane]
        return tuple(
            LastingContact(Phase(int(phases[first])), float(ends[first]), float(ends[last]))
            for first, last in self.stretches()
            if phases[first] != Phase.FLIGHT
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
        amplitudes, _ = self._amplitudes_at(np.asarray(times, float))
        return self.rotor.system.state(amplitudes)

    @checked
    def at_plane(self, times: Reals) -> tuple[np.ndarray, np.ndarray]:
        """Displacement of the contact plane and its rate at given times, in its clearances; see :meth:`at`."""
        amplitudes, _ = self._amplitudes_at(np.asarray(times, float))
        return self.rotor.system.at_plane(amplitudes, self.plane)

    def _amplitudes_at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mode amplitudes and phases at given times."""
        flat = times.ravel()
        slack = ROUNDING * self.time
        outside = flat[(flat < -slack) | (flat > self.time + slack)]
        if outside.size:
            raise InputError("times", f"{outside[0]:.10g}", f"times from 0 to {self.time:.10g}, the range followed")
        segment = np.clip(np.searchsorted(self.segment_starts, flat, side="right") - 1, 0, None)
        phases = self.segment_phases[segment]
        moved = fly_or_rub_all(
            self.rotor.system.arrays,
            self.segment_amplitudes[segment],
            phases,
            flat - self.segment_starts[segment],
            self._workspace(),
        )
        return moved.reshape(*times.shape, moved.shape[1]), phases.reshape(*times.shape, phases.shape[1])

    def _workspace(self) -> np.record:
        return rub_workspace(self.segment_amplitudes.shape[1], self.segment_phases.shape[1])

    @checked
    def forces(self, times: Reals) -> tuple[np.ndarray, np.ndarray]:
        """Normal and friction force of lasting contact at the plane at given times, in ``m c_r Ω²``; zero in flight.

        Returns
        -------
        normal, friction : ndarray
            The normal force presses the rotor inward; friction is positive along growing angle.
        """
        amplitudes, phases = self._amplitudes_at(np.asarray(times, float))
        flat, shape = amplitudes.reshape(-1, amplitudes.shape[-1]), amplitudes.shape[:-1]
        arrays = self.rotor.system.arrays
        found = forces_all(arrays, flat, phases.reshape(len(flat), phases.shape[-1]), self._workspace())[:, self.plane]
        normal, friction = arrays.masses[self.plane] * found.T
        return normal.reshape(shape), friction.reshape(shape)

    @checked
    def history(self, times: Reals | None = None) -> ContactHistory:
        """Forces, slip and powers of lasting contact at given times, by default those of :meth:`sample`."""
        times = self.sample() if times is None else np.asarray(times, float)
        _, phases = self._amplitudes_at(times)
        state, forces = self.at_plane(times), self.forces(times)
        return ContactHistory.from_states(self.rotor, self.plane, times, phases[..., self.plane], state, forces)

    @checked
    def to_dataset(self, times: Reals | None = None) -> xarray.Dataset:
        """Course of the motion at given times; see :func:`~carom.motions.storage.trajectory_dataset`."""
        from carom.motions.storage import trajectory_dataset

        if times is not None and np.ndim(times) != 1:
            raise InputError("times", np.shape(times), "times in one dimension")
        return trajectory_dataset(self, times)

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


@checked
@shows_progress
def simulate(
    machine: Subject,
    start: State | Kick,
    until: Until | None = None,
    *,
    settle: bool | None = None,
    stop_at_chatter: bool = False,
    patience: Whole = PATIENCE,
    max_events: Count = 1_000_000,
    progress: ShowProgress = None,
) -> Trajectory:
    """Follow a start through flights, impacts, sliding and rolling.

    Parameters
    ----------
    machine : Machine, Case, Parameters or model
        Of a :class:`carom.models.Staged` the last stage reached is returned, with the ``earlier`` ones.
    start : State or Kick
        On the wall (``|U| = 1`` to within 1e-12) or inside it.
    until : float or str, optional
        Time to follow it, in ``1/Ω`` or text with a unit, such as ``"2 s"``; by default to where it settles, at most
        for :func:`~carom.motions.settling.longest_time`.
    settle : bool
        End as soon as the final motion is known (criteria in :mod:`carom.core.fate`); by default only without ``until``.
    stop_at_chatter : bool
        End with ``CHATTER`` and the exact state when impacts accumulate.
    patience : int
        While it may settle: impacts without recurrence after which bouncing counts as aperiodic.
    max_events : int
        Impacts and steps of lasting contact after which to give up.

    Raises
    ------
    InputError
        The start lies outside the wall or is too fast, a number is not finite, or a limit is out of range.

    See Also
    --------
    carom.settle : many starts at once
    carom.kick, carom.State : starts
    carom.motions.energy_ledger, carom.motions.full_spectrum : evaluate a motion

    Examples
    --------
    >>> import carom as cm
    >>> machine = cm.load("examples/keogh-cole.toml")
    >>> motion = cm.simulate(machine, cm.kick("60 mm/s"))
    >>> motion.outcome.label, motion.multiplicity
    ('bouncing', 1)
    >>> len(motion.contacts)
    257
    """
    model = model_of(machine)
    state = start.state(model) if isinstance(start, Kick) else start
    settle = until is None if settle is None else settle
    end = None if until is None and settle else time_until(until, model.scales)
    options = _Options(settle, stop_at_chatter, patience, max_events, Reporter.of(progress, "simulating"))
    parts: list[Trajectory] = []
    for stage in stages_of(model):
        begins = parts[-1].begins + parts[-1].time if parts else 0.0
        longest = longest_time(stage.rotor) if end is None else end - begins
        parts.append(_follow_stage(stage.rotor, state, begins, longest, stage.trigger, options))
        if parts[-1].outcome is not Outcome.TRIGGERED:
            break
        state = State.of(*stage.carried(parts[-1].final.position, parts[-1].final.velocity))
    return dataclasses.replace(parts[-1], earlier=tuple(parts[:-1])) if len(parts) > 1 else parts[0]


class _Options(NamedTuple):
    settle: bool
    stop_at_chatter: bool
    patience: int
    max_events: int
    tell: Reporter


def _follow_stage(
    rotor: Model, start: State, begins: float, longest: float, trigger: Trigger, options: _Options
) -> Trajectory:
    """Follow a start at a time through one stage, for so long at most, or until its trigger ends it."""
    settle, stop_at_chatter, patience, max_events, tell = options
    # What has settled may still be ended by a time.
    settle, until = settle and trigger.time == np.inf, min(longest, trigger.time)
    amplitudes, contact = amplitudes_of(rotor, start, begins)
    recollection = fresh_memory(rotor, patience if settle else 0, stop_at_chatter, trigger=trigger)
    first = amplitudes.copy()
    logs: list[EventLog] = []
    reached, events, outcome, multiplicity = 0.0, 0, Outcome.EVENT_LIMIT, 0
    while outcome is Outcome.EVENT_LIMIT and events < max_events:
        log = EventLog.empty(min(CHUNK, max_events - events), len(amplitudes), len(contact))
        outcome, time, count = follow(rotor, amplitudes, until - reached, contact, log, recollection)
        logs.append(log.first(count)._replace(times=reached + log.times[:count]))
        reached, events = reached + time, events + count
        tell(reached / until)
        outcome, multiplicity = settled(rotor, amplitudes, contact, outcome, recollection)
    if outcome in REPEATING and not multiplicity and may_be_low(rotor, patience):
        struck = np.concatenate([log.times for log in logs])[-LOW_FOR:]
        if np.ptp(struck) < low_interval(rotor) * (len(struck) - 1):
            outcome = Outcome.LOW_BOUNCES
    if outcome is Outcome.TIME_REACHED:
        reached, outcome = until, Outcome.TRIGGERED if until == trigger.time else outcome
    position, velocity = rotor.system.state(amplitudes)
    return Trajectory(
        rotor=rotor,
        start=start,
        outcome=outcome,
        time=reached,
        final=State.of(position, velocity),
        multiplicity=multiplicity,
        segment_starts=np.concatenate([np.zeros(1), *(log.times for log in logs)]),
        segment_phases=np.concatenate([np.zeros((1, len(contact)), np.int64), *(log.phases for log in logs)]),
        event_planes=np.concatenate([log.planes for log in logs]),
        segment_amplitudes=np.concatenate([first[None], *(log.after for log in logs)]),
        arrivals=np.concatenate([log.before for log in logs]),
        begins=begins,
    )


def follow(
    rotor: Model, amplitudes: np.ndarray, until: float, contact: np.ndarray, log: EventLog, recollection: np.record
) -> tuple[Outcome, float, int]:
    """Advance amplitudes and contacts in place until the log is full or the motion ends.

    See :func:`carom.core.advance.advance`.
    """
    modes, system = len(amplitudes), rotor.system
    work, rub = workspace(modes), rub_workspace(modes, len(contact))
    code, *rest = advance(system.arrays, system.table, amplitudes, until, contact, log, recollection, work, rub)
    return Outcome(code), *rest
