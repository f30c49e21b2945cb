r"""Torque of the balls of a touchdown bearing, and its temperatures in a landing, from what a motion has recorded.

*Torque* by Palmgren [1]_, of which a motion has the drag in proportion to the speed, ``race_drag``, alone: with the pitch diameter ``d_m`` in mm, the kinematic
viscosity ``ν`` in mm²/s, the speed ``n`` in rpm and the load ``P₁`` in N it is, in N mm,

    M₀ + M₁,      M₀ = 10⁻⁷ f₀ max((νn)^(2/3), 160) d_m³,      M₁ = f₁ P₁ d_m,

with ``P₁`` the radial force ``F``, or ``F_a − 0.1 F`` of a bearing with the preload ``F_a`` of all rows where that is larger [2]_.

*Temperatures.*  Sleeve, race, balls and outer ring are bodies of one temperature each, ``θ`` above that of the beginning: ``Cθ̇ = −Gθ + P(t)``, with the
capacities on the diagonal of ``C`` and conductances in the symmetric ``G``, those to shaft and housing on its diagonal alone.  The heat of
slip goes into sleeve and race, that of the balls' torque into the balls.  With ``Y = C^(1/2)θ`` and the eigenvectors of ``C^(−1/2)GC^(−1/2)`` each coordinate decays
with a rate ``λ ≥ 0``; under a constant power over a time ``h``, which brings the heat ``q``,

    y → e^(−λh) y + q (1 − e^(−λh))/(λh),

which is exact, and so is a motion whose heat is known piece by piece.

*Growth* by heat presses each ball in further, along the line through its contacts under the angle ``α``, by

    ½β[(d_m cos α − D) θ_race − (d_m cos α + D) θ_outer] + β_b D θ_balls,

with the expansions ``β`` of the rings and ``β_b`` of the balls of the diameter ``D``: nothing if all warm up and expand alike, but for the size of what there is.

.. [1] Palmgren, "Ball and Roller Bearing Engineering", SKF Industries (1959).
.. [2] Harris and Kotzalas, "Essential Concepts of Bearing Technology", 5th edition, CRC Press (2006), ch. 10.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple, cast

import numpy as np

from carom.base.arguments import Reals, checked
from carom.base.results import Result, record
from carom.core.wall_work import HEAT, NORMAL
from carom.motions.kinematics import race_speed, shaft_speed
from carom.parameters import TouchdownBearing
from carom.parameters.formats import number

if TYPE_CHECKING:
    from carom.motions.contacts import ContactWorks
    from carom.motions.trajectories import Trajectory
    from carom.parameters import Scales
    from carom.parameters.balls import BallRing

PARTS = ("sleeve", "race", "balls", "outer ring")
"""Bodies of one temperature each."""
SPECIFIC_HEAT, EXPANSION, DENSITY = 460.0, 11.5e-6, 7800.0
"""Of bearing steel: J/(kg K), 1/K and kg/m³."""
DOCUMENT = (
    "at_end highest hottest growth_si=growth clearance_left_si=clearance_left load_by_growth_si=load_by_growth "
    "preload_at_most_si=preload_at_most"
)
NEGLECTED = 0.05
"""Share of the work on a race from which it is said that the motion leaves out that of a torque."""
_SHORT = 1.0
"""Landing, s, up to which heat flow between the parts may be left out."""
ROOM = 20.0
"""Temperature before a landing, °C, where none is stated."""
UP_TO_SPEED = 0.95
"""Surface speed of a race over that of the shaft from which it has come up to speed."""
RESOLVED = 2048
"""Pieces of time of equal length, at least, into which the heat of a motion is gathered."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_AT, _SHARES = 0.5 + 0.5 * _NODES, 0.5 * _WEIGHTS


