"""A compliant touchdown bearing: the table ``[touchdown]`` of a machine file."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Set
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from carom.base.outcome import InputError, shown, together
from carom.parameters.ball_heat import OF_HEAT, OF_TORQUE, BallHeat
from carom.parameters.formats import number
from carom.parameters.tables import DOWN, entries_of, entry

if TYPE_CHECKING:
    from carom.parameters.balls import BallRing, PowerLaw

LAWS = ("rigid", "kelvin-voigt", "hunt-crossley")
"""Laws of contact that a machine file may name."""
OF_LAW = ("stiffness", "damping", "dissipation", "restitution", "restitution_speed", "exponent")
"""Entries that belong to the law of a compliant touchdown bearing; the others are of race, mount and place, or of the balls."""
_NEEDED_OF_BALLS = ("balls", "ball_diameter", "race_diameter")
OF_BALLS = (
    *_NEEDED_OF_BALLS,
    *("conformity", "outer_conformity", "contact_angle", "internal_clearance", "preload", "rows"),
    *("ball_modulus", "race_modulus", "ball_density"),
)
"""Entries of its balls: they change motions where the stiffness is left out, or where a density adds their inertia to that of the race."""
OF_LIFE = ("dynamic_rating", "static_rating")
"""Ratings of the catalogue, which change no motion."""
OF_CATALOGUE = (*OF_BALLS, *OF_LIFE, *OF_TORQUE, *OF_HEAT)
"""All entries that a bearing of the catalogue has beside its law, race and mount."""
_MM, _GPA = ("mm", 1e-3), ("GPa", 1e9)
_OF_MOUNT, _PER_ROW = ("mount_mass", "mount_stiffness"), 5
_LOST_IN_MOUNT = ("mount_loss_factor", "mount_loss_frequency")
_PALMGREN = ("torque_factor", "load_factor", "viscosity")
_TOGETHER = (
    (("offset_direction",), ("offset",), "a direction needs the distance too"),
    (("race_drag",), ("race_inertia",), "a race with drag needs it"),
    ((*_OF_MOUNT, "mount_damping", *_LOST_IN_MOUNT), _OF_MOUNT, f"a mount needs {' and '.join(_OF_MOUNT)}"),
    (_LOST_IN_MOUNT, _LOST_IN_MOUNT, "a loss factor and the frequency at which it holds belong together"),
    ((*OF_BALLS, *OF_HEAT, *_PALMGREN), _NEEDED_OF_BALLS, f"the data of balls need {', '.join(_NEEDED_OF_BALLS)}"),
    (OF_TORQUE, ("race_inertia",), "a torque of the balls needs a race that turns"),
    (("torque_factor",), ("viscosity",), "the viscous torque needs it"),
    (OF_HEAT, ("race_mass",), "temperatures need it"),
    (("dynamic_rating",), ("race_inertia",), "a share of the life needs a race that turns"),
    (("preload",), ("contact_angle",), "an axial preload needs it"),
    (("ball_density",), ("race_inertia",), "it adds the inertia of the balls to that of the race"),
)
"""Entries any of which needs others, and why."""
_ON_MOUNT = "it is that of the rotor on a fixed bearing; on a mount give the damping or dissipation of the bearing"
_AT_WHICH_SPEED = "the restitution of hunt-crossley changes with the speed of the impact: state that of this one"
_Rule = tuple[str, str, bool]
"""An entry, why it must be left out or given, and whether that applies."""
PREFIX = "touchdown_"
"""Before the names of these entries where they stand beside those of the machine, as in ``--set touchdown_stiffness=1e8 N/m``."""
_POWERED = re.compile(r"(?P<number>.*?)\s*N/m(?:\^|\*\*)\(?[0-9./]+\)?")
"""A stiffness of another exponent than 1: its unit is a newton by that power of a metre."""

_FRACTION = re.compile(r"([0-9]{1,3})\s*/\s*([1-9][0-9]{0,2})")


class TurningRace(NamedTuple):
    """Inner race of a touchdown bearing: moment of inertia, kg m², and drag torque per speed, N m s."""

    inertia: float
    drag: float


class Mount(NamedTuple):
    """What a touchdown bearing sits on: mass, kg, damping, N s/m, and stiffness, N/m."""

    mass: float
    damping: float
    stiffness: float


@dataclass(frozen=True)
class TouchdownBearing(BallHeat):
    """A touchdown bearing whose force grows with the depth to which the rotor presses into it.

    Every value is a number in the SI unit below, or text with a unit such as ``"1e8 N/m"``.

    Parameters
    ----------
    law : str
        ``"kelvin-voigt"``: the force ``kδ + cδ̇``, which cannot pull; ``"hunt-crossley"``: ``kδⁿ(1 + χδ̇)``; ``"rigid"``: a wall with
        this restitution, or by default that of the machine, which may have a race, a mount and an offset too.
    stiffness : float or str
        ``k``, N/m, or N/mⁿ.  A bearing with the law of Hunt–Crossley that states its balls may leave out stiffness and exponent: they
        are then those of the power law nearest to the force of all balls (:class:`carom.closed_forms.BallRing`).
    damping : float or str, optional
        ``c``, N s/m.
    dissipation : float or str, optional
        ``χ``, s/m.
    restitution, restitution_speed : float or str, optional
        In place of damping or dissipation: radial speed after an impact over that before it, of the rotor alone.  That of
        Hunt–Crossley changes with the speed of the impact, which has to be stated, m/s.
    exponent : float or str, optional
        ``n`` of Hunt–Crossley: 3/2 for balls, 10/9 for rollers, 1 by default.
    race_inertia, race_drag : float or str, optional
        Inner race that turns: moment of inertia with what turns with it, kg m², and torque that slows it down per speed, N m s.
        Without an inertia it stands still.  With ``ball_density`` the balls are added to it.
    mount_mass, mount_stiffness, mount_damping : float or str, optional
        Mass on which the bearing sits, kg, and what holds that, N/m and N s/m: a corrugated ribbon, a tolerance ring, O-rings.  Without these it is fixed.
    mount_loss_factor, mount_loss_frequency : float or str, optional
        In place of a damping: loss factor ``η`` of the mount at a frequency ``f``, Hz, for which the damper ``ηk/(2πf)`` stands; away from it the
        damper loses in proportion to the frequency, a mount with a constant factor does not.
    offset, offset_direction : float or str, optional
        Where the centre of the bearing lies, seen from the place at which levitation holds the rotor: distance, m, and angle in the
        fixed frame from its x axis in the sense of rotation, rad; down the y axis by default.  Positions are counted from that centre.
    balls : int or str, optional
        Number of the balls that share the force, in all rows: five or more in each.  The peak force then gives the largest load of a
        ball and its pressure; ``balls`` needs both diameters.
    ball_diameter, race_diameter : float or str, optional
        Diameter of a ball, and of the inner race at the bottom of its groove, m: the pitch diameter is the sum of both.
    conformity, outer_conformity : float or str, optional
        Radius of the groove of the inner and of the outer race over the diameter of a ball, 0.52 by default.
    ball_modulus, race_modulus : float or str, optional
        Elastic moduli, Pa; 208 GPa, that of steel, by default.
    contact_angle : float or str, optional
        Angle of the line through both contacts of a ball from the radial direction, rad; 0 by default.
    internal_clearance : float or str, optional
        Diametral clearance of the balls, m.  Depths count from where the first ball is pressed: the clearance of the rotor stays as stated.
    preload : float or str, optional
        Axial force on each row, N, in place of a clearance.
    rows : int or str, optional
        1 by default, or 2 with opposite contact angles.
    ball_density : float or str, optional
        Density of the balls, kg/m³: their inertia, rolling on the outer race, is added to ``race_inertia``, which then is that of the race alone.
    dynamic_rating, static_rating : float or str, optional
        Dynamic and static load rating ``C`` and ``C_0`` of the catalogue, N: a landing has a share of the life, and a static limit.
    **others
        Torque and temperatures, by keyword alone: ``starting_torque`` to ``temperature`` of the machine file.

    Raises
    ------
    InputError
        A value is not of this kind or out of range, one that the law needs is missing, or one is given that it does not have.
    """

    law: str = "rigid"
    stiffness: float | None = entry("k_t", "stiffness of the touchdown bearing", "N/m", 1e-6, 1e18, '"1e8 N/m"')
    damping: float | None = entry("c_t", "damping of the touchdown bearing", "N s/m", 1e-12, 1e12, '"500 N s/m"', True)
    dissipation: float | None = entry("chi", "dissipation of the touchdown bearing", "s/m", 0.0, 1e6, '"0.3 s/m"')
    restitution: float | None = entry("d", "restitution at the touchdown bearing", "", 1e-6, 1.0, "0.8")
    restitution_speed: float | None = entry(
        "", "speed of the impact of that restitution", "m/s", 1e-9, 1e4, '"0.1 m/s"'
    )
    exponent: float = entry("n", "exponent of the force over the depth", "", 1.0, 2.0, "1.5", default=1.0)
    race_inertia: float | None = entry("J_r", "inertia of the race", "kg m^2", 1e-15, 1e9, '"2e-4 kg m^2"')
    race_drag: float | None = entry("", "drag torque of the race per speed", "N m s", 1e-15, 1e9, '"1e-4 N m s"', True)
    mount_mass: float | None = entry("", "mass of the mount", "kg", 1e-9, 1e9, '"2 kg"')
    mount_stiffness: float | None = entry("", "stiffness of the mount", "N/m", 1e-6, 1e18, '"2e7 N/m"')
    mount_damping: float | None = entry("", "damping of the mount", "N s/m", 1e-12, 1e12, '"3000 N s/m"', True)
    mount_loss_factor: float | None = entry("η", "loss factor of the mount", "", 1e-9, 10.0, "0.1", True)
    mount_loss_frequency: float | None = entry("", "frequency of that loss factor", "Hz", 1e-6, 1e9, '"150 Hz"')
    offset: float | None = entry("", "distance of the bearing's centre", "m", 1e-12, 1e3, '"0.05 mm"', True, usual=_MM)
    offset_direction: float | None = entry("", "direction of the bearing's centre", "rad", -1e6, 1e6, '"-90 deg"')
    balls: float | None = entry("Z", "balls that share the force", "", 5, 1000, "12", whole=True)
    ball_diameter: float | None = entry("D", "diameter of a ball", "m", 1e-5, 10.0, '"6.35 mm"', usual=_MM)
    race_diameter: float | None = entry(
        "d_i", "diameter of the inner race's groove", "m", 1e-4, 100.0, '"42 mm"', usual=_MM
    )
    conformity: float | None = entry("f", "radius of the groove over the ball diameter", "", 0.501, 1.0, "0.52")
    ball_modulus: float | None = entry("", "elastic modulus of the balls", "Pa", 1e6, 1e13, '"208 GPa"', usual=_GPA)
    race_modulus: float | None = entry("", "elastic modulus of the races", "Pa", 1e6, 1e13, '"208 GPa"', usual=_GPA)
    outer_conformity: float | None = entry("f_o", "the same of the outer race", "", 0.501, 1.0, "0.53")
    contact_angle: float | None = entry(
        "α", "contact angle of the balls", "rad", 1e-3, 1.4, '"15 deg"', True, usual=("°", math.radians(1.0))
    )
    internal_clearance: float | None = entry(
        "P_d", "diametral clearance of the balls", "m", 1e-9, 1e-2, '"10 um"', True, usual=_MM
    )
    preload: float | None = entry("F_a", "axial preload of each row", "N", 1e-6, 1e9, '"100 N"', True)
    rows: float | None = entry("", "rows of balls", "", 1, 2, "2", whole=True)
    ball_density: float | None = entry(
        "", "density of the balls, added to race_inertia", "kg/m^3", 100.0, 1e5, '"7800 kg/m^3"'
    )
    dynamic_rating: float | None = entry("C", "dynamic load rating", "N", 1.0, 1e12, '"20 kN"')
    static_rating: float | None = entry("C_0", "static load rating", "N", 1.0, 1e12, '"12 kN"')

    heading: ClassVar = "touchdown"
    texts: ClassVar = ("law",)

    def __post_init__(self) -> None:
        if self.law not in LAWS:
            raise InputError("law", shown(self.law), f"must be one of {', '.join(LAWS)}")
        if self._is_curved:
            object.__setattr__(self, "stiffness", _without_power(self.stiffness))
        object.__setattr__(self, "exponent", _as_number(self.exponent))
        super().__post_init__()
        if wrong := self._wrong():
            raise together(wrong)

    @property
    def _is_curved(self) -> bool:
        return self.exponent not in (1, "1")

    def _wrong(self) -> list[InputError]:
        """What does not fit together: entries that must be left out, and those that are missing."""
        present = self.given.keys()
        refused, needed = self._rules(present)
        needed += [
            (name, words, not present.isdisjoint(others)) for others, names, words in _TOGETHER for name in names
        ]
        wrong = [
            InputError(name, getattr(self, name), f"must be left out: {words}")
            for name, words, applies in refused
            if applies and name in present
        ] + [InputError(name, None, words) for name, words, applies in needed if applies and name not in present]
        return wrong or self._wrong_balls()

    def _wrong_balls(self) -> list[InputError]:
        """What balls cannot be: too few or too many in a row, or pressed too hard by the preload alone."""
        ring = self.ring
        if ring is None:
            return []
        most = int(math.pi * ring.pitch_diameter / ring.ball_diameter)
        if ring.balls % ring.rows or not _PER_ROW <= ring.balls // ring.rows <= most:
            allowed = f"as many in each row, {_PER_ROW} to the {most} that have room on its pitch circle"
            return [InputError("balls", ring.balls, allowed)]
        if ring.preload and not ring.contact_angle:
            return [InputError("contact_angle", 0.0, "above 0 with an axial preload")]
        if ring.preload and ring.is_overloaded:
            return [InputError("preload", ring.preload, "less: it alone presses the balls with more than 4.2 GPa")]
        return []

    def _rules(self, present: Set[str]) -> tuple[list[_Rule], list[_Rule]]:
        """Entries that a bearing of this law must not have, and those that it needs."""
        if not self.is_compliant:
            others = sorted({*OF_LAW, *OF_CATALOGUE} - {"restitution"})
            return [(name, "the law of a rigid wall has none", True) for name in others], []
        law, is_linear = self.law, self.law == "kelvin-voigt"
        own, other = ("damping", "dissipation") if is_linear else ("dissipation", "damping")
        restitutes, speed = "restitution" in present, "restitution_speed"
        by_balls = not is_linear and "balls" in present and "stiffness" not in present
        refused = [
            (other, f"the law {law} has a {own}", True),
            ("restitution", f"give {own} or restitution, not both", own in present),
            ("exponent", "the law kelvin-voigt has the exponent 1", is_linear),
            (speed, "it belongs to a restitution", not restitutes),
            (speed, "the restitution of kelvin-voigt is the same at all speeds", is_linear and restitutes),
            ("restitution", _ON_MOUNT, not present.isdisjoint(_OF_MOUNT)),
            ("exponent", "it belongs to a stiffness; without one both come from the balls", by_balls),
            ("internal_clearance", "give it or a preload, not both", "preload" in present),
            ("mount_damping", "give it or a loss factor, not both", "mount_loss_factor" in present),
            ("running_torque", f"give it or {', '.join(_PALMGREN)}", not present.isdisjoint(_PALMGREN)),
        ]
        needed = [
            (
                "stiffness",
                f"the law {law} needs it, such as stiffness = '1e8 N/m'{'' if is_linear else ', or balls'}",
                not by_balls,
            ),
            (own, f"the law {law} needs it, or a restitution", not restitutes),
            (speed, _AT_WHICH_SPEED, restitutes and not is_linear),
        ]
        return refused, needed

    @property
    def is_compliant(self) -> bool:
        """Whether the bearing is compliant."""
        return self.law != "rigid"

    @property
    def is_plain(self) -> bool:
        """Whether it is a rigid wall that stands still around the place of levitation, as a machine without this table has."""
        return not self.is_compliant and not self.given

    @property
    def race(self) -> TurningRace | None:
        """Its race, with balls whose density is stated; ``None`` if that stands still."""
        if self.race_inertia is None:
            return None
        rolling = self.ring.inertia(self.ball_density) if self.ring and self.ball_density else 0.0
        return TurningRace(self.race_inertia + rolling, self.race_drag or 0.0)

    @cached_property
    def ring(self) -> BallRing | None:
        """Its balls; ``None`` if it does not state them."""
        if self.balls is None or self.ball_diameter is None or self.race_diameter is None:
            return None
        from carom.parameters.balls import CONFORMITY, STEEL, BallRing  # which loads SciPy

        return BallRing(
            balls=int(self.balls),
            ball_diameter=self.ball_diameter,
            race_diameter=self.race_diameter,
            contact_angle=self.contact_angle or 0.0,
            conformities=(self.conformity or CONFORMITY, self.outer_conformity or CONFORMITY),
            internal_clearance=self.internal_clearance or 0.0,
            preload=self.preload or 0.0,
            rows=int(self.rows or 1),
            moduli=(self.ball_modulus or STEEL, self.race_modulus or STEEL),
        )

    @property
    def law_of_balls(self) -> PowerLaw | None:
        """The law that its stiffness and exponent are taken from; ``None`` if these are stated."""
        return self.ring.law if self.ring and self.is_compliant and self.stiffness is None else None

    @property
    def spring(self) -> tuple[float, float]:
        """Stiffness, N/mⁿ, and exponent, as stated or of its balls."""
        found = self.law_of_balls
        return (self.stiffness or 0.0, self.exponent) if found is None else found[:2]

    @property
    def of_motion(self) -> Set[str]:
        """Names of the entries that change motions, where they are stated."""
        left_out = set(OF_CATALOGUE) - set(OF_BALLS if self.law_of_balls or self.ball_density else ())
        return TOUCHDOWN_FIELDS.keys() - left_out

    @property
    def mount(self) -> Mount | None:
        """Its mount; ``None`` if it is fixed."""
        if self.mount_mass is None or self.mount_stiffness is None:
            return None
        damping = self.mount_damping or 0.0
        if self.mount_loss_factor and self.mount_loss_frequency:
            damping = self.mount_loss_factor * self.mount_stiffness / (2.0 * math.pi * self.mount_loss_frequency)
        return Mount(self.mount_mass, damping, self.mount_stiffness)

    @property
    def centre(self) -> complex:
        """Its centre in the fixed frame, seen from the place at which levitation holds the rotor, m."""
        direction = DOWN if self.offset_direction is None else self.offset_direction
        return cmath.rect(self.offset or 0.0, direction)

    @property
    def given(self) -> dict[str, float]:
        """The entries that are stated, in SI units."""
        return {name: value for name, value in super().given.items() if name != "exponent" or value != 1.0}

    @property
    def words(self) -> str:
        """Law and entries in the units of people, and what comes from the balls."""
        shown_now = [
            f"{name.replace('_', ' ')} {number(field.in_usual_unit(value))} {field.usual or self.unit(name)}".rstrip()
            for name, value in self.given.items()
            for field in [TOUCHDOWN_FIELDS[name]]
        ]
        if found := self.law_of_balls:
            shown_now.append(f"stiffness of its balls {found.words}")
        if (race := self.race) and self.ball_density:
            shown_now.append(f"race with balls {number(race.inertia, 4)} kg m^2")
        return ", ".join([self.law, *shown_now]).replace(" °,", "°,")

    def document(self) -> dict[str, object]:
        """As plain data for JSON: law, entries, and what comes from the balls, in SI units."""
        found = self.law_of_balls
        return {"law": self.law, **self.given, **({} if found is None else {"of_balls": found._asdict()})}

    def unit(self, name: str) -> str:
        """SI unit of an entry."""
        if name == "stiffness" and self._is_curved:
            return f"N/m^{self.exponent:.6g}"
        return super().unit(name)


TOUCHDOWN_FIELDS = entries_of(TouchdownBearing)
"""Entries of a ``[touchdown]`` table beside ``law``, in SI units."""


def _without_power(given: object) -> object:
    """The number of a stiffness in N/mⁿ, with or without its unit."""
    powered = _POWERED.fullmatch(given.strip()) if isinstance(given, str) else None
    return powered["number"] if powered else given


def _as_number(given: object) -> object:
    """The number of a fraction such as ``"10/9"``."""
    fraction = _FRACTION.fullmatch(given.strip()) if isinstance(given, str) else None
    return int(fraction[1]) / int(fraction[2]) if fraction else given
