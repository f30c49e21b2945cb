"""Special points of branches: where a motion of the machine appears, vanishes or changes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

from carom.base.arguments import checked
from carom.base.outcome import InputError
from carom.base.results import Result
from carom.bifurcations.conditions import orbit_of
from carom.closed_forms.thresholds import FOLD, ROLLING, WALL, Values, happens_to_rubs, wall_condition
from carom.models import Subject, exact_rotor_of
from carom.orbits.names import OrbitName
from carom.orbits.orbit import Orbit
from carom.orbits.simulated import SimulatedOrbit
from carom.parameters import Numbers, Scales
from carom.parameters.formats import format_entry

MotionKind = Literal["orbit", "contact-free", "rub", "rolling", "rubbing"]
HALVING = "period-halving"
"""Where both halves of a period become equal: the orbit is one of half the period there, at its period doubling."""
HOPF, EXTREMUM = "non-smooth-hopf", "radius-extremum"
"""Special points of orbits with one impact alone: where it vanishes only a point on the wall is left of the orbit."""
VANISHING, ONSET, LOST = "vanishing-impact", "contact-onset", "levitation-lost"
STEADY: dict[str, MotionKind] = {WALL: "contact-free", FOLD: "rub", ROLLING: "rolling", LOST: "contact-free"}
"""Special points of steady motions, and the motion of each."""


def happens_steadily(kind: str, at: Values) -> bool:
    """Whether a special point of steady motions happens to a motion of the machine."""
    if kind == FOLD:
        return happens_to_rubs(at)
    return kind != LOST or wall_condition(at) < 0.0


@dataclass(frozen=True, eq=False, repr=False)
class Bifurcation(Result):
    """A special point; :func:`~carom.continue_curve` follows most of them in the plane of two parameters.

    Attributes
    ----------
    kind : str
        Of orbits: ``"fold"`` (of the closed form: two periods meet), ``"speed-fold"`` (two radial speeds of one period
        meet), ``"period-doubling"``, ``"neimark-sacker"``, ``"grazing"`` (a maximum of the radius reaches the wall),
        ``"non-smooth-hopf"`` (orbits with one impact shrink to a boundary equilibrium), ``"vanishing-impact"`` (the
        speed of an impact vanishes: grazing of the orbit without this impact), ``"slip-stop"`` (friction begins or
        ceases to stop the slip in an impact), ``"contact-onset"`` (an impact without rebound begins to stay on the wall),
        ``"contact-change"`` (something else that happens in a period begins or ceases to), ``"period-halving"`` (both halves of the period become equal: the branch ends on one of orbits of half the
        period), or ``"radius-extremum"`` (the radius gains a maximum and a minimum between impacts: no bifurcation).
        Of steady motions: ``"boundary-equilibrium"``, ``"rub-fold"`` or ``"rolling-limit"`` (rolling in backward whirl
        begins or ceases to hold at every angle) or ``"levitation-lost"`` (of the planar rotor where small vibrations grow).
    numbers : Numbers or None
        Parameters there, if the closed form gives it; with negative ``mu`` for orbits with backward slip.  ``None`` where
        ``shot`` holds the orbit and its rotor.  Where a machine without closed forms loses levitation, the rotor.
    period, radial_speed : float
        Those of the orbit, in ``1/Ω`` and ``c_r Ω``; ``nan`` for steady motions.
    name : str
        The motion: the name of the orbit (where two orbits of the closed form meet, of the one with the longer period or
        the higher speed), ``"contact-free"``, ``"rub"``, ``"rolling"``, or ``"rubbing 1"`` and so on.
    parameter : str
        Parameter along which it was found.
    value : float
        Its value, in SI units if it is physical.
    admissible : bool
        Whether it happens to a motion of the machine, or to one that just becomes or ceases to be one.
    detail : str
        For a boundary equilibrium ``"persistence"`` (levitation turns into a rub) or ``"non-smooth fold"``
        (levitation and an unstable rub vanish together); where levitation is lost, on which side of the value, and why.
    place : float
        Position on the branch: index of the point before it plus the fraction of the step; ``nan`` without a branch.
    shot : Orbit or None
        The orbit there; ``None`` for one with one impact a period, of which the closed form gives all from the numbers,
        the period and the radial speed.
    """

    shown: ClassVar[tuple[str, ...]] = (
        "kind",
        "name",
        "parameter",
        "value",
        "period",
        "radial_speed",
        "admissible",
        "detail",
    )

    kind: str
    # Not narrower: the closed form reads the numbers.
    numbers: Any
    period: float = math.nan
    radial_speed: float = math.nan
    name: str = ""
    parameter: str = ""
    value: float = math.nan
    admissible: bool = True
    detail: str = ""
    place: float = math.nan
    # Not narrower: a word of impacts, or closed on the flow of the simulator.
    shot: Any = None

    def line_of(self, name: str, value: object) -> str:
        """The value is stated in the unit of the parameter."""
        if name == "value" and self.parameter and isinstance(value, float):
            known = getattr(self.at, "varied", {})
            return format_entry(known.get(self.parameter, self.parameter), value, 6)
        return super().line_of(name, value)

    @property
    def known_scales(self) -> Scales | None:
        """Scales of the machine there."""
        if self.shot is not None:
            return self.shot.known_scales
        units = getattr(self.numbers, "units", None)
        return None if units is None else Scales(*units)

    @classmethod
    @checked
    def near(cls, kind: str, machine: Subject, period: float = math.nan, radial_speed: float = math.nan) -> Bifurcation:
        """A point at or near a bifurcation, for a curve to start from.

        Parameters
        ----------
        kind : str
            One of :data:`~carom.bifurcations.KINDS`.
        machine : Machine, Case, Parameters or model
        period, radial_speed : float
            Those of the orbit; left out for steady motions.
        """
        return cls(kind, Numbers.of(exact_rotor_of(machine).parameters), period, radial_speed)

    @classmethod
    def of(
        cls, kind: str, orbit: Orbit | SimulatedOrbit, parameter: str, value: float, place: float, *, real: bool = True
    ) -> Bifurcation:
        """A special point of orbits that have no closed form."""
        at = orbit.period, orbit.radial_speed, orbit.name, parameter, value, real
        return cls(kind, None, *at, place=place, shot=orbit)

    @property
    def at(self) -> Any:
        """What tells the values of parameters there: numbers, or the rotor."""
        return self.numbers if self.shot is None else self.shot.rotor

    @property
    def motion(self) -> MotionKind:
        """Kind of the motion: an orbit, a steady motion, or bouncing with rub."""
        if self.shot is not None and not self.shot.flies:
            return "rubbing"
        return STEADY.get(self.kind, "orbit")

    @cached_property
    def orbit(self) -> Orbit:
        """The orbit there.

        Raises
        ------
        InputError
            It happens to another motion.
        """
        if self.shot is not None:
            return self.shot
        if not isinstance(self.name, OrbitName):
            unnamed = self.name or "a motion without a name"
            raise InputError("bifurcation", f"{self.kind} of {unnamed}", "one of an orbit")
        return orbit_of(self.numbers, self.name.pair, self.period, self.radial_speed)


def kinds_in_a_line(special: Iterable[Bifurcation]) -> str:
    """Kinds of the special points of a branch, in its order."""
    return ", ".join(point.kind for point in special) or "none"