@checked
def ball_torque(bearing: TouchdownBearing, speed: Reals, load: Reals) -> np.ndarray:
    """Torque, N m, that turns the balls of a bearing, at speeds of the race, rad/s, and radial forces, N.

    It is the running torque where that is stated, otherwise Palmgren's (above), and that of ``race_drag`` where neither is.

    Examples
    --------
    >>> import carom as cm
    >>> size = {"balls": 16, "ball_diameter": "7.94 mm", "race_diameter": "60 mm", "race_inertia": 5e-5}
    >>> bearing = cm.parameters.TouchdownBearing(
    ...     "hunt-crossley", dissipation=0.5, torque_factor=2, load_factor=0.0008, viscosity="30 mm^2/s", **size
    ... )
    >>> print(f"{1e3 * cm.motions.ball_torque(bearing, 1000.0, 500.0):.0f} N mm")
    300 N mm
    """
    turning, load = np.abs(speed), np.asarray(load, float)
    ring = bearing.ring
    if bearing.running_torque is not None:
        return np.full(np.broadcast(turning, load).shape, bearing.running_torque)
    if ring is None or not bearing.has_torque:
        return np.asarray((bearing.race_drag or 0.0) * turning + 0.0 * load)
    size, viscosity = ring.pitch_diameter, 1e6 * (bearing.viscosity or 0.0)
    viscous = np.maximum((viscosity * turning * 30.0 / math.pi) ** (2.0 / 3.0), 160.0)
    pressed = np.maximum(load, ring.rows * ring.preload - 0.1 * load)
    torque: np.ndarray = 0.1 * (bearing.torque_factor or 0.0) * viscous * size**3
    return torque + (bearing.load_factor or 0.0) * pressed * size


@dataclass
class RaceRecord:
    """What a motion does to a race, by its surface speeds in ``c_r Ω``, and the heat at its touchdown bearing.

    ``pieces`` has the heat piece by piece (n, 4): durations, s, heat of slip and of the balls, J, and integral of the race's speed squared, rad²/s.
    """

    pieces: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    began: float | None = None
    fastest: float = 0.0
    ended: float = 0.0
    up_to_speed_at: float | None = None

    def add(self, seen: Trajectory, works: ContactWorks) -> None:
        """Add a piece of a motion, seen at the touchdown bearing."""
        system, amplitudes = seen.rotor.system, seen.edge_amplitudes
        speeds = race_speed(system, seen.plane, amplitudes)
        self.began = float(speeds[0]) if self.began is None else self.began
        self.fastest = float(max(self.fastest, *speeds[[speeds.argmax(), speeds.argmin()]], key=abs))
        self.ended = float(speeds[-1])
        turning = UP_TO_SPEED * (float(system.arrays.surface_speed[seen.plane]) - 1.0)
        fast = np.flatnonzero(speeds >= turning * shaft_speed(system, amplitudes))
        if self.up_to_speed_at is None and fast.size:
            self.up_to_speed_at = float(seen.begins + np.append(seen.segment_starts, seen.time)[fast[0]])
        if seen.scales is not None:
            found = _heats(seen, works, seen.scales)
            self.pieces = _gathered(np.concatenate([self.pieces, found]), 4 * RESOLVED)


def _heats(seen: Trajectory, works: ContactWorks, scales: Scales) -> np.ndarray:
    """The same of each segment; the speed of a race is linear in contact, beside the decay by its drag, which is exact in flight."""
    race, bearing = seen.rotor.races[seen.plane], seen.rotor.definition.bearing_at(seen.plane)
    lasted = seen.durations
    slip, impulse, found = np.zeros(len(lasted)), np.zeros(len(lasted)), np.zeros((len(lasted), 4))
    slip[works.segments], impulse[works.segments] = works.found[:, seen.plane, [HEAT, NORMAL]].T
    found[:, 0], found[:, 1] = lasted * scales.time, slip * scales.energy
    if race is None:
        return found
    system = seen.rotor.system
    before = race_speed(system, seen.plane, seen.segment_amplitudes)
    after = race_speed(system, seen.plane, seen.ends_of(np.arange(len(lasted))))
    kept = np.exp(race.exponent * lasted[:, None] * np.append(_AT, 1.0))
    gained = after - before * kept[:, -1]
    speeds = (before[:, None] * kept[:, :-1] + gained[:, None] * _AT) * scales.speed / race.radius
    loads = impulse / np.where(lasted > 0.0, lasted, 1.0) * scales.force
    found[:, 3] = speeds**2 @ _SHARES * found[:, 0]
    if bearing is not None:
        found[:, 2] = (ball_torque(bearing, speeds, loads[:, None]) * np.abs(speeds)) @ _SHARES * found[:, 0]
    return found


