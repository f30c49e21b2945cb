"""What a study does not cover, by what the rotor has."""

from __future__ import annotations

from carom.outcome import STEADY_WORDS
from carom.studies.study_data import StudyData

SAMPLED = "Disturbances other than those simulated{but}. They are samples: one between them, or a larger one, may end elsewhere."
PROVEN_KICKS = ", but for the kicks that are proven to come back"
LONGER_MOTIONS = (
    "Periodic motions with two or more impacts a period, bouncing that never repeats, and motions that alternate "
    "between bounces and lasting contact. They are named only if a simulated disturbance ended in one."
)
RIGID_WALL = (
    "A touchdown bearing that moves, turns or is compliant: the wall is rigid, so the load of an impact is an impulse."
)
COMPLIANT_WALL = "Wear, heat and axial motion of the touchdown bearing: its law is taken as it is stated."
PLANAR = (
    "Changes of speed, gravity, a rotor that bends or tilts, and controllers that do more than a spring and a damper."
)
MATRICES = "Changes of speed, gravity, and controllers that add states of their own."
WEIGHT = "Changes of speed, and controllers that add states of their own."
SYMMETRY = (
    f"What rests on the symmetry of a turn: {STEADY_WORDS['rub']}s, orbits in closed form, and that a kick does the same whatever the angle of the "
    "unbalance is as it strikes. Here that is the angle in the machine file; with others some kicks may end elsewhere."
)
CLOSED_FORMS = (
    "What is known in closed form for the planar rotor alone: whether rolling lasts and from which speed whirl runs away to it, for "
    "which damping and stiffness each motion exists, how levitation ends, and that no orbit is missing."
)
FLEXIBLE = (
    "Limits of the magnetic bearings that the file does not state, magnetic bearings whose axes differ, coefficients of supports at other speeds, and changes of speed.",
    "Damping of the shaft as it turns with it.",
)
AT_LIMITS = (
    "Other angles of the unbalance to the axes of the magnetic bearings, along which their limits act, as a disturbance strikes than that of the "
    "machine file. Saturation of the iron and limits of the voltage are not modelled."
)
NOT_COVERED = (SAMPLED.format(but=""), LONGER_MOTIONS, RIGID_WALL, PLANAR)
"""What the study of a planar rotor in a rigid wall does not cover."""


def not_covered(study: StudyData) -> tuple[str, ...]:
    """What the study does not cover, by what the rotor has."""
    but = PROVEN_KICKS if study.kicks is not None and study.kicks.share else ""
    compliant = bool((study.rotor.system.arrays["stiffness"] > 0.0).any())
    found = [SAMPLED.format(but=but), LONGER_MOTIONS, COMPLIANT_WALL if compliant else RIGID_WALL]
    if study.known.orbits:
        found.append(PLANAR)
    else:
        left = FLEXIBLE if study.reduced is not None else (WEIGHT if study.heavy else MATRICES,)
        found += [*left, *([SYMMETRY] if study.heavy else []), CLOSED_FORMS]
    return (*found, AT_LIMITS) if study.rotor.system.limits else tuple(found)
