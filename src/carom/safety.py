"""The least damping above which no contact motion survives, and which motion sets it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from carom.attractors.following import endings_of
from carom.attractors.groups import Groups
from carom.attractors.search import PATIENCE
from carom.attractors.starts import DISTURBANCES, FASTEST, Start, disturbances
from carom.orbits import orbits_within_reach
from carom.outcome import InputError, Outcome
from carom.parameters import DIMENSIONLESS_FIELDS, Parameters
from carom.rotors import Rotor, jeffcott
from carom.trajectories import Trajectory
from carom.whirl import Rolling, Runaway, rolling, rub_limit, runaway_speed

__all__ = ["DampingLimit", "SafeDamping", "least_safe_damping"]

GRID = 32
"""Dampings looked at, in geometric progression, before the uppermost change is bisected."""
LOWEST = 0.02
HIGHEST = 8.0
"""Range of ``γ`` looked at, in units of the largest of 1, ``ω`` and (the upper end only) the machine's own ``γ``."""
SIMULATED, SEARCHED = 1e-3, 1e-9
"""Relative width to which simulated and searched limits are bisected."""

Evidence = Literal["closed form", "search", "simulation"]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class DampingLimit:
    """A damping up to which a contact motion exists.

    Attributes
    ----------
    motion : str
        ``"synchronous rub"``, ``"rolling"``, or the name of an orbit or attractor.
    gamma : float
        The largest damping at which it was found or is known to exist.
    above : float
        A damping from which on it is gone; the same as ``gamma`` where that is exact.
    evidence : {"closed form", "search", "simulation"}
        A closed form; a search over dampings by motions that are complete at each of them; a sample of simulated
        disturbances.
    """

    motion: str
    gamma: float
    above: float
    evidence: Evidence


@dataclass(frozen=True, eq=False)
class SafeDamping:
    """How much damping it takes that no contact motion survives, the other parameters as they are.

    Attributes
    ----------
    parameters : Parameters
        ``gamma`` is the machine's own and has no effect beyond the range looked at.
    rub : DampingLimit or None
        Stable synchronous rub; ``None`` if there is none with positive damping.
    orbits : DampingLimit or None
        Admissible orbits with one impact a period, stable or not.
    simulated : DampingLimit or None
        Whatever the simulated disturbances ended in, other than levitation.
    rolling : DampingLimit or None
        Rolling in backward whirl, which takes a fast start to get into.
    runaway : Runaway
        How fast, at the limit ``within_reach``.
    lowest, highest : float
        Range of ``gamma`` that was looked at for orbits and by simulation.
    disturbances : int
        Simulated at each damping.
    seed, fastest : int, float
        Of the sample; see :func:`~carom.attractors.disturbances`.
    """

    parameters: Parameters
    rub: DampingLimit | None
    orbits: DampingLimit | None
    simulated: DampingLimit | None
    rolling: DampingLimit | None
    runaway: Runaway
    lowest: float
    highest: float
    disturbances: int
    seed: int
    fastest: float

    @property
    def within_reach(self) -> DampingLimit | None:
        """The limit that counts for the disturbances tested: all but rolling, unless they reached it.

        ``None`` if levitation is the only motion at any positive damping.
        """
        return _within_reach(self.rub, self.orbits, self.simulated)

    @property
    def at_all(self) -> DampingLimit | None:
        """The limit that counts for any start, however fast: rolling included."""
        limits = [limit for limit in (self.within_reach, self.rolling) if limit]
        return max(limits, key=lambda limit: limit.above, default=None)

    @property
    def words(self) -> str:
        """What was found, and what it rests on."""
        return " ".join(sentence for sentence in (self._reach(), self._rolling(), self._evidence()) if sentence)

    def _reach(self) -> str:
        limit = self.within_reach
        if limit is None:
            return "At any damping looked at, all disturbances tested come back to levitation."
        if limit.above > self.highest:
            return f"Contact motions survive up to the highest damping looked at, {self._damping(self.highest)}."
        known = {
            "closed form": "a closed form",
            "search": "a search over dampings",
            "simulation": "simulation",
        }[limit.evidence]
        return (
            f"Above {self._damping(limit.above)} all disturbances tested come back to levitation. The last motion to "
            f"vanish is {_with_article(limit.motion)}, known by {known}."
        )

    def _rolling(self) -> str:
        if not self.rolling:
            return "Rolling in backward whirl cannot sustain itself at any damping."
        reached = self.simulated is not None and self.simulated.motion == "rolling"
        return (
            f"Rolling in backward whirl sustains itself up to {self._damping(self.rolling.gamma)}: once there, the rotor "
            f"stays. At the limit above, contact surely leads there from backward speeds along the wall over "
            f"{self._speed(self.runaway.certain)}; {'some' if reached else 'none'} of the disturbances tested got there."
        )

    def _evidence(self) -> str:
        return (
            f"The simulations are evidence, not proof: {self.disturbances} disturbances of up to "
            f"{self._speed(self.fastest)} (seed {self.seed}) at dampings up to {self._damping(self.highest)} in steps of "
            f"{100.0 * ((self.highest / self.lowest) ** (1.0 / (GRID - 1)) - 1.0):.0f} %."
        )

    def _damping(self, gamma: float) -> str:
        scales = self.parameters.scales
        return f"gamma = {gamma:.5g}" + (f" ({gamma * scales.damping:.4g} N s/m)" if scales else "")

    def _speed(self, speed: float) -> str:
        scales = self.parameters.scales
        return f"{speed:.3g} c_r Omega" + (f" ({speed * scales.velocity:.3g} m/s)" if scales else "")