def _gathered(pieces: np.ndarray, most: int) -> np.ndarray:
    """Pieces of time put together where there are more, each with a part of the time; longer ones stay as they are."""
    if len(pieces) <= most:
        return pieces
    ends = np.cumsum(pieces[:, 0])
    bins = np.ceil(ends * (RESOLVED / ends[-1]))
    gathered: np.ndarray = np.add.reduceat(pieces, np.flatnonzero(np.diff(bins, prepend=-1.0)))
    return gathered


class RaceRun(NamedTuple):
    """How the race of a ball bearing was turned; ``None`` where it stands still, or where the touchdown bearing does not state what that needs."""

    speed_ratio: float | None = None
    """Speed of the race over that of the shaft, at the end."""
    cage_speed: float | None = None
    """Speed of the cage at the end, in ``Ω``, if the balls roll: ``½(1 − D cos α/d_m)`` of that of the race."""
    up_to_speed_at: float | None = None
    """Time from the release after which the race's surface first has 95 % of the speed of the shaft's, ``1/Ω``, to within a step."""
    ball_traction: float | None = None
    """Share of their load that the balls need as traction to follow the race while the rotor slips on it: they skid where the oil film gives less."""
    heat: float | None = None
    """Heat of the torque of the balls, or of the drag of the race where none is stated, ``m c_r² Ω²``."""
    torque: float | None = None
    """Torque of the balls at the peak force and the speed at the end, N m."""
    neglected: float | None = None
    """What that takes beyond the drag that acts in the motion, over the work on the race: that of the drag, and what its fastest speed holds."""
    drag: float | None = None
    """``race_drag`` that takes as much as that torque in this motion, N m s."""
    starts_at: float | None = None
    """Normal force from which friction overcomes the starting torque, N; in the motion the race turns under any."""

    @property
    def torque_words(self) -> str | None:
        """The torque in words; ``None`` where none is stated."""
        if self.torque is None:
            return None
        if self.neglected is None or self.drag is None or abs(self.neglected) < NEGLECTED:
            return f"{number(self.torque, 3)} N m at the peak force"
        return (
            f"{number(self.torque, 3)} N m at the peak force; it takes {number(100.0 * abs(self.neglected), 2)} % of the work on the race "
            f"{'more' if self.neglected > 0.0 else 'less'} than the race_drag in the motion; race_drag = {self.drag:.2g} N m s would take as much over this motion"
        )


def race_run(last: Trajectory, record: RaceRecord, force: float) -> RaceRun:
    """How a race was turned in a recorded motion with a peak force, N."""
    race, bearing, scales = last.rotor.races[last.plane], last.rotor.definition.bearing_at(last.plane), last.scales
    if race is None:
        return RaceRun()
    began, fastest, ends = (each / race.radius for each in (record.began or 0.0, record.fastest, record.ended))
    spin = float(shaft_speed(last.rotor.system, last.last_amplitudes))
    found = RaceRun(ends / spin if spin else None, up_to_speed_at=record.up_to_speed_at)
    if bearing is None or scales is None:
        return found
    *_, heat, turned = record.pieces.sum(axis=0).tolist()
    friction, radius = float(last.rotor.system.arrays.friction[last.plane]), race.radius * scales.length
    work = 0.5 * race.inertia * (fastest**2 - began**2) * scales.energy + (
        dragged := (bearing.race_drag or 0.0) * turned
    )
    found = found._replace(
        heat=heat / scales.energy,
        starts_at=bearing.starting_torque and friction and bearing.starting_torque / (friction * radius),
    )
    if bearing.has_torque and turned > 0.0 and work > 0.0:
        torque = float(ball_torque(bearing, np.array(ends * scales.speed), np.array(force)))
        found = found._replace(torque=torque, neglected=(heat - dragged) / work, drag=heat / turned)
    if (ring := bearing.ring) is None:
        return found
    inner = 0.5 * (ring.pitch_diameter - ring.ball_diameter * math.cos(ring.contact_angle))
    if bearing.ball_density:
        share = ring.inertia(bearing.ball_density) / (race.inertia * scales.mass * scales.length**2)
        found = found._replace(ball_traction=friction * radius * share / inner)
    return found._replace(cage_speed=ends * inner / ring.pitch_diameter)


