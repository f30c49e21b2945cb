"""Flights of all kinds, run through the kernel and the high-precision reference, and the count of what was missed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from flint import acb
from reference import Crossing, Flight, first_crossing, jeffcott_flight, unit

from carom.base.outcome import Outcome
from carom.core import events
from carom.core.advance import advance
from carom.core.block import load_products
from carom.core.event_log import EventLog
from carom.core.flow import displacement, squared_modulus, velocity
from carom.core.lanes import CLEARED, LATE, OPEN, fly_lanes, lanes_record
from carom.core.layout import LEVELS, rotor_record, rub_workspace, workspace
from carom.core.phases import AWAY, FLIGHT
from carom.core.settling import memory
from carom.models import Rotor, jeffcott
from carom.parameters import Parameters

EPSILON = 2.0**-52
NOISE = 4.0 * EPSILON
"""Relative rounding error of a term of ``y``: about eight operations on it, each wrong by half a spacing of doubles."""
GRAZING_NOISE = 16.0 * EPSILON
"""The same as the kernel states it for what it calls grazing."""


def plain_record(exponents, driven, offsets, rows) -> np.record:
    """A rotor with one plane, whose wall nothing is asked of."""
    one = np.ones(1)
    columns = np.ones((len(exponents), 1), complex)
    given = {"exponents": exponents, "driven": driven, "offsets": offsets, "rows": rows, "columns": columns}
    return rotor_record(**given, friction=np.zeros(1), restitution=one, surface_speed=one)


@dataclass
class Tally:
    """What became of the flights of a scenario."""

    scenario: str
    tried: int = 0
    contact: int = 0
    clear: int = 0
    grazing: int = 0
    missed: int = 0
    spurious: int = 0
    unjustified_grazing: int = 0
    worst_time_error: float = 0.0
    worst_share_of_bound: float = 0.0
    examples: list[str] = field(default_factory=list)

    def check(self) -> None:
        """Fail if any flight went wrong."""
        wrong = self.missed + self.spurious + self.unjustified_grazing
        assert wrong == 0, f"{self}"
        assert self.worst_share_of_bound <= 1.0, f"{self}"

    def note(self, verdict: str, example: tuple[str, float, Crossing | None, Task]) -> None:
        """Count a verdict and keep the first few examples of those that are wrong."""
        setattr(self, verdict, getattr(self, verdict) + 1)
        if verdict in ("missed", "spurious", "unjustified_grazing") and len(self.examples) < 5:
            outcome, time, expected, task = example
            self.examples.append(
                f"{verdict}: {outcome} at {time!r}, expected {expected}, amplitudes {task.amplitudes!r}, {task.arrays!r}"
            )


@dataclass(frozen=True)
class Task:
    """A flight as the reference sees it, and as the kernel does."""

    flight: Flight
    arrays: np.record
    table: np.record
    amplitudes: np.ndarray
    plane: int = 0
    radial_speed: float | None = None

    @property
    def start(self) -> int:
        """How the flight starts, for the kernel."""
        return events.INSIDE if self.radial_speed is None else events.LEAVING

    def noise(self, time: float, relative: float = NOISE) -> float:
        """Rounding error of ``f`` at a time that doubles cannot avoid.

        Each term of ``y`` carries a relative rounding error, and its phase one of ``|λ|t`` spacings.  On the wall ``f``
        is zero by definition and grows from there at a rate with the same relative error.
        """
        spread, phase = self.flight.spread(time), self.flight.fastest * time
        away = 2.0 * relative * spread * (1.0 + phase)
        if self.radial_speed is None:
            return away
        speed = float(abs(self.flight.state(0.0)[1]).upper())
        return min(away, 2.0 * relative * spread * (self.flight.fastest + speed) * time * (1.0 + phase))


def by_kernel(task: Task, horizon: float) -> tuple[int, float]:
    """Outcome and time of the first crossing, by the kernel for single motions."""
    work = workspace(len(task.amplitudes))
    return events.first_crossing(task.arrays, task.table, task.plane, task.amplitudes, horizon, task.start, work)


def board(lanes: np.record, lane: int, task: Task) -> None:
    lower, upper = task.amplitudes
    lanes.lower_re[lane], lanes.lower_im[lane] = lower.real, lower.imag
    lanes.upper_re[lane], lanes.upper_im[lane] = upper.real, upper.imag
    inside = task.start == events.INSIDE
    lanes.level[lane] = abs(task.arrays.offsets[0] + upper) ** 2 - 1.0 if inside else 0.0
    lanes.clock[lane], lanes.depth[lane], lanes.quiet[lane], lanes.due[lane] = 0.0, 0.0, 0.0, 1e9


def by_lane(lane: int, undecided: list[Task]) -> Callable[[Task, float], tuple[int, float]]:
    """First crossing in one of the lanes; what none of its proofs decides, by the kernel for single motions."""

    def search(task: Task, horizon: float) -> tuple[int, float]:
        lanes = lanes_record()
        board(lanes, lane, task)
        while True:
            fly_lanes(task.arrays, task.table, horizon, lanes)
            verdict = lanes.verdict[lane]
            if verdict == LATE:
                return Outcome.CLEAR, horizon
            if verdict == OPEN and lanes.depth[lane] >= LEVELS:
                undecided.append(task)
                return by_kernel(task, horizon)
            if verdict not in (CLEARED, OPEN):
                return Outcome.CONTACT, lanes.clock[lane]

    return search


def by_advance(task: Task, horizon: float) -> tuple[int, float]:
    """The same by the event loop: to the first event of the motion."""
    contact, log = np.array([AWAY if task.radial_speed is None else FLIGHT]), EventLog.empty(1, len(task.amplitudes))
    scratch = memory(len(task.amplitudes)), workspace(len(task.amplitudes)), rub_workspace(len(task.amplitudes))
    outcome, time, events = advance(task.arrays, task.table, task.amplitudes.copy(), horizon, contact, log, *scratch)
    if events > 0:
        return Outcome.CONTACT, float(log.times[0])
    return (Outcome.CLEAR if outcome == Outcome.TIME_REACHED else outcome), time


def compare(
    task: Task, horizon: float, tally: Tally, search: Callable[[Task, float], tuple[int, float]] = by_kernel
) -> Crossing | None:
    """Fly a task both ways and enter the verdict in the tally."""
    expected = first_crossing(task.flight, horizon, task.radial_speed)
    code, time = search(task, horizon)
    outcome = Outcome(code)
    tally.tried += 1
    example = (outcome.label, time, expected, task)
    if outcome is Outcome.GRAZING:
        peak_time, peak = task.flight.peak(time)
        # A crossing just before the peak belongs to it.
        same = expected is None or expected.time > time or abs(task.flight.peak(expected.time)[0] - peak_time) < 1e-6
        justified = abs(peak) <= task.noise(peak_time, GRAZING_NOISE) and same
        tally.note("grazing" if justified else "unjustified_grazing", example)
    elif expected is None:
        tally.note("clear" if outcome is Outcome.CLEAR else "spurious", example)
    elif outcome is Outcome.CLEAR:
        tally.note("missed", example)
    else:
        _note_time(task, expected, time, tally, example)
    return expected


def _note_time(task: Task, expected: Crossing, time: float, tally: Tally, example: tuple) -> None:
    error, allowed = abs(time - expected.time), _time_bound(task, expected)
    if error > 1e3 * allowed + 1e-9:
        tally.note("missed" if time > expected.time else "spurious", example)
        return
    tally.note("contact", example)
    tally.worst_time_error = max(tally.worst_time_error, error)
    tally.worst_share_of_bound = max(tally.worst_share_of_bound, error / allowed)


def _time_bound(task: Task, expected: Crossing) -> float:
    """Shift of the root of ``f't + f''t²/2`` by a rounding error of ``f``, plus the spacing of doubles at that time."""
    noise, bend = task.noise(expected.time), abs(float(task.flight.level(expected.exact_time)[2]))
    square = expected.slope**2 - 2.0 * bend * noise
    return 2.0 * noise / (expected.slope + math.sqrt(max(square, 0.0))) + 2.0 * EPSILON * expected.time


