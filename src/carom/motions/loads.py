"""What a motion asks of a touchdown bearing: its loads, when they come, how the rotor stays there, and how near it comes to its magnets, over all stages."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carom.base.outcome import Outcome
from carom.base.results import KINDS, Result
from carom.models import Rotor
from carom.motions.heating import RaceRun, Temperatures
from carom.motions.trajectories import Trajectory
from carom.parameters import Scales
from carom.parameters.formats import number

MEASURED = ("impulse", "force", "depth", "power", "heat", "restitution_loss", "contact_time", "lasting_power")
"""Loads that have a unit."""
GOING_ROUND = (Outcome.FORWARD_RUB, Outcome.BACKWARD_WHIRL, Outcome.ROLLING)
"""Ends of a motion that goes round the wall in contact."""
RATED_PRESSURE = 4.2e9
"""Of the most loaded ball at the static rating, Pa (ISO 76)."""


@dataclass(frozen=True, repr=False)
class LastWhirl(Result):
    """How a plane went round at the end of a motion, in the fixed frame.

    Attributes
    ----------
    angular_speed : float
        Mean over the last turns of the shaft, in ``Ω``; negative for backward whirl.
    turned : float
        Angle over which it went round in these, in rad, with its sign.
    lasted : float
        Time over which that was seen, in ``1/Ω``: eight turns, or less of a motion that is shorter.
    since : float
        Time since which it has not turned back, in ``1/Ω``, to within a step of the motion.  If it does not go on, no earlier time is looked at
        than these turns.
    goes_on : bool
        Whether the motion has settled to going round in contact; otherwise this is what was seen, and no more.
    scales : Scales or None
    """

    angular_speed: float
    turned: float
    lasted: float
    since: float
    goes_on: bool
    scales: Scales | None = None

    @property
    def direction(self) -> str | None:
        """``"forward"`` or ``"backward"``; ``None`` if it went less than half round."""
        return None if abs(self.turned) < math.pi else "forward" if self.turned > 0.0 else "backward"

    @property
    def frequency_si(self) -> float | None:
        """Size of the mean, in Hz; ``None`` without scales."""
        return None if self.scales is None else abs(self.angular_speed) * self.scales.speed / (2.0 * math.pi)


class FirstContact(NamedTuple):
    """The first contact with a force, in ``m c_r Ω²``; times from the release in ``1/Ω``."""

    force: float
    start: float
    peak_time: float
    over: bool
    """Whether the plane has left it."""


class CatalogueLoads(NamedTuple):
    """What a landing asks of a bearing of the catalogue; ``None`` where the touchdown bearing does not state what that needs."""

    ball_load: float | None = None
    """Largest load of a ball, N, by the sum over all balls (:class:`carom.closed_forms.BallRing`)."""
    pressure: float | None = None
    """Its pressure, Pa."""
    static_share: float | None = None
    """Peak force over the static load rating."""
    life_share: float | None = None
    """Share of the life of a million turns under the dynamic load rating, by Palmgren and Miner: the mean cube of the radial force over that, times the turns of the race."""


@dataclass(frozen=True, eq=False, repr=False)
class TouchdownLoads(Result):
    """What the touchdown bearing at a plane bears in a motion, in units of the equations; ``si`` gives its loads in SI units.

    Loads are the largest over all stages, or their sum; times count from the release.  An impact on a rigid wall has an impulse, and no force
    that could be stated: there ``force`` is that of lasting contact alone.

    Attributes
    ----------
    plane : int
    is_compliant : bool
        Whether its wall is compliant.
    outcome : Outcome
        Where the motion settled, or why it was stopped.
    contacts : int
        Contacts from entering the wall on, or impacts on a rigid wall.
    bounces : int
        Those which the plane has left again.
    impulse : float
        Largest normal impulse of a contact, ``m c_r Ω``; of one that lasts at the end, whose impulse grows on, it is left out.
    impulse_at : float or None
        When it came, ``1/Ω``: the time of its largest force, or of the impact.
    force : float
        Largest normal force in lasting contact, ``m c_r Ω²``.  If the motion goes on rolling, that of the planar rotor over a
        whole turn.
    force_at : float or None
        When it came, ``1/Ω``; ``None`` on a rigid wall.
    still_growing : bool
        Whether the largest force of a compliant bearing came at the very end, in contact: a slow whirl may still speed up, and force, depth and pressure with it.
    depth : float
        Largest depth in the wall, ``c_r``; 0 if the wall is rigid.
    power : float
        Largest power of friction in lasting contact, ``m c_r² Ω³``.
    heat : float
        Work lost to friction, in impacts and in lasting contact, ``m c_r² Ω²``.
    restitution_loss : float
        Work lost along the normal, in impacts or in a compliant wall, ``m c_r² Ω²``.
    contact_time : float
        Duration of lasting contact, ``1/Ω``.
    lasting_power : float
        Power of friction with which the motion goes on, ``m c_r² Ω³``: at its end in lasting contact, or averaged over the last
        impacts; 0 if it does not go on in contact.
    restitution : float or None
        Radial speed after the contact that was entered fastest over that before it, as it was seen.
    race_at_end, fastest_race : float or None
        Speed of the race at the end, and the largest at the end of a step, in ``Ω``; ``None`` if it does not turn.
    in_contact_since : float or None
        Time since which the plane has not left the wall, to the end, ``1/Ω``; ``None`` if it is not there at the end.
    whirl : LastWhirl or None
        ``None`` if it did not touch in the last turns.
    first : FirstContact or None
        ``None`` without one, or of a rigid wall, whose impacts have no force.
    catalogue : CatalogueLoads
    turning : RaceRun
    temperatures : Temperatures or None
        ``None`` where the touchdown bearing does not state the mass of its race.
    scales : Scales or None
    """

    plane: int
    is_compliant: bool
    outcome: Outcome
    contacts: int
    bounces: int
    impulse: float
    impulse_at: float | None
    force: float
    force_at: float | None
    still_growing: bool
    depth: float
    power: float
    heat: float
    restitution_loss: float
    contact_time: float
    lasting_power: float
    restitution: float | None
    race_at_end: float | None
    fastest_race: float | None
    in_contact_since: float | None
    whirl: LastWhirl | None
    first: FirstContact | None
    catalogue: CatalogueLoads
    turning: RaceRun
    temperatures: Temperatures | None = None
    scales: Scales | None = None

    @property
    def goes_on(self) -> bool:
        """Whether the motion has settled in contact, so that impacts or heat have no end."""
        return self.outcome.settled and self.outcome is not Outcome.LEVITATED

    def si(self) -> dict[str, float] | None:
        """Loads in SI units by name; ``None`` without scales."""
        if self.scales is None:
            return None
        si = {name: getattr(self, name) * getattr(self.scales, KINDS[name]) for name in MEASURED}
        if self.temperatures is not None:
            si["temperature"] = self.temperatures.highest
        return si | {name: value for name, value in self.catalogue._asdict().items() if value is not None}

    @property
    def pressure(self) -> float | None:
        """Pressure of the most loaded ball, Pa; ``None`` if the touchdown bearing does not state its balls."""
        return self.catalogue.pressure

    @property
    def landings(self) -> float | None:
        """Such landings in the life of the touchdown bearing, 0 above its static rating or, where none is stated, above the pressure that defines ratings.

        ``None`` where its share of the life is not known or zero, where a whirl goes on, and where the motion leaves the model.
        """
        share, static = self.catalogue.life_share, self.catalogue.static_share
        endless = self.whirl is not None and self.whirl.goes_on
        if not share or endless or self.outcome is Outcome.BEYOND_MODEL:
            return None
        return 0.0 if (static or (self.pressure or 0.0) / RATED_PRESSURE) > 1.0 else 1.0 / share


@dataclass(frozen=True, repr=False)
class Braking(Result):
    """What a drop does to the speed of a shaft that is braked.

    Attributes
    ----------
    speed_at_end : float
        In ``Ω``.
    left_out : float
        Change of the speed by which the torque of the drive would add to this in flight, where it is left out, in ``Ω``.
    scales : Scales or None
    """

    speed_at_end: float
    left_out: float
    scales: Scales | None = None


@dataclass(frozen=True, repr=False)
class DropLoads(Result):
    """What a drop asks of the touchdown bearing; nothing is claimed beyond the time up to which it was followed.

    Attributes
    ----------
    rotor : Model
        That of the last stage.
    outcome : Outcome
        Where the motion settled, or why it was stopped.
    multiplicity : int
        Impacts per period if it settled to periodic bouncing.
    time : float
        Time from the release up to which it was followed, ``1/Ω``.
    planes : tuple of TouchdownLoads
        One for each contact plane.
    shaft : Braking or None
        ``None`` of a shaft at constant speed.
    magnets : MagnetReach or None
        How near it comes to its magnets; ``None`` where no air gap is known.
    scales : Scales or None
    """

    rotor: Rotor
    outcome: Outcome
    multiplicity: int
    time: float
    planes: tuple[TouchdownLoads, ...]
    shaft: Braking | None = None
    magnets: MagnetReach | None = None
    scales: Scales | None = None

    @property
    def settled_at(self) -> float | None:
        """Time from the release since which the rotor rests on the bearing, or goes round it in contact; ``None`` if it does neither."""
        if self.outcome is not Outcome.AT_REST and self.outcome not in GOING_ROUND:
            return None
        held = [each for each in self.planes if each.in_contact_since is not None]
        times = [each.in_contact_since or 0.0 for each in held]
        if self.outcome in GOING_ROUND:
            times += [each.whirl.since for each in held if each.whirl]
        return max(times, default=None)


PER_TURN, SAMPLES = 1000, 5000
"""Instants, beside those of events, at which the place of a rotor at its magnets is looked at: in a turn, and at most in a stage or piece of one."""
TOGETHER = 2_000


def excess_pull(share: float) -> float:
    """By how much a magnet pulls harder than in the linear law, relative to that, at a share of its air gap from the centre, without control current.

    A differential pair with the air gap ``s₀``, the bias current ``i₀`` and the control current ``i`` pulls a rotor at ``x`` with

        F = k [(i₀ + i)²/(s₀ − x)² − (i₀ − i)²/(s₀ + x)²],

    so without control current with ``4k i₀² s₀ x/(s₀² − x²)²``: with ``ξ = x/s₀``, ``1/(1 − ξ²)²`` times as hard as the linear law ``4k i₀² x/s₀³``.
    Saturating iron takes from that, so it is an upper bound.
    """
    return 1.0 / (1.0 - share**2) ** 2 - 1.0


def pull_words(share: float) -> str:
    """The same in words, to follow the place."""
    return f"there a magnet pulls up to {number(100.0 * excess_pull(share), 2)} % harder than in this linear model (less where its iron saturates)"


@dataclass(frozen=True, repr=False)
class MagnetReach(Result):
    """How near a rotor comes to its magnets while they act.

    Attributes
    ----------
    share : float
        Largest distance from the centre of a magnetic bearing over its air gap, while they act.
    reached : bool
        Whether it reaches one, whether they act or not.  A motion ends at the first event at which that is seen.
    """

    share: float
    reached: bool

    @property
    def words(self) -> str:
        """The same in sentences."""
        shown = "The rotor reaches a magnet: the simulated motion after that is not valid. " if self.reached else ""
        if not 0.0 < self.share < 1.0:
            return shown.rstrip()
        return shown + (
            f"While the magnets act, the rotor moves up to {number(100.0 * self.share, 2)} % of an air gap from the centre; {pull_words(self.share)}."
        )

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        wrong = excess_pull(self.share) if self.share < 1.0 else None
        return {"share_of_air_gap": self.share, "reached": self.reached, "excess_pull": wrong}


def reach_with(known: MagnetReach | None, part: Trajectory) -> MagnetReach | None:
    """What is known of a motion with one more stage, or piece of one; ``None`` where no air gap is known."""
    gaps, system = part.rotor.system.magnets, part.rotor.system
    if gaps is None:
        return known
    before, share = known or MagnetReach(0.0, False), _largest(part, gaps)
    return MagnetReach(max(before.share, share if system.levitates else 0.0), before.reached or share > 1.0)


def _largest(part: Trajectory, gaps: np.ndarray) -> float:
    begun = part.segment_starts[0]
    even = np.linspace(begun, part.time, min(SAMPLES, math.ceil(PER_TURN * (part.time - begun) / math.tau) + 2))
    times = np.concatenate([part.segment_starts, even])
    pieces = np.array_split(times, math.ceil(len(times) / TOGETHER))
    return max(float(np.abs(np.reshape(part.at(each)[0], (len(each), -1)) @ gaps.T).max()) for each in pieces)