class Network(NamedTuple):
    """Bodies that exchange heat, in SI units."""

    capacities: np.ndarray
    """J/K, shape (n,)."""
    conductances: np.ndarray
    """``G``, W/K, shape (n, n), symmetric: what leaves a body per its temperature is on the diagonal, to bodies of constant temperature too."""

    @checked
    def rises(self, durations: Reals, heats: Reals) -> np.ndarray:
        """Return the temperatures, K above the beginning, shape (k + 1, n), after each of ``k`` pieces of time, s, with a constant power each, of heats, J, shape (k, n)."""
        root = np.sqrt(self.capacities)
        rates, shapes = np.linalg.eigh(self.conductances / np.outer(root, root))
        passed = np.maximum(rates, 0.0) * np.asarray(durations, float)[:, None]
        added = np.where(passed > 0.0, -np.expm1(-passed) / np.where(passed > 0.0, passed, 1.0), 1.0)
        added *= (np.asarray(heats, float) / root) @ shapes
        kept, found = np.exp(-passed), np.zeros((len(passed) + 1, len(root)))
        for piece in range(len(passed)):
            found[piece + 1] = kept[piece] * found[piece] + added[piece]
        return np.asarray(found @ shapes.T / root)


@checked
def thermal_network(bearing: TouchdownBearing) -> Network | None:
    """Sleeve, race, balls and outer ring of a touchdown bearing, in this order; ``None`` where it does not state the mass of its race."""
    ring, race = bearing.ring, bearing.race_mass
    if ring is None or race is None:
        return None
    size = ring.ball_diameter
    balls = ring.balls * (bearing.ball_density or DENSITY) * math.pi / 6.0 * size**3
    # Two rings of one section have masses like their diameters.
    outer = bearing.outer_mass or race * (ring.race_diameter + 2.0 * size) / ring.race_diameter
    heat = bearing.specific_heat or SPECIFIC_HEAT
    of_balls = bearing.ball_specific_heat or heat
    between = np.diag([bearing.shaft_conductance or 0.0, 0.0, 0.0, bearing.housing_conductance or 0.0])
    for first, through in enumerate(
        (bearing.landing_conductance, bearing.inner_conductance, bearing.outer_conductance)
    ):
        pair = slice(first, first + 2)
        between[pair, pair] += (through or 0.0) * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return Network(
        np.array([heat * (bearing.shaft_mass or race), heat * race, of_balls * balls, heat * outer]), between
    )