def random_parameters(rng: np.random.Generator, index: int) -> Parameters:
    """Underdamped, overdamped, now and then exactly and nearly critical."""
    gamma, omega = 10.0 ** rng.uniform(-3.0, 1.0), rng.uniform(0.1, 3.0)
    if index % 5 == 0:
        gamma = 2.0 * omega
    elif index % 7 == 0:
        gamma = 2.0 * omega * (1.0 + 10.0 ** rng.uniform(-15.0, -2.0))
    return parameters(gamma, omega, rho=rng.uniform(0.0, 1.5), phi=rng.uniform(0.0, 2.0 * math.pi))


def parameters(gamma: float, omega: float, **others: float) -> Parameters:
    """Parameters of a rotor of which only the flight matters."""
    return Parameters(gamma=gamma, omega=omega, **{"rho": 0.4, "phi": 0.2, **others}, mu=0.1, d=0.9, radius_ratio=50.0)


def inside_task(rotor: Rotor, rng: np.random.Generator) -> Task:
    """A start anywhere inside, with a speed of 1e-3 to 10 in any direction."""
    position = math.sqrt(rng.uniform()) * _direction(rng)
    return task_from_state(rotor, position, 10.0 ** rng.uniform(-3.0, 1.0) * _direction(rng))


def task_from_state(rotor: Rotor, position: complex, velocity: complex) -> Task:
    """A start inside the wall."""
    flight = flight_of(rotor.parameters, acb(position), acb(velocity))
    return Task(flight, rotor.system.arrays, rotor.system.table, rotor.system.amplitudes(position, velocity))


