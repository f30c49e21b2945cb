"""Claims about all states inside the clearance and on its wall up to a speed.

Motions that never return to levitation, such as rubs, whirl and orbits with one impact a period, count by the speed of their slowest state that is known.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from flint import arb

from carom.parameters import Field
from carom.proofs.balls import Enclosure, enclosure_of_fraction, enclosures_of, rational
from carom.proofs.claims import Claim, Document, Evidence, NotShownError, claim_of, rational_of
from carom.proofs.families import read_size, unit_of
from carom.proofs.form_search import search, shown
from carom.proofs.forms import Surface
from carom.proofs.hypotheses import Hypotheses
from carom.proofs.periods import all_periods
from carom.proofs.rotor import ProvenRotor
from carom.proofs.single_impact import candidates, orbit_claims
from carom.proofs.steady import steady_claims
from carom.proofs.whirl import attracting_speed, whirl_claims

MOST_CELLS = 2000
"""Cells of the periods after which the search for orbits ends."""


class Lost(NamedTuple):
    """A motion that does not return.

    Attributes
    ----------
    words : str
        What it is.
    speed : arb
        Of one of its states, or of states that lead to it, in ``c_r Ω``; for whirl, the speed above which all do.
    """

    words: str
    speed: arb


def steadily_lost(rotor: ProvenRotor) -> Iterator[Lost]:
    """Synchronous rubs and whirl in lasting contact that are proven."""
    n = rotor.numbers
    proven = {claim.name for claim in (*steady_claims(rotor), *whirl_claims(rotor)) if claim.status == "proven"}
    for name in ("rub 1", "rub 2"):
        if f"{name} pressed" in proven:
            yield Lost(f"the synchronous {name} is a motion", arb(1))
    if "whirl attracts sliding" in proven:
        # What is claimed there holds above the upper end, so that the speed itself is not reached.
        speed = attracting_speed(n).upper()
        yield Lost("backward whirl on the wall that is faster than this runs away to rolling", speed)
    elif "whirl rolls" in proven:
        yield Lost("the rotor can roll on the wall for ever", n.radius_ratio)


def lost_on_orbits(rotor: ProvenRotor, evidence: Evidence) -> Iterator[Lost]:
    """Orbits with one impact a period that are proven, each by the slower of its states before and after the impact."""
    n = rotor.numbers
    for _, found in candidates(rotor, all_periods(rotor, evidence, None, MOST_CELLS)):
        for name, course in (found or {}).items():
            if orbit_claims(rotor, name, course)[1] != "proven":
                continue
            radial, along = course.speed, 1 + course.angular_speed
            after = along - n.mu * (1 + n.d) * radial
            speeds = ((radial * radial + along * along).sqrt(), (n.d * n.d * radial * radial + after * after).sqrt())
            yield Lost(f"the orbit {name} is a motion", min(speeds, key=lambda speed: float(speed.upper())))


THEOREM = "states"
OPTIONS = ("states_up_to",)
NOT_CLAIMED = (
    "that states faster than the speed that is shown do not return, but for those that are named",
    "how many impacts occur, how hard they are, or how long recovery takes",
    "anything about a rotor with weight, of compliant walls, or of a shaft whose speed changes",
)
SPEED = Field("states_up_to", "V", "largest speed of a state", "a speed", "m/s", 1e-9, 1e9, '"100 mm/s"')
_WHERE = "inside the clearance or on its wall"


class LargestSpeed:
    """A largest speed in the fixed frame.

    Parameters
    ----------
    hypotheses : Hypotheses
    text : str
        With a unit for a machine, in ``c_r Ω`` for a dimensionless one.
    field : Field
        What it is called, in ``m/s``.

    Attributes
    ----------
    exact : tuple of Fraction and int
        It in m/s, or in ``c_r Ω``: a rational number, times π to a power.
    physical : bool
        Whether it has a unit.

    Raises
    ------
    InputError
        It is no speed.
    """

    def __init__(self, hypotheses: Hypotheses, text: str, field: Field) -> None:
        number = read_size(field, text, hypotheses)
        self.text, self.exact, self.physical = text, (number.low, number.turns), hypotheses.table == "machine"
        self._hypotheses = hypotheses

    def share(self, share: Fraction) -> arb:
        """Ball of a share of it, in ``c_r Ω``."""
        return rational(self.exact[0] * share) * arb.pi() ** self.exact[1] / self.unit

    @property
    def unit(self) -> arb:
        """``c_r Ω`` in m/s as a ball, or 1 for a dimensionless machine."""
        return unit_of(self._hypotheses, "clearance", "speed")


def state_claims(rotor: ProvenRotor, evidence: Evidence, options: Document) -> list[Claim]:
    """Claims from forms that are searched for or read."""
    limit = LargestSpeed(rotor.hypotheses, options["states_up_to"], SPEED)
    share = _share(rotor, evidence, limit)
    lost = list(steadily_lost(rotor))
    reach = limit.share(Fraction(1))
    if share != 1 and _slowest_below(lost, reach) is None:
        lost += lost_on_orbits(rotor, evidence)
    slowest = min(lost, key=lambda entry: float(entry.speed.upper()), default=None)
    return [_recover_claim(limit, share), _lost_claim(limit, slowest), _all_claim(rotor, limit, share, lost)]


def _share(rotor: ProvenRotor, evidence: Evidence, limit: LargestSpeed) -> Fraction | None:
    """The share of the largest speed up to which all states are shown to return; ``None`` if none is."""
    n = rotor.numbers
    if not (n.gamma > 0 and n.omega_squared > 0 and n.levitation < 1):
        return None
    wall = Surface.of(n)
    found: object = evidence.take("forms", lambda: search(wall, limit.share(Fraction(1))))
    if found is None:
        return None
    if not (isinstance(found, list) and len(found) == len(("share", "traps", "limits"))):
        raise NotShownError("the forms of the certificate are not complete")
    share = rational_of(found[0])
    if not (0 < share <= 1 and shown(wall, limit.share(share), *found[1:])):
        raise NotShownError("the forms of the certificate do not show that all states return")
    return share


def _recover_claim(limit: LargestSpeed, share: Fraction | None) -> Claim:
    numbers: dict[str, Enclosure] = {}
    if share is not None:
        numbers = enclosures_of(speed=limit.share(share))
        if limit.physical and not limit.exact[1]:
            numbers["speed_si"] = enclosure_of_fraction(limit.exact[0] * share)
    return claim_of(
        "states",
        "recover",
        f"From every state {_WHERE}, no faster than the lower end of speed as seen in the fixed frame, the rotor returns to levitation, "
        "through whatever impacts and lasting contact: no other motion begins there.",
        0 if share is None else 1,
        reason="no forms were found that show it of any speed: damping is too weak beside unbalance and friction, or the search is too coarse",
        enclosures=numbers,
        limited=False,
    )


def _lost_claim(limit: LargestSpeed, slowest: Lost | None) -> Claim:
    numbers: dict[str, Enclosure] = {}
    if slowest is not None:
        numbers = enclosures_of(speed=slowest.speed)
        if limit.physical:
            numbers |= enclosures_of(speed_si=slowest.speed * limit.unit)
    stated = "" if slowest is None else f": {slowest.words}"
    return claim_of(
        "states",
        "lost",
        f"For every speed above the upper end of speed there is a slower state {_WHERE} from which the rotor never returns to levitation{stated}.",
        0 if slowest is None else 1,
        reason="no rub, no whirl in lasting contact and no orbit with one impact a period is proven of it, or looked for",
        enclosures=numbers,
        limited=False,
    )


def _all_claim(rotor: ProvenRotor, limit: LargestSpeed, share: Fraction | None, lost: list[Lost]) -> Claim:
    n, slow = rotor.numbers, _slowest_below(lost, limit.share(Fraction(1)))
    sign, reason = 0, "whether states return that are faster than those of the first claim is open"
    if share == 1:
        sign = 1
    elif n.gamma <= 0 or n.levitation >= 1:
        sign, reason = -1, "there is no levitation inside the wall that attracts"
    elif slow is not None:
        sign, reason = -1, slow.words
    return claim_of(
        "states",
        "all recover",
        f"From every state {_WHERE}, with a speed of at most {limit.text} as seen in the fixed frame, the rotor returns to levitation.",
        sign,
        reason=reason,
        limited=False,
    )


def _slowest_below(lost: list[Lost], speed: arb) -> Lost | None:
    """The slowest motion that does not return and has states slower than a speed."""
    slower = [entry for entry in lost if entry.speed < speed]
    return min(slower, key=lambda entry: float(entry.speed.upper()), default=None)
