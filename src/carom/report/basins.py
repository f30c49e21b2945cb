"""What the report begins with: where disturbances end now, and where they end after the change that is advised."""

from __future__ import annotations

from matplotlib.figure import Figure

from carom import plots
from carom.basins import Cells, map_cells
from carom.disturbances import BaseShock, BladeLoss, Disturbance, Grid, KickPlane
from carom.disturbances.plans import ITS_INSTANT
from carom.models import Rotor, axis
from carom.parameters import in_terms_of
from carom.studies import Study
from carom.studies.questions import MANY_MODES, Kind, required_kinds
from carom.studies.wording import entry_words

CELLS: dict[Kind, tuple[int, ...]] = {"kick": (120, 120), "shock": (24, 60), "blade_loss": (120,)}
"""Cells of a basin: both parts of a kick, peak and direction of a shock, phase of the change of the unbalance by the loss of a blade."""
CELLS_OF_MANY_MODES: dict[Kind, tuple[int, ...]] = {"kick": (20, 20), "shock": (6, 24), "blade_loss": (36,)}
"""The same of rotors of many modes, whose motions take milliseconds each."""
BEYOND = 1.5
"""Largest disturbance of a basin relative to the smallest that does not come back, where all that must be survived came back."""

_MISSING = {
    "no-change-needed": "No change is needed: all that was tried of what it must survive came back.",
    "no-change-found": "No change is advised: no damping or stiffness tried brings all back.",
    "not-decided": "No change is advised: too few of the disturbances that it must survive could be followed.",
}
_SEEN: dict[Kind, str] = {
    "kick": "Each point is a kick of the levitating rotor, the farther out the harder, and its colour says where it ends.",
    "shock": "Each point is a shock of the base, the farther out the harder, and its colour says where it ends.",
    "blade_loss": "Each angle is the phase of the change of the unbalance by the loss of a blade, counted from the right, where the unbalance "
    "is before it, and its colour says where it ends.",
}


def decisive(study: Study) -> Kind:
    """The kind of disturbance that is shown: of those that must be survived the one most often lost, otherwise kicks."""
    lost = study.unrecovered_kinds
    return min(lost, key=lambda entry: entry[1].fraction if entry[1] else 1.0)[0] if lost else "kick"


def caption(study: Study) -> str:
    """What is to be seen."""
    words = [_SEEN[decisive(study)]]
    if study.rotor.depends_on_instant:
        words.append(f"Each comes {ITS_INSTANT}.")
    if not study.levitates:
        words.append("Now there is no stable levitation to come back to.")
    if study.recommendation.advised is None:
        words.append(_MISSING[study.recommendation.kind])
    return " ".join(words)


def draw(study: Study) -> Figure:
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
        return plots.basin_pair(panels, None if kind == "blade_loss" else _required(study, kind))


def drawable(study: Study) -> bool:
    """Whether there is any basin: now, or after a change."""
    return study.levitates or study.recommendation.advised is not None


def _basin(rotor: Rotor, model: Disturbance, kind: Kind) -> Cells:
    cells = CELLS_OF_MANY_MODES if rotor.system.modes > MANY_MODES else CELLS
    return map_cells(rotor, Grid(model, cells[kind]))


def _required(study: Study, kind: Kind) -> float:
    """Size of a kind that must be survived."""
    return next(size for each, size, _ in required_kinds(study.required) if each == kind)


def _disturbances(study: Study, kind: Kind) -> Disturbance:
    """Disturbances up to what must be survived, or beyond the smallest that does not come back if that is larger."""
    size = _required(study, kind)
    if kind == "blade_loss":
        return BladeLoss(size, study.required.blade_loss_node)
    found = getattr(study.survives, kind, None)
    reach = size if found is None or found.size is None or found.size <= size else BEYOND * found.size
    shock = study.required.shock if kind == "shock" else None
    return KickPlane(reach) if shock is None else BaseShock(reach, shock.duration)
