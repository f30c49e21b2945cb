"""The disturbances out of levitation of which cells are proven: kicks, shocks of the base, steps of the unbalance.

Each is a disc of sizes and directions.  A family says how its largest size is written, and what one of that size counts in the response
of the rotor (:mod:`carom.proofs.starts`).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

from flint import arb

from carom.base.outcome import InputError
from carom.parameters import MACHINE_FIELDS, Field
from carom.parameters.quantities import ExactNumber, read_exact
from carom.proofs.balls import ball_of
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.lines import LineNumbers
from carom.proofs.patches import KICK_START
from carom.proofs.starts import DisturbedStart, Pulse, Step


def read_size(field: Field, text: str, hypotheses: Hypotheses, whole: str = "") -> ExactNumber:
    """One exact number: with a unit of a machine in SI units, a plain number of a dimensionless one."""
    of_machine = hypotheses.table == "machine"
    number = read_exact(
        replace(field, needs_unit=True) if of_machine else replace(field, unit="", kind="a number", example="0.2"), text
    )
    if number.low != number.high:
        raise InputError(field.name, whole or text, f"must be one {field.kind.split(maxsplit=1)[1]}, not an interval")
    return number


def unit_of(hypotheses: Hypotheses, *names: str) -> arb:
    """Product of numbers of a machine; 1 for a dimensionless one."""
    product = arb(1)
    if hypotheses.table == "machine":
        for name in names:
            product = product * ball_of(read_exact(MACHINE_FIELDS[name], hypotheses.values[name]))
    return product


@dataclass(frozen=True)
class Scale:
    """What the sizes of a disc count.

    Attributes
    ----------
    largest : ExactNumber
        The largest size, in the SI unit or dimensionless.
    one : callable
        Gives the dimensionless size of what is 1 in the unit of ``largest``, at the precision at hand.
    gain : callable
        Takes the numbers of a rotor and gives ``v`` of the dimensionless size 1.
    start : callable
        Gives the disturbance of ``v = 1``.
    """

    largest: ExactNumber
    one: Callable[[], arb]
    gain: Callable[[LineNumbers[arb]], arb]
    start: Callable[[], DisturbedStart]


@dataclass(frozen=True)
class DisturbanceFamily:
    """Disturbances out of levitation by size and direction.

    Attributes
    ----------
    about : str
        What they are, as in names of claims.
    option : str
        Name of the largest size, in Python and in certificates.
    size : str
        Name of sizes among enclosures.
    stated : str
        What they are, before the largest size.
    smaller : str
        Each of them below a size.
    reads : callable
        Takes the text of the largest size and the hypotheses, and gives a :class:`Scale`.
    """

    about: str
    option: str
    size: str
    stated: str
    smaller: str
    reads: Callable[[str, Hypotheses], Scale]


_SPEED = Field("kicks_up_to", "V", "largest kick out of levitation", "a velocity", "m/s", 1e-9, 1e9, '"100 mm/s"')
_PEAK = Field("shocks_up_to", "A", "largest peak of a shock", "an acceleration", "m/s^2", 1e-9, 1e12, '"5 g, 11 ms"')
_TIME = Field("shocks_up_to", "T", "duration of a shock", "a time", "s", 1e-9, 1e9, '"5 g, 11 ms"')
_CHANGE = Field("unbalance_up_to", "Δ", "largest change of the unbalance", "a length", "m", 1e-12, 1e9, '"0.1 mm"')
_PRODUCT = Field("unbalance_up_to", "Δ", "change of the unbalance", "an unbalance", "kg m", 1e-15, 1e9, '"2000 g mm"')


def _kicks(text: str, hypotheses: Hypotheses) -> Scale:
    largest = read_size(_SPEED, text, hypotheses)
    return Scale(largest, lambda: 1 / unit_of(hypotheses, "clearance", "speed"), lambda _: arb(1), lambda: KICK_START)


def _shocks(text: str, hypotheses: Hypotheses) -> Scale:
    """A pulse of the peak ``â`` changes the velocity by ``2âT/π``."""
    parts = text.split(",")
    if len(parts) != 2:
        raise InputError("shocks_up_to", text, f"must be the largest peak and the duration, such as {_PEAK.example}")
    peak, lasts = (
        read_size(field, part.strip(), hypotheses, text) for field, part in zip((_PEAK, _TIME), parts, strict=True)
    )

    def duration() -> arb:
        return ball_of(lasts) * unit_of(hypotheses, "speed")

    return Scale(
        peak,
        lambda: 1 / unit_of(hypotheses, "clearance", "speed", "speed"),
        lambda _: 2 * duration() / arb.pi(),
        lambda: Pulse(duration()),
    )


def _steps(text: str, hypotheses: Hypotheses) -> Scale:
    """A change ``Δρ`` of the eccentricity moves levitation by ``|Δρ|/|ω² − 1 + iγ|``; it may be given as an unbalance."""
    largest, sizes = None, ["clearance"]
    if hypotheses.table == "machine":
        with suppress(InputError):
            largest, sizes = read_size(_PRODUCT, text, hypotheses), ["clearance", "mass"]
    largest = largest or read_size(_CHANGE, text, hypotheses)
    return Scale(largest, lambda: 1 / unit_of(hypotheses, *sizes), lambda n: 1 / abs(n.product), Step)


KICKS = DisturbanceFamily(
    "kicks",
    "kicks_up_to",
    "speed",
    "kicks out of levitation, seen in the fixed frame, with velocities in the disc up to",
    "kick slower than the lower end of speed",
    _kicks,
)
SHOCKS = DisturbanceFamily(
    "shocks",
    "shocks_up_to",
    "peak",
    "half-sine shocks of the base out of levitation, in any direction, with a peak up to, and a duration of,",
    "shock with a peak below the lower end of peak",
    _shocks,
)
STEPS = DisturbanceFamily(
    "unbalance steps",
    "unbalance_up_to",
    "change",
    "steps to the unbalance of the machine, out of levitation with another one, with changes in the disc up to",
    "step by less than the lower end of change",
    _steps,
)
FAMILIES = {family.about: family for family in (KICKS, SHOCKS, STEPS)}
"""The families by what they are."""


def at_most(impacts: int) -> str:
    """A bound of a number of impacts in words: ``"at most 1 impact"``."""
    return f"at most {impacts} impact{'' if impacts == 1 else 's'}"