def wall_task(rotor: Rotor, angle: float, radial_speed: float, angular_speed: float) -> Task:
    """A start on the wall: for the reference exactly at this angle with these speeds, for the kernel rounded."""
    normal = unit(angle)
    velocity = acb(radial_speed, angular_speed) * normal
    flight = flight_of(rotor.parameters, normal, velocity)
    amplitudes = rotor.system.amplitudes(complex(normal), complex(velocity))
    return Task(flight, rotor.system.arrays, rotor.system.table, amplitudes, radial_speed=radial_speed)


def random_wall_task(rotor: Rotor, rng: np.random.Generator, kind: int) -> Task | None:
    """A start on the wall: fast, as late in a chatter, slow, or along the wall; ``None`` if that one cannot leave."""
    radial_speed = (
        -(10.0 ** rng.uniform(-3.0, 1.0)),
        -rng.uniform(0.5e-6, 2e-6),
        -(10.0 ** rng.uniform(-9.0, -3.0)),
        0.0,
    )[kind]
    angular_speed = rng.normal() * 10.0 ** rng.uniform(-3.0, 1.0)
    task = wall_task(rotor, rng.uniform(0.0, 2.0 * math.pi), radial_speed, angular_speed)
    # Along the wall it leaves only if it is pulled off by more than rounding.
    return None if radial_speed == 0.0 and not task.flight.level(0.0)[2] < -1e-10 else task


