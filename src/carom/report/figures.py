"""The figures of a study, with captions; first of all where disturbances end now, and where after the change that is advised."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from carom import plots
from carom.attractors import Ending
from carom.base.outcome import Outcome
from carom.basins import Cells, map_cells
from carom.disturbances import Disturbance, Grid, KickPlane
from carom.disturbances.plans import ITS_INSTANT
from carom.models import Rotor, axis
from carom.motions.courses import FOLLOWED, first_contacts, shown_until
from carom.motions.simulation import simulate
from carom.parameters import in_terms_of
from carom.report.html import ReportPicture
from carom.studies import Study
from carom.studies.questions import LABELS, MANY_MODES, Kind, required_kinds
from carom.studies.response import unbalance_response
from carom.studies.wording import ending_phrase, entry_words

if TYPE_CHECKING:
    from carom.motions import Trajectory

MOST_ORBITS = 2
"""Largest number of stable orbits with figures of their own."""
MOST_ENDINGS = 5
"""Largest number of disturbances shown as examples."""
LONGEST_SHOWN = 1000.0
"""Longest time that an example shows, in ``1/Ω``."""
SHOWN_TAIL = 4.0
"""Time that an example shows after its last contact, in time constants of levitation."""
SHORTEST_TAIL = 20.0 * math.pi
"""Time that it shows then even if it touched for a shorter one: ten turns."""


def pictures(study: Study) -> list[ReportPicture]:
    """Return all figures of a study in the order of the report."""
    possible = sorted((orbit for orbit in study.orbits if orbit.admissible), key=lambda orbit: not orbit.stable)
    figures, kicks = list[ReportPicture](), study.kicks
    if drawable(study):
        figures.append(ReportPicture("basins", "basins", basin_caption(study), partial(draw_basins, study)))
    # Under weight levitation is no point there, and one point alone is not worth a picture.
    if not study.under_gravity and len(study.equilibria) + len(possible) > 1:
        words = (
            "All steady motions and single-impact orbits in the frame that turns with the shaft: a synchronous whirl is a point, bouncing "
            "is a loop, and points on the circle are in contact."
        )
        figures.append(ReportPicture("overview", "motions", words, study.plot))
    figures += [*_of_disturbances(study), *_of_levitation(study), *_of_loads(study)]
    if kicks is not None:
        words = "Each point is a kick of the levitating rotor: the colour shows what is proven for its cell, or why it is open."
        figures.append(ReportPicture("proven-kicks", "proven", words, kicks.plot))
    for orbit in study.stable_orbits[:MOST_ORBITS]:
        words = (
            f"Bouncing of the rotor on the orbit {orbit.name}, with an impact every {study.wording.time(orbit.period)}. Top: in the "
            "frame that turns with the shaft, where each bounce is the same loop; bottom: in the fixed frame."
        )
        figures.append(ReportPicture(f"orbit-{_file_name(orbit.name)}", "method", words, orbit.plot))
    if possible:
        words = (
            "Multipliers: growth factors of a small disturbance from impact to impact. The orbit is stable if all lie "
            "inside the unit circle."
        )
        figures.append(ReportPicture("multipliers", "method", words, partial(plots.multipliers, possible[:12])))
    return figures


def _of_disturbances(study: Study) -> Iterator[ReportPicture]:
    reached = [member for member in study.attractors if member.count]
    for member in reached[:MOST_ENDINGS]:
        example = study.attractors.example_of(member)
        what = "a kick of the levitating rotor" if example.start.kind == "kick" else "a start within the clearance"
        shown = (
            "with its distance from the centre, contact and load over time" if example.impacts else "without contact"
        )
        # Coordinates of several are no displacements, so that their rates have no size in mm/s.
        fast = "" if np.ndim(example.start.state.position) else f" at {study.wording.velocity(example.start.speed)}"
        yield ReportPicture(
            f"disturbance-{_file_name(member.name)}",
            "motions",
            f"After {what}{fast} the rotor ends {ending_phrase(member.name)}, "
            f"as {'does' if member.count == 1 else 'do'} {member.count} of {len(study.attractors.disturbances)} disturbances "
            f"tried: {shown}.",
            partial(_history, study, example),
        )


def _of_levitation(study: Study) -> Iterator[ReportPicture]:
    """Whirls, response and sensitivity of a flexible machine."""
    found = study.levitating
    machine = found.machine
    if machine is None or found.campbell is None:
        return
    whirls = "Whirl modes over shaft speed (Campbell diagram, all modes) and their damping ratios. Unbalance excites forward modes where they cross the synchronous line; with large damping the response peaks lie elsewhere."
    yield ReportPicture("campbell", "levitating", whirls, found.campbell.plot)
    shapes = "Shapes of the lowest whirl modes along the shaft at the operating speed."
    yield ReportPicture("shapes", "levitating", shapes, lambda: plots.mode_shapes(machine, found.whirls))
    if found.response is not None:
        radii = "Unbalance response over shaft speed at the touchdown bearings: vibration (peak to peak) and phase."
        ends = float(found.response.speeds[0]), float(found.response.speeds[-1])
        yield ReportPicture("unbalance", "levitating", radii, lambda: unbalance_response(study.case, ends).plot())
    if found.sensitivity is not None:
        peaks = "Sensitivity of each control loop, with the zones of ISO 14839-3."
        yield ReportPicture("sensitivity", "levitating", peaks, found.sensitivity.plot)


def _of_loads(study: Study) -> Iterator[ReportPicture]:
    """Of each kind that must be survived the motion with the largest load, and the drop, at each touchdown bearing."""
    motions = [
        (str(each.kind), f"after the {LABELS[each.kind].lower()} with the largest load or the widest orbit", each.worst)
        for each in study.full_size
    ]
    if study.drop is not None and study.drop.motion is not None:
        motions.append(("drop", "after levitation is lost", study.drop.motion))
    several = len(study.rotor.system.contacts) > 1
    for name, when, motion in motions:
        for plane in range(len(study.rotor.system.contacts)):
            at = f" at touchdown bearing {plane + 1}" if several else ""
            bearing, mark = (f", touchdown bearing {plane + 1}", f"-{plane + 1}") if several else ("", "")
            title, seen = f"{name.replace('_', ' ').capitalize()}{bearing}", motion.seen_at(plane)
            words = f"Orbit of the shaft{at} {when}, in the fixed frame."
            yield ReportPicture(f"{name}{mark}", "loads", words, partial(plots.drop_orbit, seen, title=title))
            if touched(seen):
                until = _until(seen)
                cut = f" Drawn: the first {FOLLOWED} contacts." if until < shown_until(seen) else ""
                words = f"Distance from the centre, contact force and slip over time{at} {when}.{cut}"
                loads = partial(plots.touchdown, seen, title=title, until=until)
                yield ReportPicture(f"{name}-loads{mark}", "loads", words, loads)


def _file_name(name: str) -> str:
    return "".join(character if character.isalnum() else "-" for character in name.replace(",", "")).strip("-")


def _history(study: Study, example: Ending) -> Figure:
    """Draw the motion until it has settled, with its forces; a return to levitation a little longer."""
    if example.recovered:
        motion = simulate(study.rotor, example.start.state, until_decayed(study.rotor, example.time))
    else:
        motion = simulate(study.rotor, example.start.state, LONGEST_SHOWN, settle=True)
    if touched(motion):
        return plots.touchdown(motion, until=_until(motion))
    # A motion that stays in the last zone is drawn enlarged, without zones.
    zones, nearest = study.case.zones, float(motion.radius(motion.sample()).min())
    return plots.radius(motion, zones if nearest <= zones.limits[-1] else None)


def _until(motion: Trajectory) -> float:
    """Until when a motion is drawn over time: for persistent bouncing only as many contacts as can be distinguished."""
    until = shown_until(motion)
    return min(until, first_contacts(motion, FOLLOWED)) if motion.outcome is Outcome.BOUNCING else until


def touched(motion: Trajectory) -> bool:
    """Whether a motion touches its touchdown bearing in any of its stages."""
    parts = [part.seen_at(motion.plane) for part in motion.parts]
    return any(len(part.contacts) or part.lasting_contacts for part in parts)


def until_decayed(rotor: Rotor, time: float) -> float:
    """Time until which a motion is shown that returns to levitation at a time, in ``1/Ω``: not so long that its contacts cannot be seen."""
    decay = rotor.system.decay
    tail = min(SHOWN_TAIL / decay, max(2.0 * time, SHORTEST_TAIL)) if decay > 0.0 else 0.0
    return min(time + tail, LONGEST_SHOWN)


CELLS: dict[Kind, tuple[tuple[int, ...], tuple[int, ...]]] = {
    "kick": ((120, 120), (20, 20)),
    "shock": ((24, 60), (6, 24)),
    "base_record": ((12, 24), (4, 12)),
    "blade_loss": ((120,), (36,)),
}
"""Cells of a basin, and of one of rotors of many modes, whose motions take milliseconds each: both parts of a kick, peak and direction of a shock, phase of the
change of the unbalance by the loss of a blade."""
BEYOND = 1.5
"""Largest disturbance of a basin relative to the smallest that does not come back, where all that must be survived came back."""

_MISSING = {
    "no-change-needed": "No change is indicated: all that was tried of what it must survive came back.",
    "no-change-found": "No change is advised: no damping or stiffness tried brings all back.",
    "not-decided": "No change is advised: too few of the disturbances that it must survive could be followed.",
}
_SEEN: dict[Kind, str] = {
    "kick": "Each point is a kick of the levitating rotor, the farther out the harder, and its colour says where it ends.",
    "shock": "Each point is a shock of the base, the farther out the harder, and its colour says where it ends.",
    "base_record": "Each point is the recorded motion of the base, the farther out the harder, turned by an angle, and its colour says where it ends.",
    "blade_loss": "Each angle is the phase of the change of the unbalance by the loss of a blade, counted from the right, where the unbalance "
    "is before it, and its colour says where it ends.",
}


def decisive(study: Study) -> Kind:
    """The kind of disturbance that is shown: of those that must be survived the one most often lost, otherwise kicks."""
    lost = study.unrecovered_kinds
    return min(lost, key=lambda entry: entry[1].fraction if entry[1] else 1.0)[0] if lost else "kick"


def basin_caption(study: Study) -> str:
    """What is to be seen."""
    words = [_SEEN[decisive(study)]]
    if study.rotor.depends_on_instant:
        words.append(f"Each comes {ITS_INSTANT}.")
    if not study.levitates:
        words.append("Now there is no stable levitation to come back to.")
    if study.recommendation.advised is None:
        words.append(_MISSING[study.recommendation.kind])
    return " ".join(words)


def draw_basins(study: Study) -> Figure:
    """Draw the basin now, and beside it that after the change that is advised."""
    kind, change = decisive(study), study.recommendation.advised
    model = _disturbances(study, kind)
    panels = [("now" if change else "", _basin(study.rotor, model, kind))] if study.levitates else []
    if change is not None:
        # As the study moved the machine to the value that it checked.
        changed = axis(study.rotor, change.parameter).move(study.rotor, change.value)
        there = _basin(changed, model.rescaled(study.rotor.scales, changed.scales), kind)
        entry, value = entry_words(change.terms.entry), in_terms_of(study.case, change.parameter, change.present).text
        panels = [(f"{title}\n{entry} {value}", cells) for title, cells in panels]
        panels.append((f"after the change\n{entry} {change.terms.text}", there))
    with plots.heading(study.case.name):  # the panels say the values
        return plots.basin_pair(panels, None if kind == "blade_loss" else _required(study, kind)[0])


def drawable(study: Study) -> bool:
    """Whether there is any basin: now, or after a change."""
    return study.levitates or study.recommendation.advised is not None


def _basin(rotor: Rotor, model: Disturbance, kind: Kind) -> Cells:
    return map_cells(rotor, Grid(model, CELLS[kind][rotor.system.modes > MANY_MODES]))


def _required(study: Study, kind: Kind) -> tuple[float, Disturbance]:
    """What must be survived of a kind: its size and the disturbances up to it."""
    return next((size, model) for each, size, model in required_kinds(study.required) if each == kind)


def _disturbances(study: Study, kind: Kind) -> Disturbance:
    """Disturbances up to what must be survived, or beyond the smallest that does not come back if that is larger."""
    size, model = _required(study, kind)
    if kind == "blade_loss":
        return model
    found = getattr(study.survives, kind, None)
    reach = size if found is None or found.size is None or found.size <= size else BEYOND * found.size
    return KickPlane(reach) if kind == "kick" else replace(model, **{"peak" if kind == "shock" else "largest": reach})
