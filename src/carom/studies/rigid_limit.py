"""Whether the rigid wall is good enough: the same disturbances on a rigid wall and on walls that give way.

A study of a machine with a rigid wall follows some of its disturbances once more on springs as stiff as real touchdown bearings, with
the damping that gives a free rotor the same restitution; one of a machine whose bearing gives way follows them on the rigid wall with its
restitution.  As the stiffness grows motions tend to those of the rigid wall, slowly where many impacts follow each other
(``docs/theory/walls-that-give-way``), so where disturbances end is compared, not the motions.  These are samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from carom.basins.shares import Share
from carom.disturbances import Sample, VelocityKick
from carom.disturbances.following import follow
from carom.models import HuntCrossley, KelvinVoigt, Rotor, Touchdown, from_matrices, jeffcott
from carom.models.planar import law_of
from carom.motions.budget import NOT_FOLLOWED
from carom.parameters import Scales, TouchdownBearing
from carom.parameters.restitution import (
    damping_ratio_of,
    restitution_of_damping,
    restitution_of_dissipation,
)
from carom.parameters.told import number
from carom.results import fields_of
from carom.studies.trials import in_all
from carom.studies.wording import Wording, listed

BEARINGS = (1e7, 1e8, 1e9)
"""Stiffnesses of real touchdown bearings, N/m: from one on a soft mount to a stiff pair of ball bearings."""
RATIOS = (1e2, 1e3, 1e4)
"""Those of a machine without units, in ``m Ω²``."""
TRIED = 60
"""Disturbances followed on each wall: the smallest share that differs and is likely seen is one in twenty."""
SEED = 4
WITHOUT_COUNTERPART = ("mount_mass", "race_inertia", "offset")
"""Entries of a bearing that a rigid wall has no counterpart of."""


@dataclass(frozen=True)
class OtherWall:
    """How many of the same disturbances end alike on another wall.

    Attributes
    ----------
    stiffness : float or None
        Of the other wall, in ``m Ω²``; ``None``: it is rigid.
    restitution : float
        Of a free rotor, on both.
    alike : Share
        Disturbances that end in the same kind of motion.
    """

    stiffness: float | None
    restitution: float
    alike: Share


def on_other_walls(rotor: Rotor, disturbances: Sequence[Sample]) -> tuple[OtherWall, ...]:
    """Follow disturbances of a planar rotor on its wall and on others; none for other rotors, and without a restitution above zero."""
    others: list[tuple[float | None, Rotor]]
    if rotor.planar is None or rotor.limits or rotor.forces or rotor.system.shaft is not None:
        return ()
    bearing = rotor.definition.bearing_at(0)
    if rotor.has_closed_forms and rotor.planar.d > 0.0:
        unit, restitution = rotor.scales.stiffness if rotor.scales else 1.0, rotor.planar.d
        stiffnesses = [each / unit for each in (BEARINGS if rotor.scales else RATIOS)]
        others = [(each, _on_a_spring(rotor, each)) for each in stiffnesses]
    elif bearing is not None and rotor.scales is not None and not _has_more(bearing):
        restitution = _restitution(law_of(bearing, rotor.scales), disturbances)
        others = [(None, jeffcott(rotor.planar.replace(d=restitution)))]
    else:
        return ()
    drawn = [replace(sample, seed=SEED) for sample in in_all(disturbances, TRIED)]
    own = _ends(rotor, drawn)
    found = []
    for stiffness, other in others:
        ends = _ends(other, drawn)
        if NOT_FOLLOWED in own or NOT_FOLLOWED in ends:
            break
        same = own == ends
        share = Share.of(int(same.sum()), same.size, drawn=True, does="end alike")
        found.append(OtherWall(stiffness, restitution, share))
    return tuple(found)


def _ends(rotor: Rotor, drawn: Sequence[Sample]) -> np.ndarray:
    """Kind of motion in which each disturbance ends."""
    followed = (follow(rotor, each.starts(rotor)) for each in drawn)
    return np.concatenate([ends.outcomes for ends in followed])


def _on_a_spring(rotor: Rotor, stiffness: float) -> Rotor:
    """The rotor in a Kelvin–Voigt wall that gives a free rotor the restitution of its rigid one."""
    at: Any = rotor.planar
    mass, damping, _, spring, forcing = rotor.matrices
    law = KelvinVoigt(stiffness, 2.0 * damping_ratio_of(at.d) * stiffness**0.5)
    touchdown = Touchdown([1.0], law, at.mu, at.radius_ratio + 1.0)
    return from_matrices(
        mass=mass, damping=damping, stiffness=spring, forcing=forcing, touchdowns=[touchdown], scales=rotor.scales
    )


def _has_more(bearing: TouchdownBearing) -> bool:
    """Whether a bearing has parts that a rigid wall has not."""
    return any(getattr(bearing, name) is not None for name in WITHOUT_COUNTERPART)


def _restitution(law: Any, disturbances: Sequence[Sample]) -> float:
    """Restitution of the free rotor by a law; where it changes with the speed of the impact that of the fastest kick."""
    if isinstance(law, HuntCrossley):
        fastest = max(sample.model.fastest for sample in disturbances if isinstance(sample.model, VelocityKick))
        return restitution_of_dissipation(law.dissipation, fastest)
    return restitution_of_damping(0.5 * law.damping / law.stiffness**0.5)


def wall_words(say: Wording, found: Sequence[OtherWall]) -> str:
    """For which touchdown bearings the rigid wall is good enough, in words."""
    tried, restitution = found[0].alike.total, number(found[0].restitution, 3)
    told = listed([str(other.alike.count) for other in found])
    stiffnesses = [say.spring(other.stiffness) for other in found if other.stiffness is not None]
    if not stiffnesses:
        good = "" if found[0].alike.count == tried else "not "
        return (
            f"Of {tried} fresh disturbances {told} would end in the same kind of motion on a rigid wall with the restitution "
            f"{restitution}: as far as these show, the rigid answer is {good}good enough for this bearing."
        )
    differs = [place for place, other in enumerate(found) if other.alike.count < tried]
    if differs and differs[-1] == len(found) - 1:
        good = "none of these bearings ends all of them alike, so a table [touchdown] that states the bearing may change the verdict"
    else:
        good = f"as far as these show, the rigid answer is good enough from {stiffnesses[differs[-1] + 1 if differs else 0]} on"
    return (
        f"The wall is rigid. Of {tried} fresh disturbances {told} end in the same kind of motion on touchdown bearings of "
        f"{listed(stiffnesses)} with the restitution {restitution}: {good}."
    )


def wall_values(found: Sequence[OtherWall], scales: Scales | None) -> dict[str, Any]:
    """The same as plain data."""
    return {
        "restitution": found[0].restitution,
        "walls": [
            {
                "stiffness": other.stiffness,
                **({"stiffness_si": other.stiffness * scales.stiffness} if scales and other.stiffness else {}),
                "rigid": other.stiffness is None,
                **fields_of(other.alike, "count", "total", estimate="fraction", low="low", high="high"),
            }
            for other in found
        ],
    }