def near_grazing_task(rotor: Rotor, rng: np.random.Generator) -> tuple[Task, float] | None:
    """A flight that later has an extremum of ``|U|`` at ``1 ± δ``, and that time; found by flying back from there.

    It starts inside, or on the wall if the way back leads there.  ``None`` if the extremum is no outermost one.
    """
    excess = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-12.0, -2.0)
    position = (1 + acb(excess)) * unit(rng.uniform(0.0, 2.0 * math.pi))
    velocity = acb(0, rng.normal() * 10.0 ** rng.uniform(-2.0, 0.7)) * position
    flight = flight_of(rotor.parameters, position, velocity)
    if not flight.level(0.0)[2] < 0:
        return None
    longest = rng.uniform(0.05, 4.0)
    times = np.linspace(0.0, longest, 25)[1:]
    for i, back in enumerate(times):
        if not flight.level(-back)[0] < 0:
            return None if i < 2 else _from_wall(rotor, flight, times[i - 1], back)
    state = flight.state(-longest)
    if not flight.level(-longest)[0] < -1e-3:
        return None
    return task_from_state(rotor, complex(state[0]), complex(state[1])), longest


def _from_wall(rotor: Rotor, flight: Flight, inside: float, outside: float) -> tuple[Task, float] | None:
    for _ in range(60):
        middle = 0.5 * (inside + outside)
        if flight.level(-middle)[0] < 0:
            inside = middle
        else:
            outside = middle
    position, velocity, _ = flight.state(-inside)
    local = complex(position.conjugate() * velocity)
    if local.real >= -1e-6:
        return None
    angle = float(position.arg())
    return wall_task(rotor, angle, local.real, local.imag), inside


def flight_of(parameters: Parameters, position: acb, velocity: acb) -> Flight:
    """Reference flight of a rotor with these parameters."""
    return jeffcott_flight(parameters.gamma, parameters.omega, parameters.rho, parameters.phi, position, velocity)


def rotors(seed: int, count: int) -> list[tuple[Rotor, np.random.Generator]]:
    """Random rotors, each with a random generator of its own."""
    made = []
    for index in range(count):
        rng = np.random.default_rng([seed, index])
        made.append((jeffcott(random_parameters(rng, index)), rng))
    return made


def flights_that_cross(seed, count):
    """Flights from inside that cross the wall on the longest block, and their crossings."""
    for rotor, rng in rotors(seed, count):
        for _ in range(20):
            task = inside_task(rotor, rng)
            crossing = first_crossing(task.flight, longest_block(task))
            if crossing is not None and crossing.slope > 1e-2:
                yield rotor, rng, task, crossing
                break


def at_start(task):
    """A flight as the parts of the search get it: workspace, displacement, ``f``, size of the terms and bounds."""
    work = workspace(len(task.amplitudes))
    work.current[:] = task.amplitudes
    origin = displacement(task.arrays, task.plane, task.amplitudes)
    load_products(task.arrays, task.plane, origin, work)
    level = squared_modulus(origin) - 1.0 if task.start == events.INSIDE else 0.0
    spread = events._spread(task.arrays, task.plane, task.amplitudes)
    return work, origin, level, spread, events._bounds(task.table, work)


def longest_block(task):
    return float(task.table.durations[0])


def _direction(rng: np.random.Generator) -> complex:
    return complex(np.exp(2j * math.pi * rng.uniform()))


def complex_normal(rng, *shape):
    return rng.normal(size=shape) + 1j * rng.normal(size=shape)


def by_steps(task, horizon):
    """Outcome and time of the first crossing on the longest block by certified steps alone; checks the state there."""
    work, origin, level, spread, bounds = at_start(task)
    outcome, time = events._step_safely(
        task.arrays, task.table, task.plane, origin, level, task.start, spread, horizon, bounds, work
    )
    if outcome == Outcome.CONTACT:
        position, speed, _ = (complex(value) for value in task.flight.state(time))
        noise = 16 * EPSILON * task.flight.spread(time) * (1.0 + task.flight.fastest * time)
        assert abs(displacement(task.arrays, task.plane, work.end) - position) <= noise
        assert abs(velocity(task.arrays, task.plane, work.end) - speed) <= noise * (1.0 + task.flight.fastest)
    return outcome, time