def _with_article(motion: str) -> str:
    return f"the {motion}" if motion == "synchronous rub" else motion


def _within_reach(
    rub: DampingLimit | None, orbits: DampingLimit | None, simulated: DampingLimit | None
) -> DampingLimit | None:
    known = max((limit for limit in (rub, orbits) if limit), key=lambda limit: limit.above, default=None)
    # A simulated motion that ends within the width of its bracket of a known one is that one.
    if simulated and (known is None or simulated.gamma > known.above):
        return simulated
    return known


def least_safe_damping(
    parameters: Parameters,
    *,
    seed: int = 0,
    count: int = DISTURBANCES,
    fastest: float = FASTEST,
    highest: float | None = None,
    progress: Progress | None = None,
) -> SafeDamping:
    """Find the least damping above which no contact motion survives.

    The synchronous rub (:func:`~carom.whirl.rub_limit`) and rolling (:func:`~carom.whirl.rolling`) have closed forms.
    Single-impact orbits are complete at each damping; their uppermost limit is bisected.  What else there may be (orbits
    with several impacts, irregular bouncing, motions with rub) is left to simulation: from the highest damping down, a
    sample of disturbances is followed to where they settle, until one does not levitate; its motion is then followed
    upward by bisection, with the sample tried again at each step.

    Parameters
    ----------
    parameters : Parameters
        Of the planar rotor.
    seed, count, fastest : int, int, float
        Of the sample of disturbances; see :func:`~carom.attractors.disturbances`.
    highest : float, optional
        Largest ``γ`` to look at.
    progress : callable, optional
        Called with the share done, 0 to 1.

    Returns
    -------
    SafeDamping

    Raises
    ------
    InputError
        ``highest`` is not above the lowest damping looked at.
    """
    tell = progress or (lambda share: None)
    unit = max(1.0, parameters.omega)
    lowest = LOWEST * unit
    if highest is None:
        highest = min(HIGHEST * max(unit, parameters.gamma), DIMENSIONLESS_FIELDS["gamma"].highest)
    if not (math.isfinite(highest) and highest > lowest):
        raise InputError("highest", highest, f"a finite damping above {lowest:g}")
    grid = np.geomspace(highest, lowest, GRID)
    rotor = jeffcott(parameters)
    end = rub_limit(rotor)
    rub = DampingLimit("synchronous rub", end, end, "closed form") if end > 0.0 and parameters.d < 1.0 else None
    orbits = _uppermost(parameters, grid, _OrbitTest(), SEARCHED, "search", lambda share: tell(0.2 * share))
    test = _SampleTest(seed, count, fastest)
    simulated = _uppermost(parameters, grid, test, SIMULATED, "simulation", lambda share: tell(0.2 + 0.8 * share))
    limit = _within_reach(rub, orbits, simulated)
    runaway = runaway_speed(jeffcott(parameters.replace(gamma=limit.gamma)) if limit else rotor)
    return SafeDamping(
        parameters,
        rub,
        orbits,
        simulated,
        _rolling_limit(rolling(rotor)),
        runaway,
        lowest,
        highest,
        count,
        seed,
        fastest,
    )


def _rolling_limit(roll: Rolling) -> DampingLimit | None:
    if roll.least_force <= 0.0 or roll.largest_damping <= 0.0:
        return None
    return DampingLimit("rolling", roll.largest_damping, roll.damping_bound, "closed form")


def _uppermost(
    parameters: Parameters,
    grid: np.ndarray,
    test: _OrbitTest | _SampleTest,
    width: float,
    evidence: Evidence,
    progress: Progress,
) -> DampingLimit | None:
    """Go down the grid to the first damping at which a test finds a motion, and bisect above it."""
    clear = math.inf
    for place, gamma in enumerate(grid):
        motion = test(jeffcott(parameters.replace(gamma=float(gamma))))
        progress((place + 1) / len(grid) if not motion else 0.9)
        if motion:
            break
        clear = float(gamma)
    else:
        return None
    found = float(gamma)
    while math.isfinite(clear) and clear - found > width * found:
        middle = math.sqrt(found * clear)
        if not found < middle < clear:
            break
        again = test(jeffcott(parameters.replace(gamma=middle)))
        if again:
            found, motion = middle, again
        else:
            clear = middle
    progress(1.0)
    return DampingLimit(motion, found, clear, evidence)


class _OrbitTest:
    """Finds an admissible single-impact orbit, or an empty name."""

    def __call__(self, rotor: Rotor) -> str:
        real = [orbit for orbit in orbits_within_reach(rotor) if orbit.admissible]
        return min(real, key=lambda orbit: not orbit.stable).name if real else ""


class _SampleTest:
    """Finds a disturbance that does not levitate, or an empty name; begins with the motion found last."""

    def __init__(self, seed: int, count: int, fastest: float) -> None:
        self.seed, self.count, self.fastest = seed, count, fastest
        self.last: Start | None = None

    def __call__(self, rotor: Rotor) -> str:
        sample: Sequence[Start] = disturbances(rotor, self.count, self.seed, self.fastest)
        groups = Groups(())
        ends: list[Trajectory] = []

        def name_of(motion: Trajectory) -> str:
            ends.append(motion)
            return groups.name_of(motion)

        for start in (*([self.last] if self.last else []), *sample):
            (ending,) = endings_of(rotor, [start], PATIENCE, name_of, lambda share: None)
            if ending.outcome is not Outcome.LEVITATED:
                if ending.outcome is not Outcome.ROLLING:
                    self.last = Start("start", ends[-1].final, ending.attractor)
                return ending.attractor
        return ""
