"""The figures of a study, with captions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from carom import plots
from carom.attractors import Ending
from carom.models import Model
from carom.motions.ledger import energy_ledger
from carom.motions.trajectories import simulate
from carom.orbits.orbit import Orbit
from carom.orbits.single_impact import OrbitSet, period_condition
from carom.parameters import Zones
from carom.studies import Study
from carom.studies.endings import ending_phrase, shown_example

MOST_ORBITS = 6
"""Largest number of orbits with figures of their own."""
MOST_ENDINGS = 5
"""Largest number of disturbances shown as examples."""
PANELS = (
    " From top to bottom: distance from the bearing centre; kind of contact and direction of whirl; load on the bearing; "
    "energies and works. Where the swings are too many for a curve, their band is drawn, and the last turns at the bottom."
)
LONGEST_SHOWN = 1000.0
"""Longest time that an example shows, in ``1/Ω``."""
SHOWN_TAIL = 4.0
"""Time that an example shows after its last contact, in time constants of levitation."""


@dataclass(frozen=True)
class Picture:
    """A figure to draw.

    Attributes
    ----------
    name : str
        File name without ending.
    section : str
        ``"motions"``, ``"disturbances"`` or ``"method"``.
    caption : str
    draw : callable
        Returns the figure.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Figure]


def pictures(study: Study) -> list[Picture]:
    """Return all figures of a study in the order of the report."""
    possible = sorted((orbit for orbit in study.orbits if orbit.admissible), key=lambda orbit: not orbit.stable)
    figures = [_overview(study)]
    for orbit in possible[:MOST_ORBITS]:
        figures += _of_orbit(study, orbit)
    figures += _of_disturbances(study)
    figures.append(_condition(study.orbits))
    if possible:
        figures.append(_multipliers(possible))
    return figures


def _overview(study: Study) -> Picture:
    return Picture(
        "overview",
        "motions",
        "All steady motions and single-impact orbits in the frame that turns with the shaft. The circle is the wall: the "
        "rotor centre cannot leave it. A steady whirl is a point here, a bounce a loop that touches the circle.",
        study.plot,
    )


def _of_orbit(study: Study, orbit: Orbit) -> Iterator[Picture]:
    file = _file_name(orbit.name)
    say = study.wording
    kind = "stable, so that the machine can stay on it" if orbit.stable else "unstable, so that the machine leaves it"
    yield Picture(
        f"orbit-{file}",
        "motions",
        f"Orbit {orbit.name}, {kind}: one impact every {say.time(orbit.period)}. Above in the frame that turns with the "
        "shaft, where it repeats; below as seen from outside.",
        lambda: plots.orbit(orbit),
    )
    zones = _zones(study, np.abs(orbit.path(np.linspace(0.0, orbit.period, 400))))
    shades = "shaded are the zones of amplitude" if zones else "all of it in zone D"
    yield Picture(
        f"radius-{file}",
        "motions",
        f"Distance of the rotor centre from the bearing centre on orbit {orbit.name}; {shades}.",
        lambda: plots.radius(orbit, zones),
    )


def _zones(study: Study, radii: np.ndarray) -> Zones | None:
    """Return the zones to draw; ``None`` if a motion stays in the last zone, so that it is drawn enlarged."""
    zones = study.case.zones
    return zones if float(radii.min()) <= zones.limits[-1] else None


def _of_disturbances(study: Study) -> Iterator[Picture]:
    reached = [member for member in study.attractors if member.count]
    for member in reached[:MOST_ENDINGS]:
        example = shown_example(study.attractors, member)
        what = "a kick of the levitating rotor" if example.start.kind == "kick" else "a start within the clearance"
        yield Picture(
            f"disturbance-{_file_name(member.name)}",
            "disturbances",
            f"After {what} at {study.wording.velocity(example.start.speed)} the rotor ends {ending_phrase(member.name)}, "
            f"as {'does' if member.count == 1 else 'do'} {member.count} of {len(study.attractors.disturbances)} disturbances of "
            f"up to {study.wording.velocity(study.attractors.fastest)}."
            f"{PANELS if example.impacts else ''}",
            lambda example=example: _history(study, example),  # type: ignore[misc]
        )


def _file_name(name: str) -> str:
    return "".join(character if character.isalnum() else "-" for character in name.replace(",", "")).strip("-")


def _history(study: Study, example: Ending) -> Figure:
    """Draw the motion until it has settled, with forces and energies; a return to levitation a little longer."""
    if example.recovered:
        motion = simulate(study.rotor, example.start.state, until_decayed(study.rotor, example.time))
    else:
        motion = simulate(study.rotor, example.start.state, LONGEST_SHOWN, settle=True)
    if len(motion.contacts) or motion.lasting_contacts:
        return plots.touchdown(motion, energy_ledger(motion))
    return plots.radius(motion, _zones(study, motion.radius(motion.sample())))


def until_decayed(rotor: Model, time: float) -> float:
    """Return the time until which a motion is shown that returns to levitation at a time, in ``1/Ω``."""
    decay = -float(rotor.system.exponents.real.max())
    return min(time + (SHOWN_TAIL / decay if decay > 0.0 else 0.0), LONGEST_SHOWN)


def _condition(orbits: OrbitSet) -> Picture:
    roots = orbits.periods
    end = orbits.longest_period
    if len(roots):
        end = min(end, max(1.5 * float(roots[-1]), 10.0))
    periods = np.linspace(end / 4000.0, end, 4000)
    return Picture(
        "period-condition",
        "method",
        "The condition that the period of a single-impact orbit meets. Each zero gives up to two orbits, so the zeros "
        "show that the list of orbits is complete.",
        lambda: plots.period_condition(orbits, periods, period_condition(orbits.rotor, periods)),
    )


def _multipliers(possible: list[Orbit]) -> Picture:
    return Picture(
        "multipliers",
        "method",
        "Multipliers of the possible orbits: a small disturbance is multiplied by these numbers from impact to impact. An "
        "orbit is stable if all of them lie inside the unit circle.",
        lambda: plots.multipliers(possible[:12]),
    )