@dataclass(frozen=True, eq=False, repr=False)
class Temperatures(Result):
    """Temperatures of a touchdown bearing in a motion, and the growth of its parts, in SI units; where it ends in contact, they rise on.

    Attributes
    ----------
    bearing : TouchdownBearing
    times : ndarray, shape (n,)
        From the release, s.
    values : ndarray, shape (n, 4)
        °C, of the sleeve on the shaft, the race, the balls and the outer ring: the means of these bodies, not the flash in the contact.
    """

    bearing: TouchdownBearing
    times: np.ndarray
    values: np.ndarray

    shown: ClassVar[tuple[str, ...]] = ("highest", "hottest", "at_end", "growth", "clearance_left", "preload_at_most")

    @classmethod
    def of(cls, bearing: TouchdownBearing, record: RaceRecord) -> Temperatures | None:
        """Those of a recorded motion; ``None`` where the bearing does not state the mass of its race."""
        network = thermal_network(bearing)
        if network is None or not len(record.pieces):
            return None
        lasted, slip, rolling, _ = _gathered(record.pieces, RESOLVED).T
        share = 0.5 if bearing.slip_share is None else bearing.slip_share
        rises = network.rises(lasted, np.stack([(1.0 - share) * slip, share * slip, rolling, 0.0 * slip], axis=-1))
        begin = ROOM if bearing.temperature is None else bearing.temperature
        return cls(bearing, np.concatenate([[0.0], np.cumsum(lasted)]), begin + rises)

    @property
    def _ring(self) -> BallRing:
        return cast("BallRing", self.bearing.ring)

    @property
    def at_end(self) -> dict[str, float]:
        """Temperature of each part at the end, °C."""
        return dict(zip(PARTS, self.values[-1].tolist(), strict=True))

    @property
    def highest(self) -> float:
        """Highest temperature of a part, °C."""
        return float(self.values.max())

    @property
    def hottest(self) -> str:
        """The part that reaches it."""
        return PARTS[int(self.values.max(axis=0).argmax())]

    @property
    def warmest(self) -> str:
        """Both in words."""
        return f"{number(self.highest, 3)} °C, {self.hottest}"

    @cached_property
    def closures(self) -> np.ndarray:
        """By how much each ball is pressed in by preload and growth, m, shape (n,); below zero where it has clearance."""
        bearing, ring = self.bearing, self._ring
        _, race, balls, outer = (self.values - self.values[0]).T
        rings = EXPANSION if bearing.expansion is None else bearing.expansion
        of_balls = rings if bearing.ball_expansion is None else bearing.ball_expansion
        size, across = ring.ball_diameter, ring.pitch_diameter * math.cos(ring.contact_angle)
        pressed: np.ndarray = 0.5 * rings * ((across - size) * race - (across + size) * outer) + of_balls * size * balls
        return ring.closure + pressed

    @property
    def growth(self) -> float:
        """Diametral clearance that growth has taken away at most, m; below zero if it has grown."""
        return float((self.closures - self.closures[0])[1:].max(initial=-math.inf)) * self._across

    @property
    def _across(self) -> float:
        """Diametral clearance by depth of a ball."""
        return 2.0 / math.cos(self._ring.contact_angle)

    @property
    def clearance_left(self) -> float:
        """Least diametral clearance of the balls, m; below zero where they are pressed in."""
        return -float(self.closures.max()) * self._across

    @property
    def load_by_growth(self) -> float:
        """Largest load of each ball by preload and growth alone, N; zero where clearance is left."""
        return self._ring.ball_stiffness * max(float(self.closures.max()), 0.0) ** 1.5

    @property
    def preload_at_most(self) -> float | None:
        """Largest preload of each row in the landing, N, the axial position kept; ``None`` of balls without contact angle."""
        ring = self._ring
        if not ring.contact_angle:
            return None
        return self.load_by_growth * ring.balls / ring.rows * math.sin(ring.contact_angle)

    def rows(self) -> list[tuple[str, str]]:
        """Temperatures and growth in rows for people."""
        parts = ", ".join(f"{name} {number(value, 3)} °C" for name, value in self.at_end.items())
        when = float(self.times[int(self.values.max(axis=1).argmax())])
        flows = any(value for name, value in self.bearing.given.items() if name.endswith("conductance"))
        advice = ": state conductances for a landing this long" if self.times[-1] > _SHORT else ""
        alone = f"; without heat flow between them{advice}"
        return [
            ("temperatures at the end", f"{parts}{'' if flows else alone}"),
            ("highest temperature", f"{self.warmest}, {number(when, 3)} s after the release"),
            ("growth by heat", self._growth_words),
        ]

    @property
    def _growth_words(self) -> str:
        ring = self._ring
        taken = f"{number(1e6 * self.growth, 3)} µm of diametral clearance"
        if ring.preload:
            return f"{taken}; the preload rises from {number(ring.preload, 3)} to at most {number(self.preload_at_most or 0.0, 3)} N"
        left = 1e6 * self.clearance_left
        if left >= 0.0:
            return f"{taken}; {number(left, 3)} µm are left"
        load = self.load_by_growth
        pressure = number(1e-9 * ring.pressure_of(load), 3)
        return f"{taken}: more than the {number(1e6 * ring.internal_clearance, 3)} µm there are. WARNING: the balls are clamped, with {number(load, 3)} N each ({pressure} GPa)"

    def document(self) -> dict[str, object]:
        """As plain data for JSON."""
        return record(self, DOCUMENT)
